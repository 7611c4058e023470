/* Registration: the shift between a simulated and a real picture by phase correlation (Niu
 * (15)-(17); Kuglin and Hines, 1975), to the whole pixel. Only those terms count in which the
 * simulated picture has at least 1/50 of its strongest one: on real chips the phase of weaker
 * terms is noise. */
#ifndef NETEM_REGISTRATION_H
#define NETEM_REGISTRATION_H

#include "netem/fft.h"
#include "netem/picture.h"

struct nm_registrar {
    int side;
    struct nm_fft fft;                /* of the real picture, and back to the peak */
    fftw_complex *simulated_spectrum; /* owned */
};

/* For squares of `side` pixels. Returns 0, or -1 with the error reported. */
int nm_registrar_open(struct nm_registrar *r, int side);
void nm_registrar_close(struct nm_registrar *r);

/* The origin, at most `reach` pixels from `near` either way, at which the real picture looks most
 * like the simulated one. `sharpness`, if not NULL, receives the height of the peak: 1 would be
 * an exact cyclic shift of a picture with all terms. */
struct nm_origin nm_register(struct nm_registrar *r, const double *simulated,
                             const struct nm_picture *real, struct nm_origin near, int reach,
                             double *sharpness);

#endif
