/* Radar cross sections in double precision: the judge of lm/rcs.h and lm/target.h. The plate's
 * pattern is integrated over its surface and the corners' areas are cut out of polygons, so that
 * neither shares a formula with the firmware; of that it uses the record structures only.
 *
 * Metres, radians unless a name says otherwise, square metres. */
#ifndef REFERENCE_RCS_H
#define REFERENCE_RCS_H

#include "lm/target.h"

#include <complex.h>
#include <stddef.h>

struct ref_vector {
    double ahead, right, up;
};

/* Angle from null to null of a flat plate `wavelengths` wide, degrees: 2 asin(1 / (ways *
 * wavelengths)). One way is an antenna's, and what [Heaton] prints; two ways is an echo's. 180 when
 * there is no null. */
double ref_plate_lobe_deg(double wavelengths, int ways);

/* Cross section of a body towards a unit vector in its own axes. */
double ref_rcs_m2(const struct lm_shape *shape, double wavelength_m, struct ref_vector radar);

/* The vector (ahead, right, up of a target) in a scatterer's own axes. */
struct ref_vector ref_scatterer_axes(const struct lm_scatterer *s, struct ref_vector v);

/* The echo of one scatterer, or the sum of those of `mask`, of a target seen from a place in the
 * target's axes, metres: root of the cross section, and the phase of the way out and back, which is
 * measured as it is, not in the far field. |.|^2 of it is the cross section. */
double complex ref_target_echo(const struct lm_target *t, unsigned mask, double wavelength_m,
                               struct ref_vector radar_m);

#endif
