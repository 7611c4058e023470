#include "../plain.h"
#include "neon.h"

/* The sums of both, less `less_db_q8`, into `to_db_q8`, which may be either. Returns how many cells
 * these are: whole sixteens. */
static inline uint32_t neon_sum(const int16_t *sum_db_q8, const int16_t *level_db_q8,
                                int16_t less_db_q8, int16_t *to_db_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    const int16x8_t less = vdupq_n_s16(less_db_q8);
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    for (size_t i = 0; i < whole; i += 16) {
        int16x8x2_t sum = neon_db_q8_sum_16(lows, highs, falls, vld1q_s16_x2(sum_db_q8 + i),
                                            vld1q_s16_x2(level_db_q8 + i));
        for (size_t n = 0; n < 2; n++) {
            sum.val[n] = vqsubq_s16(sum.val[n], less);
        }
        vst1q_s16_x2(to_db_q8 + i, sum);
    }
    return whole;
}

void lm_k_levels_add(int16_t *sum_db_q8, const int16_t *level_db_q8, uint32_t cells)
{
    const uint32_t whole = neon_sum(sum_db_q8, level_db_q8, 0, sum_db_q8, cells);
    if (whole < cells) {
        lm_k_levels_add_c(sum_db_q8 + whole, level_db_q8 + whole, cells - whole);
    }
}

void lm_k_levels_mean(const int16_t *sum_db_q8, int16_t less_db_q8, int16_t *level_db_q8,
                      uint32_t cells)
{
    const uint32_t whole = neon_sum(sum_db_q8, level_db_q8, less_db_q8, level_db_q8, cells);
    if (whole < cells) {
        lm_k_levels_mean_c(sum_db_q8 + whole, less_db_q8, level_db_q8 + whole, cells - whole);
    }
}

void lm_k_highest(const int16_t *level_db_q8, int16_t *highest_db_q8, uint32_t cells)
{
    for (size_t i = 0; i < cells; i += LM_K_HIGHEST_CELLS) {
        const int16x8x2_t level = vld1q_s16_x2(level_db_q8 + i);
        *highest_db_q8++ = vmaxvq_s16(vmaxq_s16(level.val[0], level.val[1]));
    }
}

/* Of three vectors side by side: the larger of each number and the one `lanes` further on. */
static inline int16x8x3_t neon_larger(int16x8x3_t x, const int lanes)
{
    const int16x8x3_t on =
        lanes == 1
            ? (int16x8x3_t){{vextq_s16(x.val[0], x.val[1], 1), vextq_s16(x.val[1], x.val[2], 1),
                             vextq_s16(x.val[2], x.val[2], 1)}}
        : lanes == 2
            ? (int16x8x3_t){{vextq_s16(x.val[0], x.val[1], 2), vextq_s16(x.val[1], x.val[2], 2),
                             vextq_s16(x.val[2], x.val[2], 2)}}
            : (int16x8x3_t){
                  {vextq_s16(x.val[0], x.val[1], 4), vextq_s16(x.val[1], x.val[2], 4), x.val[2]}};
    return (int16x8x3_t){{vmaxq_s16(x.val[0], on.val[0]), vmaxq_s16(x.val[1], on.val[1]),
                          vmaxq_s16(x.val[2], on.val[2])}};
}

uint32_t lm_k_stand_out(const int16_t *level_db_q8, int16_t least_db_q8, int16_t above_db_q8)
{
    _Static_assert(LM_K_BESIDE == 4, "nine cells: the larger of two, four, eight, and the ninth");
    const uint8x16_t bit = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const int16x8_t least = vdupq_n_s16(least_db_q8), above = vdupq_n_s16(above_db_q8);
    const int16_t *const from = level_db_q8 - LM_K_BESIDE;
    const int16x8x3_t level = {{vld1q_s16(from), vld1q_s16(from + 8), vld1q_s16(from + 16)}};
    const int16x8x3_t of_eight = neon_larger(neon_larger(neon_larger(level, 1), 2), 4);
    uint8x16_t does[2];
    for (size_t n = 0; n < 2; n++) {
        const int16x8_t cell = vextq_s16(level.val[n], level.val[n + 1], LM_K_BESIDE);
        const int16x8_t most = vqsubq_s16(cell, above);
        const int16x8_t highest = vmaxq_s16(of_eight.val[n], level.val[n + 1]);
        const uint16x8_t is_peak = vandq_u16(vcgeq_s16(cell, least), vcgeq_s16(cell, highest));
        const uint16x8_t is_far =
            vandq_u16(vcgeq_s16(most, level.val[n]), vcgeq_s16(most, level.val[n + 1]));
        does[n] = vreinterpretq_u8_u16(vandq_u16(is_peak, is_far));
    }
    const uint8x16_t mask = vandq_u8(vuzp1q_u8(does[0], does[1]), bit);
    return vaddv_u8(vget_low_u8(mask)) | (uint32_t)vaddv_u8(vget_high_u8(mask)) << 8;
}

