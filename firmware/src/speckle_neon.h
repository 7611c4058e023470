/* Texture by the vectors of 64-bit Arm: cells of classes that have none are passed over eight at a
 * time. The results are those of speckle.c to the bit. Not for other machines, where it is never
 * called. */
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

static inline void texture_neon(const struct lm_texture *t, const uint32_t *cell,
                                const uint32_t *noise, int32_t *restrict level_q8, size_t cells)
{
    /* The first entry of a class's row, and below it the mask of those among which is chosen. */
    int32_t choice[LM_DB_CLASSES];
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        choice[i] = t->entry[i] | t->among[i];
    }
    const uint8x16x4_t choices = neon_by_class(choice), gain_q8 = neon_by_class(t->gain_q8);
    const uint8x16_t changes = neon_changes(t);
    for (size_t i = 0; i < cells; i += 8) {
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
}

#else

static inline void texture_neon(const struct lm_texture *t, const uint32_t *cell,
                                const uint32_t *noise, int32_t *restrict level_q8, size_t cells)
{
    (void)t, (void)cell, (void)noise, (void)level_q8, (void)cells;
}

#endif

#endif
