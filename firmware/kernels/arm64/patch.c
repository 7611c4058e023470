#include "../plain.h"
#include "neon.h"

enum { Q20_TO_Q7 = 13 };

/* lm_k_grey_between of sixteen. */
static inline uint8x16_t neon_between(uint8x16_t first, uint8x16_t second, uint16x8_t low_q7,
                                      uint16x8_t high_q7)
{
    const uint16x8_t low = vsubl_u8(vget_low_u8(second), vget_low_u8(first));
    const uint16x8_t high = vsubl_high_u8(second, first);
    const uint8x8_t more = vrshrn_n_u16(vmulq_u16(low, low_q7), 7);
    return vaddq_u8(first, vrshrn_high_n_u16(more, vmulq_u16(high, high_q7), 7));
}

/* Store one of sixteen bytes, and go on to the next row's. The compiler adds the stride apart. */
#define NEON_STORE_BYTE(to, bytes, n)                                                              \
    __asm__ volatile("st1 {%1.b}[" #n "], [%0], %2"                                                \
                     : "+r"(to)                                                                    \
                     : "w"(bytes), "r"((ptrdiff_t)LM_K_HELD)                                       \
                     : "memory")

static inline void store_column(uint8_t *to, uint8x16_t grey)
{
    NEON_STORE_BYTE(to, grey, 0);
    NEON_STORE_BYTE(to, grey, 1);
    NEON_STORE_BYTE(to, grey, 2);
    NEON_STORE_BYTE(to, grey, 3);
    NEON_STORE_BYTE(to, grey, 4);
    NEON_STORE_BYTE(to, grey, 5);
    NEON_STORE_BYTE(to, grey, 6);
    NEON_STORE_BYTE(to, grey, 7);
    NEON_STORE_BYTE(to, grey, 8);
    NEON_STORE_BYTE(to, grey, 9);
    NEON_STORE_BYTE(to, grey, 10);
    NEON_STORE_BYTE(to, grey, 11);
    NEON_STORE_BYTE(to, grey, 12);
    NEON_STORE_BYTE(to, grey, 13);
    NEON_STORE_BYTE(to, grey, 14);
    NEON_STORE_BYTE(to, grey, 15);
}

/* Cells are looked up among the 32 from the group's first on. Beyond these a look-up gives 0, and
 * the share of that is 0. */
void lm_k_patch_hold(const struct lm_k_patch_cells *cells, const uint8_t *grey, uint32_t rows,
                     uint8_t (*held)[LM_K_HELD], uint32_t at)
{
    if (!cells->are_close) {
        lm_k_patch_hold_c(cells, grey, rows, held, at);
        return;
    }
    uint8_t *to = held[0] + at;
    for (uint32_t row = 0; row < rows; row += LM_K_PATCH_GROUP) {
        const uint8x16x2_t near = vld1q_u8_x2(grey + cells->first[row / LM_K_PATCH_GROUP]);
        const uint8x16_t above = vld1q_u8(cells->above + row);
        const uint8x16_t part_q7 = vld1q_u8(cells->part_q7 + row);
        const uint8x16_t lower = vqtbl2q_u8(near, above);
        const uint8x16_t upper = vqtbl2q_u8(near, vaddq_u8(above, vdupq_n_u8(1)));
        store_column(
            to, neon_between(lower, upper, vmovl_u8(vget_low_u8(part_q7)), vmovl_high_u8(part_q7)));
        to += LM_K_PATCH_GROUP * LM_K_HELD;
    }
}

/* Where sixteen pixels lie in a strip, in 128ths of a line; what is beyond 2^9 lines lies there. */
static inline uint16x8x2_t neon_places_q7(int32_t on_q20, int32_t step_q20)
{
    const int32x4_t order = {0, 1, 2, 3}, four = vdupq_n_s32(4 * step_q20);
    const int32x4_t a = vmlaq_s32(vdupq_n_s32(on_q20), vdupq_n_s32(step_q20), order);
    const int32x4_t b = vaddq_s32(a, four), c = vaddq_s32(b, four), d = vaddq_s32(c, four);
    return (uint16x8x2_t){{vqshrun_high_n_s32(vqshrun_n_s32(a, Q20_TO_Q7), b, Q20_TO_Q7),
                           vqshrun_high_n_s32(vqshrun_n_s32(c, Q20_TO_Q7), d, Q20_TO_Q7)}};
}

void lm_k_patch_paint(const struct lm_k_patch_strip *lent)
{
    const struct lm_k_patch_strip s = *lent; /* no store can change it */
    const int32_t end_q20 = (int32_t)s.lines * LM_K_LINE_Q20;
    const uint16x8_t end_q7 = vdupq_n_u16((uint16_t)(s.lines * LM_K_LINE_Q7));
    const uint16x8_t share_mask = vdupq_n_u16(LM_K_LINE_Q7 - 1);
    uint8_t *pixels = s.pixels;
    for (uint32_t i = 0; i < s.rows; i++, pixels += s.up) {
        const int32_t on_q20 = s.on_q20[i], step_q20 = s.step_q20[i];
        const uint8x16_t row = vld1q_u8(s.held[i]);
        s.held[i][0] = s.held[i][s.lines];
        if (on_q20 >= end_q20) {
            s.on_q20[i] = on_q20 - end_q20;
            continue;
        }
        const uint16x8x2_t place = neon_places_q7(on_q20, step_q20);
        const uint16x8_t low = vminq_u16(place.val[0], end_q7),
                         high = vminq_u16(place.val[1], end_q7);
        const uint8x16_t line = vshrn_high_n_u16(vshrn_n_u16(low, 7), high, 7);
        const uint8x16_t before = vqtbl1q_u8(row, line);
        const uint8x16_t behind = vqtbl1q_u8(row, vaddq_u8(line, vdupq_n_u8(1)));
        const uint32_t column_px = s.column_px[i];
        vst1q_u8(pixels + column_px, neon_between(before, behind, vandq_u16(low, share_mask),
                                                  vandq_u16(high, share_mask)));
        /* Of a vector that compares, each that is less adds -1. */
        const uint16x8_t less = vaddq_u16(vcltq_u16(low, end_q7), vcltq_u16(high, end_q7));
        const int32_t less_count = vaddvq_s16(vreinterpretq_s16_u16(less));
        s.column_px[i] = (uint16_t)((int32_t)column_px - less_count);
        s.on_q20[i] = on_q20 - less_count * step_q20 - end_q20;
    }
}
