/* Radar cross section of a few simple bodies, in the optical region: every size several wavelengths
 * or more. Sphere, flat plate and triangular corner are those of [Heaton], "High resolution
 * radar targets"; docs/EQUATIONS.md, "Targets", has the equations and where they come from.
 *
 * A cross section is in decibels above one square metre (dBsm), times 256. */
#ifndef LM_RCS_H
#define LM_RCS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/radar.h"

enum lm_shape_kind {
    LM_SHAPE_SPHERE = 1, /* size[0] is the radius */
    LM_SHAPE_PLATE = 2,  /* size[0] to the right, size[1] up; the normal points ahead */
    LM_SHAPE_DIHEDRAL =
        3, /* two faces size[0] wide at right angles, crease size[1] long and upright */
    LM_SHAPE_TRIHEDRAL =
        4, /* three right triangles whose legs are size[0]; opens ahead, one leg up */
    LM_SHAPE_KINDS
};

enum {
    LM_SHAPE_SIZE_MAX_MM = 100000,
    LM_RCS_NONE_DBSM_Q8 = -100 * 256 /* returned for nothing at all, and nothing less is */
};

struct lm_shape {
    uint8_t kind;        /* enum lm_shape_kind */
    bool is_two_sided;   /* plates: the back answers as the front does */
    uint32_t size_mm[2]; /* each 1..LM_SHAPE_SIZE_MAX_MM where the kind uses it */
};

/* Where the radar is seen from a body: a unit vector in the body's own axes, 1.0 is 2^30. */
struct lm_direction {
    int32_t ahead_q30, right_q30, up_q30;
};

/* The cross section towards the radar. wavelength_um is LM_WAVELENGTH_MIN_UM..MAX_UM.
 *
 * Sphere: pi a^2 from everywhere.
 * Plate: physical optics, 4 pi A^2 / lambda^2 at the normal. The lobe is the two-way one, 2
 * asin(lambda / 2a) from null to null: the phase runs over the plate on the way out and again on
 * the way back. [Heaton]'s Table 1 has the one-way lobe, twice as wide. Dihedral and trihedral: the
 * double and the triple reflection of geometrical optics, 8 pi a^2 b^2 / lambda^2 and 4 pi a^4 / (3
 * lambda^2) at the best. What single faces return outside the opening is left out: make them plates
 * if it matters.
 *
 * Worst error 0.01 dB where the pattern is within 30 dB of its peak
 * (tests/unit/firmware/targets/test_rcs.c). Cost: 60 instructions for a sphere, 500 for a plate. */
int32_t lm_rcs_dbsm_q8(const struct lm_shape *shape, uint32_t wavelength_um,
                       struct lm_direction radar);

#endif
