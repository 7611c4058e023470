#include "classify/mixtures.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REACH = 2, SURE_NEIGHBOURS = 5 };

/* A class of the pair that the network gave the pixel keeps it down to this share. */
#define SHARE_TO_KEEP 0.4

int db_mixtures_init(struct db_mixtures *m, const struct db_net *net, double tolerance)
{
    *m = (struct db_mixtures){.band_count = net->band_count, .tolerance = tolerance};
    const size_t bands = (size_t)net->band_count;
    m->weights = malloc(bands * sizeof *m->weights);
    m->sums = malloc(DB_CLASS_MAX * bands * sizeof *m->sums);
    if (!m->weights || !m->sums) {
        db_mixtures_free(m);
        return hs_error("mixtures", NULL, "out of memory");
    }
    for (size_t i = 0; i < bands; i++) {
        m->weights[i] = 1 / ((double)net->scale[i] * (double)net->scale[i]);
    }
    return 0;
}

void db_mixtures_free(struct db_mixtures *m)
{
    free(m->weights);
    free(m->sums);
    *m = (struct db_mixtures){0};
}

/* The pixels at most `reach` from one, as far as the block goes. */
struct window {
    int left, right, top, bottom; /* inclusive */
};

static struct window window_at(const struct db_mixtures_block *b, int x, int y, int reach)
{
    return (struct window){.left = x > reach ? x - reach : 0,
                           .right = x + reach < b->width ? x + reach : b->width - 1,
                           .top = y > reach ? y - reach : 0,
                           .bottom = y + reach < b->rows ? y + reach : b->rows - 1};
}

static bool is_sure(const struct db_mixtures_block *b, int x, int y)
{
    const struct window w = window_at(b, x, y, 1);
    const uint8_t own = b->classes[(size_t)y * (size_t)b->width + (size_t)x];
    int same = -1; /* itself */
    for (int v = w.top; v <= w.bottom; v++) {
        for (int u = w.left; u <= w.right; u++) {
            same += b->classes[(size_t)v * (size_t)b->width + (size_t)u] == own;
        }
    }
    return own < DB_CLASS_MAX && same >= SURE_NEIGHBOURS;
}

static void find_sure(const struct db_mixtures_block *b)
{
    const int top = b->first > REACH ? b->first - REACH : 0;
    const int end = b->first + b->count + REACH;
    for (int y = top; y < b->rows && y < end; y++) {
        for (int x = 0; x < b->width; x++) {
            b->sure[(size_t)y * (size_t)b->width + (size_t)x] = is_sure(b, x, y);
        }
    }
}

/* The sums of the sure pixels of each class in the window become means. */
static void find_means(struct db_mixtures *m, const struct db_mixtures_block *b, int x, int y,
                       int counts[DB_CLASS_MAX])
{
    const struct window w = window_at(b, x, y, REACH);
    const size_t bands = (size_t)m->band_count, plane = (size_t)b->rows * (size_t)b->width;
    memset(counts, 0, DB_CLASS_MAX * sizeof *counts);
    for (int v = w.top; v <= w.bottom; v++) {
        for (int u = w.left; u <= w.right; u++) {
            const size_t at = (size_t)v * (size_t)b->width + (size_t)u;
            if (!b->sure[at]) {
                continue;
            }
            double *sums = m->sums + (size_t)b->classes[at] * bands;
            const bool is_first = counts[b->classes[at]]++ == 0;
            for (size_t i = 0; i < bands; i++) {
                sums[i] = (is_first ? 0 : sums[i]) + (double)b->planes[i * plane + at];
            }
        }
    }
    for (size_t c = 0; c < DB_CLASS_MAX; c++) {
        for (size_t i = 0; counts[c] > 0 && i < bands; i++) {
            m->sums[c * bands + i] /= counts[c];
        }
    }
}

/* The best mixture so far. */
struct fit {
    double residual;
    uint8_t winner;
};

static uint8_t larger(double share_of_a, uint8_t a, uint8_t c, uint8_t own)
{
    const double enough = own == a ? SHARE_TO_KEEP : own == c ? 1 - SHARE_TO_KEEP : 0.5;
    return share_of_a >= enough ? a : c;
}

/* Squared distances, weighted: of the means of `a` and `c`, of the pixel from the line between
 * them. */
static void try_pair(const struct db_mixtures *m, const float *pixel, size_t stride, uint8_t a,
                     uint8_t c, uint8_t own, struct fit *best)
{
    const size_t bands = (size_t)m->band_count;
    const double *of_a = m->sums + a * bands, *of_c = m->sums + c * bands;
    double apart = 0, along = 0, away = 0;
    for (size_t i = 0; i < bands; i++) {
        const double d = of_a[i] - of_c[i], p = (double)pixel[i * stride] - of_c[i];
        apart += m->weights[i] * d * d;
        along += m->weights[i] * p * d;
        away += m->weights[i] * p * p;
    }
    if (!(apart > 0)) {
        return;
    }
    const double share = fmin(fmax(along / apart, 0), 1);
    const double residual = away - share * (2 * along - share * apart);
    if (residual <= m->tolerance * m->tolerance * apart && residual < best->residual) {
        *best = (struct fit){residual, larger(share, a, c, own)};
    }
}

static uint8_t judge(struct db_mixtures *m, const struct db_mixtures_block *b, int x, int y)
{
    const size_t at = (size_t)y * (size_t)b->width + (size_t)x;
    const size_t plane = (size_t)b->rows * (size_t)b->width;
    int counts[DB_CLASS_MAX];
    struct fit best = {INFINITY, b->classes[at]};
    find_means(m, b, x, y, counts);
    for (int a = 0; a < DB_CLASS_MAX; a++) {
        for (int c = a + 1; counts[a] > 0 && c < DB_CLASS_MAX; c++) {
            if (counts[c] > 0) {
                try_pair(m, b->planes + at, plane, (uint8_t)a, (uint8_t)c, b->classes[at], &best);
            }
        }
    }
    return best.winner;
}

uint64_t db_mixtures_resolve(struct db_mixtures *m, const struct db_mixtures_block *b, uint8_t *out)
{
    uint64_t changed = 0;
    find_sure(b);
    for (int y = 0; y < b->count; y++) {
        for (int x = 0; x < b->width; x++) {
            const size_t at = (size_t)(b->first + y) * (size_t)b->width + (size_t)x;
            const uint8_t own = b->classes[at];
            const bool stays = own >= DB_CLASS_MAX || b->sure[at];
            const uint8_t now = stays ? own : judge(m, b, x, b->first + y);
            out[(size_t)y * (size_t)b->width + (size_t)x] = now;
            changed += now != own;
        }
    }
    return changed;
}
