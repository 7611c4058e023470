#include "realradar/class_order.h"

#include "gis/class_raster.h"
#include "hs/error.h"
#include "realradar/speckle_statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FEWEST_PIXELS = 50 };

/* The pixels with data in all rasters, in reading order. */
struct pixels {
    size_t count;
    uint8_t *classes;
    float *measured, *reflectivity, *simulated;
};

struct ranked {
    float value;
    uint32_t index;
};

static int by_value(const void *a, const void *b)
{
    const float x = ((const struct ranked *)a)->value, y = ((const struct ranked *)b)->value;
    return (x > y) - (x < y);
}

/* Ranks of the values, less the mean rank. Returns 0, or -1 on no memory. */
static int rank(const float *values, size_t count, float *ranks)
{
    struct ranked *order = malloc(count * sizeof *order);
    if (!order) {
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        order[i] = (struct ranked){values[i], (uint32_t)i};
    }
    qsort(order, count, sizeof *order, by_value);
    for (size_t first = 0, last; first < count; first = last) {
        for (last = first + 1; last < count && order[last].value <= order[first].value; last++) {
        }
        for (size_t i = first; i < last; i++) {
            ranks[order[i].index] = (float)((double)(first + last) - (double)count) / 2;
        }
    }
    free(order);
    return 0;
}

double rr_rank_correlation(const float *a, const float *b, size_t count)
{
    float *ranks = malloc(2 * (count + 1) * sizeof *ranks);
    double product = NAN, square_a = 0, square_b = 0;
    if (ranks && rank(a, count, ranks) == 0 && rank(b, count, ranks + count) == 0) {
        product = 0;
        for (size_t i = 0; i < count; i++) {
            const double x = ranks[i], y = ranks[count + i];
            product += x * y;
            square_a += x * x;
            square_b += y * y;
        }
    }
    free(ranks);
    return square_a > 0 && square_b > 0 ? product / sqrt(square_a * square_b) : NAN;
}

