#include <stdbool.h>

#include "../plain.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/level.h"
#include "neon.h"

enum {
    GROUP = 16,
    NOWHERE = INT16_MAX,        /* displacement of a cell without power */
    REACH_16THS = 32,           /* what one pass takes: displacements up to two cells apart */
    NOTHING_DB_Q8 = -(1 << 17), /* below every share */
    ALL_DB_Q8 = 65535
};

/* 65535 and 10 log10 of 1 - n / 16: lower bytes, upper bytes. A number above 15 looks up 0. */
static const uint8_t shares_db_q8[2][16] = {
    {255, 183, 107, 24, 191, 94, 244, 127, 252, 104, 189, 242, 250, 186, 247, 244},
    {255, 255, 255, 255, 254, 254, 253, 253, 252, 252, 251, 250, 249, 248, 246, 243}};

/* Tables that stay in registers. Those of sums are loaded each time: they take twelve. */
struct tables {
    uint8x16_t share[2], height[2];
};

/* The line as it is laid over. */
struct laid {
    int32_t *level_db_q8; /* of cell 0; nothing is there yet from entry `filled` on */
    int32_t filled;
};

/* Part of a group, as in c/layover.c. */
struct pass {
    int32_t first, most_16ths;
    uint8x16_t place_16ths; /* 0..32; anything above for those that take no part */
};

static inline int32x4x4_t load_16(const int32_t *from)
{
    return neon_load_8_and_8(from, from + 8);
}

static inline void store_16(int32_t *to, int32x4x4_t x)
{
    neon_store_8_and_8(to, to + 8, x);
}

/* Look up sixteen bytes in a row of a table. The compiler must not load it before `after` is known:
 * it has no registers for several rows, and would copy them to the stack and back. */
static inline uint8x16_t look_up(const uint8_t row[64], uint8x16_t after, uint8x16_t place)
{
    __asm__("" : "+r"(row) : "w"(after));
    return vqtbl4q_u8(vld1q_u8_x4(row), place);
}

static inline int32x4x4_t sum_16(int32x4x4_t a_q8, int32x4x4_t b_q8)
{
    const struct neon_db_sum at = neon_db_sum_of(a_q8, b_q8);
    const uint8x16_t low = look_up(fx_table_db_sum_lines[0], at.line, at.line);
    const uint8x16_t high = look_up(fx_table_db_sum_lines[1], low, at.line);
    const uint8x16_t fall = look_up(fx_table_db_sum_lines[2], high, at.line);
    return neon_db_sum_raise(low, high, fall, at.place, a_q8, b_q8);
}

/* Saturated to 16 bits. */
static inline int16x8x2_t narrow_16(int32x4x4_t x)
{
    return (int16x8x2_t){{vqmovn_high_s32(vqmovn_s32(x.val[0]), x.val[1]),
                          vqmovn_high_s32(vqmovn_s32(x.val[2]), x.val[3])}};
}

/* How far the cells of a group are displaced away from the radar, in sixteenths of a cell. */
static inline int16x8x2_t displace(const struct tables *t, const struct lm_k_layover *l,
                                   uint32_t group, int32x4x4_t level_db_q8)
{
    const int32x4_t reference = vdupq_n_s32(l->reference_m_q14);
    const uint32_t *cell = l->cell + group;
    const uint32x4x4_t cells = {
        {vld1q_u32(cell), vld1q_u32(cell + 4), vld1q_u32(cell + 8), vld1q_u32(cell + 12)}};
    const uint8x16_t code = vandq_u8(neon_lower_bytes(neon_lower_halves(cells)), vdupq_n_u8(15));
    const uint16x8x2_t height = neon_words_of_16(t->height, code);
    const int32x4_t dark = vdupq_n_s32(LM_LEVEL_SHADOW / 2);
    int32x4x4_t terrain = load_16(l->elevation_m_q14 + group);
    uint32x4_t is_dark[4];
    for (size_t k = 0; k < 4; k++) {
        terrain.val[k] = vqrdmulhq_n_s32(vsubq_s32(reference, terrain.val[k]), l->sixteenths_q31);
        is_dark[k] = vcleq_s32(level_db_q8.val[k], dark);
    }
    int16x8x2_t away = narrow_16(terrain);
    for (size_t n = 0; n < 2; n++) {
        const uint16x8_t is_out = vuzp1q_u16(vreinterpretq_u16_u32(is_dark[2 * n]),
                                             vreinterpretq_u16_u32(is_dark[2 * n + 1]));
        away.val[n] = vbslq_s16(is_out, vdupq_n_s16(NOWHERE),
                                vqsubq_s16(away.val[n], vreinterpretq_s16_u16(height.val[n])));
    }
    return away;
}

