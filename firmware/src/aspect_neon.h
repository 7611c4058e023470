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

/* The legend as bytes side by side, code 0 first. */
struct neon_legend {
    uint8x16x4_t height_q14; /* four bytes for each code */
    uint8x16_t mark, edge_low, edge_high;
};

/* What a group of cells takes over from the one before it. */
struct neon_before {
    int32x4_t tangent, of_two, horizon;
    uint8x8_t mark, shores; /* bit 0 of `shores`: some cell was behind one */
};

/* Which cells of a group are not shown, and which have no edge. */
struct neon_hidden {
    uint32x4_t unseen[2];
    uint8x8_t has_no_edge;
};

static inline struct neon_legend neon_legend_of(const struct lm_legend *l)
{
    struct neon_legend n;
    int16x8_t edge[2];
    uint16x8_t mark[2];
    for (int half = 0; half < 2; half++) {
        const int first = half ? CODES / 2 : 0;
        const int32x4_t low = vld1q_s32(l->kind + first), high = vld1q_s32(l->kind + first + 4);
        edge[half] = vcombine_s16(vshrn_n_s32(low, MARK_BITS), vshrn_n_s32(high, MARK_BITS));
        mark[half] = vreinterpretq_u16_s16(vcombine_s16(vmovn_s32(low), vmovn_s32(high)));
        n.height_q14.val[2 * half] = vreinterpretq_u8_s32(vld1q_s32(l->height_q14 + first));
        n.height_q14.val[2 * half + 1] = vreinterpretq_u8_s32(vld1q_s32(l->height_q14 + first + 4));
    }
    const uint8x16_t near = vreinterpretq_u8_s16(edge[0]), far = vreinterpretq_u8_s16(edge[1]);
    n.edge_low = vuzp1q_u8(near, far);
    n.edge_high = vuzp2q_u8(near, far);
    n.mark = vandq_u8(vuzp1q_u8(vreinterpretq_u8_u16(mark[0]), vreinterpretq_u8_u16(mark[1])),
                      vdupq_n_u8((1 << MARK_BITS) - 1));
    return n;
}

