#include "ground_slope.h"

#include "gis/gdal_start.h"
#include "gis/length_unit.h"
#include "gis/plausible.h"
#include "hs/error.h"

#include <gdalwarper.h>
#include <math.h>
#include <stdlib.h>

static const float nothing = -1e30F;

static int check(const struct ground_slope *s, const char *path)
{
    const struct db_grid *from = &s->terrain.grid, *to = s->grid;
    if (s->terrain.band_count != 1) {
        return hs_error(path, "name a raster of elevations", "has %d bands", s->terrain.band_count);
    }
    if (!from->has_geotransform || !from->crs) {
        return hs_error(path, "add it with gdal_edit.py or gdalwarp", "has no georeferencing");
    }
    if (!to->crs || to->geotransform[2] != 0 || to->geotransform[4] != 0 ||
        to->geotransform[5] > 0) {
        return hs_error(path, "bring the class raster to a CRS, north up, with gdalwarp",
                        "cannot be laid under a class raster that has no CRS or is turned");
    }
    return 0;
}

int ground_slope_open(struct ground_slope *s, const char *path, const struct db_grid *grid,
                      int rows_most, bool is_trusted)
{
    *s = (struct ground_slope){.grid = grid};
    if (db_raster_open_one(&s->terrain, path) != 0) {
        return -1;
    }
    s->heights = malloc((size_t)(rows_most + 2) * (size_t)grid->width * sizeof *s->heights);
    if (!s->heights) {
        return hs_error(path, NULL, "out of memory");
    }
    const GDALRasterBandH band = s->terrain.bands[0].handle;
    return check(s, path) != 0 || db_band_unit(band, path, NULL, &s->metres) != 0
               ? -1
               : db_plausible_terrain(band, path, s->metres, is_trusted);
}

void ground_slope_close(struct ground_slope *s)
{
    free(s->heights);
    db_raster_close(&s->terrain);
    *s = (struct ground_slope){.heights = NULL};
}

/* An empty raster of rows y .. y + rows - 1 of the grid, which may begin and end beyond it. */
static GDALDatasetH empty_rows(const struct db_grid *grid, int y, int rows)
{
    GDALDatasetH d =
        GDALCreate(GDALGetDriverByName("MEM"), "", grid->width, rows, 1, GDT_Float32, NULL);
    double g[6];
    for (int i = 0; i < 6; i++) {
        g[i] = grid->geotransform[i];
    }
    g[3] += y * g[5];
    if (d) {
        GDALSetGeoTransform(d, g);
        GDALSetSpatialRef(d, grid->crs);
        GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), (double)nothing);
        GDALFillRaster(GDALGetRasterBand(d, 1), (double)nothing, 0);
    }
    return d;
}

int ground_slope_rows(struct ground_slope *s, int y, int rows)
{
    const int width = s->grid->width;
    GDALDatasetH target = empty_rows(s->grid, y - 1, rows + 2);
    CPLErrorReset();
    const bool is_there = target &&
                          GDALReprojectImage(s->terrain.files[0], NULL, target, NULL, GRA_Bilinear,
                                             0, 0.05, NULL, NULL, NULL) == CE_None &&
                          GDALRasterIO(GDALGetRasterBand(target, 1), GF_Read, 0, 0, width, rows + 2,
                                       s->heights, width, rows + 2, GDT_Float32, 0, 0) == CE_None;
    if (target) {
        GDALClose(target);
    }
    s->y = y;
    s->rows = rows;
    for (size_t i = 0; is_there && i < (size_t)rows * (size_t)width; i++) {
        s->missing += s->heights[(size_t)width + i] <= nothing;
    }
    s->pixels += (size_t)rows * (size_t)width;
    return is_there ? 0
                    : hs_error(s->terrain.name, "give terrain of the same place",
                               "cannot be brought to the class raster: %s", db_gdal_complaint());
}

static double rise(const struct ground_slope *s, float from, float to, double apart_m)
{
    const bool has_both = from > nothing && to > nothing && apart_m > 0;
    return has_both ? (double)(to - from) * s->metres / apart_m : 0;
}

void ground_slope_at(const struct ground_slope *s, const struct pixel_places *places, int column,
                     int row, double *east, double *north)
{
    const int width = s->grid->width;
    const float *line = s->heights + (size_t)(row - s->y + 1) * (size_t)width;
    const int west = column > 0 ? column - 1 : 0;
    const int right = column < width - 1 ? column + 1 : width - 1;
    const struct reflect_place a = places->row[west], b = places->row[right];
    *east = rise(s, line[west], line[right], hypot(hypot(b.x - a.x, b.y - a.y), b.z - a.z));
    *north = rise(s, line[width + column], line[column - width], 2 * places->pixel_m);
}

double ground_slope_elevation_m(const struct ground_slope *s, int column, int row)
{
    const float at = s->heights[(size_t)(row - s->y + 1) * (size_t)s->grid->width + (size_t)column];
    return at > nothing ? (double)at * s->metres : 0;
}