/* Take the cells out of a group that are displaced least. False if none is left. */
static inline bool take(struct pass *p, uint32_t group, int16x8x2_t *away_16ths)
{
    const int32_t least = vminvq_s16(vminq_s16(away_16ths->val[0], away_16ths->val[1]));
    if (least == NOWHERE) {
        return false;
    }
    const int16x8_t base = vdupq_n_s16((int16_t)(least & ~15));
    const int16x8_t beyond[2] = {vqsubq_s16(away_16ths->val[0], base),
                                 vqsubq_s16(away_16ths->val[1], base)};
    const int16x8_t reach = vdupq_n_s16(REACH_16THS), nowhere = vdupq_n_s16(NOWHERE);
    p->first = (int32_t)group + (least >> 4);
    p->place_16ths = vqmovun_high_s16(vqmovun_s16(beyond[0]), beyond[1]);
    const uint8x16_t is_now = vcleq_u8(p->place_16ths, vdupq_n_u8(REACH_16THS));
    p->most_16ths = vmaxvq_u8(vandq_u8(p->place_16ths, is_now));
    for (size_t n = 0; n < 2; n++) {
        away_16ths->val[n] = vbslq_s16(vcleq_s16(beyond[n], reach), nowhere, away_16ths->val[n]);
    }
    return true;
}

/* Shares of powers, as levels. */
static inline int32x4x4_t share(const struct tables *t, int32x4x4_t level_db_q8,
                                uint8x16_t gone_16ths)
{
    const uint16x8x2_t left = neon_words_of_16(t->share, gone_16ths);
    for (size_t n = 0; n < 2; n++) {
        const uint16x8_t w = left.val[n];
        level_db_q8.val[2 * n] = vreinterpretq_s32_u32(
            vaddw_u16(vreinterpretq_u32_s32(level_db_q8.val[2 * n]), vget_low_u16(w)));
        level_db_q8.val[2 * n + 1] = vreinterpretq_s32_u32(
            vaddw_high_u16(vreinterpretq_u32_s32(level_db_q8.val[2 * n + 1]), w));
    }
    return level_db_q8;
}

/* Sixteen numbers from `lanes` lanes before the first one on. */
static inline int32x4x4_t from_before(int32x4_t before, int32x4x4_t x, const int lanes)
{
    const int32x4_t all[5] = {before, x.val[0], x.val[1], x.val[2], x.val[3]};
    int32x4x4_t moved;
    for (size_t k = 0; k < 4; k++) {
        moved.val[k] =
            lanes == 1 ? vextq_s32(all[k], all[k + 1], 3) : vextq_s32(all[k], all[k + 1], 2);
    }
    return moved;
}

static inline int32x4x4_t no_less(int32x4x4_t x, int32_t least)
{
    for (size_t k = 0; k < 4; k++) {
        x.val[k] = vmaxq_s32(x.val[k], vdupq_n_s32(least));
    }
    return x;
}

/* Add a group that moves by whole cells to where nothing is yet. */
static inline void move(struct laid *laid, const struct tables *t, const struct pass *p,
                        int32x4x4_t low_db_q8)
{
    store_16(laid->level_db_q8 + p->first,
             no_less(share(t, low_db_q8, p->place_16ths), LM_LEVEL_SHADOW));
    laid->filled = p->first + GROUP;
}

/* Put an entry where nothing is yet, or add it to what is there. */
static inline void put(int32_t *to_db_q8, int32_t level_db_q8, bool is_new)
{
    *to_db_q8 = is_new ? fx_max_i32(level_db_q8, LM_LEVEL_SHADOW)
                       : fx_db_q8_sum_vec(level_db_q8, *to_db_q8);
}

static inline void put_16(int32_t *to_db_q8, int32x4x4_t sum, bool is_new)
{
    store_16(to_db_q8, is_new ? no_less(sum, LM_LEVEL_SHADOW) : sum_16(sum, load_16(to_db_q8)));
}

