#include "classify/specks.h"

#include <math.h>

/* The pixels at most `reach` from one, as far as the block goes. */
struct window {
    int left, right, top, bottom; /* inclusive */
};

static struct window window_at(const struct db_specks_block *b, int x, int y, int reach)
{
    return (struct window){.left = x > reach ? x - reach : 0,
                           .right = x + reach < b->width ? x + reach : b->width - 1,
                           .top = y > reach ? y - reach : 0,
                           .bottom = y + reach < b->rows ? y + reach : b->rows - 1};
}

bool db_specks_has(const struct db_specks_block *b, const bool is_spared[DB_CLASS_MAX], size_t at)
{
    const uint8_t own = b->before[at];
    return own != b->after[at] && own < DB_CLASS_MAX && !is_spared[own];
}

/* A speck's pixel, and what is known of it. */
struct pixel {
    const struct db_net *net;
    const bool *is_spared;
    const struct db_specks_block *b;
    int x, y;
};

static size_t place(const struct pixel *p, int x, int y)
{
    return (size_t)y * (size_t)p->b->width + (size_t)x;
}

/* True if the pixel there is of a class and of no speck. */
static bool is_ground(const struct pixel *p, size_t at)
{
    return p->b->before[at] < DB_CLASS_MAX && !db_specks_has(p->b, p->is_spared, at);
}

/* Mean of a band over the pixels of one class in the 5 x 5 around, of which there is one. */
static double mean(const struct pixel *p, const float *plane, int c)
{
    const struct window w = window_at(p->b, p->x, p->y, DB_SPECKS_HALO);
    double sum = 0;
    int count = 0;
    for (int v = w.top; v <= w.bottom; v++) {
        for (int u = w.left; u <= w.right; u++) {
            const size_t at = place(p, u, v);
            if (p->b->before[at] == c && is_ground(p, at)) {
                sum += (double)plane[at];
                count++;
            }
        }
    }
    return sum / count;
}

/* Squared distance of the pixel from the class around it. */
static double distance(const struct pixel *p, int c)
{
    const size_t plane = (size_t)p->b->rows * (size_t)p->b->width, own = place(p, p->x, p->y);
    double sum = 0;
    for (int i = 0; i < p->net->band_count; i++) {
        const float *band = p->b->planes + (size_t)i * plane;
        const double d = ((double)band[own] - mean(p, band, c)) / (double)p->net->scale[i];
        sum += d * d;
    }
    return sum;
}

static uint8_t settle(const struct pixel *p)
{
    const struct window w = window_at(p->b, p->x, p->y, 1);
    bool is_beside[DB_CLASS_MAX] = {false};
    for (int v = w.top; v <= w.bottom; v++) {
        for (int u = w.left; u <= w.right; u++) {
            if (is_ground(p, place(p, u, v))) {
                is_beside[p->b->before[place(p, u, v)]] = true;
            }
        }
    }
    double least = INFINITY;
    uint8_t nearest = p->b->after[place(p, p->x, p->y)];
    for (int c = 0; c < DB_CLASS_MAX; c++) {
        const double d = is_beside[c] ? distance(p, c) : INFINITY;
        if (d < least) {
            least = d;
            nearest = (uint8_t)c;
        }
    }
    return nearest;
}

uint64_t db_specks_settle(const struct db_net *net, const bool is_spared[DB_CLASS_MAX],
                          const struct db_specks_block *b, uint8_t *out)
{
    uint64_t changed = 0;
    for (int y = 0; y < b->count; y++) {
        for (int x = 0; x < b->width; x++) {
            const struct pixel p = {net, is_spared, b, x, b->first + y};
            const size_t at = place(&p, x, b->first + y);
            const uint8_t now = db_specks_has(b, is_spared, at) ? settle(&p) : b->before[at];
            out[(size_t)y * (size_t)b->width + (size_t)x] = now;
            changed += now != b->before[at];
        }
    }
    return changed;
}
