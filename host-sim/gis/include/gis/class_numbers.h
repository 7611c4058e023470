/* Class numbers: which class of the table each number of a class raster is.
 *
 * A raster that names its classes is matched by name, so that the order of the table does not
 * matter: GDAL's category names, the metadata item LANDMASS_CLASSES of its band, or an attribute
 * table with a column of names. In one that does not, a number is a place in the table; that is
 * said, with the area of each class. */
#ifndef GIS_CLASS_NUMBERS_H
#define GIS_CLASS_NUMBERS_H

#include "hs/class_table.h"

#include <gdal.h>
#include <stdbool.h>
#include <stdint.h>

/* The metadata item of a class raster's band: names between commas, from number 0. */
#define DB_CLASS_NAMES_ITEM "LANDMASS_CLASSES"

enum { DB_CLASS_UNKNOWN = 254 };

struct db_class_numbers {
    uint8_t class_of[256]; /* an index of the table, DB_CLASS_NODATA or DB_CLASS_UNKNOWN */
    bool are_named;
};

/* Read the names and every pixel of the band. `ignores_names`: go by the numbers all the same.
 * Prints the share and area of each class when the numbers are taken on trust. Returns 0, or -1
 * with the error reported:
 * - a value is no whole number 0..255, so that this is no class raster,
 * - a pixel has a name that the table has not, or a number behind the table's end,
 * - the file cannot be read, or no memory.
 *
 * Cost: one pass over the file; 64 MiB of memory at most. */
int db_class_numbers_read(struct db_class_numbers *n, GDALRasterBandH band, const char *path,
                          const struct db_class_table *table, bool ignores_names);

/* Read the names alone, of a raster whose pixels were looked at before. */
void db_class_numbers_match(struct db_class_numbers *n, GDALRasterBandH band,
                            const struct db_class_table *table, bool ignores_names);

#endif
