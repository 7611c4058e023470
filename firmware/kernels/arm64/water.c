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

static inline void neon_add_where(int32_t *level_db_q8, const int32_t *cell_db_q8, int32x4_t even,
                                  int32x4_t is_water)
{
    const int32x4_t gain = vandq_s32(vaddq_s32(vld1q_s32(cell_db_q8), even), is_water);
    vst1q_s32(level_db_q8, vaddq_s32(vld1q_s32(level_db_q8), gain));
}

void lm_k_water_gain(uint32_t water, int32_t even_db_q8, const int32_t *cell_db_q8,
                     const uint32_t *cell, int32_t *restrict level_q8, uint32_t cells)
{
    const uint8x16_t of_class = neon_water_of_class(water);
    const int32x4_t even = vdupq_n_s32(even_db_q8);
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const uint8x16_t class_index =
            vshrq_n_u8(neon_lower_bytes(neon_lower_halves(vld1q_u32_x4(cell + i))), 4);
        const int8x16_t is_water = vreinterpretq_s8_u8(vqtbl1q_u8(of_class, class_index));
        const int16x8_t low = vmovl_s8(vget_low_s8(is_water)), high = vmovl_high_s8(is_water);
        neon_add_where(level_q8 + i, cell_db_q8 + i, even, vmovl_s16(vget_low_s16(low)));
        neon_add_where(level_q8 + i + 4, cell_db_q8 + i + 4, even, vmovl_high_s16(low));
        neon_add_where(level_q8 + i + 8, cell_db_q8 + i + 8, even, vmovl_s16(vget_low_s16(high)));
        neon_add_where(level_q8 + i + 12, cell_db_q8 + i + 12, even, vmovl_high_s16(high));
    }
}
