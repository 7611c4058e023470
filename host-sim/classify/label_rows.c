/* A label raster seen on the image's grid, a row at a time. */
#include "classify/exemplars.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>

enum { LABEL_LIMIT = 1 << 24 }; /* Whole numbers below this pass through a float unchanged. */

static int check_extent(const struct db_raster *labels, const struct db_grid *grid)
{
    const struct db_grid *l = &labels->grid;
    bool fits;
    if (l->has_geotransform && grid->has_geotransform) {
        struct db_grid scaled = *l;
        scaled.width = grid->width;
        scaled.height = grid->height;
        for (int i = 0; i < 6; i += 3) {
            scaled.geotransform[i + 1] *= (double)l->width / grid->width;
            scaled.geotransform[i + 2] *= (double)l->height / grid->height;
        }
        fits = db_grid_is_same(&scaled, grid);
    } else {
        fits = fabs((double)l->width * grid->height / ((double)l->height * grid->width) - 1) < 0.01;
    }
    if (!fits) {
        return hs_error(labels->name, "cut the labels to the image's extent",
                        "does not cover the same extent as the image (%d x %d labels, %d x %d "
                        "pixels)",
                        l->width, l->height, grid->width, grid->height);
    }
    return 0;
}

/* Label cells first..end-1 along one axis have their centres in image pixel i; where there is none,
 * the one at the pixel's centre. */
static void cells_of(int i, int cells, int pixels, int *first, int *end)
{
    const double ratio = (double)cells / pixels;
    *first = (int)ceil(i * ratio - 0.5);
    *end = (int)ceil((i + 1) * ratio - 0.5);
    if (*first >= *end) {
        *first = (int)floor((i + 0.5) * ratio);
        *end = *first + 1;
    }
}

int db_label_rows_open(struct db_label_rows *l, const char *path, const struct db_grid *grid)
{
    *l = (struct db_label_rows){.width = grid->width, .height = grid->height};
    if (db_raster_open_one(&l->raster, path) != 0) {
        return -1;
    }
    if (l->raster.band_count != 1) {
        hs_error(path, "give the labels as one band of numbers", "has %d bands",
                 l->raster.band_count);
        db_label_rows_close(l);
        return -1;
    }
    if (check_extent(&l->raster, grid) != 0) {
        db_label_rows_close(l);
        return -1;
    }
    const size_t rows = (size_t)(l->raster.grid.height / grid->height) + 2;
    const size_t count = rows * (size_t)l->raster.grid.width;
    l->pixels = malloc(count * sizeof *l->pixels);
    l->valid = malloc(count);
    if (!l->pixels || !l->valid) {
        db_label_rows_close(l);
        return hs_error(path, NULL, "out of memory");
    }
    return 0;
}

static int32_t label_of(float value, uint8_t valid)
{
    return valid && value >= 0 && value < LABEL_LIMIT && value == floorf(value) ? (int32_t)value
                                                                                : -1;
}

/* The most frequent label of a small rectangle; the smallest of equals. Quadratic in its few cells.
 */
static int32_t majority(const struct db_label_rows *l, int rows, int x_first, int x_end)
{
    const int width = l->raster.grid.width;
    int32_t best = -1;
    int best_count = 0;
    for (int i = 0; i < rows * (x_end - x_first); i++) {
        const int xi = x_first + i % (x_end - x_first), yi = i / (x_end - x_first);
        const int32_t label = label_of(l->pixels[yi * width + xi], l->valid[yi * width + xi]);
        int count = 0;
        for (int y = 0; y < rows; y++) {
            for (int x = x_first; x < x_end; x++) {
                count += label_of(l->pixels[y * width + x], l->valid[y * width + x]) == label;
            }
        }
        if (count > best_count || (count == best_count && label < best)) {
            best = label;
            best_count = count;
        }
    }
    return best;
}

int db_label_rows_read(struct db_label_rows *l, int y, int32_t *labels)
{
    const struct db_grid *grid = &l->raster.grid;
    int first, end;
    cells_of(y, grid->height, l->height, &first, &end);
    if (db_raster_read(&l->raster, first, end - first, l->pixels, l->valid) != 0) {
        return -1;
    }
    for (int x = 0; x < l->width; x++) {
        int x_first, x_end;
        cells_of(x, grid->width, l->width, &x_first, &x_end);
        labels[x] = majority(l, end - first, x_first, x_end);
    }
    return 0;
}

void db_label_rows_close(struct db_label_rows *l)
{
    db_raster_close(&l->raster);
    free(l->pixels);
    free(l->valid);
    *l = (struct db_label_rows){0};
}
