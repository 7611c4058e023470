#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/kernels_display.h"

enum { Q20_TO_Q7 = 13 };

/* Sixteen greys that lie between two each, of which the first is a pair's lower byte. gcc makes
 * vectors of the loops that stand between the look-ups, but of none that it has unrolled whole. */
static inline void between(const uint16_t pair[16], const uint16_t share_q7[16], uint8_t grey[16])
{
#pragma GCC unroll 1
    for (uint32_t k = 0; k < 16; k++) {
        grey[k] = lm_k_grey_between((uint8_t)pair[k], (uint8_t)(pair[k] >> 8), share_q7[k]);
    }
}

void lm_k_patch_hold(const struct lm_k_patch_cells *cells, const uint8_t *grey, uint32_t rows,
                     uint8_t (*held)[LM_K_HELD], uint32_t at)
{
    uint16_t pair[LM_K_PATCH_GROUP], share_q7[LM_K_PATCH_GROUP];
    uint8_t made[LM_K_PATCH_GROUP];
    for (uint32_t row = 0; row < rows; row += LM_K_PATCH_GROUP) {
        const uint8_t *const near = grey + cells->first[row / LM_K_PATCH_GROUP];
        for (uint32_t i = 0; i < LM_K_PATCH_GROUP; i++) {
            pair[i] = fx_load_u16(near + cells->above[row + i]);
            share_q7[i] = cells->part_q7[row + i];
        }
        between(pair, share_q7, made);
        for (uint32_t i = 0; i < LM_K_PATCH_GROUP; i++) {
            held[row + i][at] = made[i];
        }
    }
}

/* One row, whose next pixel lies within the strip. Returns how many of its pixels do. Positions
 * are below 2^24 + 15 * 2^26. */
static inline uint32_t paint_row(const uint8_t held[LM_K_HELD], uint32_t lines, uint32_t on_q20,
                                 uint32_t step_q20, uint8_t *pixels)
{
    uint8_t line[LM_K_STRIP_PX];
    uint16_t share_q7[LM_K_STRIP_PX], pair[LM_K_STRIP_PX];
    const uint32_t end_q7 = lines * LM_K_LINE_Q7;
    uint32_t count = 0;
#pragma GCC unroll 1
    for (uint32_t k = 0; k < LM_K_STRIP_PX; k++) {
        const uint32_t on_q7 = (on_q20 + k * step_q20) >> Q20_TO_Q7;
        const uint16_t place_q7 = (uint16_t)fx_min_u32(on_q7, end_q7);
        line[k] = (uint8_t)(place_q7 / LM_K_LINE_Q7);
        share_q7[k] = place_q7 % LM_K_LINE_Q7;
        count += on_q7 < end_q7;
    }
    for (uint32_t k = 0; k < LM_K_STRIP_PX; k++) {
        pair[k] = fx_load_u16(held + line[k]);
    }
    between(pair, share_q7, pixels);
    return count;
}

void lm_k_patch_paint(const struct lm_k_patch_strip *lent)
{
    const struct lm_k_patch_strip s = *lent; /* no store can change it */
    const int32_t end_q20 = (int32_t)s.lines * LM_K_LINE_Q20;
    uint8_t *pixels = s.pixels;
    for (uint32_t i = 0; i < s.rows; i++, pixels += s.up) {
        const int32_t on_q20 = s.on_q20[i], step_q20 = s.step_q20[i];
        uint32_t count = 0;
        if (on_q20 < end_q20) {
            count = paint_row(s.held[i], s.lines, (uint32_t)on_q20, (uint32_t)step_q20,
                              pixels + s.column_px[i]);
        }
        s.column_px[i] = (uint16_t)(s.column_px[i] + count);
        s.on_q20[i] = on_q20 + (int32_t)count * step_q20 - end_q20;
        s.held[i][0] = s.held[i][s.lines];
    }
}
