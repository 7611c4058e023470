#include "netem/fft.h"

#include "hs/error.h"

int nm_fft_open(struct nm_fft *f, int rows, int columns, const char *place)
{
    *f = (struct nm_fft){
        .rows = rows,
        .columns = columns,
        .spectrum_size = (size_t)rows * (size_t)(columns / 2 + 1),
        .plane = fftw_alloc_real((size_t)rows * (size_t)columns),
    };
    f->spectrum = nm_fft_spectrum_new(f);
    if (f->plane && f->spectrum) {
        f->forward = fftw_plan_dft_r2c_2d(rows, columns, f->plane, f->spectrum, FFTW_ESTIMATE);
        f->backward = fftw_plan_dft_c2r_2d(rows, columns, f->spectrum, f->plane, FFTW_ESTIMATE);
    }
    if (!f->forward || !f->backward) {
        nm_fft_close(f);
        return hs_error(place, "use smaller pictures", "out of memory");
    }
    return 0;
}

void nm_fft_close(struct nm_fft *f)
{
    if (f->forward) {
        fftw_destroy_plan(f->forward);
    }
    if (f->backward) {
        fftw_destroy_plan(f->backward);
    }
    fftw_free(f->plane);
    fftw_free(f->spectrum);
    *f = (struct nm_fft){0};
}

fftw_complex *nm_fft_spectrum_new(const struct nm_fft *f)
{
    return fftw_alloc_complex(f->spectrum_size);
}

void nm_fft_to(struct nm_fft *f, fftw_complex *spectrum)
{
    fftw_execute_dft_r2c(f->forward, f->plane, spectrum);
}

void nm_fft_back(struct nm_fft *f)
{
    fftw_execute(f->backward);
}
