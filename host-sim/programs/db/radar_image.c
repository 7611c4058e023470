#include "radar_image.h"

#include "gis/gdal_start.h"
#include "gis/plausible.h"
#include "hs/error.h"

#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A dataset over planes of ours, one behind the other, on a grid that begins at row y of `grid`. */
static GDALDatasetH over(float *planes, const struct db_grid *grid, int y, int rows)
{
    char name[192];
    GDALDatasetH d =
        GDALCreate(GDALGetDriverByName("MEM"), "", grid->width, rows, 0, GDT_Float32, NULL);
    for (int b = 0; d && b < 2; b++) {
        const size_t at = (size_t)b * (size_t)rows * (size_t)grid->width;
        snprintf(name, sizeof name, "DATAPOINTER=%p", (void *)(planes + at));
        char *options[] = {name, NULL};
        if (GDALAddBand(d, GDT_Float32, options) != CE_None) {
            GDALClose(d);
            return NULL;
        }
    }
    double g[6];
    memcpy(g, grid->geotransform, sizeof g);
    g[0] += y * g[2];
    g[3] += y * g[5];
    if (d) {
        GDALSetGeoTransform(d, g);
        GDALSetSpatialRef(d, grid->crs);
    }
    return d;
}

struct reading {
    const struct radar_options *o;
    double factor; /* gamma of sigma */
    uint64_t above_zero, valid;
};

/* Powers and weights in place of values and whatever is behind them. */
static int take_powers(struct reading *t, float *power, float *weight, const uint8_t *valid,
                       size_t count)
{
    const bool is_db = t->o->unit == RADAR_DB;
    for (size_t i = 0; i < count; i++) {
        const double v = (double)power[i];
        if (!valid[i]) {
            power[i] = weight[i] = 0;
            continue;
        }
        if (!is_db && v < 0) {
            return hs_error(t->o->path, "is it --radar-unit db?",
                            "holds %g, and no power is below 0", v);
        }
        t->valid++;
        t->above_zero += v > 0;
        power[i] = (float)(t->factor * (is_db ? pow(10, v / 10) : v));
        weight[i] = 1;
    }
    return 0;
}

/* The sum over `side` values around each of a row, column or plane of them, `step` apart. */
static void sum_line(float *line, size_t count, size_t step, int side, float *scratch)
{
    double sum = 0;
    const size_t half = (size_t)side / 2;
    for (size_t i = 0; i < count; i++) {
        scratch[i] = line[i * step];
    }
    for (size_t i = 0; i < count + half; i++) {
        sum += i < count ? (double)scratch[i] : 0;
        sum -= i >= (size_t)side ? (double)scratch[i - (size_t)side] : 0;
        if (i >= half) {
            line[(i - half) * step] = (float)fmax(sum, 0);
        }
    }
}

static int sum_squares(float *plane, int width, int height, int side)
{
    float *scratch = malloc((size_t)(width > height ? width : height) * sizeof *scratch);
    for (int y = 0; scratch && y < height; y++) {
        sum_line(plane + (size_t)y * (size_t)width, (size_t)width, 1, side, scratch);
    }
    for (int x = 0; scratch && x < width; x++) {
        sum_line(plane + x, (size_t)height, (size_t)width, side, scratch);
    }
    const int result = scratch ? 0 : -1;
    free(scratch);
    return result;
}

static int check_unit(const struct reading *t)
{
    if (t->valid == 0) {
        return hs_error(t->o->path, "check its nodata value", "holds no data");
    }
    if (t->o->unit == RADAR_DB && (double)t->above_zero > 0.9 * (double)t->valid) {
        return hs_error(t->o->path, "is it --radar-unit linear?",
                        "is above 0 in %.0f %% of its pixels, and ground hardly ever returns 0 dB",
                        100.0 * (double)t->above_zero / (double)t->valid);
    }
    return 0;
}

static int read_powers(struct radar_image *r, const struct db_raster *raster,
                       const struct radar_options *o)
{
    const double cosine = cos(o->incidence_deg * 0.017453292519943295);
    struct reading t = {.o = o, .factor = isnan(o->incidence_deg) ? 1 : 1 / cosine};
    const int width = raster->grid.width, height = raster->grid.height;
    const size_t count = (size_t)width * (size_t)height;
    uint8_t *valid = malloc(count);
    r->planes = malloc(2 * count * sizeof *r->planes);
    if (!valid || !r->planes) {
        free(valid);
        return hs_error(o->path, "cut it to the class raster's area", "out of memory");
    }
    struct db_raster one = *raster;
    one.bands = &raster->bands[o->band - 1];
    one.band_count = 1;
    const bool is_taken = db_raster_read(&one, 0, height, r->planes, valid) == 0 &&
                          take_powers(&t, r->planes, r->planes + count, valid, count) == 0 &&
                          check_unit(&t) == 0;
    free(valid);
    r->missing = count - t.valid;
    if (is_taken && o->multilook > 1 &&
        (sum_squares(r->planes, width, height, (int)o->multilook) != 0 ||
         sum_squares(r->planes + count, width, height, (int)o->multilook) != 0)) {
        return hs_error(o->path, NULL, "out of memory");
    }
    return is_taken ? 0 : -1;
}

