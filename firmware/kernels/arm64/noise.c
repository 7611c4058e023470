#include "lm/kernels_clutter.h"
#include "neon.h"

enum { NEON_CELLS = 2 * LM_LANES }; /* that a turn takes: two blocks of draws */

/* The classes of sixteen cells. */
static inline uint8x16_t neon_class_index(const uint32_t *cell)
{
    return vshrq_n_u8(neon_lower_bytes(neon_lower_halves(vld1q_u32_x4(cell))), 4);
}

static inline void neon_add(int32_t *level_db_q8, int16x8_t gain_db_q8)
{
    vst1q_s32(level_db_q8, vaddw_s16(vld1q_s32(level_db_q8), vget_low_s16(gain_db_q8)));
    vst1q_s32(level_db_q8 + 4, vaddw_high_s16(vld1q_s32(level_db_q8 + 4), gain_db_q8));
}

void lm_k_class_gain(const int32_t *gain_db_q8, const uint32_t *cell, int32_t *restrict level_q8,
                     uint32_t cells)
{
    const int32x4x4_t gain = vld1q_s32_x4(gain_db_q8);
    const uint8x16_t first =
        vreinterpretq_u8_s16(vmovn_high_s32(vmovn_s32(gain.val[0]), gain.val[1]));
    const uint8x16_t second =
        vreinterpretq_u8_s16(vmovn_high_s32(vmovn_s32(gain.val[2]), gain.val[3]));
    const uint8x16_t bytes[2] = {vuzp1q_u8(first, second), vuzp2q_u8(first, second)};
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const uint16x8x2_t of_cells = neon_words_of_16(bytes, neon_class_index(cell + i));
        neon_add(level_q8 + i, vreinterpretq_s16_u16(of_cells.val[0]));
        neon_add(level_q8 + i + 8, vreinterpretq_s16_u16(of_cells.val[1]));
    }
}
