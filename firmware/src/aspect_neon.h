/* A line's light by the vectors of 64-bit Arm: eight cells at a time from the map to their levels.
 * What aspect.c does in several loops is one here, and small tables are held in registers. The
 * results are the same to the bit. Not for other machines, where it is never called. */
#ifndef ASPECT_NEON_H
#define ASPECT_NEON_H

#include <stddef.h>
#include <stdint.h>

#include "aspect_line.h"
#include "fx/log.h"
#include "fx/neon.h"

#if FX_HAS_NEON

/* The legend as bytes side by side, code 0 first: lower bytes, upper bytes. */
struct neon_legend {
    uint8x16_t height_dm[2], edge_q8[2], mark;
};

/* What a group of cells takes over from the one before it. */
struct neon_before {
    int32x4_t tangent, of_two, horizon;
    uint8x16_t mark;
    uint8x8_t shores; /* bit 0: some cell was behind one */
};

/* Which cells of a group are not shown, and which have no edge. */
struct neon_hidden {
    uint32x4_t unseen[2];
    uint8x16_t has_no_edge;
};

static inline struct neon_legend neon_legend_of(const struct lm_legend *l)
{
    return (struct neon_legend){
        {vld1q_u8(l->bytes.height_dm[0]), vld1q_u8(l->bytes.height_dm[1])},
        {vld1q_u8(l->bytes.edge_q8[0]), vld1q_u8(l->bytes.edge_q8[1])},
        vld1q_u8(l->bytes.mark),
    };
}

/* Tangents of eight cells from cell i on: tangent_of. `code` are their height codes. */
static inline int32x4x2_t neon_tangents(const struct neon_legend *l,
                                        const struct lm_range_grid *grid,
                                        const struct lm_scan_line *line, size_t i, uint8x16_t code)
{
    const uint16x8_t height_dm = fx_neon_words(l->height_dm[0], l->height_dm[1], code);
    const uint32x4_t low = vld1q_u32((const uint32_t *)line->elevation_q14 + i);
    const uint32x4_t high = vld1q_u32((const uint32_t *)line->elevation_q14 + i + 4);
    const uint32x4_t top_q14[2] = {
        vsraq_n_u32(low, vmull_n_u16(vget_low_u16(height_dm), Q19_OF_DM), 5),
        vsraq_n_u32(high, vmull_high_n_u16(height_dm, Q19_OF_DM), 5)};
    int32x4x2_t tangent;
    for (size_t k = 0; k < 2; k++) {
        const int32x4_t fall_q14 = vld1q_s32(grid->fall_q14 + i + 4 * k);
        const int32x4_t apparent_q14 = vsubq_s32(vreinterpretq_s32_u32(top_q14[k]), fall_q14);
        /* Twice the product's upper half. */
        tangent.val[k] = vqdmulhq_s32(apparent_q14, vld1q_s32(grid->inverse_range + i + 4 * k));
    }
    return tangent;
}

/* The horizon behind each of four cells. */
static inline int32x4_t neon_horizon(struct neon_before *b, int32x4_t tangent)
{
    const int32x4_t of_two = vmaxq_s32(tangent, vextq_s32(b->tangent, tangent, 3));
    const int32x4_t of_four = vmaxq_s32(of_two, vextq_s32(b->of_two, of_two, 2));
    b->tangent = tangent;
    b->of_two = of_two;
    return vmaxq_s32(of_four, b->horizon);
}

/* By how much the horizon rises over each of four cells. */
static inline uint32x4_t neon_rise(struct neon_before *b, int32x4_t tangent)
{
    const int32x4_t before = b->horizon;
    b->horizon = neon_horizon(b, tangent);
    return vreinterpretq_u32_s32(vsubq_s32(b->horizon, vextq_s32(before, b->horizon, 3)));
}

/* Brightness of leading edges, of eight cells whose classes are given twice; *left gets the mark of
 * water behind a shore. */
static inline uint16x8_t neon_edges(const struct neon_legend *l, struct neon_before *b,
                                    uint8x16_t has_no_edge, uint8x16_t class_index, uint8x8_t *left)
{
    const uint8x16_t mark = vqtbl1q_u8(l->mark, class_index);
    const uint8x16_t before = vextq_u8(b->mark, mark, 15);
    /* Beyond the table is nothing. */
    const uint8x16_t at = vorrq_u8(class_index, vorrq_u8(vceqq_u8(mark, before), has_no_edge));
    b->mark = mark;
    *left = vget_low_u8(vbicq_u8(before, vorrq_u8(mark, has_no_edge)));
    return fx_neon_words(l->edge_q8[0], l->edge_q8[1], at);
}

/* Eight cells from cell i on; their horizon, level and whether they are behind a shore are stored.
 */
