/* Class rasters: one byte a pixel, the index into the class table; DB_CLASS_NODATA where there is
 * none. */
#ifndef GIS_CLASS_RASTER_H
#define GIS_CLASS_RASTER_H

#include "gis/raster.h"
#include "hs/class_table.h"

/* Create one with the table's colours and names in it. Returns 0, or -1 reported. */
int db_class_raster_create(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                           const struct db_class_table *table);

/* Open one for reading: one band. Returns 0, or -1 reported. */
int db_class_raster_open(struct db_raster *r, const char *path);

/* Read rows; every value must be a class of the table or no data. `scratch` holds rows * width
 * floats and `valid` as many bytes. Returns 0, or -1 reported. */
int db_class_raster_read(const struct db_raster *r, const struct db_class_table *table, int y,
                         int rows, float *scratch, uint8_t *valid, uint8_t *classes);

/* Print how many pixels each class has, and how many none. */
void db_class_counts_print(const struct db_class_table *table, const uint64_t counts[256]);

#endif
