#include "scene.h"

#include "check.h"
#include "gis/gdal_start.h"
#include "support.h"

#include <ogr_srs_api.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *scene_folder(void)
{
    static char folder[256];
    if (!folder[0]) {
        db_gdal_start();
        snprintf(folder, sizeof folder, "%s/tmp/db-image-%ld", support_build_dir(), (long)getpid());
        assert_int_equal(support_run("mkdir -p %s", folder), 0);
    }
    return folder;
}

const char *scene_path(const char *name)
{
    static char paths[8][512];
    static unsigned next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", scene_folder(), name);
    return path;
}

static void set_crs(GDALDatasetH dataset, int epsg)
{
    OGRSpatialReferenceH crs = OSRNewSpatialReference(NULL);
    assert_int_equal(OSRImportFromEPSG(crs, epsg), OGRERR_NONE);
    assert_int_equal(GDALSetSpatialRef(dataset, crs), CE_None);
    OSRDestroySpatialReference(crs);
}

struct scene_raster scene_in_degrees(int side, double west_deg, double north_deg, double step_deg,
                                     GDALDataType type, double (*value)(double x, double y))
{
    return (struct scene_raster){.width = side,
                                 .height = side,
                                 .geotransform = {west_deg, step_deg, 0, north_deg, 0, -step_deg},
                                 .epsg = 4326,
                                 .type = type,
                                 .value = value};
}

void scene_write(const char *name, const struct scene_raster *raster)
{
    const char *path = scene_path(name); /* the first one registers GDAL's drivers */
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), path, raster->width,
                                      raster->height, 1, raster->type, NULL);
    assert_non_null(dataset);
    const double *t = raster->geotransform;
    assert_int_equal(GDALSetGeoTransform(dataset, (double *)t), CE_None);
    if (raster->epsg) {
        set_crs(dataset, raster->epsg);
    }
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (raster->has_nodata) {
        GDALSetRasterNoDataValue(band, raster->nodata);
    }
    double *row = malloc((size_t)raster->width * sizeof *row);
    for (int y = 0; y < raster->height; y++) {
        for (int x = 0; x < raster->width; x++) {
            const double u = x + 0.5, v = y + 0.5;
            row[x] = raster->value(t[0] + u * t[1] + v * t[2], t[3] + u * t[4] + v * t[5]);
        }
        assert_int_equal(GDALRasterIO(band, GF_Write, 0, y, raster->width, 1, row, raster->width, 1,
                                      GDT_Float64, 0, 0),
                         CE_None);
    }
    free(row);
    GDALClose(dataset);
}

void scene_text(const char *name, const char *text)
{
    FILE *file = fopen(scene_path(name), "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

void scene_classes(void)
{
    scene_text(SCENE_CLASSES,
               "[soil]\ncolour = 176 140 90\nkind = ground\ngamma_db = -20\nspread_db = 3\n"
               "limits_db = -29 -11\n"
               "[asphalt]\ncolour = 96 96 104\nkind = ground\ngamma_db = -30\nspread_db = 3\n"
               "limits_db = -39 -21\n"
               "[concrete]\ncolour = 208 208 200\nkind = ground\ngamma_db = -28\nspread_db = 3\n"
               "limits_db = -37 -19\n"
               "[structure]\ncolour = 216 48 40\nkind = structure\ngamma_db = 0\nspread_db = 5\n"
               "limits_db = -15 15\nheight_m = 8\n"
               "[trees]\ncolour = 48 136 48\nkind = trees\ngamma_db = -15\nspread_db = 3\n"
               "limits_db = -24 -6\nheight_m = 12\n"
               "[water]\ncolour = 32 64 160\nkind = water\ngamma_db = -40\nspread_db = 3\n"
               "limits_db = -49 -31\nheight_m = 5\n");
}

int scene_run(const char *format, ...)
{
    char arguments[3000];
    va_list list;
    va_start(list, format);
    vsnprintf(arguments, sizeof arguments, format, list);
    va_end(list);
    return support_run("%s/bin/landmass-db %s >%s/log 2>&1", support_build_dir(), arguments,
                       scene_folder());
}

bool scene_log_holds(const char *text)
{
    char line[2048];
    bool found = false;
    FILE *log = fopen(scene_path("log"), "r");
    while (log && fgets(line, sizeof line, log)) {
        found = found || strstr(line, text);
    }
    if (log) {
        fclose(log);
    }
    if (!found) {
        support_run("sed 's/^/# /' %s/log", scene_folder());
    }
    return found;
}
