/* Code map: the legend of somebody's land cover, code by code, in classes of ours. A text file of
 * lines
 *
 *     CODE = CLASS            # what the legend calls it
 *     LOW-HIGH = CLASS
 *     CODE = none             # known, but no ground: no data
 *
 * Codes are whole numbers 0..65535. A code that the file does not name is unknown, and nothing is
 * guessed for it. */
#ifndef GIS_CODE_MAP_H
#define GIS_CODE_MAP_H

#include "hs/class_table.h"

#include <gdal.h>
#include <stdint.h>

enum { DB_CODES = 65536, DB_CODE_LINES_MAX = 512, DB_CODE_UNKNOWN = -1 };

struct db_code_line {
    int low, high;
    int class_index; /* of the table, or DB_CLASS_NODATA */
    char legend[120];
};

struct db_code_map {
    struct db_code_line lines[DB_CODE_LINES_MAX];
    int count;
    int16_t line_of[DB_CODES]; /* DB_CODE_UNKNOWN: none */
    int unknown_class;         /* class of unknown codes, DB_CLASS_NODATA, or DB_CODE_UNKNOWN */
};

/* Read the file. Unknown codes stay unknown. Returns 0, or -1 with file, line, cause and remedy
 * reported:
 * - the file cannot be read, names no code, or has more than DB_CODE_LINES_MAX lines,
 * - a line is no `code = class`, or its code or class is none,
 * - a code is named twice. */
int db_code_map_read(struct db_code_map *map, const char *path, const struct db_class_table *table);

/* The class of a code: an index of the table, DB_CLASS_NODATA, or DB_CODE_UNKNOWN. */
int db_code_map_class(const struct db_code_map *map, long code);

/* Read the whole band, and print each code that occurs with its pixels, share, class and legend.
 * Pixels of the band's own nodata value are no code. `path` names the file in messages. Returns 0,
 * or -1 with the error reported:
 * - the band's values are no whole numbers, or it cannot be read,
 * - a code is unknown, and map->unknown_class gives it no class: all such codes are named.
 *
 * Cost: one pass over the file; 64 MiB of memory at most. */
int db_code_map_survey(const struct db_code_map *map, const struct db_class_table *table,
                       GDALRasterBandH band, const char *path);

#endif
