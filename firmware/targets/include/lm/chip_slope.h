/* Chip on a slope: the chip shows its target on level ground, and this says where its shadow comes
 * to lie on the ground that is there and, in a patch, where its pixels do. Source:
 * docs/EQUATIONS.md, "Signatures". No call fails.
 *
 *     ray over the top  .
 *          top  |`.     `.                 The ray that meets the ground at P goes on to L, at the
 *               |   `.     `.              height of the foot. P is dark if the chip is dark at L:
 *               |  __.--P     `.           the nearer to the foot the higher P lies.
 *          foot o-'- - - -`. - - -`- - -
 *               |<- y ->|    `L                                                               */
#ifndef LM_CHIP_SLOPE_H
#define LM_CHIP_SLOPE_H

#include "lm/target_view.h"

/* Ground about a chip's origin. */
struct lm_chip_slope {
    int32_t foot_m_q14;         /* elevation of the origin */
    uint32_t cells_a_metre_q16; /* that a ray goes on while it sinks by a metre; up to 2^26 */
    bool is_known;              /* the rest holds: lm_chip_slope_lean was called */
    int32_t ground_m_q14;       /* below the origin, on its own line */
    uint32_t stretch_q16;       /* cells of the chip for a cell that is shown: 1 on level ground */
};

enum { LM_CHIP_STRETCH_MIN_Q16 = 1 << 14, LM_CHIP_STRETCH_MAX_Q16 = 1 << 18 };

/* Set the ray: `range_m_q8` is the ground range of the origin, at least 1; `cell_m_q8` is 64 or
 * more. */
void lm_chip_slope_set(struct lm_chip_slope *slope, int32_t foot_m_q10, uint32_t range_m_q8,
                       uint32_t cell_m_q8, const struct lm_target_heights *h);

/* Where a ray meets the level of the foot: cells * 256 beyond the origin. It passes over a place so
 * far beyond the origin, below 2^31, at a height of `rise_m_q14` above the foot. */
int64_t lm_chip_slope_level_cells_q8(const struct lm_chip_slope *slope, int32_t beyond_cells_q8,
                                     int32_t rise_m_q14);

/* Set how the ground about the origin leans: it rises by `rise_m_q14` over `length_m_q8` (above 0)
 * away from the radar, and is displayed nearer by `lean_q16` (below 2^17) times its height. */
void lm_chip_slope_lean(struct lm_chip_slope *slope, int32_t ground_m_q14, int32_t rise_m_q14,
                        uint32_t length_m_q8, int32_t lean_q16);

#endif