/* Add a group of which no cell moves by more than one cell beyond the first. */
static inline void add_two(struct laid *laid, const struct tables *t, const struct pass *p,
                           int32x4x4_t low_db_q8)
{
    int32_t *const to_db_q8 = laid->level_db_q8 + p->first;
    const bool is_new = p->first + 1 >= laid->filled;
    const int32x4_t before = vdupq_n_s32(is_new ? to_db_q8[0] : NOTHING_DB_Q8);
    const int32x4x4_t next = share(t, low_db_q8, vabdq_u8(p->place_16ths, vdupq_n_u8(16)));
    const int32x4x4_t own = share(t, low_db_q8, p->place_16ths);
    put_16(to_db_q8, sum_16(own, from_before(before, next, 1)), is_new);
    put(to_db_q8 + GROUP, vgetq_lane_s32(next.val[3], 3), is_new);
    laid->filled = fx_max_i32(laid->filled, p->first + 1 + GROUP);
}

static inline void add_three(struct laid *laid, const struct tables *t, const struct pass *p,
                             int32x4x4_t low_db_q8)
{
    int32_t *const to_db_q8 = laid->level_db_q8 + p->first;
    const bool is_new = p->first + 2 >= laid->filled;
    const int32x4_t nothing = vdupq_n_s32(NOTHING_DB_Q8);
    const int32x4_t before = vdupq_n_s32(is_new ? to_db_q8[0] : NOTHING_DB_Q8);
    const int32x4_t before_second =
        vsetq_lane_s32(is_new ? to_db_q8[1] : NOTHING_DB_Q8, nothing, 3);
    const int32x4x4_t next = share(t, low_db_q8, vabdq_u8(p->place_16ths, vdupq_n_u8(16)));
    const int32x4x4_t second = share(t, low_db_q8, vsubq_u8(vdupq_n_u8(32), p->place_16ths));
    const int32x4x4_t own = share(t, low_db_q8, p->place_16ths);
    const int32x4x4_t sum = sum_16(own, from_before(before, next, 1));
    put_16(to_db_q8, sum_16(sum, from_before(before_second, second, 2)), is_new);
    put(to_db_q8 + GROUP,
        fx_db_q8_sum_vec(vgetq_lane_s32(next.val[3], 3), vgetq_lane_s32(second.val[3], 2)), is_new);
    put(to_db_q8 + GROUP + 1, vgetq_lane_s32(second.val[3], 3), is_new);
    laid->filled = fx_max_i32(laid->filled, p->first + 2 + GROUP);
}

static inline void lay(struct laid *laid, const struct tables *t, const struct pass *p,
                       int32x4x4_t low_db_q8)
{
    if (p->most_16ths == 0 && p->first >= laid->filled) {
        move(laid, t, p, low_db_q8);
    } else if (p->most_16ths <= 16) {
        add_two(laid, t, p, low_db_q8);
    } else {
        add_three(laid, t, p, low_db_q8);
    }
}

static inline struct tables load_tables(const struct lm_k_layover *line)
{
    return (struct tables){
        .share = {vld1q_u8(shares_db_q8[0]), vld1q_u8(shares_db_q8[1])},
        .height = {vld1q_u8(line->height_sixteenths[0]), vld1q_u8(line->height_sixteenths[1])}};
}

void lm_k_layover(const struct lm_k_layover *lent, int32_t *laid_db_q8)
{
    const struct lm_k_layover copy = *lent, *const line = &copy; /* no store can change it */
    const int32_t margin = LM_K_LAYOVER_MARGIN, cells = (int32_t)line->cells;
    const struct tables tables = load_tables(line);
    struct laid laid = {laid_db_q8 + margin, -margin};
    const int32x4_t dark = vdupq_n_s32(LM_LEVEL_SHADOW);
    const int32x4x4_t all_dark = {{dark, dark, dark, dark}};
    for (int32_t i = 0; i < margin + cells + margin; i += GROUP) {
        store_16(laid_db_q8 + i, all_dark);
    }
    for (uint32_t group = 0; group < line->cells; group += GROUP) {
        int32x4x4_t level_db_q8 = load_16(line->level_db_q8 + group);
        int16x8x2_t away_16ths = displace(&tables, line, group, level_db_q8);
        struct pass p;
        for (size_t k = 0; k < 4; k++) {
            level_db_q8.val[k] = vsubq_s32(level_db_q8.val[k], vdupq_n_s32(ALL_DB_Q8));
        }
        while (take(&p, group, &away_16ths)) {
            if (p.first >= -margin && p.first < cells) {
                lay(&laid, &tables, &p, level_db_q8);
            }
        }
    }
}
