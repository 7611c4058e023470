#include "gis/preview.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int db_preview_init(struct db_preview *p, const struct db_grid *grid, int plane_count)
{
    const int side = grid->width > grid->height ? grid->width : grid->height;
    *p = (struct db_preview){.plane_count = plane_count};
    p->step = (side + DB_PREVIEW_SIDE - 1) / DB_PREVIEW_SIDE;
    p->width = (grid->width + p->step - 1) / p->step;
    p->height = (grid->height + p->step - 1) / p->step;
    p->values =
        malloc((size_t)plane_count * (size_t)p->width * (size_t)p->height * sizeof *p->values);
    return p->values ? 0 : hs_error("picture", NULL, "out of memory");
}

void db_preview_free(struct db_preview *p)
{
    free(p->values);
    *p = (struct db_preview){0};
}

void db_preview_add(struct db_preview *p, int plane, int y, int rows, int width,
                    const float *values, const uint8_t *valid)
{
    float *to = p->values + (size_t)plane * (size_t)p->width * (size_t)p->height;
    const int first = (y + p->step - 1) / p->step;
    for (int py = first; py * p->step < y + rows; py++) {
        const size_t row = (size_t)(py * p->step - y) * (size_t)width;
        for (int px = 0; px < p->width; px++) {
            const size_t at = row + (size_t)(px * p->step);
            to[py * p->width + px] = valid[at] ? values[at] : (float)NAN;
        }
    }
}

static int compare_floats(const void *a, const void *b)
{
    const float p = *(const float *)a, q = *(const float *)b;
    return (p > q) - (p < q);
}

/* The 2nd and 98th percentiles of the values that are there. */
static int find_range(const float *values, size_t count, float range[2])
{
    float *sorted = malloc((count + 1) * sizeof *sorted);
    if (!sorted) {
        return hs_error("picture", NULL, "out of memory");
    }
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isnan(values[i])) {
            sorted[used++] = values[i];
        }
    }
    if (used > 0) {
        qsort(sorted, used, sizeof *sorted, compare_floats);
        range[0] = sorted[used / 50];
        range[1] = sorted[used - 1 - used / 50];
    }
    free(sorted);
    return 0;
}

static uint8_t to_byte(double value, double low, double high)
{
    if (isnan(value)) {
        return 0;
    }
    const double part = high > low ? (value - low) / (high - low) : 0.5;
    return (uint8_t)lround(255 * fmin(1, fmax(0, part)));
}

static uint8_t *pixel_at(const struct db_preview *p, uint8_t *rgb, size_t i, int panel, int panels)
{
    const size_t width = (size_t)p->width, row = i / width;
    return rgb + 3 * ((row * (size_t)panels + (size_t)panel) * width + i % width);
}

int db_preview_paint_stretched(const struct db_preview *p, uint8_t *rgb, int panel, int panels)
{
    const size_t count = (size_t)p->width * (size_t)p->height;
    for (int c = 0; c < 3; c++) {
        const float *plane = p->values + (p->plane_count == 3 ? (size_t)c * count : 0);
        float range[2] = {0, 1};
        if (find_range(plane, count, range) != 0) {
            return -1;
        }
        for (size_t i = 0; i < count; i++) {
            pixel_at(p, rgb, i, panel, panels)[c] =
                to_byte((double)plane[i], (double)range[0], (double)range[1]);
        }
    }
    return 0;
}

void db_preview_paint_classes(const struct db_preview *p, const struct db_class_table *table,
                              uint8_t *rgb, int panel, int panels)
{
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        static const uint8_t nothing[3] = {0, 0, 0};
        const float v = p->values[i];
        const bool is_class = v >= 0 && v < (float)table->count;
        memcpy(pixel_at(p, rgb, i, panel, panels), is_class ? table->items[(int)v].colour : nothing,
               3);
    }
}

void db_preview_paint_grey(const struct db_preview *p, double low, double high, uint8_t *rgb,
                           int panel, int panels)
{
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        memset(pixel_at(p, rgb, i, panel, panels), to_byte((double)p->values[i], low, high), 3);
    }
}
