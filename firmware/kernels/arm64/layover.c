#include <stdbool.h>

#include "../plain.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/level.h"
#include "neon.h"

/* Levels are words of 16 bits here, counted from LM_LEVEL_SHADOW up: nothing is below it, eight lie
 * in a vector, and a share is one subtraction that ends at 0. */

enum {
    GROUP = 16,
    NOWHERE = INT16_MAX, /* displacement of a cell without power */
    REACH_16THS = 32     /* what one pass takes: displacements up to two cells apart */
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
    uint16_t *level; /* of cell 0; nothing is there yet from entry `filled` on */
    int32_t filled;
};

/* Sixteen cells, of which `number` is the first. */
struct group {
    const uint32_t *cell;
    const int32_t *elevation_m_q14;
    const int16_t *level_db_q8;
    int32_t number;
};

/* Part of a group, as in c/layover.c. */
struct pass {
    int32_t first;
    uint32_t most_16ths;
    uint8x16_t place_16ths; /* 0..32; anything above for those that take no part */
};

/* Look up sixteen bytes in a row of a table. The compiler must not load it before `after` is known:
 * it has no registers for several rows, and would copy them to the stack and back. */
static inline uint8x16_t look_up(const uint8_t row[64], uint8x16_t after, uint8x16_t place)
{
    __asm__("" : "+r"(row) : "w"(after));
    return vqtbl4q_u8(vld1q_u8_x4(row), place);
}

static inline uint16x8x2_t load_16(const uint16_t *from)
{
    return (uint16x8x2_t){{vld1q_u16(from), vld1q_u16(from + 8)}};
}

static inline void store_16(uint16_t *to, uint16x8x2_t x)
{
    vst1q_u16(to, x.val[0]);
    vst1q_u16(to + 8, x.val[1]);
}

/* fx_db_q8_sum_vec of sixteen. */
static inline uint16x8x2_t sum_16(uint16x8x2_t a, uint16x8x2_t b)
{
    const struct neon_db_sum at =
        neon_db_sum_of_16(vabdq_u16(a.val[0], b.val[0]), vabdq_u16(a.val[1], b.val[1]));
    const uint8x16_t low = look_up(fx_table_db_sum_lines[0], at.line, at.line);
    const uint8x16_t high = look_up(fx_table_db_sum_lines[1], low, at.line);
    const uint8x16_t fall = look_up(fx_table_db_sum_lines[2], high, at.line);
    const uint16x8x2_t more_q13 = neon_db_sum_more_q13(low, high, fall, at.place);
    return (uint16x8x2_t){{vsraq_n_u16(vmaxq_u16(a.val[0], b.val[0]), more_q13.val[0], 5),
                           vsraq_n_u16(vmaxq_u16(a.val[1], b.val[1]), more_q13.val[1], 5)}};
}

/* Saturated to 16 bits. */
static inline int16x8x2_t narrow_16(int32x4x4_t x)
{
    return (int16x8x2_t){{vqmovn_high_s32(vqmovn_s32(x.val[0]), x.val[1]),
                          vqmovn_high_s32(vqmovn_s32(x.val[2]), x.val[3])}};
}

/* How far the cells of a group are displaced away from the radar, in sixteenths of a cell. */
static inline int16x8x2_t displace(const struct tables *t, const struct lm_k_layover *l,
                                   const struct group *g, int16x8x2_t level_db_q8)
{
    const int32x4_t reference = vdupq_n_s32(l->reference_m_q14);
    const uint8x16_t code =
        vandq_u8(neon_lower_bytes(neon_lower_halves(vld1q_u32_x4(g->cell))), vdupq_n_u8(15));
    const uint16x8x2_t height = neon_words_of_16(t->height, code);
    const int16x8_t dark = vdupq_n_s16(LM_LEVEL_SHADOW / 2);
    int32x4x4_t terrain = neon_load_8_and_8(g->elevation_m_q14, g->elevation_m_q14 + 8);
    for (size_t k = 0; k < 4; k++) {
        terrain.val[k] = vqrdmulhq_n_s32(vsubq_s32(reference, terrain.val[k]), l->sixteenths_q31);
    }
    int16x8x2_t away = narrow_16(terrain);
    for (size_t n = 0; n < 2; n++) {
        away.val[n] = vbslq_s16(vcleq_s16(level_db_q8.val[n], dark), vdupq_n_s16(NOWHERE),
                                vqsubq_s16(away.val[n], vreinterpretq_s16_u16(height.val[n])));
    }
    return away;
}

/* Take the cells out of a group that are displaced least, `least` sixteenths, where some are;
 * *is_last if there are no others. */
