#include "lm/kernels_clutter.h"
#include "neon.h"

enum { NEON_CELLS = 16 };

/* Bytes of sixteen classes, 0xff for those that are water. */
static uint8x16_t neon_water_of_class(uint32_t water)
{
    static const uint8_t bit[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    const uint8x8_t bits = vld1_u8(bit);
    return vcombine_u8(vtst_u8(vdup_n_u8((uint8_t)water), bits),
                       vtst_u8(vdup_n_u8((uint8_t)(water >> 8)), bits));
}

static inline void neon_add_where(int16_t *level_db_q8, const int32_t *cell_db_q8, int32x4_t even,
                                  int8x8_t is_water)
{
    const int32x4_t low = vaddq_s32(vld1q_s32(cell_db_q8), even);
    const int32x4_t high = vaddq_s32(vld1q_s32(cell_db_q8 + 4), even);
    const int16x8_t gain = vandq_s16(neon_held_8(low, high), vmovl_s8(is_water));
    vst1q_s16(level_db_q8, vqaddq_s16(vld1q_s16(level_db_q8), gain));
}

void lm_k_water_gain(uint32_t water, int32_t even_db_q8, const int32_t *cell_db_q8,
                     const uint32_t *cell, int16_t *restrict level_db_q8, uint32_t cells)
{
    const uint8x16_t of_class = neon_water_of_class(water);
    const int32x4_t even = vdupq_n_s32(even_db_q8);
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const uint8x16_t class_index =
            vshrq_n_u8(neon_lower_bytes(neon_lower_halves(vld1q_u32_x4(cell + i))), 4);
        const int8x16_t is_water = vreinterpretq_s8_u8(vqtbl1q_u8(of_class, class_index));
        neon_add_where(level_db_q8 + i, cell_db_q8 + i, even, vget_low_s8(is_water));
        neon_add_where(level_db_q8 + i + 8, cell_db_q8 + i + 8, even, vget_high_s8(is_water));
    }
}
