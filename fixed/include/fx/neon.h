/* Whether the vectors of 64-bit Arm (NEON) are at hand, and what several loops make of them. A loop
 * that is written for them has a twin in plain C with the same results to the bit, which every
 * other machine runs. -DFX_NO_NEON takes the twins on Arm too. */
#ifndef FX_NEON_H
#define FX_NEON_H

#include "fx/tables.h"

#if defined(__aarch64__) && defined(__ARM_NEON) && !defined(FX_NO_NEON)

#include <arm_neon.h>
#define FX_HAS_NEON 1

/* Four entries of a table. */
static inline int32x4_t fx_neon_lookup(const int32_t *table, int32x4_t index)
{
    return (int32x4_t){table[vgetq_lane_s32(index, 0)], table[vgetq_lane_s32(index, 1)],
                       table[vgetq_lane_s32(index, 2)], table[vgetq_lane_s32(index, 3)]};
}

/* level + fx_db_q8_of_many(power) of four; anything where the power is 0. */
static inline int32x4_t fx_neon_add_db_q8(int32x4_t level_q8, uint32x4_t power)
{
    const uint32x4_t octaves = vandq_u32(vclzq_u32(power), vdupq_n_u32(28));
    const uint32x4_t top = vshlq_u32(power, vreinterpretq_s32_u32(octaves));
    const int32x4_t step = vreinterpretq_s32_u32(vshrq_n_u32(top, 21));
    const int32x4_t db_q14 =
        vmlsq_s32(fx_neon_lookup(fx_table_db_steps_q14, step), vreinterpretq_s32_u32(octaves),
                  vdupq_n_s32(FX_DB_OCTAVE_Q14));
    return vsraq_n_s32(level_q8, db_q14, 6);
}

/* What fx_table_db_sum_q8 has at eight steps, each 0..511. It is not looked up but worked out, from
 * lines that stay in registers: the step's upper bits choose the line, the lower ones the place. */
static inline uint16x8_t fx_neon_db_sum_q8(uint16x8_t step)
{
    static const uint8_t bend[16] = {0, 6, 10, 12, 12, 10, 6, 0};
    const uint8x8_t line = vshrn_n_u16(step, 3);
    const uint8x8_t place = vand_u8(vmovn_u16(step), vdup_n_u8(7));
    const uint8x16_t all = vcombine_u8(line, vdup_n_u8(0));
    const uint8x16_t low = vqtbl4q_u8(vld1q_u8_x4(fx_table_db_sum_lines[0]), all);
    const uint8x16_t high = vqtbl4q_u8(vld1q_u8_x4(fx_table_db_sum_lines[1]), all);
    const uint8x8_t half_fall = vqtbl4_u8(vld1q_u8_x4(fx_table_db_sum_lines[2]), line);
    const uint16x8_t base = vreinterpretq_u16_u8(vzip1q_u8(low, high));
    const uint16x8_t straight = vmlsl_u8(base, half_fall, vadd_u8(place, place));
    return vshrq_n_u16(vsubw_u8(straight, vqtbl1_u8(vld1q_u8(bend), place)), 6);
}

#else
#define FX_HAS_NEON 0
#endif

#endif
