/* Class rasters: one byte a pixel, the index into the class table; DB_CLASS_NODATA where there is
 * none. */
#ifndef GIS_CLASS_RASTER_H
#define GIS_CLASS_RASTER_H

#include "gis/class_numbers.h"
#include "gis/raster.h"
#include "hs/class_table.h"

/* Create one on `grid` with the table's colours and names in it, the names as categories and,
 * for when the side file is lost, as DB_CLASS_NAMES_ITEM too. Returns 0, or -1 with the error
 * reported as db_raster_create does. */
int db_class_raster_create(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                           const struct db_class_table *table);

/* Give one that is being written an attribute table: number, name, pixels, area and colour of each
 * class. `area_km2` and `pixels` are by class. Call before the commit. */
void db_class_raster_attributes(struct db_raster_out *out, const struct db_class_table *table,
                                const uint64_t *pixels, const double *area_km2);

/* Open one for reading, and read which class its numbers are (gis/class_numbers.h). Returns 0, or
 * -1 with the error reported and nothing to close: it cannot be opened, has not one band, or its
 * classes are not those of the table. */
int db_class_raster_open(struct db_raster *r, struct db_class_numbers *numbers, const char *path,
                         const struct db_class_table *table, bool ignores_names);

/* Read rows y .. y + rows - 1 into `classes`, rows * width bytes: an index into the table, or
 * DB_CLASS_NODATA. `scratch` holds rows * width floats and `valid` as many bytes. Returns 0, or -1
 * with the error reported: a row cannot be read, or holds a class that it had not when it was
 * opened. */
int db_class_raster_read(const struct db_raster *r, const struct db_class_numbers *numbers, int y,
                         int rows, float *scratch, uint8_t *valid, uint8_t *classes);

/* Print how many pixels each class has, and how many none: counts[index], and
 * counts[DB_CLASS_NODATA]. */
void db_class_counts_print(const struct db_class_table *table, const uint64_t counts[256]);

#endif
