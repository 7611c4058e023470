/* Polarised wave at a reflection: its electric vector, as a complex vector square to the way. What
 * a smooth place sends on, and what smooth and rough places send to the radar. All of it is linear
 * in the wave.
 *
 * POLARISATION. H is level, V square to it: `across` and `rise` of the axes of sight, for sending
 * and receiving alike (backscatter alignment). A plate, a trihedral return the sign of what was
 * sent, a dihedral turns one of the two over.
 *
 * ROUGH PLACES return a sum of two scatterings, each with a random phase of its own: one that
 * keeps H and V of the place (by the law's own shares; small perturbation knows more of it, below)
 * and one that crosses them. The latter is as much weaker as was measured on bare soil (Oh,
 * Sarabandi, Ulaby, IEEE Trans. GRS-30, 1992): q = 0.23 sqrt(Gamma) (1 - exp(-k s)), Gamma the
 * power reflected straight on. A place that is tilted about the line of sight crosses H and V of
 * the radar besides, as geometry has it. */
#ifndef TRACER_WAVE_H
#define TRACER_WAVE_H

#include "tracer/reflect.h"
#include "tracer/sensor.h"

#include <complex.h>

struct wave {
    double complex x, y, z;
};

/* Which way the electric vector points that the channel of the law sends, and that it receives. */
struct vec wave_sent(enum reflect_channel channel, const struct trace_axes *axes);
struct vec wave_received(enum reflect_channel channel, const struct trace_axes *axes);

struct wave wave_of(struct vec electric); /* a real one */
double complex wave_dot(const struct wave *e, struct vec axis);

/* What goes on specularly from a plane of that normal, of unit length, on the side that the wave
 * comes from. `along`: where it goes before. */
struct wave wave_reflected(const struct wave *e, struct vec along, struct vec normal,
                           const struct reflect_pair *pair);

/* Physical optics of that plane: what it returns along `back`, for a wave front of the area of the
 * place, where a mirror straight on returns -e. Fields on the plane are those of the wave and of
 * its reflection; the electric and the magnetic current of both radiate. */
struct wave wave_optics(const struct wave *e, struct vec along, struct vec normal, struct vec back,
                        const struct reflect_pair *pair);

/* What the rough place of record `t` returns along `back`, as the root of a share of intensity;
 * `kept` and `crossed` are the phases of its two scatterings. */
struct wave wave_scattered(const struct wave *e, struct vec along, struct vec normal,
                           struct vec back, const struct reflect_law *law,
                           const struct trace_record *t, double complex kept,
                           double complex crossed);

#endif