/* A point's side lobes on sixteen levels: eight before its own, and eight behind it. */
struct neon_lobes {
    int16x8x2_t level, lobe;
    struct neon_db_sum at;
};

static inline struct neon_lobes neon_lobes_of(const int16_t *side_db_q8, int16x8_t point,
                                              int16x8x2_t level)
{
    struct neon_lobes of = {.level = level,
                            .lobe = {{vqaddq_s16(point, vld1q_s16(side_db_q8 - LM_K_LOBES_REACH)),
                                      vqaddq_s16(point, vld1q_s16(side_db_q8 + 1))}}};
    of.at = neon_db_sum_of_levels(of.level, of.lobe);
    return of;
}

/* The levels with those lobes that count. */
static inline int16x8x2_t neon_with_lobes(const struct neon_lobes *of, uint16x8x2_t more_q13)
{
    const int16x8_t below = vdupq_n_s16(LM_K_LOBES_BELOW_DB_Q8);
    int16x8x2_t sum = neon_db_sum_raised(of->level, of->lobe, more_q13);
    for (size_t n = 0; n < 2; n++) {
        const uint16x8_t counts = vcgtq_s16(of->lobe.val[n], vqsubq_s16(of->level.val[n], below));
        sum.val[n] = vbslq_s16(counts, sum.val[n], of->level.val[n]);
    }
    return sum;
}

/* Of a row of the table of sums, what two look up. */
static inline uint8x16x2_t neon_look_up_two(size_t row, uint8x16_t first, uint8x16_t second)
{
    const uint8x16x4_t table = vld1q_u8_x4(fx_table_db_sum_lines[row]);
    return (uint8x16x2_t){{vqtbl4q_u8(table, first), vqtbl4q_u8(table, second)}};
}

/* A cell of eight lines. */
static inline int16x8_t neon_load_across(int16_t *const *line, uint32_t cell)
{
    int16x8_t v = vld1q_dup_s16(line[0] + cell);
    v = vld1q_lane_s16(line[1] + cell, v, 1);
    v = vld1q_lane_s16(line[2] + cell, v, 2);
    v = vld1q_lane_s16(line[3] + cell, v, 3);
    v = vld1q_lane_s16(line[4] + cell, v, 4);
    v = vld1q_lane_s16(line[5] + cell, v, 5);
    v = vld1q_lane_s16(line[6] + cell, v, 6);
    return vld1q_lane_s16(line[7] + cell, v, 7);
}

static inline void neon_store_across(int16_t *const *line, uint32_t cell, int16x8_t v)
{
    vst1q_lane_s16(line[0] + cell, v, 0);
    vst1q_lane_s16(line[1] + cell, v, 1);
    vst1q_lane_s16(line[2] + cell, v, 2);
    vst1q_lane_s16(line[3] + cell, v, 3);
    vst1q_lane_s16(line[4] + cell, v, 4);
    vst1q_lane_s16(line[5] + cell, v, 5);
    vst1q_lane_s16(line[6] + cell, v, 6);
    vst1q_lane_s16(line[7] + cell, v, 7);
}

void lm_k_side_lobes(const int16_t *along_db_q8, const int16_t *across_db_q8, int16_t point_db_q8,
                     int16_t *const *around, uint32_t cell)
{
    _Static_assert(LM_K_LOBES_REACH == 8, "a vector each way");
    const int16x8_t point = vdupq_n_s16(point_db_q8);
    int16_t *const *const right = around + LM_K_LOBES_REACH + 1;
    int16_t *const own = around[LM_K_LOBES_REACH] + cell;
    const struct neon_lobes across = neon_lobes_of(
        across_db_q8, point,
        (int16x8x2_t){{neon_load_across(around, cell), neon_load_across(right, cell)}});
    struct neon_lobes along = across;
    if (along_db_q8) {
        along =
            neon_lobes_of(along_db_q8, point,
                          (int16x8x2_t){{vld1q_s16(own - LM_K_LOBES_REACH), vld1q_s16(own + 1)}});
    }
    const uint8x16x2_t low = neon_look_up_two(0, across.at.line, along.at.line);
    const uint8x16x2_t high = neon_look_up_two(1, across.at.line, along.at.line);
    const uint8x16x2_t fall = neon_look_up_two(2, across.at.line, along.at.line);
    int16x8x2_t sum = neon_with_lobes(
        &across, neon_db_sum_more_q13(low.val[0], high.val[0], fall.val[0], across.at.place));
    neon_store_across(around, cell, sum.val[0]);
    neon_store_across(right, cell, sum.val[1]);
    if (along_db_q8) {
        sum = neon_with_lobes(
            &along, neon_db_sum_more_q13(low.val[1], high.val[1], fall.val[1], along.at.place));
        vst1q_s16(own - LM_K_LOBES_REACH, sum.val[0]);
        vst1q_s16(own + 1, sum.val[1]);
    }
}
