/* Vectors of 64-bit Arm (NEON, Advanced SIMD) that several kernels share: tables of 16 and 64
 * bytes looked up at once, decibels and powers. Each is equal to the bit to the function of
 * fx/log.h that it names. */
#ifndef NEON_H
#define NEON_H

#include <arm_neon.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "fx/const.h"
#include "fx/tables.h"

/* The lower and the upper halves of sixteen numbers, and the lower bytes of those. */
static inline uint16x8x2_t neon_lower_halves(uint32x4x4_t v)
{
    return (uint16x8x2_t){
        {vuzp1q_u16(vreinterpretq_u16_u32(v.val[0]), vreinterpretq_u16_u32(v.val[1])),
         vuzp1q_u16(vreinterpretq_u16_u32(v.val[2]), vreinterpretq_u16_u32(v.val[3]))}};
}

static inline uint16x8x2_t neon_upper_halves(uint32x4x4_t v)
{
    return (uint16x8x2_t){
        {vuzp2q_u16(vreinterpretq_u16_u32(v.val[0]), vreinterpretq_u16_u32(v.val[1])),
         vuzp2q_u16(vreinterpretq_u16_u32(v.val[2]), vreinterpretq_u16_u32(v.val[3]))}};
}

static inline uint8x16_t neon_lower_bytes(uint16x8x2_t v)
{
    return vuzp1q_u8(vreinterpretq_u8_u16(v.val[0]), vreinterpretq_u8_u16(v.val[1]));
}

/* Lower and upper bytes of a table of 16 numbers, as the two below want them. */
static inline void neon_set_bytes(uint8x16_t bytes[2], const uint16_t *from)
{
    const uint8x16_t low = vreinterpretq_u8_u16(vld1q_u16(from));
    const uint8x16_t high = vreinterpretq_u8_u16(vld1q_u16(from + 8));
    bytes[0] = vuzp1q_u8(low, high);
    bytes[1] = vuzp2q_u8(low, high);
}

/* Eight entries of a table of 16 numbers, of which the lower and the upper bytes are given; the
 * indices stand in the lower half. */
static inline uint16x8_t neon_words(uint8x16_t low, uint8x16_t high, uint8x16_t index)
{
    return vreinterpretq_u16_u8(vzip1q_u8(vqtbl1q_u8(low, index), vqtbl1q_u8(high, index)));
}

/* The same of sixteen: lower bytes first. */
static inline uint16x8x2_t neon_words_of_16(const uint8x16_t table[2], uint8x16_t index)
{
    const uint8x16_t low = vqtbl1q_u8(table[0], index), high = vqtbl1q_u8(table[1], index);
    return (uint16x8x2_t){
        {vreinterpretq_u16_u8(vzip1q_u8(low, high)), vreinterpretq_u16_u8(vzip2q_u8(low, high))}};
}

/* The upper halves of eight numbers, each shifted up by its zeros, so that it starts with a one. */
static inline uint16x8_t neon_tops(uint32x4_t low, uint32x4_t high)
{
    const int32x4_t zeros[2] = {vreinterpretq_s32_u32(vclzq_u32(low)),
                                vreinterpretq_s32_u32(vclzq_u32(high))};
    return vuzp2q_u16(vreinterpretq_u16_u32(vshlq_u32(low, zeros[0])),
                      vreinterpretq_u16_u32(vshlq_u32(high, zeros[1])));
}

/* level + fx_db_q8_vec(power) of eight; anything where the power is 0. The table is not looked
 * up: its lines stay in registers. */
