#include "../plain.h"
#include "../shore.h"
#include "fx/bits.h"
#include "lm/tile_point.h"
#include "neon.h"

/* Sixteen cells a turn from the map to their levels, for so many bytes a vector holds. What
 * c/light.c does in several loops is one here, and small tables are held in registers.
 *
 * A turn's cells stand in columns: a vector of four has every fourth, so that three of four cells
 * find the one before them in the vector before. Bytes and halves have the same order: first
 * cells 0, 4, 8, 12, then 1, 5, 9, 13. Loads and stores of four vectors bring it about. */

enum { NEON_CELLS = 16 }; /* that a turn takes */

_Static_assert(LM_CELLS_MAX % NEON_CELLS == 0, "a whole number of turns fits in a line's arrays");
_Static_assert(LM_K_CODES == 16, "a vector looks up all codes at once");

/* Heights of the codes and gains of the classes, lower bytes and upper bytes; edges of the marks,
 * marks of the classes; where a cell's neighbour before it stands;
 * steps of the reflectivity and of edges. */
struct neon_class_lut {
    uint8x16_t height_dm[2], gain_db_q8[2], edge_db_q3, mark, one_before, step, eighth;
};

/* What a turn takes over from the one before it: its last four horizons, its marks; and marks of
 * all cells so far that were left. */
struct neon_before {
    int32x4_t horizon;
    uint8x16_t mark, left;
};

/* Which cells of a turn are not shown: all bits of them are set. */
struct neon_hidden {
    uint32x4x4_t words;
    uint8x16_t bytes;
};

/* Where a turn's cells are. */
struct neon_place {
    const uint32_t *cell, *elevation_m_q14, *fall_m_q14;
    const int16_t *gain_db_q8;
    const int32_t *inverse_range;
    int32_t *horizon;
    int16_t *level_db_q8;
    uint8_t *behind_shore;
};

/* Where a cell's neighbour before it stands among sixteen; the first one's is in the turn before.
 */