static int by_float(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Of the values whose class it is; `scratch` has room for them all. */
static struct rr_spread spread_of(const struct pixels *p, const float *values, int class_index,
                                  float *scratch)
{
    size_t count = 0;
    for (size_t i = 0; i < p->count; i++) {
        if (p->classes[i] == class_index) {
            scratch[count++] = values[i];
        }
    }
    qsort(scratch, count, sizeof *scratch, by_float);
    const double last = (double)(count - 1);
    return (struct rr_spread){scratch[(size_t)lround(0.05 * last)],
                              scratch[(size_t)lround(0.5 * last)],
                              scratch[(size_t)lround(0.95 * last)]};
}

static void pixels_free(struct pixels *p)
{
    free(p->classes);
    free(p->measured);
    free(p->reflectivity);
    free(p->simulated);
}

static int pixels_alloc(struct pixels *p, size_t most)
{
    *p = (struct pixels){0};
    p->classes = malloc(most);
    p->measured = malloc(most * sizeof *p->measured);
    p->reflectivity = malloc(most * sizeof *p->reflectivity);
    p->simulated = malloc(most * sizeof *p->simulated);
    if (!p->classes || !p->measured || !p->reflectivity || !p->simulated) {
        pixels_free(p);
        return hs_error("classes", "compare a smaller raster", "out of memory");
    }
    return 0;
}

enum { CLASSES, REFLECTIVITY, RADAR, RASTERS };

struct rows {
    float *plane[RASTERS];
    uint8_t *valid[RASTERS], *classes;
};

static void rows_free(struct rows *rows)
{
    for (int i = 0; i < RASTERS; i++) {
        free(rows->plane[i]);
        free(rows->valid[i]);
    }
    free(rows->classes);
}

static int rows_alloc(struct rows *rows, const struct db_raster *rasters)
{
    const size_t width = (size_t)rasters[CLASSES].grid.width;
    rows->classes = malloc(width);
    bool is_short = !rows->classes;
    for (int i = 0; i < RASTERS; i++) {
        rows->plane[i] = malloc(width * (size_t)rasters[i].band_count * sizeof *rows->plane[i]);
        rows->valid[i] = malloc(width);
        is_short = is_short || !rows->plane[i] || !rows->valid[i];
    }
    return is_short ? hs_error("classes", NULL, "out of memory") : 0;
}

static int take_row(struct pixels *p, struct rows *rows, const struct db_raster *rasters,
                    const struct db_class_numbers *numbers, int y)
{
    if (db_class_raster_read(&rasters[CLASSES], numbers, y, 1, rows->plane[CLASSES],
                             rows->valid[CLASSES], rows->classes) != 0 ||
        db_raster_read(&rasters[REFLECTIVITY], y, 1, rows->plane[REFLECTIVITY],
                       rows->valid[REFLECTIVITY]) != 0 ||
        db_raster_read(&rasters[RADAR], y, 1, rows->plane[RADAR], rows->valid[RADAR]) != 0) {
        return -1;
    }
    for (int x = 0; x < rasters[CLASSES].grid.width; x++) {
        if (rows->classes[x] != DB_CLASS_NODATA && rows->valid[REFLECTIVITY][x] &&
            rows->valid[RADAR][x]) {
            p->classes[p->count] = rows->classes[x];
            p->reflectivity[p->count] = rows->plane[REFLECTIVITY][x];
            p->measured[p->count++] = rows->plane[RADAR][x];
        }
    }
    return 0;
}

static int take_pixels(struct pixels *p, const struct db_raster *rasters,
                       const struct db_class_numbers *numbers)
{
    struct rows rows = {0};
    int status = rows_alloc(&rows, rasters);
    for (int y = 0; y < rasters[CLASSES].grid.height && status == 0; y++) {
        status = take_row(p, &rows, rasters, numbers, y);
    }
    rows_free(&rows);
    return status;
}

static int add_speckle(struct pixels *p)
{
    const unsigned side = (unsigned)ceil(sqrt((double)p->count));
    double *power = malloc((size_t)side * side * sizeof *power);
    if (!power) {
        return hs_error("classes", NULL, "out of memory");
    }
    rr_firmware_speckle(power, side, RR_SIMULATED_LOOKS_LOG2, 1);
    for (size_t i = 0; i < p->count; i++) {
        p->simulated[i] = (float)((double)p->reflectivity[i] + 10 * log10(power[i]));
    }
    free(power);
    return 0;
}

static int by_measured(const void *a, const void *b)
{
    const double x = ((const struct rr_class_row *)a)->measured.median;
    const double y = ((const struct rr_class_row *)b)->measured.median;
    return (x > y) - (x < y);
}

static void fill_rows(struct rr_class_order *order, const struct pixels *p, float *scratch)
{
    size_t pixels[DB_CLASS_MAX] = {0};
    for (size_t i = 0; i < p->count; i++) {
        pixels[p->classes[i]]++;
    }
    for (int c = 0; c < DB_CLASS_MAX; c++) {
        if (pixels[c] >= FEWEST_PIXELS) {
            order->rows[order->count++] = (struct rr_class_row){
                .class_index = c,
                .pixels = pixels[c],
                .measured = spread_of(p, p->measured, c, scratch),
                .reflectivity = spread_of(p, p->reflectivity, c, scratch),
                .simulated = spread_of(p, p->simulated, c, scratch),
            };
        }
    }
    qsort(order->rows, (size_t)order->count, sizeof order->rows[0], by_measured);
}

static int fill_order(struct rr_class_order *order, const struct pixels *p)
{
    float *scratch = malloc((p->count + 1) * sizeof *scratch);
    if (!scratch) {
        return hs_error("classes", NULL, "out of memory");
    }
    fill_rows(order, p, scratch);
    free(scratch);
    float measured[DB_CLASS_MAX], simulated[DB_CLASS_MAX];
    for (int i = 0; i < order->count; i++) {
        measured[i] = (float)order->rows[i].measured.median;
        simulated[i] = (float)order->rows[i].reflectivity.median;
    }
    order->class_correlation = rr_rank_correlation(measured, simulated, (size_t)order->count);
    order->pixel_correlation = rr_rank_correlation(p->measured, p->simulated, p->count);
    return 0;
}

static int compare_open(struct rr_class_order *order, const struct db_raster *rasters,
                        const struct db_class_numbers *numbers)
{
    const struct db_grid *grid = &rasters[CLASSES].grid;
    for (int i = REFLECTIVITY; i <= RADAR; i++) {
        if (!db_grid_is_same(grid, &rasters[i].grid)) {
            return hs_error(rasters[i].name, "bring both to one grid, for example with gdalwarp",
                            "has other pixels than %s", rasters[CLASSES].name);
        }
    }
    struct pixels p;
    if (pixels_alloc(&p, (size_t)grid->width * (size_t)grid->height) != 0) {
        return -1;
    }
    int status = take_pixels(&p, rasters, numbers);
    if (status == 0) {
        status = add_speckle(&p);
    }
    if (status == 0) {
        status = fill_order(order, &p);
    }
    pixels_free(&p);
    return status;
}

int rr_class_order_compare(struct rr_class_order *order, const struct rr_class_source *source)
{
    const char *const paths[RASTERS] = {source->class_raster, source->reflectivity, source->radar};
    struct db_raster rasters[RASTERS];
    struct db_class_numbers numbers;
    int open = 0, status = 0;
    *order = (struct rr_class_order){0};
    while (open < RASTERS && status == 0) {
        status = open == CLASSES ? db_class_raster_open(&rasters[open], &numbers, paths[open],
                                                        source->table, false)
                                 : db_raster_open_one(&rasters[open], paths[open]);
        open += status == 0;
    }
    if (status == 0) {
        status = compare_open(order, rasters, &numbers);
    }
    while (open > 0) {
        db_raster_close(&rasters[--open]);
    }
    return status;
}