static inline void neon_cells(const struct lm_range_grid *grid, const struct lm_scan_line *line,
                              const struct neon_legend *l, const struct neon_hidden *hidden,
                              size_t i, struct neon_before *b, struct lm_sight *sight,
                              uint8_t *behind_shore)
{
    const uint16x8_t cells = vuzp1q_u16(vreinterpretq_u16_u32(vld1q_u32(line->cell + i)),
                                        vreinterpretq_u16_u32(vld1q_u32(line->cell + i + 4)));
    const uint8x16_t lower = vuzp1q_u8(vreinterpretq_u8_u16(cells), vreinterpretq_u8_u16(cells));
    uint8x8_t left;
    const uint16x8_t edge_q8 = neon_edges(l, b, hidden->has_no_edge, vshrq_n_u8(lower, 4), &left);
    const int32x4x2_t seen =
        neon_tangents(l, grid, line, i, vandq_u8(lower, vdupq_n_u8(CODES - 1)));
    /* The upper byte times LM_GAMMA_CODE_STEP_Q8, below 2^15, and an edge, below 2^15. */
    const uint16x8_t bright_q8 = vsraq_n_u16(edge_q8, vandq_u16(cells, vdupq_n_u16(0xFF00)), 1);
    const uint32x4_t gain_q8[2] = {vld1q_u32((const uint32_t *)grid->gain_q8 + i),
                                   vld1q_u32((const uint32_t *)grid->gain_q8 + i + 4)};
    const int32x4x2_t dark_q8 = {
        {vreinterpretq_s32_u32(vaddw_u16(gain_q8[0], vget_low_u16(bright_q8))),
         vreinterpretq_s32_u32(vaddw_high_u16(gain_q8[1], bright_q8))}};
    uint32x4x2_t rise;
    for (size_t k = 0; k < 2; k++) {
        rise.val[k] =
            neon_rise(b, vbslq_s32(hidden->unseen[k], vdupq_n_s32(INT32_MIN), seen.val[k]));
        vst1q_s32(sight->horizon + i + 4 * k + 1, b->horizon);
    }
    const int32x4x2_t lit_q8 = fx_neon_add_db_q8(dark_q8, rise);
    for (size_t k = 0; k < 2; k++) {
        vst1q_s32(sight->level_q8 + i + 4 * k,
                  vbslq_s32(vceqzq_u32(rise.val[k]), vdupq_n_s32(LM_LEVEL_SHADOW), lit_q8.val[k]));
    }
    b->shores = vorr_u8(b->shores, left);
    vst1_u8(behind_shore + i, left);
}

/* Cells of the group at `i` before the first that is shown, and up to it. */
static inline struct neon_hidden neon_hidden_at(size_t i, size_t first)
{
    static const uint32_t number[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const uint32x4_t shown = vdupq_n_u32((uint32_t)(first - i));
    const uint32x4_t low = vld1q_u32(number), high = vld1q_u32(number + 4);
    const uint16x8_t upto =
        vcombine_u16(vmovn_u32(vcleq_u32(low, shown)), vmovn_u32(vcleq_u32(high, shown)));
    return (struct neon_hidden){{vcltq_u32(low, shown), vcltq_u32(high, shown)},
                                vcombine_u8(vmovn_u16(upto), vmovn_u16(upto))};
}

/* Sixteen cells at a time, of which the last eight may be behind the line. */
static inline void neon_shores(const struct lm_range_grid *grid, const struct lm_legend *legend,
                               const struct lm_scan_line *line, const uint64_t *behind_shore,
                               struct lm_sight *sight)
{
    const uint32_t cells = grid->cells;
    for (uint32_t i = grid->first & ~7u; i < cells; i += 16) {
        const uint64_t *eight = behind_shore + i / 8;
        if (((eight[0] | eight[1]) & 0x0101010101010101) != 0) {
            add_shores_of(grid, legend, line, eight[0], i, sight);
            add_shores_of(grid, legend, line, eight[1], i + 8, sight);
        }
    }
}

/* Horizon, level and edges of a line whose horizon starts with `start`. */
static inline void light_line_neon(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line, int32_t start,
                                   struct lm_sight *sight)
{
    uint64_t behind_shore[LM_CELLS_ROOM / 8 + 1];
    const struct neon_legend l = neon_legend_of(legend);
    const int32x4_t all = vdupq_n_s32(start);
    struct neon_before before = {all, all, all, vdupq_n_u8(0), vdup_n_u8(0)};
    const size_t cells = grid->cells, first = grid->first & ~7u, end = (cells + 7) & ~(size_t)7;
    for (size_t k = 0; k < first; k++) {
        sight->horizon[k + 1] = start;
        sight->level_q8[k] = LM_LEVEL_SHADOW;
    }
    sight->horizon[0] = start;
    if (first < cells) {
        const struct neon_hidden some = neon_hidden_at(first, grid->first);
        neon_cells(grid, line, &l, &some, first, &before, sight, (uint8_t *)behind_shore);
    }
    behind_shore[end / 8] = 0; /* asked with the last eight */
    const struct neon_hidden none = {{vdupq_n_u32(0), vdupq_n_u32(0)}, vdupq_n_u8(0)};
    for (size_t i = first + 8; i < end; i += 8) {
        neon_cells(grid, line, &l, &none, i, &before, sight, (uint8_t *)behind_shore);
    }
    if (vaddv_u8(vand_u8(before.shores, vdup_n_u8(MARK_WATER))) != 0) {
        neon_shores(grid, legend, line, behind_shore, sight);
    }
}

#else

static inline void light_line_neon(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line, int32_t start,
                                   struct lm_sight *sight)
{
    (void)grid, (void)legend, (void)line, (void)start, (void)sight;
}

#endif

#endif