/* How many of its pixels lie along a pixel of the class raster, in the middle of that. */
static int compare_pixels(struct radar_image *r)
{
    float none[2] = {0, 0};
    const struct db_grid *g = r->grid;
    struct db_grid one = *g;
    one.width = 1;
    GDALDatasetH target = over(none, &one, 0, 1);
    void *way = target ? GDALCreateGenImgProjTransformer2(r->powers, target, NULL) : NULL;
    double x[2] = {g->width / 2.0, g->width / 2.0 + 1}, y[2] = {g->height / 2.0, g->height / 2.0};
    double z[2] = {0, 0};
    int found[2] = {0, 0};
    if (way) {
        GDALGenImgProjTransform(way, TRUE, 2, x, y, z, found);
        GDALDestroyGenImgProjTransformer(way);
    }
    if (target) {
        GDALClose(target);
    }
    r->pixels_per_cell = hypot(x[1] - x[0], y[1] - y[0]);
    r->how = r->pixels_per_cell > 1.5 ? GRA_Average : GRA_Bilinear;
    return found[0] && found[1] ? 0
                                : hs_error(r->name, "give imagery of the same place",
                                           "cannot be brought to the class raster's place");
}

static int check_raster(const struct db_raster *raster, const struct radar_options *o)
{
    const struct db_grid *g = &raster->grid;
    if (o->band > raster->band_count) {
        return hs_error(o->path, "choose another --radar-band", "has %d bands", raster->band_count);
    }
    if (!g->has_geotransform || !g->crs) {
        return hs_error(o->path, "add it with gdal_edit.py or gdalwarp", "has no georeferencing");
    }
    return (int64_t)g->width * g->height <= RADAR_PIXELS_MAX
               ? 0
               : hs_error(o->path, "cut it to the class raster's area, as with gdalwarp -te",
                          "has more than %d million pixels", RADAR_PIXELS_MAX >> 20);
}

int radar_image_open(struct radar_image *r, const struct radar_options *options,
                     const struct db_grid *grid)
{
    struct db_raster raster;
    *r = (struct radar_image){.grid = grid, .name = options->path};
    if (db_raster_open_one(&raster, options->path) != 0) {
        return -1;
    }
    int result = check_raster(&raster, options);
    if (result == 0) {
        result = db_plausible_radar(raster.bands[options->band - 1].handle, options->path,
                                    options->unit == RADAR_LINEAR, options->is_trusted);
    }
    if (result == 0) {
        result = read_powers(r, &raster, options);
    }
    if (result == 0) {
        r->powers = over(r->planes, &raster.grid, 0, raster.grid.height);
        result = r->powers ? compare_pixels(r) : hs_error(r->name, NULL, "out of memory");
    }
    db_raster_close(&raster);
    return result;
}

int radar_image_rows(const struct radar_image *r, int y, int rows, float *gamma_db)
{
    const size_t count = (size_t)rows * (size_t)r->grid->width;
    float *planes = calloc(2 * count, sizeof *planes);
    GDALDatasetH target = planes ? over(planes, r->grid, y, rows) : NULL;
    CPLErrorReset();
    const bool is_there = target && GDALReprojectImage(r->powers, NULL, target, NULL, r->how, 0,
                                                       0.05, NULL, NULL, NULL) == CE_None;
    for (size_t i = 0; is_there && i < count; i++) {
        const double power = (double)planes[i], weight = (double)planes[count + i];
        gamma_db[i] = weight > 1e-6 && power > 0 ? (float)(10 * log10(power / weight)) : (float)NAN;
    }
    if (target) {
        GDALClose(target);
    }
    free(planes);
    return is_there ? 0
                    : hs_error(r->name, "give imagery of the same place",
                               "cannot be brought to the class raster: %s", db_gdal_complaint());
}

void radar_image_close(struct radar_image *r)
{
    if (r->powers) {
        GDALClose(r->powers);
    }
    free(r->planes);
    *r = (struct radar_image){.powers = NULL};
}
