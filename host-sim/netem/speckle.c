#include "netem/speckle.h"

#include "hs/error.h"
#include "tracer/pix.h"

#include <math.h>
#include <stdlib.h>

/* The response along one axis, its energy 1: white noise keeps its power. */
static void make_line(int aperture, double line[PIX_KERNEL_SIDE])
{
    double energy = 0;
    pix_taylor(aperture, line);
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        energy += line[i] * line[i];
    }
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        line[i] /= sqrt(energy);
    }
}

/* Convolve along one axis, the far end joined to the near one: `step` from one to the next,
 * `stride` from one line to the next. */
static void spread(const double *from, int side, int step, int stride,
                   const double line[PIX_KERNEL_SIDE], double *to)
{
    const int half = PIX_KERNEL_SIDE / 2;
    for (int i = 0; i < side * side; i++) {
        double sum = 0;
        const int along = i % side, base = i / side * stride;
        for (int k = 0; k < PIX_KERNEL_SIDE; k++) {
            const int at = (along + k - half + side * PIX_KERNEL_SIDE) % side;
            sum += line[k] * from[base + at * step];
        }
        to[base + along * step] = sum;
    }
}

/* Add the power of one part of a field, of the mean `mean`, to `power`. */
static void add_part(double *power, int side, const double line[PIX_KERNEL_SIDE], double mean,
                     double *noise, double *spread_out, struct hs_rng *rng)
{
    for (int i = 0; i < side * side; i++) {
        noise[i] = hs_rng_normal(rng);
    }
    spread(noise, side, 1, side, line, spread_out);
    spread(spread_out, side, side, 1, line, noise);
    for (int i = 0; i < side * side; i++) {
        power[i] += mean * noise[i] * noise[i];
    }
}

int nm_speckle(double *pixels, int side, int aperture, int looks, struct hs_rng *rng)
{
    double line[PIX_KERNEL_SIDE];
    const size_t count = (size_t)side * (size_t)side;
    double *power = calloc(3 * count, sizeof *power);
    if (!power) {
        return hs_error("speckle", "use smaller pictures", "out of memory");
    }
    make_line(aperture, line);
    for (int part = 0; part < 2 * looks; part++) {
        add_part(power, side, line, 0.5 / looks, power + count, power + 2 * count, rng);
    }
    for (size_t i = 0; i < count; i++) {
        pixels[i] = tanh(sqrt(power[i]) * atanh(fmin(pixels[i], 1 - 1e-12)));
    }
    free(power);
    return 0;
}