static inline void take(struct pass *p, int32_t group, int32_t least, int16x8x2_t *away_16ths,
                        bool *is_last)
{
    const int16x8_t base = vdupq_n_s16((int16_t)(least & ~15));
    const int16x8_t beyond[2] = {vqsubq_s16(away_16ths->val[0], base),
                                 vqsubq_s16(away_16ths->val[1], base)};
    p->first = group + (least >> 4);
    p->place_16ths = vqmovun_high_s16(vqmovun_s16(beyond[0]), beyond[1]);
    p->most_16ths = vmaxvq_u8(p->place_16ths);
    *is_last = p->most_16ths <= REACH_16THS;
    if (!*is_last) {
        const int16x8_t reach = vdupq_n_s16(REACH_16THS), nowhere = vdupq_n_s16(NOWHERE);
        const uint8x16_t is_now = vcleq_u8(p->place_16ths, vdupq_n_u8(REACH_16THS));
        p->most_16ths = vmaxvq_u8(vandq_u8(p->place_16ths, is_now));
        for (size_t n = 0; n < 2; n++) {
            away_16ths->val[n] =
                vbslq_s16(vcleq_s16(beyond[n], reach), nowhere, away_16ths->val[n]);
        }
    }
}

/* Shares of powers. `below` is what the levels lack to the highest one, 65535. */
static inline uint16x8x2_t share(const struct tables *t, uint16x8x2_t below, uint8x16_t gone_16ths)
{
    const uint16x8x2_t left = neon_words_of_16(t->share, gone_16ths);
    return (uint16x8x2_t){
        {vqsubq_u16(left.val[0], below.val[0]), vqsubq_u16(left.val[1], below.val[1])}};
}

/* Sixteen numbers from `lanes` lanes before the first one on. */
static inline uint16x8x2_t from_before(uint16x8_t before, uint16x8x2_t x, const int lanes)
{
    if (lanes == 1) {
        return (uint16x8x2_t){{vextq_u16(before, x.val[0], 7), vextq_u16(x.val[0], x.val[1], 7)}};
    }
    return (uint16x8x2_t){{vextq_u16(before, x.val[0], 6), vextq_u16(x.val[0], x.val[1], 6)}};
}

/* The number, of which the compiler must not see that others use it: it would work out for each
 * pass what few need. */
static inline int32_t apart(int32_t x)
{
    __asm__("" : "+r"(x));
    return x;
}

/* Put an entry where nothing is yet, or add it to what is there. */
static inline void put(uint16_t *to, uint32_t level, bool is_new)
{
    *to = (uint16_t)(is_new ? level : (uint32_t)fx_db_q8_sum_vec((int32_t)level, *to));
}

static inline void put_16(uint16_t *to, uint16x8x2_t sum, bool is_new)
{
    store_16(to, is_new ? sum : sum_16(sum, load_16(to)));
}

/* Add a group of which no cell moves by more than one cell beyond the first. */
static inline void add_two(struct laid *laid, const struct tables *t, const struct pass *p,
                           uint16x8x2_t below)
{
    const int32_t first = apart(p->first);
    uint16_t *const to = laid->level + first;
    const bool is_new = first + 1 >= laid->filled;
    const uint16x8_t before = vdupq_n_u16(is_new ? to[0] : 0);
    const uint16x8x2_t next = share(t, below, vabdq_u8(p->place_16ths, vdupq_n_u8(16)));
    const uint16x8x2_t own = share(t, below, p->place_16ths);
    put_16(to, sum_16(own, from_before(before, next, 1)), is_new);
    put(to + GROUP, vgetq_lane_u16(next.val[1], 7), is_new);
    laid->filled = fx_max_i32(laid->filled, first + 1 + GROUP);
}

static inline void add_three(struct laid *laid, const struct tables *t, const struct pass *p,
                             uint16x8x2_t below)
{
    const int32_t first = apart(p->first);
    uint16_t *const to = laid->level + first;
    const bool is_new = first + 2 >= laid->filled;
    const uint16x8_t before = vdupq_n_u16(is_new ? to[0] : 0);
    const uint16x8_t before_second = vsetq_lane_u16(is_new ? to[1] : 0, vdupq_n_u16(0), 7);
    const uint16x8x2_t next = share(t, below, vabdq_u8(p->place_16ths, vdupq_n_u8(16)));
    const uint16x8x2_t second = share(t, below, vsubq_u8(vdupq_n_u8(32), p->place_16ths));
    const uint16x8x2_t own = share(t, below, p->place_16ths);
    const uint16x8x2_t sum = sum_16(own, from_before(before, next, 1));
    put_16(to, sum_16(sum, from_before(before_second, second, 2)), is_new);
    put(to + GROUP,
        (uint32_t)fx_db_q8_sum_vec(vgetq_lane_u16(next.val[1], 7),
                                   vgetq_lane_u16(second.val[1], 6)),
        is_new);
    put(to + GROUP + 1, vgetq_lane_u16(second.val[1], 7), is_new);
    laid->filled = fx_max_i32(laid->filled, first + 2 + GROUP);
}

