#include "tracer/focus.h"

#include "hs/error.h"
#include "hs/taylor.h"

#include <fftw3.h>
#include <math.h>
#include <stdlib.h>

/* Echoes lie between the points of a grid. Each is laid on TAPS points either way by a
 * Kaiser-Bessel kernel, whose own spectrum is divided out behind the FFT (Jackson and others, IEEE
 * Trans. Medical Imaging 10, 1991). The grid is twice as fine as the cells, and wider than the
 * picture, so that what is outside lays its side lobes into it. */
enum { TAPS = 6, TABLE = 1024 /* a point */, FINER = 2 };

static const double pi = 3.14159265358979323846;
static const double beta = 13.8551; /* pi sqrt((TAPS / FINER)^2 (FINER - 1/2)^2 - 0.8): Beatty */
static const double taylor_db = 35;
static const int taylor_n_bar = 4;

const char *const focus_weighting_names[FOCUS_WEIGHTINGS] = {"uniform", "hamming", "taylor"};

/* -3 dB widths in units of 1 / band: of the sinc; Harris, Proc. IEEE 66, 1978, table 1; pix.h. */
static const double width_in_nulls[FOCUS_WEIGHTINGS] = {0.886, 1.303, 1.184};

double focus_band(enum focus_weighting weighting, double resolution_m)
{
    return width_in_nulls[weighting] / resolution_m;
}

/* ---- the kernel ---- */

/* Modified Bessel function of order 0, by its series. */
static double bessel_i0(double x)
{
    double term = 1, sum = 1;
    for (int k = 1; k < 64 && term > 1e-17 * sum; k++) {
        term *= x * x / (4.0 * k * k);
        sum += term;
    }
    return sum;
}

static void make_table(double *table)
{
    for (int i = 0; i <= TAPS * TABLE / 2; i++) {
        const double part = 2.0 * i / (TAPS * TABLE);
        table[i] = bessel_i0(beta * sqrt(1 - part * part));
    }
    table[TAPS * TABLE / 2 + 1] = 0;
}

/* Its spectrum at so many cycles a point; within the band the root is real. */
static double kernel_spectrum(double cycles)
{
    const double z = sqrt(beta * beta - pi * pi * TAPS * TAPS * cycles * cycles);
    return TAPS * sinh(z) / z;
}

/* ---- one direction, across or range ---- */

struct side {
    int points;           /* of the grid */
    double per_m, middle; /* place on the grid: middle + per_m * metres */
    double *weights;      /* owned: by frequency, in the order of FFTW */
};

void focus_window(enum focus_weighting weighting, double *window, int count)
{
    hs_taylor(window, count, weighting == FOCUS_TAYLOR ? taylor_db : 0, taylor_n_bar);
    for (int i = 0; i < count; i++) {
        const double turn = 2 * pi * (i - (count - 1) / 2.0) / count;
        window[i] = weighting == FOCUS_HAMMING ? 0.54 + 0.46 * cos(turn) : window[i];
    }
}

/* Weights of the band's `count` frequencies, the middle one 0; and the kernel divided out. */
static int weigh(struct side *s, enum focus_weighting weighting, int count)
{
    double *window = malloc((size_t)count * sizeof *window), sum = 0;
    s->weights = calloc((size_t)s->points, sizeof *s->weights);
    if (!window || !s->weights) {
        free(window);
        return hs_error("picture", "give fewer --cells", "out of memory");
    }
    focus_window(weighting, window, count);
    for (int i = 0; i < count; i++) {
        sum += window[i];
    }
    for (int i = 0; i < count; i++) {
        const int frequency = i - count / 2;
        const int at = frequency < 0 ? frequency + s->points : frequency;
        s->weights[at] = window[i] / sum / kernel_spectrum((double)frequency / s->points);
    }
    free(window);
    return 0;
}

static int side_open(struct side *s, const struct focus_order *o, uint32_t cells, double cell_m)
{
    const double band = focus_band(o->weighting, o->resolution_m);
    *s = (struct side){
        .points = (int)(FINER * cells * 5 / 4 + 64) / 16 * 16,
        .per_m = FINER / cell_m,
    };
    s->middle = s->points / 2.0;
    const double frequencies = band * s->points / s->per_m;
    const int count = 2 * (int)lround((frequencies - 1) / 2) + 1; /* odd: alike on both sides */
    if (count < 7) {
        return hs_error("--resolution", "give a finer one, or more --cells",
                        "%g m is about as large as the picture", o->resolution_m);
    }
    return weigh(s, o->weighting, count);
}

/* ---- the grid ---- */

struct grid {
    struct side across, range;
    double complex *values; /* owned; range rows of across points */
    double table[TAPS * TABLE / 2 + 2];
};

/* First point and the kernel's values for a place on a side. Returns -1 where it does not fit. */
static int taps_at(const struct grid *g, const struct side *s, double metres, double taps[TAPS])
{
    const double at = s->middle + metres * s->per_m;
    if (!(at >= TAPS && at < s->points - TAPS)) {
        return -1;
    }
    const int first = (int)at - TAPS / 2 + 1;
    for (int i = 0; i < TAPS; i++) {
        const double place = fabs(first + i - at) * TABLE;
        const int below = (int)place;
        taps[i] = g->table[below] + (place - below) * (g->table[below + 1] - g->table[below]);
    }
    return first;
}

