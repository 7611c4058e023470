/* GDAL set up for host programs: silent, its cache bounded, its last complaint kept for our own
 * messages. */
#ifndef GIS_GDAL_START_H
#define GIS_GDAL_START_H

#include <gdal.h>
#include <stdbool.h>

/* Register the drivers; call once before anything that opens a raster or a vector file. */
void db_gdal_start(void);

/* Note every file that an open dataset reads, its side files and the sources of a virtual raster
 * included, as an input (hs/input_file.h). Returns `dataset`, which may be NULL. */
GDALDatasetH db_gdal_note(GDALDatasetH dataset);

/* True if a file of a dataset's list holds data: it is there, no folder, and not the statistics
 * that GDAL leaves beside a raster, which have no part in what is made of it. */
bool db_gdal_is_data(const char *path);

/* GDAL's last complaint on one line, or "unknown cause". Points into GDAL; good until its next
 * call. */
const char *db_gdal_complaint(void);

#endif
