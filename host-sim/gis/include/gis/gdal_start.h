/* GDAL set up for host programs: silent, its cache bounded, its last complaint kept for our own
 * messages. */
#ifndef GIS_GDAL_START_H
#define GIS_GDAL_START_H

/* Register the drivers; call once before anything that opens a raster or a vector file. */
void db_gdal_start(void);

/* GDAL's last complaint on one line, or "unknown cause". Points into GDAL; good until its next
 * call. */
const char *db_gdal_complaint(void);

#endif
