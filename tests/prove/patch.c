/* Strips of a patch (lm_k_patch_paint in plain C), of one row: rows do not know of each other.
 *
 * Proved, for any place in any strip that the header allows: no access outside the greys that are
 * held and the sixteen pixels, no overflow; the row goes on by as many pixels as lie in the strip,
 * to the first one behind it; a row that begins behind the strip is left alone.
 *
 * Assumed: a plane has a row above a patch's last, for every frame has a margin; places lie below
 * 2^30, of which a patch of 1,022 lines has room. The vectors of arm64 are compared with it by
 * tests/kernels. */
#include <string.h>

#define __builtin_memcpy memcpy /* of which the checker has a body */
#include "firmware/kernels/c/patch.c"

#include "prove.h"

enum { COLUMNS = 20, MOST_Q20 = 1 << 30, STEP_MOST_Q20 = 1 << 26 };

void prove_strip(void)
{
    uint8_t pixels[2][COLUMNS], held[1][LM_K_HELD];
    const uint32_t lines = nondet_u32();
    const int32_t step_q20 = nondet_i32(), begun_q20 = nondet_i32();
    int32_t on_q20 = begun_q20;
    uint16_t column_px = nondet_u16();
    ASSUME(lines >= 1 && lines <= LM_K_STRIP_LINES);
    ASSUME(step_q20 >= 1 && step_q20 <= STEP_MOST_Q20);
    ASSUME((int64_t)step_q20 * LM_K_STRIP_PX >= (int64_t)lines * LM_K_LINE_Q20);
    ASSUME(on_q20 >= 0 && on_q20 < MOST_Q20);
    ASSUME(column_px <= COLUMNS - LM_K_STRIP_PX);
    const uint16_t begun_px = column_px;
    const struct lm_k_patch_strip strip = {.held = held,
                                           .lines = lines,
                                           .step_q20 = &step_q20,
                                           .on_q20 = &on_q20,
                                           .column_px = &column_px,
                                           .pixels = pixels[1],
                                           .up = -COLUMNS,
                                           .rows = 1};
    lm_k_patch_paint(&strip);
    const int32_t count = column_px - begun_px, end_q20 = (int32_t)lines * LM_K_LINE_Q20;
    PROVE(count >= 0 && count <= LM_K_STRIP_PX && on_q20 >= 0);
    PROVE(begun_q20 < end_q20 ? count >= 1 && on_q20 < step_q20
                              : count == 0 && on_q20 == begun_q20 - end_q20);
}