/* Tangents of four cells: tangent_of. */
static inline int32x4_t neon_tangents(const struct neon_legend *l, uint32x4_t cell,
                                      int32x4_t elevation_q14, int32x4_t fall_q14,
                                      int32x4_t inverse)
{
    /* The four bytes of the code's entry. */
    const uint32x4_t code = vandq_u32(cell, vdupq_n_u32(CODES - 1));
    const uint32x4_t at = vorrq_u32(vmulq_n_u32(code, 0x04040404), vdupq_n_u32(0x03020100));
    const int32x4_t height_q14 =
        vreinterpretq_s32_u8(vqtbl4q_u8(l->height_q14, vreinterpretq_u8_u32(at)));
    const int32x4_t apparent_q14 = vsubq_s32(vaddq_s32(elevation_q14, height_q14), fall_q14);
    const int64x2_t low = vmull_s32(vget_low_s32(apparent_q14), vget_low_s32(inverse));
    const int64x2_t high = vmull_high_s32(apparent_q14, inverse);
    return vshrn_high_n_s64(vshrn_n_s64(low, 30), high, 30);
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

/* Levels of four cells lit by what they show above the horizon. */
static inline int32x4_t neon_light(struct neon_before *b, int32x4_t horizon, int32x4_t level_q8)
{
    const int32x4_t rise = vsubq_s32(horizon, vextq_s32(b->horizon, horizon, 3));
    b->horizon = horizon;
    return vbslq_s32(vceqzq_s32(rise), vdupq_n_s32(LM_LEVEL_SHADOW),
                     fx_neon_add_db_q8(level_q8, vreinterpretq_u32_s32(rise)));
}

/* Brightness of leading edges, of eight cells; *left gets the mark of water behind a shore. */
static inline int16x8_t neon_edges(const struct neon_legend *l, struct neon_before *b,
                                   uint8x8_t has_no_edge, const uint32x4_t cell[2], uint8x8_t *left)
{
    const uint16x8_t low =
        vuzp1q_u16(vreinterpretq_u16_u32(cell[0]), vreinterpretq_u16_u32(cell[1]));
    const uint8x8_t class_index = vand_u8(vshrn_n_u16(low, 4), vdup_n_u8(CODES - 1));
    const uint8x8_t mark = vqtbl1_u8(l->mark, class_index);
    const uint8x8_t before = vext_u8(b->mark, mark, 7);
    /* Beyond the table is nothing. */
    const uint8x8_t at = vorr_u8(class_index, vorr_u8(vceq_u8(mark, before), has_no_edge));
    b->mark = mark;
    *left = vbic_u8(before, vorr_u8(mark, has_no_edge));
    const uint8x8x2_t edge = vzip_u8(vqtbl1_u8(l->edge_low, at), vqtbl1_u8(l->edge_high, at));
    return vreinterpretq_s16_u8(vcombine_u8(edge.val[0], edge.val[1]));
}

/* Eight cells from cell i on; their horizon, level and whether they are behind a shore are stored.
 */
static inline void neon_cells(const struct lm_range_grid *grid, const struct lm_scan_line *line,
                              const struct neon_legend *l, const struct neon_hidden *hidden,
                              size_t i, struct neon_before *b, struct lm_sight *sight,
                              uint8_t *behind_shore)
{
    const uint32x4_t cells[2] = {vld1q_u32(line->cell + i), vld1q_u32(line->cell + i + 4)};
    uint8x8_t left;
    const int16x8_t edge_q8 = neon_edges(l, b, hidden->has_no_edge, cells, &left);
    for (size_t k = 0; k < 2; k++) {
        const size_t at = i + 4 * k;
        const int32x4_t seen =
            neon_tangents(l, cells[k], vld1q_s32(line->elevation_q14 + at),
                          vld1q_s32(grid->fall_q14 + at), vld1q_s32(grid->inverse_range + at));
        const int32x4_t tangent = vbslq_s32(hidden->unseen[k], vdupq_n_s32(INT32_MIN), seen);
        const int32x4_t code = vreinterpretq_s32_u32(vshrq_n_u32(cells[k], 8));
        const int32x4_t flat_q8 =
            vmlaq_n_s32(vld1q_s32(grid->gain_q8 + at), code, LM_GAMMA_CODE_STEP_Q8);
        const int32x4_t dark_q8 =
            k ? vaddw_high_s16(flat_q8, edge_q8) : vaddw_s16(flat_q8, vget_low_s16(edge_q8));
        const int32x4_t horizon = neon_horizon(b, tangent);
        vst1q_s32(sight->level_q8 + at, neon_light(b, horizon, dark_q8));
        vst1q_s32(sight->horizon + at + 1, horizon);
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
    return (struct neon_hidden){{vcltq_u32(low, shown), vcltq_u32(high, shown)}, vmovn_u16(upto)};
}

static inline void neon_shores(const struct lm_range_grid *grid, const struct lm_legend *legend,
                               const struct lm_scan_line *line, const uint8_t *behind_shore,
                               struct lm_sight *sight)
{
    for (uint32_t i = grid->first & ~7u; i < grid->cells; i += 8) {
        const uint64_t eight = vget_lane_u64(vreinterpret_u64_u8(vld1_u8(behind_shore + i)), 0);
        for (uint64_t left = eight & 0x0101010101010101; left != 0; left &= left - 1) {
            add_shore(grid, legend, line, i + (uint32_t)fx_ctz64(left) / 8, sight);
        }
    }
}

/* Horizon, level and edges of a line whose horizon starts with `start`. */
static inline void light_line_neon(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line, int32_t start,
                                   struct lm_sight *sight)
{
    uint8_t behind_shore[LM_CELLS_ROOM];
    const struct neon_legend l = neon_legend_of(legend);
    const int32x4_t all = vdupq_n_s32(start);
    struct neon_before before = {all, all, all, vdup_n_u8(0), vdup_n_u8(0)};
    const size_t cells = grid->cells;
    size_t i = grid->first & ~7u;
    for (size_t k = 0; k < i; k++) {
        sight->horizon[k + 1] = start;
        sight->level_q8[k] = LM_LEVEL_SHADOW;
    }
    sight->horizon[0] = start;
    if (i < cells) {
        const struct neon_hidden some = neon_hidden_at(i, grid->first);
        neon_cells(grid, line, &l, &some, i, &before, sight, behind_shore);
    }
    const struct neon_hidden none = {{vdupq_n_u32(0), vdupq_n_u32(0)}, vdup_n_u8(0)};
    for (i += 8; i < cells; i += 8) {
        neon_cells(grid, line, &l, &none, i, &before, sight, behind_shore);
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
