/* Chip in a patch: a chip turned to the target's ray, with its power and shadow resampled from its
 * pixels to the patch's cells. Source: docs/EQUATIONS.md, "Signatures".
 *
 * Coordinates of a cell are cells * 256 from the target's origin: `right` as the radar looks,
 * `beyond` away from the radar. Chip columns run to the right and rows run beyond, before the turn.
 *
 *              beyond
 *                ^      ..row 63      The cell's box of pixels is laid along the chip's own
 *                |  ..::''  /         columns and rows. Four entries of the summed-area tables
 *        +---.-::''        /          give the power or the shadow in it.
 *        |  /    o--------/--> right
 *        | /   ::''    ..:            o is the target's origin, in column side / 2
 *        |/..::''..::''               and row origin_row
 *        row 0                                                                              */
#ifndef LM_CHIP_PATCH_H
#define LM_CHIP_PATCH_H

#include "lm/chips.h"
#include "lm/smear.h"

/* Cells of a patch around a target. They lie on lines that are rays from the antenna, in rows
 * across the line of sight through the patch's centre. */
enum { LM_CHIP_CELL_WIDE_MIN_Q16 = 1 << 13, LM_CHIP_CELL_WIDE_MAX_Q16 = 1 << 18 };
struct lm_chip_cells {
    uint32_t cell_mm;
    uint32_t wide_q16; /* from line to line there, in cells: LM_CHIP_CELL_WIDE_MIN_Q16.._MAX_Q16 */
    fx_bam_t aside; /* of the target's ray, to the right of that line of sight; within 75 degrees */
};

/* Rectangle of whole cells around the target's origin. The ends are exclusive. */
struct lm_chip_reach {
    int32_t right, right_end, beyond, beyond_end;
};

/* Map from the cells of a patch to the pixels of one chip. Index [0] is columns, [1] is rows. */
struct lm_chip_patch {
    const struct lm_chip_slot *slot; /* borrowed: it must stay in use as long as this struct */
    int32_t right_px_q16[2];         /* step of one line to the right, in columns and rows */
    int32_t beyond_px_q16[2];        /* step of one cell beyond, along the line */
    int32_t origin_px_q16[2];        /* the target's origin */
    struct lm_chip_reach lit, dark;  /* cells that may have power; cells that may have shadow */
    /* Half the side of the box of pixels that a cell takes. The box is as large as the cell, but
     * not smaller than a pixel. The box for power is stretched by a smear; that for shadow is not.
     */
    int32_t half_px_q8[2], dark_half_px_q8;
    int32_t gain_db_q8; /* area of a stretched cell over that of its box */
};

/* Set the map for a chip turned by `turn` from the target's ray, less than half a right angle. The
 * power is stretched by one slice of a mover's smear; the shadow is not. `slot` is borrowed as long
 * as `chip` is used; it must be resident. */
void lm_chip_patch_set(struct lm_chip_patch *chip, const struct lm_chip_slot *slot, fx_bam_t turn,
                       const struct lm_chip_cells *cells, const struct lm_smear *smear);

/* Cross section of the part of the target in one cell; LM_RCS_NONE_DBSM_Q8 if it has none. The cell
 * must lie in `lit`. For a smear, add lm_smear_share_db_q8. The sum over all cells differs from the
 * target's cross section by less than 0.1 dB (tests/unit/firmware/targets/test_signature.c).
 * Cost: 180 instructions. */
int32_t lm_chip_patch_rcs_dbsm_q8(const struct lm_chip_patch *chip, int32_t right_cells_q8,
                                  int32_t beyond_cells_q8);

enum { LM_CHIP_SHADOW_ALL = 4 * 255 }; /* shadow of a cell that is all in the dark */

/* Part of a cell in the target's shadow, 0..LM_CHIP_SHADOW_ALL. The cell must lie in `dark`.
 * Cost: 180 instructions. */
uint32_t lm_chip_patch_shadow(const struct lm_chip_patch *chip, int32_t right_cells_q8,
                              int32_t beyond_cells_q8);

#endif
