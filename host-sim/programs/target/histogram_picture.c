#include "histogram_picture.h"

#include "hs/chart.h"

#include <math.h>

enum { ACROSS = 3, PANEL_WIDTH = 300, PANEL_HEIGHT = 180, STEP_X = 380, STEP_Y = 260 };
enum { LOW_POWER = -6 }; /* of ten: the least share that is drawn */

static void draw_bars(const struct chart *c, const struct histogram *h)
{
    const double wide = (double)c->width / HISTOGRAM_BINS;
    for (int i = 0; i < HISTOGRAM_BINS; i++) {
        if (h->counts[i] == 0) {
            continue;
        }
        const double share = (double)h->counts[i] / (double)h->total;
        const double level = fmax(1 - log10(share) / LOW_POWER, 0);
        for (int x = (int)ceil(i * wide); x < (int)ceil((i + 1) * wide) - 1; x++) {
            const double foot = c->top + c->height;
            sheet_line(c->sheet, c->left + x, foot, c->left + x, foot - level * c->height,
                       INK_BLUE);
        }
    }
}

int histogram_picture(const struct histogram h[HISTOGRAM_CHANNELS], const char *path)
{
    struct sheet sheet;
    if (sheet_open(&sheet, ACROSS * STEP_X, HISTOGRAM_CHANNELS / ACROSS * STEP_Y) != 0) {
        return -1;
    }
    for (int i = 0; i < HISTOGRAM_CHANNELS; i++) {
        const struct chart chart = {.sheet = &sheet,
                                    .left = i % ACROSS * STEP_X + 60,
                                    .top = i / ACROSS * STEP_Y + 40,
                                    .width = PANEL_WIDTH,
                                    .height = PANEL_HEIGHT,
                                    .x_low = h[i].low,
                                    .x_high = h[i].high,
                                    .x_step = (h[i].high - h[i].low) / 4,
                                    .y_low = LOW_POWER,
                                    .y_high = 0,
                                    .y_step = 1,
                                    .title = h[i].name,
                                    .x_name = "share, power of ten"};
        chart_axes(&chart);
        draw_bars(&chart, &h[i]);
    }
    return sheet_close(&sheet, path);
}
