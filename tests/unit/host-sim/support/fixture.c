#include "fixture.h"

#include "check.h"
#include "gis/gdal_start.h"
#include "support.h"

#include <ogr_srs_api.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int fixture_open(void **state)
{
    (void)state;
    db_gdal_start();
    return support_run("rm -rf %s/tmp/db-%ld && mkdir -p %s/tmp/db-%ld", support_build_dir(),
                       (long)getpid(), support_build_dir(), (long)getpid());
}

int fixture_close(void **state)
{
    (void)state;
    return support_run("rm -rf %s/tmp/db-%ld", support_build_dir(), (long)getpid());
}

const char *fixture_path(const char *name)
{
    static char paths[64][FIXTURE_PATH];
    static unsigned turn;
    char *path = paths[turn++ % 64];
    snprintf(path, FIXTURE_PATH, "%s/tmp/db-%ld/%s", support_build_dir(), (long)getpid(), name);
    return path;
}

void fixture_write(const char *name, const char *text)
{
    FILE *f = fopen(fixture_path(name), "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

struct db_grid fixture_grid(int width, int height)
{
    struct db_grid grid = {.width = width,
                           .height = height,
                           .has_geotransform = true,
                           .geotransform = {500000, 1, 0, -400000, 0, -1}};
    grid.crs = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(grid.crs, 32622);
    OSRSetAxisMappingStrategy(grid.crs, OAMS_TRADITIONAL_GIS_ORDER);
    return grid;
}

void fixture_raster(const char *name, const struct db_grid *grid, GDALDataType type,
                    const float *values, double nodata)
{
    GDALDatasetH file = GDALCreate(GDALGetDriverByName("GTiff"), fixture_path(name), grid->width,
                                   grid->height, 1, type, NULL);
    assert_non_null(file);
    if (grid->has_geotransform) {
        GDALSetGeoTransform(file, (double *)grid->geotransform);
    }
    if (grid->crs) {
        GDALSetSpatialRef(file, grid->crs);
    }
    const GDALRasterBandH band = GDALGetRasterBand(file, 1);
    GDALSetRasterNoDataValue(band, nodata);
    assert_int_equal(GDALRasterIO(band, GF_Write, 0, 0, grid->width, grid->height, (void *)values,
                                  grid->width, grid->height, GDT_Float32, 0, 0),
                     CE_None);
    GDALClose(file);
}

static int run(char *said, size_t size, const char *format, va_list arguments)
{
    char command[2048];
    const int length = vsnprintf(command, sizeof command, format, arguments);
    if (length < 0 || length >= (int)sizeof command) {
        return -1;
    }
    if (!said) {
        return support_run("%s/bin/landmass-db %s 2>&1", support_build_dir(), command);
    }
    const int status = support_run("%s/bin/landmass-db %s > %s 2>&1", support_build_dir(), command,
                                   fixture_path("said.txt"));
    FILE *f = fopen(fixture_path("said.txt"), "r");
    assert_non_null(f);
    said[fread(said, 1, size - 1, f)] = '\0';
    fclose(f);
    return status;
}

int fixture_run(char *said, size_t size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int status = run(said, size, format, arguments);
    va_end(arguments);
    return status;
}

int fixture_fails(int exit_code, const char *text, const char *format, ...)
{
    char said[8192];
    va_list arguments;
    va_start(arguments, format);
    const int status = run(said, sizeof said, format, arguments);
    va_end(arguments);
    if (status == exit_code && strstr(said, text)) {
        return 1;
    }
    print_message("# exit %d, wanted %d with `%s`: %s\n", status, exit_code, text, said);
    return 0;
}
