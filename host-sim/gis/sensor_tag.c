#include "gis/sensor_tag.h"

#include "gis/gdal_start.h"
#include "hs/error.h"

void db_sensor_tag_write(struct db_raster_out *out, enum hs_sensor sensor)
{
    GDALSetMetadataItem(out->dataset, DB_SENSOR_ITEM, hs_sensor_name(sensor), NULL);
}

int db_sensor_tag_read(const char *path, enum hs_sensor *sensor)
{
    struct db_raster r;
    if (db_raster_open_one(&r, path) != 0) {
        return -1;
    }
    const char *name = GDALGetMetadataItem(r.files[0], DB_SENSOR_ITEM, NULL);
    const int found = name ? hs_sensor_find(name) : HS_SENSOR_X;
    if (found < 0) {
        hs_error(path, "give one of `landmass-db reflect`",
                 "is for a sensor `%.40s` (%s) that is "
                 "not known here",
                 name, DB_SENSOR_ITEM);
    }
    *sensor = found < 0 ? HS_SENSOR_X : (enum hs_sensor)found;
    const int result = found < 0 ? -1 : name == NULL;
    db_raster_close(&r);
    return result;
}
