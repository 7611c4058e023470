#include "table_picture.h"

#include "hs/chart.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>

enum { ACROSS = 4, SIDE_MAX_PX = 300, GAP = 8, CAPTION = 24 };

static const uint32_t nothing = 0x203060;

static const char *const captions[TRACE_CHANNELS] = {
    "blocked",     "material", "theta1 incidence", "theta2 echo",
    "theta4 turn", "phase",    "across",           "range"};

static void limits(const float *image, size_t count, float *low, float *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        *low = fminf(*low, image[i]); /* passes over a NaN */
        *high = fmaxf(*high, image[i]);
    }
}

/* One channel with its corner at (x, y), every `thin`-th ray a pixel, the upper row on top. */
static void draw_channel(const struct trace_records *r, const float *image, uint32_t thin, int x,
                         int y, struct sheet *sheet)
{
    const uint32_t columns = r->sensor.columns / thin, rows = r->sensor.rows / thin;
    float low, high;
    limits(image, (size_t)r->sensor.columns * r->sensor.rows, &low, &high);
    for (uint32_t row = 0; row < rows; row++) {
        for (uint32_t column = 0; column < columns; column++) {
            const float value = image[(size_t)row * thin * r->sensor.columns + column * thin];
            const float share = high > low ? (value - low) / (high - low) : 1;
            const uint32_t ink =
                isnan(value) ? nothing : 0x010101u * (uint32_t)lroundf(255 * share);
            sheet_dot(sheet, x + (int)column, y + (int)(rows - 1 - row), ink);
        }
    }
}

int table_picture(const struct trace_records *r, uint32_t bounce, const char *path)
{
    const uint32_t larger = r->sensor.columns > r->sensor.rows ? r->sensor.columns : r->sensor.rows;
    const uint32_t thin = (larger + SIDE_MAX_PX - 1) / SIDE_MAX_PX;
    const int step_x = (int)(r->sensor.columns / thin) + GAP;
    const int step_y = (int)(r->sensor.rows / thin) + GAP + CAPTION;
    float *image = malloc((size_t)r->sensor.columns * r->sensor.rows * sizeof *image);
    struct sheet sheet;
    if (!image || sheet_open(&sheet, ACROSS * step_x + GAP,
                             (TRACE_CHANNELS + ACROSS - 1) / ACROSS * step_y + GAP) != 0) {
        free(image);
        return image ? -1 : hs_error(path, "trace fewer rays", "out of memory");
    }
    for (int channel = 0; channel < TRACE_CHANNELS; channel++) {
        const int x = GAP + channel % ACROSS * step_x, y = GAP + channel / ACROSS * step_y;
        trace_image(r, bounce, (enum trace_channel)channel, image);
        draw_channel(r, image, thin, x, y, &sheet);
        sheet_text(&sheet, x, y + step_y - GAP - CAPTION + 4, captions[channel], INK_BLACK);
    }
    free(image);
    return sheet_close(&sheet, path);
}
