/* Detail for an image that is being built: a text file (docs/database.md, "Detail") in, the section
 * DETAIL out. It is cut by tiles of LOD 0; the records are those of lm/detail.h.
 *
 * Example: detail of an image whose plan is made.
 *
 *     struct build_detail detail;
 *     if (build_detail_read(&detail, path, &settings) != 0) {
 *         return -1;
 *     }
 *     struct build_detail_record r = build_detail_of_tile(&detail, row, column);
 *     ...
 *     build_detail_free(&detail); */
#ifndef BUILD_DETAIL_H
#define BUILD_DETAIL_H

#include "build/facing.h"
#include "hs/class_table.h"
#include "lm/detail.h"
#include "reflectivity/reflect.h"

#include <stddef.h>
#include <stdint.h>

struct build_detail_settings {
    uint8_t shift0;
    uint32_t seed;                      /* of the roofs' reflectivity */
    const struct db_class_table *table; /* borrowed, as are the laws of its classes */
    const struct db_reflect_law *laws;
    const struct build_facing *facing; /* class numbers by the turn of a wall; borrowed */
};

/* Item with its tile, and the place in the file that keeps the order of equals. */
struct build_detail_item {
    uint32_t row, column, order;
    struct lm_detail_item item;
};

struct build_detail {
    struct build_detail_item *items; /* owned; by tile, then from low to high */
    uint32_t count;
    uint8_t *section; /* owned: the records one behind the other */
    size_t section_bytes;
    struct build_detail_record *records; /* owned; one a tile, by row and column */
    uint32_t record_count;
    uint8_t side_log2; /* of a tile of LOD 0, BAM of latitude */
    double reach_m;    /* no corner of an item lies farther from its middle */
};

/* Where the detail of a tile lies in the section, in units of LM_DETAIL_UNIT_BYTES. */
struct build_detail_record {
    uint32_t row, column;
    uint32_t place, units; /* units 0: the tile has none */
    uint32_t items;
};

/* Read a file. Returns 0, or -1 with file, line, cause and remedy reported and nothing to free:
 * - the file cannot be read, or a line is none of the forms of docs/database.md,
 * - a number is out of its range,
 * - there is a building, and the class table has no class of the kind structure,
 * - a tile has more than LM_DETAIL_ITEMS_MAX items. */
int build_detail_read(struct build_detail *d, const char *path,
                      const struct build_detail_settings *settings);

/* The record of a tile of LOD 0; units 0 when it has no detail. */
struct build_detail_record build_detail_of_tile(const struct build_detail *d, uint32_t row,
                                                uint32_t column);

/* Harmless on a zeroed struct. */
void build_detail_free(struct build_detail *d);

#endif
