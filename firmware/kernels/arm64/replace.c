#include "../plain.h"
#include "neon.h"

enum { NEON_CELLS = 16 };

/* Replace those of sixteen cells whose classes have a mark. */
static inline void neon_replace(uint8x16_t marks, uint32x4_t by, uint32_t *cell)
{
    const uint32x4x4_t old = vld1q_u32_x4(cell);
    const uint8x16_t low = neon_lower_bytes(neon_lower_halves(old));
    const uint8x16_t is_one = vqtbl1q_u8(marks, vshrq_n_u8(low, 4));
    if (!neon_any(is_one)) {
        return;
    }
    const uint8x16_t pair[2] = {vzip1q_u8(is_one, is_one), vzip2q_u8(is_one, is_one)};
    for (size_t h = 0; h < 2; h++) {
        const uint16x8_t half = vreinterpretq_u16_u8(pair[h]);
        const uint32x4_t first = vreinterpretq_u32_u16(vzip1q_u16(half, half));
        const uint32x4_t second = vreinterpretq_u32_u16(vzip2q_u16(half, half));
        vst1q_u32(cell + 8 * h, vbslq_u32(first, by, old.val[2 * h]));
        vst1q_u32(cell + 8 * h + 4, vbslq_u32(second, by, old.val[2 * h + 1]));
    }
}

/* The last turn ends with the line and takes some cells once more, which changes none. */
void lm_k_replace(uint32_t classes, uint32_t by, uint32_t *cell, uint32_t cells)
{
    if (cells < NEON_CELLS) {
        lm_k_replace_c(classes, by, cell, cells);
        return;
    }
    const uint8x16_t bit = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const uint8x16_t marks =
        vtstq_u8(vcombine_u8(vdup_n_u8((uint8_t)classes), vdup_n_u8((uint8_t)(classes >> 8))), bit);
    const uint32x4_t new = vdupq_n_u32(by);
    uint32_t *const last = cell + cells - NEON_CELLS;
    for (; cell < last; cell += NEON_CELLS) {
        neon_replace(marks, new, cell);
    }
    neon_replace(marks, new, last);
}
