#include "registration.h"

#include "hs/error.h"

#include <math.h>

/* Of the largest term of the simulated spectrum: what is weaker is not compared. */
static const double band_floor = 0.02;

int nm_registrar_open(struct nm_registrar *r, int side)
{
    const size_t pixels = (size_t)side * (size_t)side;
    const size_t half = (size_t)side * (size_t)(side / 2 + 1);
    *r = (struct nm_registrar){side,
                               fftw_alloc_real(pixels),
                               fftw_alloc_real(pixels),
                               fftw_alloc_real(pixels),
                               fftw_alloc_complex(half),
                               fftw_alloc_complex(half),
                               NULL,
                               NULL};
    if (r->real && r->simulated && r->peak && r->real_spectrum && r->simulated_spectrum) {
        r->forward = fftw_plan_dft_r2c_2d(side, side, r->real, r->real_spectrum, FFTW_ESTIMATE);
        r->backward = fftw_plan_dft_c2r_2d(side, side, r->real_spectrum, r->peak, FFTW_ESTIMATE);
    }
    if (!r->forward || !r->backward) {
        nm_registrar_close(r);
        return hs_error("registration", "use smaller chips", "out of memory");
    }
    return 0;
}

void nm_registrar_close(struct nm_registrar *r)
{
    if (r->forward) {
        fftw_destroy_plan(r->forward);
    }
    if (r->backward) {
        fftw_destroy_plan(r->backward);
    }
    fftw_free(r->real);
    fftw_free(r->simulated);
    fftw_free(r->peak);
    fftw_free(r->real_spectrum);
    fftw_free(r->simulated_spectrum);
    *r = (struct nm_registrar){0};
}

static void take_mean(double *pixels, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        sum += pixels[i];
    }
    for (int i = 0; i < count; i++) {
        pixels[i] -= sum / count;
    }
}

static double largest_of(const fftw_complex *spectrum, int count)
{
    double largest = 0;
    for (int i = 0; i < count; i++) {
        largest = fmax(largest, hypot(spectrum[i][0], spectrum[i][1]));
    }
    return largest;
}

/* (17), with the real picture as H: of its product with the conjugate of G only the phase counts.
 * Outside the radar's band the simulated picture holds nothing, and the phase there is noise. */
static void cross_phase(struct nm_registrar *r)
{
    const int half = r->side * (r->side / 2 + 1);
    const double floor = band_floor * largest_of(r->simulated_spectrum, half);
    for (int i = 0; i < half; i++) {
        const double *g = r->simulated_spectrum[i];
        double *h = r->real_spectrum[i];
        const double re = h[0] * g[0] + h[1] * g[1], im = h[1] * g[0] - h[0] * g[1];
        const double size = hypot(re, im);
        const double scale = hypot(g[0], g[1]) > floor && size > 0 ? 1 / size : 0;
        h[0] = scale * re;
        h[1] = scale * im;
    }
}

static double peak_at(const struct nm_registrar *r, int x, int y)
{
    const int n = r->side;
    return r->peak[(y + n) % n * n + (x + n) % n] / ((double)n * n);
}

struct nm_origin nm_register(struct nm_registrar *r, const double *simulated,
                             const struct nm_picture *real, struct nm_origin near, int reach,
                             double *sharpness)
{
    const int pixels = r->side * r->side;
    nm_picture_cut(real, near, r->side, r->real);
    for (int i = 0; i < pixels; i++) {
        r->simulated[i] = simulated[i];
    }
    take_mean(r->real, pixels);
    take_mean(r->simulated, pixels);
    fftw_execute_dft_r2c(r->forward, r->real, r->real_spectrum);
    fftw_execute_dft_r2c(r->forward, r->simulated, r->simulated_spectrum);
    cross_phase(r);
    fftw_execute(r->backward);
    const int limit = reach < (r->side - 1) / 2 ? reach : (r->side - 1) / 2;
    struct nm_origin best = {0, 0};
    for (int y = -limit; y <= limit; y++) {
        for (int x = -limit; x <= limit; x++) {
            if (peak_at(r, x, y) > peak_at(r, best.x, best.y)) {
                best = (struct nm_origin){x, y};
            }
        }
    }
    if (sharpness) {
        *sharpness = peak_at(r, best.x, best.y);
    }
    return (struct nm_origin){near.x + best.x, near.y + best.y};
}
