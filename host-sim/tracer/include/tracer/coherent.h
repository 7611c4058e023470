/* Coherent sum of traced echoes: fields with their phase instead of intensities. What a ray stands
 * for is a tube of plane waves, and its echo is physical optics over the part of the facet that the
 * tube lights (Ling, Chou, Lee, "Shooting and bouncing rays", IEEE Trans. AP-37, 1989).
 *
 * UNITS. A field is the root of a radar cross section in m^2: |sum|^2 is that of what was summed,
 * 4 pi A^2 / wavelength^2 for a mirror of aperture A. A rough share s of a tube of area a on the
 * plane adds 4 s a, what a white matt surface does for s = 1, with a phase of its own.
 *
 * POLARISATION. A law without a channel reflects each ray as HH or VV everywhere. One with a
 * channel (reflect.h) follows the electric vector: every reflection turns it by the place's own
 * plane of incidence, and so there is HV (wave.h). Of one radar far away; `r` of other ends is
 * taken as such by laws without a channel alone.
 *
 * WHAT RAYS CANNOT SHOW. A facet's return beside the specular direction is a sum in which phases
 * turn from ray to ray. Where they turn by more than half a turn, the rays are too far apart: that
 * part is left out. More --rays show more of it. The ground has no end, and so its first reflection
 * returns by its roughness alone. */
#ifndef TRACER_COHERENT_H
#define TRACER_COHERENT_H

#include "tracer/records.h"
#include "tracer/reflect.h"

#include <complex.h>

struct coherent_echo {
    double across_m, range_m; /* where it is focused */
    double complex field;     /* with the phase of the way, -4 pi range / wavelength */
};

/* Call `take` for each echo, wherever it lies, in the order of the records. Phases of rough shares
 * are drawn by `seed`, bounce and ray: the
 * same for all channels. Signs are those of backscatter alignment: HH and VV agree
 * after an odd number of metal reflections and are opposite after an even one. */
void coherent_echoes(const struct trace_records *r, const struct reflect_law *law, uint64_t seed,
                     void (*take)(void *ctx, const struct coherent_echo *echo), void *ctx);

/* The sum of all: the field of one frequency from one direction. */
double complex coherent_total(const struct trace_records *r, const struct reflect_law *law,
                              uint64_t seed);

#endif