static const uint8_t one_before[NEON_CELLS] = {0, 12, 13, 14, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

static inline struct neon_class_lut neon_class_lut_of(const struct lm_k_lit_line *line)
{
    struct neon_class_lut l;
    neon_set_bytes(l.height_dm, line->tops.height_dm_of_code);
    neon_set_bytes(l.gain_db_q8, (const uint16_t *)line->class_gain_db_q8);
    l.edge_db_q3 = vsetq_lane_u8(line->edge_structure_db_q3, vdupq_n_u8(0), LM_K_STRUCTURE);
    l.edge_db_q3 = vsetq_lane_u8(line->edge_trees_db_q3, l.edge_db_q3, LM_K_TREES);
    l.mark = vld1q_u8(line->mark_of_class);
    l.one_before = vld1q_u8(one_before);
    l.step = vdupq_n_u8(LM_GAMMA_CODE_STEP_DB_Q8);
    l.eighth = vdupq_n_u8(32);
    /* Else one is loaded with its address each turn, and the others set, once for each half. */
    __asm__("" : "+w"(l.one_before), "+w"(l.step), "+w"(l.eighth));
    return l;
}

/* lm_k_tangent of sixteen cells whose height codes are given. */
static inline int32x4x4_t neon_tangents(const struct neon_class_lut *l, const struct neon_place *at,
                                        uint8x16_t code)
{
    const uint16x8x2_t height_dm = neon_words_of_16(l->height_dm, code);
    const uint32x4x4_t foot_q14 = vld4q_u32(at->elevation_m_q14);
    const uint32x4x4_t fall_m_q14 = vld4q_u32(at->fall_m_q14);
    const int32x4x4_t inverse_range = vld4q_s32(at->inverse_range);
    int32x4x4_t tangent;
    for (size_t n = 0; n < 4; n++) {
        const uint16x8_t pair_dm = height_dm.val[n / 2];
        const uint32x4_t height_m_q19 = n % 2 ? vmull_high_n_u16(pair_dm, LM_K_Q19_OF_DM)
                                              : vmull_n_u16(vget_low_u16(pair_dm), LM_K_Q19_OF_DM);
        const uint32x4_t apparent_m_q14 =
            vsraq_n_u32(vsubq_u32(foot_q14.val[n], fall_m_q14.val[n]), height_m_q19, 5);
        /* Twice the product's upper half. */
        tangent.val[n] = vqdmulhq_s32(vreinterpretq_s32_u32(apparent_m_q14), inverse_range.val[n]);
    }
    return tangent;
}

/* The horizons before each column of four, whose highest tangents are given. A horizon never falls:
 * what is shifted in beside the last one, of cells before it, changes nothing. */
static inline int32x4_t neon_before_columns(int32x4_t horizon, int32x4_t highest)
{
    const int32x4_t one = vextq_s32(horizon, highest, 3);
    const int32x4_t two = vmaxq_s32(one, vextq_s32(horizon, one, 3));
    return vmaxq_s32(two, vextq_s32(horizon, two, 2));
}

/* vst4q_s32, and on: gcc 12 would put four vectors together on the stack, or copy each. */
static inline int32_t *neon_store_columns(int32_t *to, int32x4x4_t x)
{
    register int32x4_t first __asm__("v20") = x.val[0], second __asm__("v21") = x.val[1],
                             third __asm__("v22") = x.val[2], fourth __asm__("v23") = x.val[3];
    __asm__ volatile("st4 {%1.4s, %2.4s, %3.4s, %4.4s}, [%0], #64"
                     : "+r"(to)
                     : "w"(first), "w"(second), "w"(third), "w"(fourth)
                     : "memory");
    return to;
}

/* vst2q_s16 likewise. */
static inline int16_t *neon_store_pairs(int16_t *to, int16x8x2_t x)
{
    register int16x8_t even __asm__("v20") = x.val[0], odd __asm__("v21") = x.val[1];
    __asm__ volatile("st2 {%1.8h, %2.8h}, [%0], #32" : "+r"(to) : "w"(even), "w"(odd) : "memory");
    return to;
}

/* Store the horizons behind sixteen cells. Returns by how much the horizon rises over each. */
static inline uint32x4x4_t neon_rise(struct neon_before *b, int32x4x4_t tangent, int32_t **to)
{
    int32x4x4_t horizon = tangent;
    uint32x4x4_t rise;
    for (size_t n = 1; n < 4; n++) {
        horizon.val[n] = vmaxq_s32(horizon.val[n - 1], tangent.val[n]);
    }
    const int32x4_t first = neon_before_columns(b->horizon, horizon.val[3]);
    int32x4_t before = first;
    for (size_t n = 0; n < 4; n++) {
        horizon.val[n] = vmaxq_s32(horizon.val[n], first);
        rise.val[n] = vreinterpretq_u32_s32(vsubq_s32(horizon.val[n], before));
        before = horizon.val[n];
    }
    b->horizon = before;
    *to = neon_store_columns(*to, horizon);
    return rise;
}

/* Brightness of the leading edges of cells whose classes are given, of which the hidden ones change
 * nothing; *left gets the mark of water behind a shore. */
static inline uint8x16_t neon_edges(const struct neon_class_lut *l, struct neon_before *b,
                                    uint8x16_t hidden, uint8x16_t class_index, uint8x16_t *left)
{
    const uint8x16_t mark = vbslq_u8(hidden, b->mark, vqtbl1q_u8(l->mark, class_index));
    const uint8x16_t before = vcopyq_laneq_u8(vqtbl1q_u8(mark, l->one_before), 0, b->mark, 15);
    b->mark = mark;
    *left = vbicq_u8(before, mark);
    b->left = vorrq_u8(b->left, *left);
    return vqtbl1q_u8(l->edge_db_q3, vbicq_u8(mark, before));
}

/* What the cells show but for gain: edge, reflectivity and the horizon's rise. `more_q8` is that of
 * the cells' upper halves, which may be negative and wraps. */
static inline struct neon_levels neon_shown(const struct neon_class_lut *l, uint8x16_t edge_db_q3,
                                            uint16x8x2_t cells, uint16x8x2_t more_q8,
                                            uint32x4x4_t rise)
{
    const uint8x16_t gamma =
        vuzp2q_u8(vreinterpretq_u8_u16(cells.val[0]), vreinterpretq_u8_u16(cells.val[1]));
    /* The upper byte times LM_GAMMA_CODE_STEP_DB_Q8. With LM_EDGE_MAX_DB_Q8 and the rise's decibels
     * it takes 16 bits: 32640 + 8160 + 24659. */
    const uint16x8x2_t own_q8 = {
        {vmlal_u8(vmlal_u8(more_q8.val[0], vget_low_u8(gamma), vget_low_u8(l->step)),
                  vget_low_u8(edge_db_q3), vget_low_u8(l->eighth)),
         vmlal_high_u8(vmlal_high_u8(more_q8.val[1], gamma, l->step), edge_db_q3, l->eighth)}};
    return neon_add_db_q8_of_16(own_q8, neon_octaves_of(rise));
}

/* The gains of place of sixteen cells. */
static inline int16x8x2_t neon_gains(const int16_t *gain_db_q8)
{
    const int16x8x2_t pairs = vld2q_s16(gain_db_q8);
    return vuzpq_s16(pairs.val[0], pairs.val[1]);
}

/* Store the levels of sixteen cells: what they show, of which LM_LEVEL_SHADOW is 0, and the gains
 * of place and class. */
static inline void neon_store_levels(struct neon_place *at, struct neon_levels shown,
                                     uint16x8x2_t class_gain_db_q8)
{
    const int16x8x2_t gain_db_q8 = neon_gains(at->gain_db_q8);
    int16x8_t level_q8[2];
    for (size_t n = 0; n < 2; n++) {
        const int16x8_t gain_q8 =
            vqaddq_s16(gain_db_q8.val[n], vreinterpretq_s16_u16(class_gain_db_q8.val[n]));
        const int16x8_t shown_q8 = vreinterpretq_s16_u16(
            vaddq_u16(shown.level_db_q8.val[n], vdupq_n_u16(0x8000 + NEON_31_OCTAVES_DB_Q8)));
        level_q8[n] = vbslq_s16(shown.is_none[n], vdupq_n_s16(LM_LEVEL_SHADOW),
                                vqaddq_s16(shown_q8, gain_q8));
    }
    /* Those of even numbers, and those of odd ones. */
    at->level_db_q8 = neon_store_pairs(at->level_db_q8, vzipq_s16(level_q8[0], level_q8[1]));
}

/* Sixteen cells; their horizon, level and whether they are behind a shore are stored. */
static inline __attribute__((always_inline)) void neon_cells(const struct neon_class_lut *l,
                                                             const struct neon_hidden *hidden,
                                                             struct neon_before *b,
                                                             struct neon_place *at)
{
    const uint32x4x4_t words = vld4q_u32(at->cell);
    const uint16x8x2_t cells = neon_lower_halves(words);
    const uint8x16_t lower = neon_lower_bytes(cells);
    int32x4x4_t seen = neon_tangents(l, at, vandq_u8(lower, vdupq_n_u8(LM_K_CODES - 1)));
    for (size_t n = 0; n < 4; n++) {
        seen.val[n] = vbslq_s32(hidden->words.val[n], vdupq_n_s32(INT32_MIN), seen.val[n]);
    }
    const uint32x4x4_t rise = neon_rise(b, seen, &at->horizon);
    uint8x16_t left;
    const uint8x16_t class_index = vshrq_n_u8(lower, 4);
    const uint8x16_t edge_db_q3 = neon_edges(l, b, hidden->bytes, class_index, &left);
    vst1q_u8(at->behind_shore, left);
    neon_store_levels(at, neon_shown(l, edge_db_q3, cells, neon_upper_halves(words), rise),
                      neon_words_of_16(l->gain_db_q8, class_index));
    at->cell += NEON_CELLS;
    at->elevation_m_q14 += NEON_CELLS;
    at->fall_m_q14 += NEON_CELLS;
    at->gain_db_q8 += NEON_CELLS;
    at->inverse_range += NEON_CELLS;
    at->behind_shore += NEON_CELLS;
    /* Else the compiler would add up one distance and, with it, five addresses. */
    __asm__(""
            : "+r"(at->cell), "+r"(at->elevation_m_q14), "+r"(at->fall_m_q14), "+r"(at->gain_db_q8),
              "+r"(at->inverse_range));
}

/* The first `count` cells of a turn. */
static inline struct neon_hidden neon_hide(uint32_t count)
{
    static const uint32_t number[4] = {0, 4, 8, 12};
    struct neon_hidden h;
    for (uint32_t n = 0; n < 4; n++) {
        h.words.val[n] =
            vcltq_u32(vaddq_u32(vld1q_u32(number), vdupq_n_u32(n)), vdupq_n_u32(count));
    }
    h.bytes = neon_lower_bytes(neon_lower_halves(h.words));
    return h;
}

/* The marks of eight cells. */
static inline uint64_t neon_marks(const struct lm_k_lit_line *line, uint32_t i)
{
    const uint32_t *cell = line->tops.cell + i;
    const uint16x8_t halves = vuzp1q_u16(vreinterpretq_u16_u32(vld1q_u32(cell)),
                                         vreinterpretq_u16_u32(vld1q_u32(cell + 4)));
    const uint8x8_t class_index = vshr_n_u8(vmovn_u16(halves), 4);
    const uint8x8_t mark = vqtbl1_u8(vld1q_u8(line->mark_of_class), class_index);
    return vget_lane_u64(vreinterpret_u64_u8(mark), 0);
}

/* Add to eight levels what is positive of the shore, where there is light. */
static inline void neon_brighten(int16_t *level_db_q8, int32x4_t low_db_q8, int32x4_t high_db_q8)
{
    const int16x8_t old_q8 = vld1q_s16(level_db_q8), zero = vdupq_n_s16(0);
    const uint16x8_t is_dark = vceqq_s16(old_q8, vdupq_n_s16(LM_LEVEL_SHADOW));
    const int16x8_t shore_q8 = vmaxq_s16(neon_held_8(low_db_q8, high_db_q8), zero);
    vst1q_s16(level_db_q8, vqaddq_s16(old_q8, vbslq_s16(is_dark, zero, shore_q8)));
}

/* The shore from cell i on: whole groups of eight cells without water, and then one by one. */
static inline void neon_add_shore(const struct lm_k_lit_line *line, uint32_t i)
{
    static const int32_t number[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const int32_t fall_db_q8 = line->shore_fall_db_q8;
    int32_t shore_db_q8 = line->shore_db_q8;
    for (; i + 8 <= line->tops.cells && shore_db_q8 > 0; i += 8, shore_db_q8 -= 8 * fall_db_q8) {
        if ((neon_marks(line, i) & EACH_IS_WATER) != 0) {
            break;
        }
        const int32x4_t all_q8 = vdupq_n_s32(shore_db_q8);
        neon_brighten(line->level_db_q8 + i, vmlsq_n_s32(all_q8, vld1q_s32(number), fall_db_q8),
                      vmlsq_n_s32(all_q8, vld1q_s32(number + 4), fall_db_q8));
    }
    add_shore(line, i, shore_db_q8);
}

/* Shores behind eight cells from `first` on, each of which has a byte of `eight`. */
static inline void neon_add_shores(const struct lm_k_lit_line *line, uint64_t eight, uint32_t first)
{
    for (uint64_t left = eight & EACH_IS_WATER; left != 0; left &= left - 1) {
        neon_add_shore(line, first + (uint32_t)fx_ctz64(left) / 8);
    }
}

/* Where the bytes of sixteen cells stand. */
static const uint8_t row_of_columns[NEON_CELLS] = {0, 4, 8,  12, 1, 5, 9,  13,
                                                   2, 6, 10, 14, 3, 7, 11, 15};

/* Shores are rare: they are looked for where a stretch, which may end behind the line, has one.
 * Each cell has a byte, from those of `first` on. */
static inline void neon_shores(const struct lm_k_lit_line *line, const uint8_t *behind_shore,
                               uint32_t first)
{
    const uint8_t *const end = behind_shore + line->tops.cells;
    for (const uint8_t *at = behind_shore + first; at < end;) {
        const uint8x16x2_t left = vld1q_u8_x2(at);
        const uint8x16_t some = vshlq_n_u8(vorrq_u8(left.val[0], left.val[1]), 7);
        at += LM_K_SHORE_STRETCH;
        if (neon_any(some)) {
            const uint32_t behind = (uint32_t)(at - behind_shore);
            for (uint32_t i = behind - LM_K_SHORE_STRETCH; i < behind; i += NEON_CELLS) {
                const uint64x2_t eights = vreinterpretq_u64_u8(
                    vqtbl1q_u8(vld1q_u8(behind_shore + i), vld1q_u8(row_of_columns)));
                neon_add_shores(line, vgetq_lane_u64(eights, 0), i);
                neon_add_shores(line, vgetq_lane_u64(eights, 1), i + 8);
            }
        }
    }
}

/* What the first turn compares its cells with. */
static inline struct neon_before neon_before_of(const struct lm_k_lit_line *line)
{
    const int32x4_t all = vdupq_n_s32(line->start);
    const uint32_t class_index = line->tops.cell[line->tops.first] >> 4 & (LM_K_CODES - 1);
    return (struct neon_before){all, vdupq_n_u8(line->mark_of_class[class_index]), vdupq_n_u8(0)};
}

void lm_k_light(const struct lm_k_lit_line *line)
{
    uint8_t behind_shore[LM_CELLS_MAX + LM_K_SHORE_STRETCH];
    const struct lm_k_tops *const tops = &line->tops;
    const size_t hidden = tops->first % NEON_CELLS, first = tops->first - hidden;
    int32_t *const horizon = line->horizon;
    int16_t *const level_db_q8 = line->level_db_q8;
    horizon[0] = line->start;
    for (size_t k = 0; k < first; k++) {
        horizon[k + 1] = line->start;
        level_db_q8[k] = LM_LEVEL_SHADOW;
    }
    const struct neon_class_lut l = neon_class_lut_of(line);
    struct neon_before before = neon_before_of(line);
    struct neon_place at = {.cell = tops->cell + first,
                            .elevation_m_q14 = (const uint32_t *)tops->elevation_m_q14 + first,
                            .fall_m_q14 = (const uint32_t *)tops->fall_m_q14 + first,
                            .gain_db_q8 = line->gain_db_q8 + first,
                            .inverse_range = tops->inverse_range + first,
                            .horizon = horizon + first + 1,
                            .level_db_q8 = level_db_q8 + first,
                            .behind_shore = behind_shore + first};
    const uint32_t *const end = tops->cell + tops->cells;
    if (hidden != 0) {
        const struct neon_hidden some = neon_hide((uint32_t)hidden);
        neon_cells(&l, &some, &before, &at);
    }
    const uint32x4_t zero = vdupq_n_u32(0);
    const struct neon_hidden none = {{{zero, zero, zero, zero}}, vdupq_n_u8(0)};
    while (at.cell < end) {
        neon_cells(&l, &none, &before, &at);
    }
    if (neon_any(vtstq_u8(before.left, vdupq_n_u8(LM_K_WATER)))) {
        vst1q_u8(at.behind_shore, vdupq_n_u8(0)); /* looked at with an odd number of turns */
        neon_shores(line, behind_shore, (uint32_t)first);
    }
}

static inline int32x4_t neon_highest_of(int32x4_t highest, int32x4x4_t tangent)
{
    return vmaxq_s32(highest, vmaxq_s32(vmaxq_s32(tangent.val[0], tangent.val[1]),
                                        vmaxq_s32(tangent.val[2], tangent.val[3])));
}

/* The last turn ends with the line and takes some cells once more. */
int32_t lm_k_highest_tangent(const struct lm_k_tops *tops)
{
    if (tops->cells - tops->first < NEON_CELLS) {
        return lm_k_highest_tangent_c(tops);
    }
    const uint32_t last = tops->cells - NEON_CELLS;
    struct neon_class_lut l;
    neon_set_bytes(l.height_dm, tops->height_dm_of_code);
    int32x4_t highest = vdupq_n_s32(INT32_MIN);
    for (uint32_t i = tops->first, end = 0; end < tops->cells; i = end) {
        const uint32_t begin = i < last ? i : last;
        const struct neon_place at = {.elevation_m_q14 =
                                          (const uint32_t *)tops->elevation_m_q14 + begin,
                                      .fall_m_q14 = (const uint32_t *)tops->fall_m_q14 + begin,
                                      .inverse_range = tops->inverse_range + begin};
        const uint8x16_t lower = neon_lower_bytes(neon_lower_halves(vld4q_u32(tops->cell + begin)));
        highest = neon_highest_of(
            highest, neon_tangents(&l, &at, vandq_u8(lower, vdupq_n_u8(LM_K_CODES - 1))));
        end = begin + NEON_CELLS;
    }
    return vmaxvq_s32(highest);
}
