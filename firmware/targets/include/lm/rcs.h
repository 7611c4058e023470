/* Radar cross section of simple shapes: sphere, flat plate, dihedral and trihedral corner. It holds
 * in the optical region, where every size is several wavelengths or more.
 *
 * Source: [Heaton], "High resolution radar targets" (sphere, plate, trihedral);
 * docs/EQUATIONS.md, "Targets", has the equations and their derivation. */
#ifndef LM_RCS_H
#define LM_RCS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/radar.h"
#include "lm/units.h"

/* Shapes, and what their sizes mean. Axes are those of struct lm_direction. */
enum lm_shape_kind {
    LM_SHAPE_SPHERE = 1, /* size[0]: radius */
    LM_SHAPE_PLATE = 2,  /* size[0]: extent to the right; size[1]: extent up; normal: ahead */
    LM_SHAPE_DIHEDRAL =
        3, /* size[0]: width of each face; size[1]: length of the upright crease; opens ahead */
    LM_SHAPE_TRIHEDRAL =
        4, /* size[0]: leg of each of the three right triangles; opens ahead, one leg up */
    LM_SHAPE_KINDS
};

enum {
    LM_SHAPE_SIZE_MAX_MM = 100000,
    LM_RCS_NONE_DBSM_Q8 =
        LM_DB_Q8(-100) /* no return at all; every cross section is at least this */
};

/* A shape. `size_mm` is 1..LM_SHAPE_SIZE_MAX_MM each, where the kind uses it. */
struct lm_shape {
    uint8_t kind;      /* enum lm_shape_kind */
    bool is_two_sided; /* plate: true if its back returns as its front does */
    uint32_t size_mm[2];
};

/* Direction of the radar as a unit vector in the shape's own axes; 1.0 is 2^30. */
struct lm_direction {
    int32_t ahead_q30, right_q30, up_q30;
};

/* Cross section of a shape towards the radar. wavelength_um is LM_WAVELENGTH_MIN_UM..MAX_UM.
 *
 * - Sphere: pi a^2 from everywhere.
 * - Plate: physical optics, 4 pi A^2 / lambda^2 at the normal. The lobe is the two-way one, 2
 *   asin(lambda / 2a) from null to null. The phase runs over the plate on the way out and back.
 * Table 1 of [Heaton] has the one-way lobe, twice as wide.
 * - Dihedral: double reflection of geometrical optics, 8 pi a^2 b^2 / lambda^2 on axis.
 * - Trihedral: triple reflection of geometrical optics, 4 pi a^4 / (3 lambda^2) on axis.
 *
 * Returns of single faces of a corner outside its opening are left out. Add plates where they
 * matter. An unknown kind returns LM_RCS_NONE_DBSM_Q8.
 *
 * Worst error 0.01 dB where the pattern is within 30 dB of its peak
 * (tests/unit/firmware/targets/test_rcs.c). Cost: 60 instructions for a sphere, 500 for a plate. */
int32_t lm_rcs_dbsm_q8(const struct lm_shape *shape, uint32_t wavelength_um,
                       struct lm_direction radar);

#endif
