#include "netem/registration.h"

#include "hs/error.h"

#include <math.h>
#include <string.h>

/* Of the largest term of the simulated spectrum: what is weaker is not compared. */
static const double band_floor = 0.02;

int nm_registrar_open(struct nm_registrar *r, int side)
{
    *r = (struct nm_registrar){.side = side};
    if (nm_fft_open(&r->fft, side, side, "registration") != 0) {
        return -1;
    }
    r->simulated_spectrum = nm_fft_spectrum_new(&r->fft);
    if (!r->simulated_spectrum) {
        nm_registrar_close(r);
        return hs_error("registration", "use smaller chips", "out of memory");
    }
    return 0;
}

void nm_registrar_close(struct nm_registrar *r)
{
    nm_fft_close(&r->fft);
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
    const int half = (int)r->fft.spectrum_size;
    const double floor = band_floor * largest_of(r->simulated_spectrum, half);
    for (int i = 0; i < half; i++) {
        const double *g = r->simulated_spectrum[i];
        fftw_complex product;
        nm_fft_correlate(r->fft.spectrum[i], g, product);
        const double size = hypot(product[0], product[1]);
        const double scale = hypot(g[0], g[1]) > floor && size > 0 ? 1 / size : 0;
        r->fft.spectrum[i][0] = scale * product[0];
        r->fft.spectrum[i][1] = scale * product[1];
    }
}

static double peak_at(const struct nm_registrar *r, int x, int y)
{
    const int n = r->side;
    return r->fft.plane[(y + n) % n * n + (x + n) % n] / ((double)n * n);
}

struct nm_origin nm_register(struct nm_registrar *r, const double *simulated,
                             const struct nm_picture *real, struct nm_origin near, int reach,
                             double *sharpness)
{
    const int pixels = r->side * r->side;
    memcpy(r->fft.plane, simulated, (size_t)pixels * sizeof *simulated);
    take_mean(r->fft.plane, pixels);
    nm_fft_to(&r->fft, r->simulated_spectrum);
    nm_picture_cut(real, near, r->side, r->fft.plane);
    take_mean(r->fft.plane, pixels);
    nm_fft_to(&r->fft, r->fft.spectrum);
    cross_phase(r);
    nm_fft_back(&r->fft);
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
