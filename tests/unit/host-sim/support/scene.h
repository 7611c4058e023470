/* Rasters made from functions of a place, for tests of what is built from them. */
#ifndef DB_SCENE_H
#define DB_SCENE_H

#include <gdal.h>
#include <stdbool.h>
#include <stddef.h>

struct scene_raster {
    int width, height;
    double geotransform[6];
    int epsg; /* 0: none */
    GDALDataType type;
    bool has_nodata;
    double nodata;
    double (*value)(double x, double y); /* at the pixel's centre, CRS units */
};

/* Put GDAL's drivers and our temporary folder in place; its path, good for ever. Call before all
 * others. */
const char *scene_folder(void);

/* "<folder>/<name>", good until the eighth next call. */
const char *scene_path(const char *name);

/* A square of `side` pixels of `step_deg` each, longitude and latitude, whose north-west corner is
 * given. */
struct scene_raster scene_in_degrees(int side, double west_deg, double north_deg, double step_deg,
                                     GDALDataType type, double (*value)(double x, double y));

/* Write the raster as GeoTIFF under the folder. */
void scene_write(const char *name, const struct scene_raster *raster);

/* Write a text file under the folder. */
void scene_text(const char *name, const char *text);

/* A table of six classes: soil, asphalt, concrete, structure (8 m), trees (12 m), water. */
#define SCENE_CLASSES "scene.classes"
void scene_classes(void);

/* Run `landmass-db` with these arguments; what it says goes to <folder>/log. Returns its exit code.
 */
int scene_run(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Does the log of the last run hold this text? */
bool scene_log_holds(const char *text);

#endif
