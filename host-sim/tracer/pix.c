#include "tracer/pix.h"

#include "hs/error.h"
#include "hs/taylor.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double side_lobe_db = 35;
static const int n_bar = 4;
static const double width_in_nulls = 1.184; /* -3 dB width of Taylor -35 dB, nbar 4 */

void pix_taylor(int aperture, double response[PIX_KERNEL_SIDE])
{
    double window[PIX_KERNEL_SIDE], sum = 0;
    hs_taylor(window, aperture, side_lobe_db, n_bar);
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        response[i] = 0;
    }
    for (int n = 0; n < aperture; n++) {
        const double turn = 2 * pi * (n - (aperture - 1) / 2.0) / PIX_KERNEL_SIDE;
        sum += window[n];
        for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
            response[i] += window[n] * cos(turn * (i - PIX_KERNEL_SIDE / 2));
        }
    }
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        response[i] = fabs(response[i]) / sum;
    }
}

int pix_resolution_check(double resolution_m, double spacing_m)
{
    const double finest_m = width_in_nulls * spacing_m;
    const double coarsest_m = finest_m * PIX_KERNEL_SIDE;
    return resolution_m >= finest_m * (1 - 1e-9) && resolution_m <= coarsest_m * (1 + 1e-9)
               ? 0
               : hs_error("--resolution", "give one of them, or other cells",
                          "cells of %g m take %.4g to %.4g m, not %g m", spacing_m, finest_m,
                          coarsest_m, resolution_m);
}

int pix_aperture(double resolution_m, double spacing_m)
{
    const double aperture = PIX_KERNEL_SIDE * spacing_m * width_in_nulls / resolution_m;
    return (int)lround(fmin(fmax(aperture, 1), PIX_KERNEL_SIDE));
}

/* Spread `from` by `weights` into `to`. */
static void spread_line(const float *from, int count, const float weights[PIX_KERNEL_SIDE],
                        float *to)
{
    const int half = PIX_KERNEL_SIDE / 2;
    for (int i = 0; i < count; i++) {
        to[i] = 0;
    }
    for (int i = 0; i < count; i++) {
        const int low = i - half > 0 ? i - half : 0;
        const int high = i + half < count - 1 ? i + half : count - 1;
        for (int k = low; from[i] > 0 && k <= high; k++) {
            to[k] += from[i] * weights[k - i + half];
        }
    }
}

/* What is needed for lines of one length. */
struct spreader {
    float *line, *spread, *within; /* owned: a line, what becomes of it, the weights inside it */
    int count;
};

static bool spreader_open(struct spreader *s, int count, const float weights[PIX_KERNEL_SIDE])
{
    const size_t size = (size_t)count * sizeof(float);
    *s = (struct spreader){malloc(size), malloc(size), malloc(size), count};
    if (!s->line || !s->spread || !s->within) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        s->line[i] = 1;
    }
    spread_line(s->line, count, weights, s->within);
    return true;
}

static void spreader_close(struct spreader *s)
{
    free(s->line);
    free(s->spread);
    free(s->within);
}

/* Numbers `step` apart, in place. */
static void spread_in_place(struct spreader *s, float *first, int step,
                            const float weights[PIX_KERNEL_SIDE])
{
    for (int i = 0; i < s->count; i++) {
        s->line[i] = first[(size_t)i * (size_t)step];
    }
    spread_line(s->line, s->count, weights, s->spread);
    for (int i = 0; i < s->count; i++) {
        first[(size_t)i * (size_t)step] = s->spread[i] / s->within[i];
    }
}

static void power_weights(int aperture, float weights[PIX_KERNEL_SIDE])
{
    double response[PIX_KERNEL_SIDE], sum = 0;
    pix_taylor(aperture, response);
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        sum += response[i] * response[i];
    }
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        weights[i] = (float)(response[i] * response[i] / sum);
    }
}

int pix_spread(float *power, int width, int height, int aperture)
{
    float weights[PIX_KERNEL_SIDE];
    struct spreader rows, columns;
    power_weights(aperture, weights);
    const bool has_rows = spreader_open(&rows, width, weights);
    const bool has_columns = spreader_open(&columns, height, weights);
    for (int row = 0; has_rows && has_columns && row < height; row++) {
        spread_in_place(&rows, power + (size_t)row * (size_t)width, 1, weights);
    }
    for (int column = 0; has_rows && has_columns && column < width; column++) {
        spread_in_place(&columns, power + column, width, weights);
    }
    spreader_close(&rows);
    spreader_close(&columns);
    return has_rows && has_columns ? 0 : hs_error("picture", NULL, "out of memory");
}

void pix_coarsen(const float *power, int width, int height, int ratio, float *coarse)
{
    for (int row = 0; row < height / ratio; row++) {
        for (int column = 0; column < width / ratio; column++) {
            float sum = 0;
            for (int k = 0; k < ratio * ratio; k++) {
                sum += power[(row * ratio + k / ratio) * width + column * ratio + k % ratio];
            }
            coarse[row * (width / ratio) + column] = sum / (float)(ratio * ratio);
        }
    }
}

void pix_speckle(float *power, int count, int looks, struct hs_rng *rng)
{
    for (int i = 0; i < count; i++) {
        double sum = 0;
        for (int k = 0; k < looks; k++) {
            sum -= log1p(-hs_rng_uniform(rng));
        }
        power[i] *= (float)(sum / looks);
    }
}
