/* Texture and noise floor by the vectors of 64-bit Arm, to the bit as in speckle.c: cells of
 * classes without texture are passed over eight at a time, and what the floor adds is worked out
 * instead of looked up. Each function does whole groups of eight and returns how many cells these
 * are: none on other machines. */
#ifndef SPECKLE_NEON_H
#define SPECKLE_NEON_H

#include <stdbool.h>
#include <stddef.h>

#include "fx/neon.h"
#include "lm/speckle.h"

#if FX_HAS_NEON

/* Sixteen numbers of 32 bits, one for each class, held in registers. */
static inline uint8x16x4_t neon_by_class(const int32_t entry[LM_DB_CLASSES])
{
    return vld1q_u8_x4((const uint8_t *)entry);
}

/* Whether each class changes the level of a cell: all bits of its byte, or none. */
static inline uint8x16_t neon_changes(const struct lm_texture *t)
{
    uint8_t change[LM_DB_CLASSES];
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const bool has_texture = t->among[i] != 0;
        change[i] = has_texture || t->gain_q8[i] + lm_speckle_q8[0][t->entry[i]] != 0 ? 255 : 0;
    }
    return vld1q_u8(change);
}

static inline int32x4_t neon_of_class(uint8x16x4_t entry, uint32x4_t at)
{
    return vreinterpretq_s32_u8(vqtbl4q_u8(entry, vreinterpretq_u8_u32(at)));
}

/* Four cells of which some change. */
static inline int32x4_t neon_texture(uint8x16x4_t choice, uint8x16x4_t gain_q8, uint32x4_t cell,
                                     uint32x4_t noise, int32x4_t level_q8)
{
    /* The four bytes of the class's entries. */
    const uint32x4_t class_index = vandq_u32(vshrq_n_u32(cell, 4), vdupq_n_u32(LM_DB_CLASSES - 1));
    const uint32x4_t at = vorrq_u32(vmulq_n_u32(class_index, 0x04040404), vdupq_n_u32(0x03020100));
    const uint32x4_t slice =
        vorrq_u32(vshrq_n_u32(noise, 12), vdupq_n_u32(~(LM_SPECKLE_SLICES - 1u)));
    const int32x4_t entry = vandq_s32(vreinterpretq_s32_u32(slice), neon_of_class(choice, at));
    return vaddq_s32(vaddq_s32(level_q8, neon_of_class(gain_q8, at)),
                     fx_neon_lookup(lm_speckle_q8[0], entry));
}

static inline uint32_t texture_neon(const struct lm_texture *t, const uint32_t *cell,
                                    const uint32_t *noise, int32_t *restrict level_q8,
                                    uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    /* The first entry of a class's row, and below it the mask of those among which is chosen. */
    int32_t choice[LM_DB_CLASSES];
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        choice[i] = t->entry[i] | t->among[i];
    }
    const uint8x16x4_t choices = neon_by_class(choice), gain_q8 = neon_by_class(t->gain_q8);
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
                          neon_texture(choices, gain_q8, group[(k - i) / 4], vld1q_u32(noise + k),
                                       vld1q_s32(level_q8 + k)));
            }
        }
    }
    return whole;
}

static inline uint32_t floor_neon(int32_t floor_q8, int32_t *level_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    const int32x4_t floor = vdupq_n_s32(floor_q8);
    for (size_t i = 0; i < whole; i += 8) {
        const int32x4_t low = vld1q_s32(level_q8 + i), high = vld1q_s32(level_q8 + i + 4);
        const uint32x4_t apart[2] = {vreinterpretq_u32_s32(vabdq_s32(low, floor)),
                                     vreinterpretq_u32_s32(vabdq_s32(high, floor))};
        const uint16x8_t apart_q8 = vqmovn_high_u32(vqmovn_u32(apart[0]), apart[1]);
        const uint16x8_t step = vminq_u16(vshrq_n_u16(apart_q8, 4), vdupq_n_u16(511));
        const int16x8_t more_q8 = vreinterpretq_s16_u16(fx_neon_db_sum_q8(step));
        vst1q_s32(level_q8 + i, vaddw_s16(vmaxq_s32(low, floor), vget_low_s16(more_q8)));
        vst1q_s32(level_q8 + i + 4, vaddw_high_s16(vmaxq_s32(high, floor), more_q8));
    }
    return whole;
}

#else

static inline uint32_t texture_neon(const struct lm_texture *t, const uint32_t *cell,
                                    const uint32_t *noise, int32_t *level_q8, uint32_t cells)
{
    return (void)t, (void)cell, (void)noise, (void)level_q8, (void)cells, 0;
}

static inline uint32_t floor_neon(int32_t floor_q8, int32_t *level_q8, uint32_t cells)
{
    return (void)floor_q8, (void)level_q8, (void)cells, 0;
}

#endif

#endif