static void lay_echo(void *ctx, const struct coherent_echo *echo)
{
    struct grid *g = ctx;
    double aside[TAPS], away[TAPS];
    const int column = taps_at(g, &g->across, echo->across_m, aside);
    const int row = taps_at(g, &g->range, echo->range_m, away);
    if (column < 0 || row < 0) {
        return;
    }
    for (int i = 0; i < TAPS; i++) {
        double complex *to = g->values + (size_t)(row + i) * (size_t)g->across.points + column;
        for (int k = 0; k < TAPS; k++) {
            to[k] += away[i] * aside[k] * echo->field;
        }
    }
}

/* FFT, band and weighting, FFT back: in place. */
static int filter(struct grid *g)
{
    const int rows = g->range.points, columns = g->across.points;
    const fftw_plan forth =
        fftw_plan_dft_2d(rows, columns, g->values, g->values, FFTW_FORWARD, FFTW_ESTIMATE);
    const fftw_plan back =
        fftw_plan_dft_2d(rows, columns, g->values, g->values, FFTW_BACKWARD, FFTW_ESTIMATE);
    const int result = forth && back ? 0 : hs_error("picture", "give fewer --cells", "no memory");
    if (result == 0) {
        fftw_execute(forth);
        for (size_t i = 0; i < (size_t)rows * (size_t)columns; i++) {
            const double w =
                g->range.weights[i / (size_t)columns] * g->across.weights[i % (size_t)columns];
            g->values[i] *= w;
        }
        fftw_execute(back);
    }
    if (forth) {
        fftw_destroy_plan(forth);
    }
    if (back) {
        fftw_destroy_plan(back);
    }
    return result;
}

/* The middles of pixels are points of the grid. */
static void take_pixels(const struct grid *g, const struct trace_grid *cells, int ratio,
                        float complex *chip)
{
    const int width = (int)cells->cells_across / ratio, height = (int)cells->cells_range / ratio;
    const int left = g->across.points / 2 - (int)cells->cells_across;
    const int near = g->range.points / 2 - (int)cells->cells_range;
    for (int i = 0; i < width * height; i++) {
        const int row = near + (2 * (i / width) + 1) * ratio;
        const int column = left + (2 * (i % width) + 1) * ratio;
        chip[i] = (float complex)g->values[(size_t)row * (size_t)g->across.points + (size_t)column];
    }
}

static int focus(struct grid *g, const struct trace_records *r, const struct reflect_law *law,
                 const struct focus_order *o, const struct coherent_echo *more, size_t more_count,
                 float complex *chip)
{
    if (side_open(&g->across, o, r->grid.cells_across, r->grid.cell_m) != 0 ||
        side_open(&g->range, o, r->grid.cells_range, r->grid.cell_m) != 0) {
        return -1;
    }
    const size_t count = (size_t)g->across.points * (size_t)g->range.points;
    g->values = fftw_alloc_complex(count);
    if (!g->values) {
        return hs_error("picture", "give fewer --cells", "out of memory");
    }
    for (size_t i = 0; i < count; i++) {
        g->values[i] = 0;
    }
    make_table(g->table);
    coherent_echoes(r, law, o->seed, lay_echo, g);
    for (size_t i = 0; i < more_count; i++) {
        lay_echo(g, &more[i]);
    }
    if (filter(g) != 0) {
        return -1;
    }
    take_pixels(g, &r->grid, (int)o->ratio, chip);
    return 0;
}

/* Pixels are samples: the band must fit between them, or it folds over. */
static int check_pixels(const struct trace_records *r, const struct focus_order *o)
{
    const double pixel_m = o->ratio * r->grid.cell_m;
    const double finest_m = width_in_nulls[o->weighting] * pixel_m;
    return o->resolution_m >= finest_m * (1 - 1e-9)
               ? 0
               : hs_error("--resolution", "give a coarser one, or a smaller --pixel",
                          "pixels of %g m hold a band of %.4g m of resolution at best, not %g m",
                          pixel_m, finest_m, o->resolution_m);
}

float complex *focus_chip(const struct trace_records *r, const struct reflect_law *law,
                          const struct focus_order *o)
{
    return focus_chip_with(r, law, o, NULL, 0);
}

float complex *focus_chip_with(const struct trace_records *r, const struct reflect_law *law,
                               const struct focus_order *o, const struct coherent_echo *more,
                               size_t count)
{
    if (check_pixels(r, o) != 0) {
        return NULL;
    }
    const size_t pixels =
        (size_t)(r->grid.cells_across / o->ratio) * (r->grid.cells_range / o->ratio);
    float complex *chip = malloc(pixels * sizeof *chip);
    struct grid *grid = calloc(1, sizeof *grid);
    int result = chip && grid ? 0 : hs_error("picture", "give fewer --cells", "out of memory");
    if (result == 0) {
        result = focus(grid, r, law, o, more, count, chip);
        fftw_free(grid->values);
        free(grid->across.weights);
        free(grid->range.weights);
    }
    free(grid);
    if (result != 0) {
        free(chip);
        return NULL;
    }
    return chip;
}
