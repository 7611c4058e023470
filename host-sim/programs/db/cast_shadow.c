#include "cast_shadow.h"

#include "gis/length_unit.h"
#include "gis/plausible.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>

enum { ROWS = 256 };

static int add_terrain(struct cast_shadow *s, struct ground_slope *terrain)
{
    for (int y = 0; y < s->height; y += ROWS) {
        const int rows = y + ROWS < s->height ? ROWS : s->height - y;
        if (ground_slope_rows(terrain, y, rows) != 0) {
            return -1;
        }
        for (int row = 0; row < rows; row++) {
            for (int x = 0; x < s->width; x++) {
                s->tops[(size_t)(y + row) * (size_t)s->width + (size_t)x] =
                    (float)ground_slope_elevation_m(terrain, x, y + row);
            }
        }
    }
    return 0;
}

/* Check the raster of heights. `metres` becomes its unit. */
static int check_heights(const struct db_raster *r, const struct cast_shadow_of *of, double *metres)
{
    if (r->band_count != 1 || !db_grid_is_same(&r->grid, &of->classes->grid)) {
        return hs_error(of->heights, "bring it onto the grid of the class raster with gdalwarp",
                        "has %d bands, or lies on another grid than the class raster",
                        r->band_count);
    }
    const GDALRasterBandH band = r->bands[0].handle;
    return db_band_unit(band, of->heights, NULL, metres) != 0
               ? -1
               : db_plausible_heights(band, of->heights, *metres, of->classes->bands[0].handle,
                                      of->is_trusted);
}

static int add_heights(struct cast_shadow *s, const struct cast_shadow_of *of)
{
    const char *const path = of->heights;
    struct db_raster r;
    double metres = 1;
    if (db_raster_open_one(&r, path) != 0) {
        return -1;
    }
    int result = check_heights(&r, of, &metres);
    const size_t count = (size_t)ROWS * (size_t)s->width;
    float *block = malloc(count * sizeof *block);
    uint8_t *valid = malloc(count);
    for (int y = 0; result == 0 && block && valid && y < s->height; y += ROWS) {
        const int rows = y + ROWS < s->height ? ROWS : s->height - y;
        result = db_raster_read(&r, y, rows, block, valid);
        for (size_t i = 0; i < (size_t)rows * (size_t)s->width; i++) {
            s->tops[(size_t)y * (size_t)s->width + i] +=
                valid[i] ? fmaxf(block[i] * (float)metres, 0) : 0;
        }
    }
    const bool has_memory = block && valid;
    free(block);
    free(valid);
    db_raster_close(&r);
    return has_memory ? result : hs_error(path, NULL, "out of memory");
}

int cast_shadow_open(struct cast_shadow *s, const struct cast_shadow_of *of,
                     const double pixel_m[2])
{
    const struct db_grid *const grid = &of->classes->grid;
    const size_t count = (size_t)grid->width * (size_t)grid->height;
    *s = (struct cast_shadow){
        .width = grid->width, .height = grid->height, .east_m = pixel_m[0], .south_m = pixel_m[1]};
    if (count > SHADOW_PIXELS_MAX) {
        return hs_error("--shadows", "cut the class raster, as with gdal_translate -srcwin",
                        "needs all of the raster in memory, and it has more than %d Mi pixels",
                        SHADOW_PIXELS_MAX >> 20);
    }
    s->tops = calloc(count, sizeof *s->tops);
    if (!s->tops) {
        return hs_error("--shadows", "cut the class raster", "out of memory");
    }
    if ((of->terrain && add_terrain(s, of->terrain) != 0) ||
        (of->heights && add_heights(s, of) != 0)) {
        return -1;
    }
    s->highest = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        s->highest = fmaxf(s->highest, s->tops[i]);
    }
    return 0;
}

void cast_shadow_close(struct cast_shadow *s)
{
    free(s->tops);
    *s = (struct cast_shadow){.tops = NULL};
}

/* Whether something stands between a pixel and the sun: along the way towards it, a pixel at a
 * time, until the way is above all there is. */
static bool is_hidden(const struct cast_shadow *s, int column, int row, const double sun[3])
{
    const double across = sun[0] / s->east_m, down = -sun[1] / s->south_m;
    const double stride = 1 / fmax(fabs(across), fmax(fabs(down), 1e-9));
    const double dx = across * stride, dy = down * stride, dz = sun[2] * stride;
    double x = column + 0.5, y = row + 0.5;
    double z = (double)s->tops[(size_t)row * (size_t)s->width + (size_t)column];
    while (z < (double)s->highest) {
        x += dx;
        y += dy;
        z += dz;
        const int c = (int)floor(x), r = (int)floor(y);
        if (c < 0 || c >= s->width || r < 0 || r >= s->height) {
            return false;
        }
        if ((double)s->tops[(size_t)r * (size_t)s->width + (size_t)c] > z) {
            return true;
        }
    }
    return false;
}

double cast_shadow_at(const struct cast_shadow *s, int column, int row)
{
    double missing = 0;
    for (int i = 0; i < s->sun_count; i++) {
        missing += is_hidden(s, column, row, s->suns[i].direction) ? s->suns[i].weight : 0;
    }
    return missing;
}
