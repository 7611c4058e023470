/* Points of a tile's row, made of its strips (lm_k_tile_row in plain C).
 *
 * Proved, for any strips and any row south of them: no access outside the arrays, every point is
 * written, and the first one is right.
 *
 * Assumed: nothing. The vectors of arm64 are compared with it by tests/kernels. */
#include "firmware/kernels/c/tile_row.c"

#include "prove.h"

struct lm_k_strips nondet_strips(void);
struct lm_tile_point nondet_point(void);

void prove_row(void)
{
    struct lm_tile_point points[LM_TILE_POINTS], south[LM_TILE_POINTS];
    const struct lm_k_strips strips = nondet_strips();
    const uint32_t i = nondet_u32();
    ASSUME(i < LM_TILE_POINTS);
    lm_k_tile_row(points, south, &strips);
    PROVE(points[i].cell == (strips.gamma[i] << 8 | strips.class_height[i]));
    PROVE((uint16_t)(points[0].post - south[0].post) ==
          (uint16_t)((strips.left_low[0] | strips.left_high[0] << 8) >> 1 ^
                     -(strips.left_low[0] & 1)));
}
