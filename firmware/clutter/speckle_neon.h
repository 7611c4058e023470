/* Texture, and speckle over a noise floor, by the vectors of 64-bit Arm, to the bit as in
 * speckle.c: eight cells at a time, or sixteen, of which those without the texture are passed over.
 * Not for other machines, where it is never called. */
#ifndef SPECKLE_NEON_H
#define SPECKLE_NEON_H

#include <stdbool.h>
#include <stddef.h>

#include "fx/neon.h"
#include "lm/speckle.h"

#if FX_HAS_NEON

/* Classes that have a shape: all bits of a class's byte, or none. */
static inline uint8x16_t neon_classes_of(const struct lm_texture *t, int32_t shape)
{
    const int32x4x4_t word = vld1q_s32_x4(t->of_class);
    const int16x8_t low = vmovn_high_s32(vmovn_s32(word.val[0]), word.val[1]);
    const int16x8_t high = vmovn_high_s32(vmovn_s32(word.val[2]), word.val[3]);
    const uint8x16_t of_class = vreinterpretq_u8_s8(vmovn_high_s16(vmovn_s16(low), high));
    const uint8x16_t mask = vdupq_n_u8((1 << LM_TEXTURE_SHAPE_BITS) - 1);
    return vceqq_u8(vandq_u8(of_class, mask), vdupq_n_u8((uint8_t)shape));
}

/* The classes of sixteen cells. */
static inline uint8x16_t neon_class_index(const uint32_t *cell)
{
    return vshrq_n_u8(fx_neon_lower_bytes(fx_neon_lower_halves(vld1q_u32_x4(cell))), 4);
}

static inline void neon_add(int32_t *level_q8, int16x8_t gain_q8)
{
    vst1q_s32(level_q8, vaddw_s16(vld1q_s32(level_q8), vget_low_s16(gain_q8)));
    vst1q_s32(level_q8 + 4, vaddw_high_s16(vld1q_s32(level_q8 + 4), gain_q8));
}

/* The gain of each cell's class, which takes 16 bits: LM_TEXTURE_LOSS_MAX_Q8. */
static inline void gain_neon(const struct lm_texture *t, const uint32_t *cell,
                             int32_t *restrict level_q8, uint32_t cells)
{
    const int32x4x4_t word = vld1q_s32_x4(t->of_class);
    int16x4_t gain_q8[4];
    for (size_t n = 0; n < 4; n++) {
        gain_q8[n] = vshrn_n_s32(word.val[n], LM_TEXTURE_SHAPE_BITS);
    }
    const uint8x16_t first = vreinterpretq_u8_s16(vcombine_s16(gain_q8[0], gain_q8[1]));
    const uint8x16_t second = vreinterpretq_u8_s16(vcombine_s16(gain_q8[2], gain_q8[3]));
    const uint8x16_t bytes[2] = {vuzp1q_u8(first, second), vuzp2q_u8(first, second)};
    for (size_t i = 0; i < cells; i += 16) {
        const uint16x8x2_t of_cells = fx_neon_words_of_16(bytes, neon_class_index(cell + i));
        neon_add(level_q8 + i, vreinterpretq_s16_u16(of_cells.val[0]));
        neon_add(level_q8 + i + 8, vreinterpretq_s16_u16(of_cells.val[1]));
    }
}

/* The draws of one shape, for the cells of the classes that have it. */
static inline void texture_neon(const struct lm_texture *t, const struct lm_noise_line *noise,
                                int32_t shape, const uint32_t *cell, int32_t *restrict level_q8,
                                uint32_t cells)
{
    const uint8x16_t has_it = neon_classes_of(t, shape);
    const int16_t *const row_q8 = lm_noise_q8[shape];
    const uint32_t *entry = noise->entry;
    for (size_t i = 0; i < cells; i += 16, entry += 2) {
        const uint8x16_t here = vqtbl1q_u8(has_it, neon_class_index(cell + i));
        if (vmaxvq_u32(vreinterpretq_u32_u8(here)) != 0) {
            const int16x8_t low = vmovl_s8(vget_low_s8(vreinterpretq_s8_u8(here)));
            const int16x8_t high = vmovl_high_s8(vreinterpretq_s8_u8(here));
            neon_add(level_q8 + i, vandq_s16(vld1q_s16(row_q8 + entry[0]), low));
            neon_add(level_q8 + i + 8, vandq_s16(vld1q_s16(row_q8 + entry[1]), high));
        }
    }
}

static inline void speckle_neon(const int16_t *row_q8, const struct lm_noise_line *noise,
                                int32_t *restrict level_q8, uint32_t cells)
{
    for (size_t i = 0; i < cells; i += LM_NOISE_BLOCK) {
        neon_add(level_q8 + i, vld1q_s16(row_q8 + noise->entry[i / LM_NOISE_BLOCK]));
    }
}

static inline void speckle_floor_neon(const int16_t *row_q8, const struct lm_noise_line *noise,
                                      int32_t floor_q8, const int32_t *level_q8,
                                      int32_t *restrict speckled_q8, uint32_t cells)
{
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    const int32x4_t one = vdupq_n_s32(floor_q8);
    const int32x4x4_t floor = {{one, one, one, one}};
    for (size_t i = 0; i < cells; i += 2 * LM_NOISE_BLOCK) {
        /* A block that is left over is done twice at once. */
        const size_t next = i + LM_NOISE_BLOCK < cells ? i + LM_NOISE_BLOCK : i;
        const int32x4x4_t level = fx_neon_load_8_and_8(level_q8 + i, level_q8 + next);
        int32x4x4_t sum = fx_neon_db_q8_sum(lows, highs, falls, level, floor);
        const int16x8_t draw_q8[2] = {vld1q_s16(row_q8 + noise->entry[i / LM_NOISE_BLOCK]),
                                      vld1q_s16(row_q8 + noise->entry[next / LM_NOISE_BLOCK])};
        for (size_t n = 0; n < 2; n++) {
            sum.val[2 * n] = vaddw_s16(sum.val[2 * n], vget_low_s16(draw_q8[n]));
            sum.val[2 * n + 1] = vaddw_high_s16(sum.val[2 * n + 1], draw_q8[n]);
        }
        fx_neon_store_8_and_8(speckled_q8 + i, speckled_q8 + next, sum);
    }
}

#else

static inline void gain_neon(const struct lm_texture *t, const uint32_t *cell, int32_t *level_q8,
                             uint32_t cells)
{
    (void)t, (void)cell, (void)level_q8, (void)cells;
}

static inline void texture_neon(const struct lm_texture *t, const struct lm_noise_line *noise,
                                int32_t shape, const uint32_t *cell, int32_t *level_q8,
                                uint32_t cells)
{
    (void)t, (void)noise, (void)shape, (void)cell, (void)level_q8, (void)cells;
}

static inline void speckle_neon(const int16_t *row_q8, const struct lm_noise_line *noise,
                                int32_t *level_q8, uint32_t cells)
{
    (void)row_q8, (void)noise, (void)level_q8, (void)cells;
}

static inline void speckle_floor_neon(const int16_t *row_q8, const struct lm_noise_line *noise,
                                      int32_t floor_q8, const int32_t *level_q8,
                                      int32_t *speckled_q8, uint32_t cells)
{
    (void)row_q8, (void)noise, (void)floor_q8, (void)level_q8, (void)speckled_q8, (void)cells;
}

#endif

#endif
