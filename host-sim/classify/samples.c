#include "classify/samples.h"

#include "hs/error.h"
#include "hs/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t db_feature_bytes(int band_count, int context)
{
    /* The bands with their halo are held beside the features. */
    const size_t planes =
        (size_t)db_feature_count(band_count, context) + (context > 1 ? (size_t)band_count : 0);
    return planes * sizeof(float) + 2;
}

/* Rows of one band with the halo that the windows need, and running sums over each column of the
 * window. */
struct window {
    const float *plane;
    const uint8_t *valid;
    int width, height;           /* of the plane */
    int half;                    /* the window reaches so far each way */
    double *sum, *square, *sure; /* of each column, over the window's rows */
};

static void add_row(struct window *w, int row)
{
    const size_t begin = (size_t)row * (size_t)w->width;
    for (int x = 0; x < w->width; x++) {
        const double v = w->plane[begin + (size_t)x], use = w->valid[begin + (size_t)x] ? 1 : 0;
        w->sum[x] += use * v;
        w->square[x] += use * v * v;
        w->sure[x] += use;
    }
}

/* Slide along the columns; `sure` sums are whole numbers and stay exact. */
static void write_row(const struct window *w, float *mean, float *deviation)
{
    double sum = 0, square = 0, count = 0;
    for (int x = -w->half; x < w->width; x++) {
        const int enters = x + w->half, leaves = x - w->half - 1;
        if (enters < w->width) {
            sum += w->sum[enters];
            square += w->square[enters];
            count += w->sure[enters];
        }
        if (leaves >= 0) {
            sum -= w->sum[leaves];
            square -= w->square[leaves];
            count -= w->sure[leaves];
        }
        if (x >= 0) {
            const double m = count > 0 ? sum / count : 0;
            const double variance = count > 0 ? square / count - m * m : 0;
            mean[x] = (float)m;
            deviation[x] = (float)sqrt(fmax(0, variance));
        }
    }
}

/* Each row is summed anew. A sum that slid down the image would be rounded by the rows it has left
 * behind, and pixels would depend on where a block begins. */
static void fill_windows(struct window *w, int first, int rows, float *mean, float *deviation)
{
    const size_t bytes = (size_t)w->width * sizeof *w->sum;
    for (int i = 0; i < rows; i++) {
        const int top = first + i - w->half, bottom = first + i + w->half;
        memset(w->sum, 0, bytes);
        memset(w->square, 0, bytes);
        memset(w->sure, 0, bytes);
        for (int row = top > 0 ? top : 0; row <= bottom && row < w->height; row++) {
            add_row(w, row);
        }
        write_row(w, mean + (size_t)i * (size_t)w->width, deviation + (size_t)i * (size_t)w->width);
    }
}

static int read_with_context(const struct db_raster *r, int context, int y, int rows, float *planes,
                             uint8_t *valid)
{
    const int half = context / 2, width = r->grid.width;
    const int top = y > half ? y - half : 0;
    const int bottom = y + rows + half < r->grid.height ? y + rows + half : r->grid.height;
    const size_t with_halo = (size_t)(bottom - top) * (size_t)width;
    const size_t count = (size_t)rows * (size_t)width, skip = (size_t)(y - top) * (size_t)width;
    const size_t bands = (size_t)r->band_count;
    float *pixels = malloc(bands * with_halo * sizeof *pixels);
    uint8_t *sure = malloc(with_halo);
    double *sums = malloc(3 * (size_t)width * sizeof *sums);
    int result = -1;
    if (!pixels || !sure || !sums) {
        hs_error(r->name, NULL, "out of memory");
    } else {
        result = db_raster_read(r, top, bottom - top, pixels, sure);
    }
    for (size_t b = 0; result == 0 && b < bands; b++) {
        const float *plane = pixels + b * with_halo;
        memcpy(planes + b * count, plane + skip, count * sizeof *planes);
        struct window w = {plane, sure, width,        bottom - top,
                           half,  sums, sums + width, sums + 2 * width};
        fill_windows(&w, y - top, rows, planes + (bands + b) * count,
                     planes + (2 * bands + b) * count);
    }
    if (result == 0) {
        memcpy(valid, sure + skip, count);
    }
    free(pixels);
    free(sure);
    free(sums);
    return result;
}

int db_features_read(const struct db_raster *r, int context, int y, int rows, float *planes,
                     uint8_t *valid)
{
    return context > 1 ? read_with_context(r, context, y, rows, planes, valid)
                       : db_raster_read(r, y, rows, planes, valid);
}

/* Rows that are in memory at the moment. */
struct block {
    float *planes;
    uint8_t *valid;
    int y, rows;
};

/* Copy the exemplars that lie in the block; returns how many were met. */
static size_t take_exemplars(struct db_samples *s, const struct db_exemplars *e, size_t next,
                             const struct block *block, int width)
{
    const size_t count = (size_t)block->rows * (size_t)width;
    size_t i = next;
    for (; i < e->count && e->items[i].y < block->y + block->rows; i++) {
        const size_t at =
            (size_t)(e->items[i].y - block->y) * (size_t)width + (size_t)e->items[i].x;
        if (!block->valid[at]) {
            s->without_data++;
            continue;
        }
        float *row = s->inputs + s->count * (size_t)s->input_count;
        for (int f = 0; f < s->input_count; f++) {
            row[f] = block->planes[(size_t)f * count + at];
        }
        s->items[s->count++] = e->items[i];
    }
    return i - next;
}

static int read_blocks(struct db_samples *s, const struct db_raster *r, int context,
                       const struct db_exemplars *e, struct block *block, int block_rows)
{
    struct hs_progress progress;
    hs_progress_begin(&progress, "exemplars", e->count);
    int result = 0;
    for (size_t next = 0; result == 0 && next < e->count;) {
        block->y = e->items[next].y;
        block->rows =
            block->y + block_rows < r->grid.height ? block_rows : r->grid.height - block->y;
        result = db_features_read(r, context, block->y, block->rows, block->planes, block->valid);
        if (result == 0) {
            next += take_exemplars(s, e, next, block, r->grid.width);
            hs_progress_update(&progress, next);
        }
    }
    hs_progress_end(&progress);
    return result;
}

int db_samples_read(struct db_samples *s, const struct db_raster *r, int context,
                    const struct db_exemplars *e)
{
    *s = (struct db_samples){.input_count = db_feature_count(r->band_count, context)};
    const int rows = db_raster_block_rows(&r->grid, db_feature_bytes(r->band_count, context));
    const size_t pixels = (size_t)rows * (size_t)r->grid.width;
    struct block block = {malloc((size_t)s->input_count * pixels * sizeof(float)), malloc(pixels),
                          0, 0};
    s->inputs = malloc((e->count + 1) * (size_t)s->input_count * sizeof *s->inputs);
    s->items = malloc((e->count + 1) * sizeof *s->items);
    int result = -1;
    if (!block.planes || !block.valid || !s->inputs || !s->items) {
        hs_error(r->name, "lower --per-class", "out of memory for %zu exemplars", e->count);
    } else {
        result = read_blocks(s, r, context, e, &block, rows);
    }
    free(block.planes);
    free(block.valid);
    if (result != 0) {
        db_samples_free(s);
    }
    return result;
}

void db_samples_free(struct db_samples *s)
{
    free(s->inputs);
    free(s->items);
    *s = (struct db_samples){0};
}
