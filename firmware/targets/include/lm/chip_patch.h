/* A chip laid over the cells of a patch: turned to the line of sight, and its power and shadow
 * brought from its pixels to the cells. docs/EQUATIONS.md, "Signatures". */
#ifndef LM_CHIP_PATCH_H
#define LM_CHIP_PATCH_H

#include "lm/chips.h"
#include "lm/smear.h"

/* Places are cells * 256 to the right of the target's origin, as the radar looks, and beyond it. */
struct lm_chip_reach {
    int32_t right, right_end, beyond, beyond_end; /* whole cells, the ends left out */
};

struct lm_chip_patch {
    const struct lm_chip_slot *slot; /* borrowed: as long as it is in use */
    int32_t right_px_q16[2];         /* a cell to the right, in columns and rows of the chip */
    int32_t beyond_px_q16[2];
    int32_t origin_px_q16[2];       /* column and row of the origin */
    struct lm_chip_reach lit, dark; /* cells that may have power, and shadow */
    /* Half the box of columns and rows, pixels * 256, whose mean a cell shows: as large as the
     * cell, but not smaller than a pixel, and its power stretched by a smear. */
    int32_t half_px_q8[2], dark_half_px_q8;
    int32_t gain_db_q8; /* of a stretched cell's area over that of the box, dB * 256 */
};

/* A chip turned by less than half a right angle, over cells of `cell_mm`. The power of one slice of
 * a mover's smear is stretched, its shadow is not. */
void lm_chip_patch_set(struct lm_chip_patch *chip, const struct lm_chip_slot *slot, fx_bam_t turn,
                       uint32_t cell_mm, const struct lm_smear *smear);

/* Cross section of what a cell has of the target, dBsm * 256; LM_RCS_NONE_DBSM_Q8 for nothing. To
 * be weakened by lm_smear_share_db_q8. The sum over all cells differs from the target's by less
 * than 0.1 dB (tests/unit/firmware/targets/test_signature.c). Only for places within the lay's
 * reach. Cost: 180 instructions. */
int32_t lm_chip_patch_rcs_dbsm_q8(const struct lm_chip_patch *chip, int32_t right_cells_q8,
                                  int32_t beyond_cells_q8);

enum { LM_CHIP_SHADOW_ALL = 4 * 255 };

/* How much of a cell lies in the target's shadow, 0..LM_CHIP_SHADOW_ALL. Cost: 180 instructions. */
uint32_t lm_chip_patch_shadow(const struct lm_chip_patch *chip, int32_t right_cells_q8,
                              int32_t beyond_cells_q8);

#endif