static inline void lay(struct laid *laid, const struct tables *t, const struct pass *p,
                       uint16x8x2_t below)
{
    if (p->most_16ths == 0 && p->first >= laid->filled) {
        store_16(laid->level + p->first, share(t, below, p->place_16ths));
        laid->filled = p->first + GROUP;
    } else if (p->most_16ths <= 16) {
        add_two(laid, t, p, below);
    } else {
        add_three(laid, t, p, below);
    }
}

static inline struct tables load_tables(const struct lm_k_layover *line)
{
    return (struct tables){
        .share = {vld1q_u8(shares_db_q8[0]), vld1q_u8(shares_db_q8[1])},
        .height = {vld1q_u8(line->height_sixteenths[0]), vld1q_u8(line->height_sixteenths[1])}};
}

static inline int32_t least_of(int16x8x2_t away_16ths)
{
    return vminvq_s16(vminq_s16(away_16ths.val[0], away_16ths.val[1]));
}

/* Lay a group of sixteen cells over the line, of that many cells. Those without power go along with
 * the first pass: they have no share to give, and ask for no pass of their own. */
static inline void lay_group(struct laid *laid, const struct tables *t,
                             const struct lm_k_layover *line, const struct group *g,
                             uint32_t displayed)
{
    const int16x8_t most = vdupq_n_s16(LM_K_LAYOVER_MOST_DB_Q8);
    int16x8x2_t level_db_q8 = vld1q_s16_x2(g->level_db_q8);
    int16x8x2_t away_16ths = displace(t, line, g, level_db_q8);
    uint16x8x2_t below;
    struct pass p;
    int32_t least = least_of(away_16ths);
    if (least == NOWHERE) {
        return;
    }
    bool is_last = false;
    for (size_t n = 0; n < 2; n++) {
        const uint16x8_t is_nowhere = vceqq_s16(away_16ths.val[n], vdupq_n_s16(NOWHERE));
        level_db_q8.val[n] = vminq_s16(level_db_q8.val[n], most);
        below.val[n] = veorq_u16(vreinterpretq_u16_s16(level_db_q8.val[n]), vdupq_n_u16(INT16_MAX));
        below.val[n] = vorrq_u16(below.val[n], is_nowhere);
        away_16ths.val[n] = vbslq_s16(is_nowhere, vdupq_n_s16((int16_t)least), away_16ths.val[n]);
    }
    while (!is_last) {
        take(&p, g->number, least, &away_16ths, &is_last);
        if ((uint32_t)(p.first + LM_K_LAYOVER_MARGIN) < displayed) {
            lay(laid, t, &p, below);
        }
        if (is_last) {
            return;
        }
        least = least_of(away_16ths);
        is_last = least == NOWHERE;
    }
}

/* Make levels of the words of a line, in place. */
static inline void count_from_0(uint16_t *word, int32_t count)
{
    const uint16x8_t shadow = vdupq_n_u16((uint16_t)LM_LEVEL_SHADOW);
    for (int32_t i = 0; i < count; i += GROUP) {
        const uint16x8x2_t levels = load_16(word + i);
        store_16(word + i, (uint16x8x2_t){{veorq_u16(levels.val[0], shadow),
                                           veorq_u16(levels.val[1], shadow)}});
    }
}

void lm_k_layover(const struct lm_k_layover *lent, int16_t *laid_db_q8)
{
    const struct lm_k_layover copy = *lent, *const line = &copy; /* no store can change it */
    const int32_t margin = LM_K_LAYOVER_MARGIN, cells = (int32_t)line->cells;
    const struct tables tables = load_tables(line);
    uint16_t *const word = (uint16_t *)laid_db_q8;
    struct laid laid = {word + margin, -margin};
    const uint16x8x2_t dark = {{vdupq_n_u16(0), vdupq_n_u16(0)}};
    for (int32_t i = 0; i < margin + cells + margin; i += GROUP) {
        store_16(word + i, dark);
    }
    struct group g = {line->cell, line->elevation_m_q14, line->level_db_q8, 0};
    for (; g.number < cells; g.number += GROUP) {
        lay_group(&laid, &tables, line, &g, line->cells + LM_K_LAYOVER_MARGIN);
        g.cell += GROUP;
        g.elevation_m_q14 += GROUP;
        g.level_db_q8 += GROUP;
    }
    count_from_0(word + margin, cells);
}
