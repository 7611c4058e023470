/* Texture, and speckle over a noise floor, by the vectors of 64-bit Arm, to the bit as in
 * speckle.c: cells of classes without texture are passed over eight at a time, and what the floor
 * adds is worked out instead of looked up. Each function does whole groups of eight and returns how
 * many cells these are: none on other machines. */
#ifndef SPECKLE_NEON_H
#define SPECKLE_NEON_H

#include <stdbool.h>
#include <stddef.h>

#include "fx/neon.h"
#include "lm/speckle.h"

/* The bits of a class's entry that choose a row. */
enum { TEXTURE_ROWS = (1 << LM_TEXTURE_ENTRY_BITS) - LM_SPECKLE_SLICES };

#if FX_HAS_NEON

/* Whether each class changes the level of a cell: all bits of its byte, or none. */
static inline uint8x16_t neon_changes(const struct lm_texture *t)
{
    const int32x4_t none = vdupq_n_s32(-lm_speckle_q8[0][0] * (1 << LM_TEXTURE_ENTRY_BITS));
    const uint32x4_t is_none[4] = {
        vceqq_s32(vld1q_s32(t->of_class), none), vceqq_s32(vld1q_s32(t->of_class + 4), none),
        vceqq_s32(vld1q_s32(t->of_class + 8), none), vceqq_s32(vld1q_s32(t->of_class + 12), none)};
    const uint16x8_t low = vmovn_high_u32(vmovn_u32(is_none[0]), is_none[1]);
    const uint16x8_t high = vmovn_high_u32(vmovn_u32(is_none[2]), is_none[3]);
    return vmvnq_u8(vmovn_high_u16(vmovn_u16(low), high));
}

/* Four cells of which some change. */
static inline int32x4_t neon_texture(uint8x16x4_t of_classes, uint32x4_t cell, uint32x4_t noise,
                                     int32x4_t level_q8)
{
    /* The four bytes of the class's word. */
    const uint32x4_t class_index = vandq_u32(vshrq_n_u32(cell, 4), vdupq_n_u32(LM_DB_CLASSES - 1));
    const uint32x4_t at = vorrq_u32(vmulq_n_u32(class_index, 0x04040404), vdupq_n_u32(0x03020100));
    const int32x4_t of_class =
        vreinterpretq_s32_u8(vqtbl4q_u8(of_classes, vreinterpretq_u8_u32(at)));
    const uint32x4_t slice = vandq_u32(vshrq_n_u32(noise, 12), vdupq_n_u32(LM_SPECKLE_SLICES - 1));
    const uint32x4_t chosen = vorrq_u32(slice, vdupq_n_u32(TEXTURE_ROWS));
    const int32x4_t entry = vandq_s32(of_class, vreinterpretq_s32_u32(chosen));
    const int32x4_t gained_q8 = vsraq_n_s32(level_q8, of_class, LM_TEXTURE_ENTRY_BITS);
    return vaddq_s32(gained_q8, fx_neon_lookup(lm_speckle_q8[0], entry));
}

static inline uint32_t texture_neon(const struct lm_texture *t, const uint32_t *cell,
                                    const uint32_t *noise, int32_t *restrict level_q8,
                                    uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    const uint8x16x4_t of_classes = vld1q_u8_x4((const uint8_t *)t->of_class);
    const uint8x16_t changes = neon_changes(t);
    for (size_t i = 0; i < whole; i += 8) {
        const uint32x4_t group[2] = {vld1q_u32(cell + i), vld1q_u32(cell + i + 4)};
        const uint16x8_t low =
            vuzp1q_u16(vreinterpretq_u16_u32(group[0]), vreinterpretq_u16_u32(group[1]));
        const uint8x8_t class_index = vand_u8(vshrn_n_u16(low, 4), vdup_n_u8(LM_DB_CLASSES - 1));
        const uint8x8_t changed = vqtbl1_u8(changes, class_index);
        const uint64_t some = vget_lane_u64(vreinterpret_u64_u8(changed), 0);
        for (size_t k = i; k < i + 8; k += 4) {
            if ((uint32_t)(k == i ? some : some >> 32) != 0) {
                vst1q_s32(level_q8 + k,
                          neon_texture(of_classes, group[(k - i) / 4], vld1q_u32(noise + k),
                                       vld1q_s32(level_q8 + k)));
            }
        }
    }
    return whole;
}

static inline int32x4_t neon_speckle(const int32_t *table_q8, const uint32_t *noise)
{
    return fx_neon_lookup(table_q8, vreinterpretq_s32_u32(vshrq_n_u32(vld1q_u32(noise), 22)));
}

static inline uint32_t speckle_floor_neon(const struct lm_speckle_config *config, int32_t floor_q8,
                                          const uint32_t *noise, const int32_t *level_q8,
                                          int32_t *restrict speckled_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    const int32x4x2_t floor = {{vdupq_n_s32(floor_q8), vdupq_n_s32(floor_q8)}};
    const int32_t *const table_q8 = lm_speckle_q8[config->looks_log2];
    for (size_t i = 0; i < whole; i += 8) {
        const int32x4x2_t level = {{vld1q_s32(level_q8 + i), vld1q_s32(level_q8 + i + 4)}};
        const int32x4x2_t sum = fx_neon_db_q8_sum(level, floor);
        vst1q_s32(speckled_q8 + i, vaddq_s32(sum.val[0], neon_speckle(table_q8, noise + i)));
        vst1q_s32(speckled_q8 + i + 4,
                  vaddq_s32(sum.val[1], neon_speckle(table_q8, noise + i + 4)));
    }
    return whole;
}

#else

static inline uint32_t texture_neon(const struct lm_texture *t, const uint32_t *cell,
                                    const uint32_t *noise, int32_t *level_q8, uint32_t cells)
{
    return (void)t, (void)cell, (void)noise, (void)level_q8, (void)cells, 0;
}

static inline uint32_t speckle_floor_neon(const struct lm_speckle_config *config, int32_t floor_q8,
                                          const uint32_t *noise, const int32_t *level_q8,
                                          int32_t *speckled_q8, uint32_t cells)
{
    return (void)config, (void)floor_q8, (void)noise, (void)level_q8, (void)speckled_q8,
           (void)cells, 0;
}

#endif

#endif
