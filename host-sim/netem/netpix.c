#include "netem/netpix.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int nm_netpix_open(struct nm_netpix *pix, int side)
{
    *pix = (struct nm_netpix){.side = side};
    if (nm_convolver_open(&pix->convolver, side, NM_LARGE) != 0) {
        return -1;
    }
    const size_t cells = (size_t)side * (size_t)side * sizeof(double);
    pix->picture = nm_spectrum_new(&pix->convolver);
    pix->kernel = nm_spectrum_new(&pix->convolver);
    pix->sum = nm_spectrum_new(&pix->convolver);
    pix->d_out = nm_spectrum_new(&pix->convolver);
    pix->fixed = nm_spectrum_new(&pix->convolver);
    pix->fixed_kernel = malloc(NM_LARGE * NM_LARGE * sizeof(double));
    pix->cells = malloc(cells);
    pix->d_cells = malloc(cells);
    bool is_whole = pix->picture && pix->kernel && pix->sum && pix->d_out && pix->fixed &&
                    pix->fixed_kernel && pix->cells && pix->d_cells;
    for (int k = 0; k < NM_FIRST_KERNELS; k++) {
        pix->channel[k] = nm_spectrum_new(&pix->convolver);
        pix->plane[k] = malloc(cells);
        is_whole = is_whole && pix->channel[k] && pix->plane[k];
    }
    if (!is_whole) {
        nm_netpix_close(pix);
        return hs_error("pixels", "use a smaller picture", "out of memory");
    }
    pix->fixed_kernel[0] = NAN;
    return 0;
}

void nm_netpix_close(struct nm_netpix *pix)
{
    nm_convolver_close(&pix->convolver);
    fftw_free(pix->picture);
    fftw_free(pix->kernel);
    fftw_free(pix->sum);
    fftw_free(pix->d_out);
    fftw_free(pix->fixed);
    free(pix->fixed_kernel);
    for (int k = 0; k < NM_FIRST_KERNELS; k++) {
        fftw_free(pix->channel[k]);
        free(pix->plane[k]);
    }
    free(pix->cells);
    free(pix->d_cells);
    *pix = (struct nm_netpix){0};
}

void nm_pix_draw(struct nm_pix_values *v, const double *kernel, struct hs_rng *rng)
{
    *v = (struct nm_pix_values){0};
    memcpy(v->large, kernel, sizeof v->large);
    for (int k = 0; k < NM_SMALL_KERNELS; k++) {
        for (int i = 0; i < NM_SMALL * NM_SMALL; i++) {
            v->small[k][i] = hs_rng_normal(rng) / NM_SMALL;
        }
    }
    v->second[0][NM_SECOND * NM_SECOND / 2] = 1;
}

static void sample(const struct nm_netpix *pix, const double *cells, double *pixels)
{
    const int pixel_side = pix->side / NM_CELLS_PER_PIXEL;
    for (int y = 0; y < pixel_side; y++) {
        for (int x = 0; x < pixel_side; x++) {
            pixels[y * pixel_side + x] = tanh(cells[NM_CELLS_PER_PIXEL * (y * pix->side + x)]);
        }
    }
}

/* The derivative by all cells before the sampling, most of them zero. */
static void unsample(const struct nm_netpix *pix, const double *pixels, const double *d_pixels,
                     double *d_cells)
{
    const int pixel_side = pix->side / NM_CELLS_PER_PIXEL;
    memset(d_cells, 0, (size_t)pix->side * (size_t)pix->side * sizeof *d_cells);
    for (int y = 0; y < pixel_side; y++) {
        for (int x = 0; x < pixel_side; x++) {
            const int i = y * pixel_side + x;
            d_cells[NM_CELLS_PER_PIXEL * (y * pix->side + x)] =
                d_pixels[i] * (1 - pixels[i] * pixels[i]);
        }
    }
}

static bool is_same(const double *a, const double *b, size_t count)
{
    size_t i = 0;
    while (i < count && a[i] == b[i]) {
        i++;
    }
    return i == count;
}

/* The spectrum of the fixed kernel, which is mostly the one of the last call; not a number before
 * the first. */
static fftw_complex *fixed_spectrum(struct nm_netpix *pix, const double *kernel)
{
    const size_t count = NM_LARGE * NM_LARGE;
    if (!is_same(pix->fixed_kernel, kernel, count)) {
        memcpy(pix->fixed_kernel, kernel, count * sizeof *kernel);
        nm_spectrum_of_kernel(&pix->convolver, kernel, NM_LARGE, pix->fixed);
    }
    return pix->fixed;
}

void nm_netpix_fixed(struct nm_netpix *pix, const double *kernel, const double *picture,
                     double *pixels)
{
    struct nm_convolver *c = &pix->convolver;
    nm_spectrum_of_picture(c, picture, pix->picture);
    nm_spectrum_clear(c, pix->sum);
    nm_spectrum_add_product(c, pix->picture, fixed_spectrum(pix, kernel), pix->sum);
    nm_picture_of_spectrum(c, pix->sum, pix->cells);
    sample(pix, pix->cells, pixels);
}

void nm_netpix_fixed_backward(struct nm_netpix *pix, const double *kernel, const double *pixels,
                              const double *d_pixels, double *d_picture)
{
    struct nm_convolver *c = &pix->convolver;
    unsample(pix, pixels, d_pixels, pix->d_cells);
    nm_spectrum_of_picture(c, pix->d_cells, pix->picture);
    nm_spectrum_clear(c, pix->sum);
    nm_spectrum_add_correlation(c, pix->picture, fixed_spectrum(pix, kernel), pix->sum);
    nm_picture_of_spectrum(c, pix->sum, d_picture);
}