static inline int32x4x2_t neon_add_db_q8(int32x4x2_t level_db_q8, uint32x4x2_t power)
{
    const uint32x4_t zeros[2] = {vclzq_u32(power.val[0]), vclzq_u32(power.val[1])};
    const uint16x8_t top = neon_tops(power.val[0], power.val[1]);
    /* Eight bits behind the first one, four of which say which line. */
    const uint8x16_t twice = vreinterpretq_u8_u16(vaddq_u16(top, top));
    const uint8x16_t mantissa = vuzp2q_u8(twice, twice), line = vshrq_n_u8(mantissa, 4);
    const uint16x8_t base =
        neon_words(vld1q_u8(fx_table_db_lines[0]), vld1q_u8(fx_table_db_lines[1]), line);
    const uint8x16_t slope = vqtbl1q_u8(vld1q_u8(fx_table_db_lines[2]), line);
    const uint16x8_t db_q13 = vmlal_u8(base, vget_low_u8(slope), vget_low_u8(mantissa));
    /* Below the 32nd octave, as many as there are zeros. */
    const uint32x4_t all = vdupq_n_u32(31 * FX_DB_PER_OCTAVE_Q13);
    const uint32x4_t low =
        vmlsq_n_u32(vaddw_u16(all, vget_low_u16(db_q13)), zeros[0], FX_DB_PER_OCTAVE_Q13);
    const uint32x4_t high =
        vmlsq_n_u32(vaddw_high_u16(all, db_q13), zeros[1], FX_DB_PER_OCTAVE_Q13);
    return (int32x4x2_t){{vsraq_n_s32(level_db_q8.val[0], vreinterpretq_s32_u32(low), 5),
                          vsraq_n_s32(level_db_q8.val[1], vreinterpretq_s32_u32(high), 5)}};
}

/* Sixteen levels, and where the power was 0: there a level means nothing. */
struct neon_levels {
    uint16x8x2_t level_db_q8;
    uint16x8_t is_none[2];
};

/* Sixteen powers as decibels are worked out from them: the upper halves of each, shifted up by its
 * zeros, and the zeros. */
struct neon_octaves {
    uint16x8_t top[2], zeros[2];
};

/* Those of powers in their order. */
static inline struct neon_octaves neon_octaves_of(uint32x4x4_t power)
{
    struct neon_octaves o;
    for (size_t n = 0; n < 2; n++) {
        const uint32x4_t low = power.val[2 * n], high = power.val[2 * n + 1];
        o.top[n] = neon_tops(low, high);
        o.zeros[n] = vuzp1q_u16(vreinterpretq_u16_u32(vclzq_u32(low)),
                                vreinterpretq_u16_u32(vclzq_u32(high)));
    }
    return o;
}

/* Steps of 31 octaves. */
enum { NEON_31_OCTAVES_DB_Q8 = 31 * (FX_DB_PER_OCTAVE_Q13 / 32) };

/* The first two rows of fx_table_db_lines, whose numbers are below 2^15, and fractions of a step of
 * 31 octaves, below 2^10. */
static inline void neon_set_octaves(uint8x16_t base[2])
{
    const uint8x16_t low = vld1q_u8(fx_table_db_lines[0]), high = vld1q_u8(fx_table_db_lines[1]);
    const uint16x8_t more_q13 = vdupq_n_u16(31 * (FX_DB_PER_OCTAVE_Q13 % 32));
    const uint8x16_t first =
        vreinterpretq_u8_u16(vaddq_u16(vreinterpretq_u16_u8(vzip1q_u8(low, high)), more_q13));
    const uint8x16_t second =
        vreinterpretq_u8_u16(vaddq_u16(vreinterpretq_u16_u8(vzip2q_u8(low, high)), more_q13));
    base[0] = vuzp1q_u8(first, second);
    base[1] = vuzp2q_u8(first, second);
}

/* The same of sixteen, less NEON_31_OCTAVES_DB_Q8, where all fits in 16 bits: the decibels take
 * 24659. Fractions of a step are taken away before they are cut off, and are not more than there
 * are, 32 octaves aside; whole steps are behind. */
static inline struct neon_levels neon_add_db_q8_of_16(uint16x8x2_t level_db_q8,
                                                      struct neon_octaves power)
{
    struct neon_levels sum;
    const uint8x16_t mantissa = vshrn_high_n_u16(vshrn_n_u16(power.top[0], 7), power.top[1], 7);
    const uint8x16_t line = vshrq_n_u8(mantissa, 4);
    uint8x16_t rows[2];
    neon_set_octaves(rows);
    const uint16x8x2_t base = neon_words_of_16(rows, line);
    const uint8x16_t slope = vqtbl1q_u8(vld1q_u8(fx_table_db_lines[2]), line);
    const uint16x8_t db_q13[2] = {vmlal_u8(base.val[0], vget_low_u8(slope), vget_low_u8(mantissa)),
                                  vmlal_high_u8(base.val[1], slope, mantissa)};
    for (size_t n = 0; n < 2; n++) {
        const uint16x8_t fine_q13 =
            vmlsq_n_u16(db_q13[n], power.zeros[n], FX_DB_PER_OCTAVE_Q13 % 32);
        sum.level_db_q8.val[n] = vmlsq_n_u16(vsraq_n_u16(level_db_q8.val[n], fine_q13, 5),
                                             power.zeros[n], FX_DB_PER_OCTAVE_Q13 / 32);
        sum.is_none[n] = vceqq_u16(power.zeros[n], vdupq_n_u16(32));
    }
    return sum;
}

