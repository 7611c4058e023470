/* GDAL set up for host programs: silent, its cache bounded, its last complaint kept for our own
 * messages. */
#ifndef GIS_GDAL_START_H
#define GIS_GDAL_START_H

#include <gdal.h>

/* Register the drivers; call once before anything that opens a raster or a vector file. */
void db_gdal_start(void);

/* Note every file that an open dataset reads, its side files and the sources of a virtual raster
 * included, as an input (hs/input_file.h). Returns `dataset`, which may be NULL. */
GDALDatasetH db_gdal_note(GDALDatasetH dataset);

/* GDAL's last complaint on one line, or "unknown cause". Points into GDAL; good until its next
 * call. */
const char *db_gdal_complaint(void);

#endif
