/* A target's chip over the cells of a patch, in double precision: the judge of lm/chip_patch.h. */
#ifndef REFERENCE_CHIP_H
#define REFERENCE_CHIP_H

#include "lm/signature.h"

/* A chip as it lies on the ground: what a radar at `turn_rad` more than the chip's bearing sees. */
struct ref_chip {
    const struct lm_chip *chip;
    double pixel_m, origin_row, turn_rad;
};

/* Cross section of all of it, m^2. */
double ref_chip_total_m2(const struct lm_chip *chip);

/* Cross section, m^2, of a square cell whose middle is so far to the right of the target's origin,
 * as the radar looks, and beyond it: that of the pixels under it, `block` x `block` of them made
 * one. A cell that is smaller than such a pixel shows the mean of a square as large. */
double ref_chip_cell_m2(const struct ref_chip *c, int block, double right_m, double beyond_m,
                        double cell_m);

/* The part of the cell that lies in shadow. */
double ref_chip_cell_shadow(const struct ref_chip *c, double right_m, double beyond_m,
                            double cell_m);

/* Where a chip shows a place of ground that is not level: so far beyond the origin does the ray
 * that meets the place meet the level of the target's foot. The ray comes from an antenna `range_m`
 * from the target and `antenna_m` above its foot; the place is `beyond_m` behind it and `rise_m`
 * above its foot. Found on the ray itself, the Earth being curved. */
double ref_chip_level_m(double antenna_m, double range_m, double beyond_m, double rise_m);

#endif