/* Distance of eight levels, in steps of the table. */
static inline uint16x8_t neon_db_sum_step(int32x4_t a0_q8, int32x4_t a1_q8, int32x4_t b0_q8,
                                          int32x4_t b1_q8)
{
    const uint32x4_t apart[2] = {vreinterpretq_u32_s32(vabdq_s32(a0_q8, b0_q8)),
                                 vreinterpretq_u32_s32(vabdq_s32(a1_q8, b1_q8))};
    const uint16x8_t steps = vqshrn_high_n_u32(vqshrn_n_u32(apart[0], 4), apart[1], 4);
    return vminq_u16(steps, vdupq_n_u16(511));
}

/* Where two times sixteen levels meet in the table: the line, and the place in it. */
struct neon_db_sum {
    uint8x16_t line, place;
};

static inline struct neon_db_sum neon_db_sum_of(int32x4x4_t a_q8, int32x4x4_t b_q8)
{
    const uint16x8_t step[2] = {
        neon_db_sum_step(a_q8.val[0], a_q8.val[1], b_q8.val[0], b_q8.val[1]),
        neon_db_sum_step(a_q8.val[2], a_q8.val[3], b_q8.val[2], b_q8.val[3])};
    return (struct neon_db_sum){
        vshrn_high_n_u16(vshrn_n_u16(step[0], 3), step[1], 3),
        vuzp1q_u8(vreinterpretq_u8_u16(step[0]), vreinterpretq_u8_u16(step[1]))};
}

/* What the table says, from bytes of its rows: by how much sums are above the higher levels. */
static inline uint16x8x2_t neon_db_sum_more_q13(uint8x16_t low, uint8x16_t high, uint8x16_t fall,
                                                uint8x16_t place)
{
    return (uint16x8x2_t){{vmlsl_u8(vreinterpretq_u16_u8(vzip1q_u8(low, high)), vget_low_u8(fall),
                                    vget_low_u8(place)),
                           vmlsl_high_u8(vreinterpretq_u16_u8(vzip2q_u8(low, high)), fall, place)}};
}

/* Where the rows of fx_table_db_sum_lines are, for loops that have no registers for their twelve
 * vectors and load them each time. */
struct neon_sum_rows {
    const uint8_t *at[3];
};

/* The compiler must not see that they are a constant apart: it would work them out each time. */
static inline struct neon_sum_rows neon_sum_rows(void)
{
    struct neon_sum_rows r;
    for (size_t n = 0; n < 3; n++) {
        r.at[n] = fx_table_db_sum_lines[n];
        __asm__("" : "+r"(r.at[n]));
    }
    return r;
}

/* Look up sixteen bytes in a row of a table. The compiler must not load it before `after` is known,
 * nor leave it loaded: it would copy rows to the stack and back. */
static inline uint8x16_t neon_look_up(const uint8_t *row, uint8x16_t after, uint8x16_t place)
{
    __asm__ volatile("" : : "w"(after) : "memory");
    uint8x16_t found = vqtbl4q_u8(vld1q_u8_x4(row), place);
    __asm__ volatile("" : "+w"(found));
    return found;
}

/* neon_db_sum_more_q13 of what the rows say. */
static inline uint16x8x2_t neon_look_up_more_q13(const struct neon_sum_rows *rows,
                                                 struct neon_db_sum at)
{
    const uint8x16_t low = neon_look_up(rows->at[0], at.line, at.line);
    const uint8x16_t high = neon_look_up(rows->at[1], low, at.line);
    const uint8x16_t fall = neon_look_up(rows->at[2], high, at.line);
    return neon_db_sum_more_q13(low, high, fall, at.place);
}

