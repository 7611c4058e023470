/* Sensor tag: the sensor that a reflectivity raster is for, as GDAL metadata of the file
 * (LANDMASS_SENSOR=ku). A raster without a tag is for X band, as all were before there was one. */
#ifndef GIS_SENSOR_TAG_H
#define GIS_SENSOR_TAG_H

#include "gis/raster.h"
#include "hs/sensor.h"

#define DB_SENSOR_ITEM "LANDMASS_SENSOR"

/* Tag a raster that is being written. */
void db_sensor_tag_write(struct db_raster_out *out, enum hs_sensor sensor);

/* The sensor of the raster at `path`. Returns 0; 1 with HS_SENSOR_X if it has no tag; or -1 with
 * the error reported: the file cannot be opened, or names a sensor that is not known here. */
int db_sensor_tag_read(const char *path, enum hs_sensor *sensor);

#endif