static const double *first_kernel(const struct nm_pix_values *v, int k, int *size)
{
    *size = k == 0 ? NM_LARGE : NM_SMALL;
    return k == 0 ? v->large : v->small[k - 1];
}

void nm_netpix_trainable(struct nm_netpix *pix, const struct nm_pix_values *v,
                         const double *picture, double *pixels)
{
    struct nm_convolver *c = &pix->convolver;
    const size_t cells = (size_t)pix->side * (size_t)pix->side;
    nm_spectrum_of_picture(c, picture, pix->picture);
    for (int k = 0; k < NM_FIRST_KERNELS; k++) {
        int size;
        const double *kernel = first_kernel(v, k, &size);
        nm_spectrum_of_kernel(c, kernel, size, pix->kernel);
        nm_spectrum_clear(c, pix->sum);
        nm_spectrum_add_product(c, pix->picture, pix->kernel, pix->sum);
        nm_picture_of_spectrum(c, pix->sum, pix->plane[k]);
        for (size_t i = 0; i < cells; i++) {
            pix->plane[k][i] = fmax(pix->plane[k][i] + v->first_bias[k], 0);
        }
        nm_spectrum_of_picture(c, pix->plane[k], pix->channel[k]);
    }
    nm_spectrum_clear(c, pix->sum);
    for (int k = 0; k < NM_CHANNELS; k++) {
        nm_spectrum_of_kernel(c, v->second[k], NM_SECOND, pix->kernel);
        nm_spectrum_add_product(c, k < NM_FIRST_KERNELS ? pix->channel[k] : pix->picture,
                                pix->kernel, pix->sum);
    }
    nm_picture_of_spectrum(c, pix->sum, pix->cells);
    for (size_t i = 0; i < cells; i++) {
        pix->cells[i] += v->second_bias;
    }
    sample(pix, pix->cells, pixels);
}

static void add_kernel_gradient(struct nm_netpix *pix, const fftw_complex *d_out,
                                const fftw_complex *in, int size, double *gradient)
{
    double kernel[NM_LARGE * NM_LARGE];
    struct nm_convolver *c = &pix->convolver;
    nm_spectrum_clear(c, pix->sum);
    nm_spectrum_add_correlation(c, d_out, in, pix->sum);
    nm_kernel_of_spectrum(c, pix->sum, size, kernel);
    for (int i = 0; i < size * size; i++) {
        gradient[i] += kernel[i];
    }
}

/* From `d_out`, the derivative by a layer's result, to `d_in`, that by what its kernel ran over. */
static void back_through(struct nm_netpix *pix, const fftw_complex *d_out, const double *kernel,
                         int size, double *d_in)
{
    struct nm_convolver *c = &pix->convolver;
    nm_spectrum_of_kernel(c, kernel, size, pix->kernel);
    nm_spectrum_clear(c, pix->sum);
    nm_spectrum_add_correlation(c, d_out, pix->kernel, pix->sum);
    nm_picture_of_spectrum(c, pix->sum, d_in);
}

static void first_layer_backward(struct nm_netpix *pix, const struct nm_pix_values *v, int k,
                                 const double *d_plane, double *d_picture,
                                 struct nm_pix_values *gradient)
{
    const size_t cells = (size_t)pix->side * (size_t)pix->side;
    for (size_t i = 0; i < cells; i++) {
        pix->cells[i] = pix->plane[k][i] > 0 ? d_plane[i] : 0;
        gradient->first_bias[k] += pix->cells[i];
    }
    nm_spectrum_of_picture(&pix->convolver, pix->cells, pix->channel[k]);
    int size;
    const double *kernel = first_kernel(v, k, &size);
    add_kernel_gradient(pix, pix->channel[k], pix->picture, size,
                        k == 0 ? gradient->large : gradient->small[k - 1]);
    if (d_picture) {
        back_through(pix, pix->channel[k], kernel, size, pix->cells);
        for (size_t i = 0; i < cells; i++) {
            d_picture[i] += pix->cells[i];
        }
    }
}

void nm_netpix_trainable_backward(struct nm_netpix *pix, const struct nm_pix_values *v,
                                  const double *pixels, const double *d_pixels, double *d_picture,
                                  struct nm_pix_values *gradient)
{
    struct nm_convolver *c = &pix->convolver;
    const size_t cells = (size_t)pix->side * (size_t)pix->side;
    unsample(pix, pixels, d_pixels, pix->d_cells);
    for (size_t i = 0; i < cells; i++) {
        gradient->second_bias += pix->d_cells[i];
    }
    fftw_complex *d_out = pix->d_out;
    nm_spectrum_of_picture(c, pix->d_cells, d_out);
    for (int k = 0; k < NM_CHANNELS; k++) {
        add_kernel_gradient(pix, d_out, k < NM_FIRST_KERNELS ? pix->channel[k] : pix->picture,
                            NM_SECOND, gradient->second[k]);
    }
    if (d_picture) {
        back_through(pix, d_out, v->second[NM_FIRST_KERNELS], NM_SECOND, d_picture);
    }
    for (int k = 0; k < NM_FIRST_KERNELS; k++) {
        back_through(pix, d_out, v->second[k], NM_SECOND, pix->d_cells);
        first_layer_backward(pix, v, k, pix->d_cells, d_picture, gradient);
    }
}
