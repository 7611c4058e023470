/* Surfaces built in: what a thing of that name is made of, and how rough it is, by frequency. */
#ifndef TRACER_SURFACES_H
#define TRACER_SURFACES_H

#include "tracer/reflect.h"

struct surface {
    struct reflect_material plain; /* all but permittivity and loss */
    double complex (*permittivity)(double ghz);
    double low_ghz, high_ghz;       /* where the source of the permittivity holds */
    const char *what;               /* in a few words */
    const char *source, *roughness; /* of permittivity, and of heights; "UNSOURCED": to look at */
};

extern const struct surface surfaces[];
extern const int surface_count;

/* By its name or another usual one (`steel`, `tyre`), in capitals or not; NULL when there is none.
 * `M_` in front does not count; some editors of models put it there. */
const struct surface *surface_find(const char *name);

/* The row at a wavelength. */
struct reflect_material surface_at(const struct surface *s, double wavelength_m);

/* Warn when the wavelength is beyond what the source covers. */
void surface_doubt(const struct surface *s, double wavelength_m);

/* Print the table at a wavelength, in the form of a file for --materials (materials.h). */
void surfaces_print(double wavelength_m);

/* Print permittivity and reflection straight on in X, Ku, K and Ka band, and the sources. */
void surfaces_print_bands(void);

#endif
