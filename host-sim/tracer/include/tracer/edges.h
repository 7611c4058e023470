/* Diffraction by edges: the physical theory (PTD) of Ufimtsev, first order. Physical optics stops
 * the current of a face at its edge; what a true edge does beyond that is added along it. A plate's
 * side lobes are then right in both polarisations, and its edge echoes when it is turned away.
 *
 * LAW. A wedge of outer angle a = n pi, seen from phi above its first face, returns by length L
 *     field = -i L / sqrt pi * (f1 cos^2 t - g1 sin^2 t) * sinc(turns along L)
 *             * exp(-i 4 pi range / wavelength),   t between the electric vector and the edge,
 *     f1, g1 = sin(pi/n)/n (1 / (cos(pi/n) - 1) -+ 1 / (cos(pi/n) - cos(2 phi/n)))
 *              -+ (tan(phi)/2 of each face that is lit)
 * in the units of coherent.h (Ufimtsev, Method of Edge Waves, 1962, chapter 1, for phi = phi0;
 * Knott and Senior, Proc. IEEE 62, 1974, for directions that are not square to the edge, where phi
 * and t are those across it). f1 and g1 are finite everywhere.
 *
 * WHAT IS LEFT OUT. Waves from one edge over a face to the next, corners, edges seen by way of
 * another reflection, edges that stand on the ground, inner edges (they are corners of rays), and
 * edges between faces that turn by less than EDGES_LEAST_TURN_DEG: those are a round body's. Metal
 * is assumed; another surface counts by its coefficient straight on. */
#ifndef TRACER_EDGES_H
#define TRACER_EDGES_H

#include "tracer/coherent.h"
#include "tracer/mesh.h"
#include "tracer/scene.h"
#include "tracer/sensor.h"

#define EDGES_LEAST_TURN_DEG 15.0

/* A law with a channel (reflect.h) has the parts of both electric vectors, sent and received, in
 * the place of cos^2 t and sin^2 t. */

/* Ufimtsev's f1 and g1; `wedge_rad` pi..2 pi, `phi_rad` within it. */
struct edge_waves {
    double soft, hard; /* electric vector along the edge, across it */
};
struct edge_waves edges_waves(double wedge_rad, double phi_rad);

struct edge_echoes {
    struct coherent_echo *echoes; /* owned */
    size_t count;
};

/* The echoes of the edges of `m`, which stands in scene `s`, for one radar far away (order->look).
 * Each edge is divided into pieces of at most `piece_m`, of which those count that the radar sees.
 * Returns 0, or -1 reported with *e empty. */
int edges_make(struct edge_echoes *e, const struct mesh *m, const struct scene *s,
               const struct trace_look *look, const struct reflect_law *law, double piece_m);
void edges_free(struct edge_echoes *e);

#endif