/* The larger ones, and what the table says that they are raised by. */
static inline int32x4x4_t neon_db_sum_raise(uint8x16_t low, uint8x16_t high, uint8x16_t fall,
                                            uint8x16_t place, int32x4x4_t a_q8, int32x4x4_t b_q8)
{
    const uint16x8x2_t more_q13 = neon_db_sum_more_q13(low, high, fall, place);
    int32x4x4_t sum;
    for (size_t n = 0; n < 2; n++) {
        const int16x8_t more_q8 = vreinterpretq_s16_u16(vshrq_n_u16(more_q13.val[n], 5));
        const int32x4_t most[2] = {vmaxq_s32(a_q8.val[2 * n], b_q8.val[2 * n]),
                                   vmaxq_s32(a_q8.val[2 * n + 1], b_q8.val[2 * n + 1])};
        sum.val[2 * n] = vaddw_s16(most[0], vget_low_s16(more_q8));
        sum.val[2 * n + 1] = vaddw_high_s16(most[1], more_q8);
    }
    return sum;
}

/* fx_db_q8_sum_vec of sixteen, by the rows of fx_table_db_sum_lines: to be loaded before a
 * loop, whose stores would else have them loaded again each time. Steps' upper bits choose lines.
 */
static inline int32x4x4_t neon_db_q8_sum(uint8x16x4_t lows, uint8x16x4_t highs, uint8x16x4_t falls,
                                         int32x4x4_t a_q8, int32x4x4_t b_q8)
{
    const struct neon_db_sum at = neon_db_sum_of(a_q8, b_q8);
    return neon_db_sum_raise(vqtbl4q_u8(lows, at.line), vqtbl4q_u8(highs, at.line),
                             vqtbl4q_u8(falls, at.line), at.place, a_q8, b_q8);
}

/* The same of levels of 16 bits, whose distances are given. Below line 32 a place counts from step
 * 0, from there on from step 256; the last lines have no fall. */
static inline struct neon_db_sum neon_db_sum_of_16(uint16x8_t apart_q8, uint16x8_t further_q8)
{
    const uint8x16_t line = vqshrn_high_n_u16(vqshrn_n_u16(apart_q8, 7), further_q8, 7);
    return (struct neon_db_sum){vminq_u8(line, vdupq_n_u8(63)),
                                vshrn_high_n_u16(vshrn_n_u16(apart_q8, 4), further_q8, 4)};
}

/* Levels held within 16 bits. */
static inline int16x8_t neon_held_8(int32x4_t low, int32x4_t high)
{
    return vqmovn_high_s32(vqmovn_s32(low), high);
}

/* Where the sums of two times sixteen levels of 16 bits meet in the table. */
static inline struct neon_db_sum neon_db_sum_of_levels(int16x8x2_t a_q8, int16x8x2_t b_q8)
{
    return neon_db_sum_of_16(vreinterpretq_u16_s16(vabdq_s16(a_q8.val[0], b_q8.val[0])),
                             vreinterpretq_u16_s16(vabdq_s16(a_q8.val[1], b_q8.val[1])));
}

/* The larger ones, raised by what the table says, held within 16 bits. */
static inline int16x8x2_t neon_db_sum_raised(int16x8x2_t a_q8, int16x8x2_t b_q8,
                                             uint16x8x2_t more_q13)
{
    int16x8x2_t sum;
    for (size_t n = 0; n < 2; n++) {
        const int16x8_t more_q8 = vreinterpretq_s16_u16(vshrq_n_u16(more_q13.val[n], 5));
        sum.val[n] = vqaddq_s16(vmaxq_s16(a_q8.val[n], b_q8.val[n]), more_q8);
    }
    return sum;
}

/* fx_db_q8_sum_vec of sixteen levels of 16 bits, held within them. */
static inline int16x8x2_t neon_db_q8_sum_16(uint8x16x4_t lows, uint8x16x4_t highs,
                                            uint8x16x4_t falls, int16x8x2_t a_q8, int16x8x2_t b_q8)
{
    const struct neon_db_sum at = neon_db_sum_of_levels(a_q8, b_q8);
    const uint16x8x2_t more_q13 =
        neon_db_sum_more_q13(vqtbl4q_u8(lows, at.line), vqtbl4q_u8(highs, at.line),
                             vqtbl4q_u8(falls, at.line), at.place);
    return neon_db_sum_raised(a_q8, b_q8, more_q13);
}

/* Eight numbers, and eight more. */
static inline int32x4x4_t neon_load_8_and_8(const int32_t *from, const int32_t *and_from)
{
    return (int32x4x4_t){
        {vld1q_s32(from), vld1q_s32(from + 4), vld1q_s32(and_from), vld1q_s32(and_from + 4)}};
}

static inline void neon_store_8_and_8(int32_t *to, int32_t *and_to, int32x4x4_t x)
{
    vst1q_s32(to, x.val[0]);
    vst1q_s32(to + 4, x.val[1]);
    vst1q_s32(and_to, x.val[2]);
    vst1q_s32(and_to + 4, x.val[3]);
}

/* Octaves in Q8 above 2^-31 for fx_power_q24_vec of eight: -31.0 up to just below 1.0. */
static inline int16x8_t neon_octaves_q8(int16x8_t db_q8)
{
    const int16x8_t octaves_q8 =
        vaddq_s16(vqrdmulhq_n_s16(db_q8, FX_OCTAVES_PER_DB_Q15), vdupq_n_s16(-7 * 256));
    return vminq_s16(vmaxq_s16(octaves_q8, vdupq_n_s16(-31 * 256)), vdupq_n_s16(255));
}

/* Q15 to Q31 and then up by as many bits, of which there are none or less. */
static inline uint32x4x2_t neon_shift_q15(uint16x8_t x_q15, int16x8_t up)
{
    const uint16x8_t nothing = vdupq_n_u16(0);
    const uint32x4_t low = vreinterpretq_u32_u16(vzip1q_u16(nothing, x_q15)),
                     high = vreinterpretq_u32_u16(vzip2q_u16(nothing, x_q15));
    return (uint32x4x2_t){
        {vshlq_u32(low, vmovl_s16(vget_low_s16(up))), vshlq_u32(high, vmovl_high_s16(up))}};
}

/* fx_power_q24_vec of sixteen. Of the lines of its table the lower byte of the octaves chooses
 * one; the upper byte says how far down. */
static inline uint32x4x4_t neon_power_q24(int16x8_t low_db_q8, int16x8_t high_db_q8)
{
    const int16x8_t low_q8 = neon_octaves_q8(low_db_q8), high_q8 = neon_octaves_q8(high_db_q8);
    const uint8x16_t place = vuzp1q_u8(vreinterpretq_u8_s16(low_q8), vreinterpretq_u8_s16(high_q8));
    const uint8x16_t line = vshrq_n_u8(place, 4);
    const uint8x16_t base[2] = {vqtbl1q_u8(vld1q_u8(fx_table_power_lines[0]), line),
                                vqtbl1q_u8(vld1q_u8(fx_table_power_lines[1]), line)};
    const uint8x16_t slope = vqtbl1q_u8(vld1q_u8(fx_table_power_lines[2]), line);
    const uint16x8_t low_q15 = vmlal_u8(vreinterpretq_u16_u8(vzip1q_u8(base[0], base[1])),
                                        vget_low_u8(slope), vget_low_u8(place));
    const uint16x8_t high_q15 =
        vmlal_high_u8(vreinterpretq_u16_u8(vzip2q_u8(base[0], base[1])), slope, place);
    const uint32x4x2_t low_q24 = neon_shift_q15(low_q15, vshrq_n_s16(low_q8, 8)),
                       high_q24 = neon_shift_q15(high_q15, vshrq_n_s16(high_q8, 8));
    return (uint32x4x4_t){{low_q24.val[0], low_q24.val[1], high_q24.val[0], high_q24.val[1]}};
}

/* As a word: the most of bytes takes an instruction more to ask about. */
static inline bool neon_any(uint8x16_t x)
{
    return vmaxvq_u32(vreinterpretq_u32_u8(x)) != 0;
}

#endif
