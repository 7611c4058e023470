#include <stdbool.h>

#include "../plain.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/level.h"
#include "neon.h"

/* Shares are counted from LM_LEVEL_SHADOW up here: nothing is below it, and a share is one
 * subtraction that ends at 0. */

enum {
    GROUP = 16,
    NOWHERE = INT16_MAX, /* displacement of a cell without power */
    REACH_16THS = 32     /* what one pass takes: displacements up to two cells apart */
};

/* 65535 and 10 log10 of 1 - n / 16: lower bytes, upper bytes. A number above 15 looks up 0. */
static const uint8_t shares_db_q8[2][16] = {
    {255, 183, 107, 24, 191, 94, 244, 127, 252, 104, 189, 242, 250, 186, 247, 244},
    {255, 255, 255, 255, 254, 254, 253, 253, 252, 252, 251, 250, 249, 248, 246, 243}};

/* Tables that stay in registers. Those of sums are loaded each time: they take twelve. Where their
 * rows are stays in registers, too. */
struct tables {
    uint8x16_t share[2], height[2];
    struct neon_sum_rows sums;
};

/* The line as it is laid over. */
struct laid {
    int16_t *level_db_q8; /* of cell 0; nothing is there yet from entry `filled` on */
    int32_t filled;
};

/* Where the next sixteen cells are read from. */
struct source {
    const uint32_t *cell;
    const int32_t *elevation_m_q14;
    const int16_t *level_db_q8;
};

/* Part of a group, as in c/layover.c. */
struct pass {
    int32_t first;
    uint32_t most_16ths;
    uint8x16_t place_16ths; /* 0..32; anything above for those that take no part */
};

/* Of levels what lies above LM_LEVEL_SHADOW, or of that the levels. */
static inline uint16x8_t from_shadow(uint16x8_t x)
{
    return veorq_u16(x, vdupq_n_u16((uint16_t)LM_LEVEL_SHADOW));
}

static inline uint16x8x2_t load_16(const int16_t *from)
{
    return (uint16x8x2_t){{from_shadow(vreinterpretq_u16_s16(vld1q_s16(from))),
                           from_shadow(vreinterpretq_u16_s16(vld1q_s16(from + 8)))}};
}

static inline void store_16(int16_t *to, uint16x8x2_t x)
{
    vst1q_s16(to, vreinterpretq_s16_u16(from_shadow(x.val[0])));
    vst1q_s16(to + 8, vreinterpretq_s16_u16(from_shadow(x.val[1])));
}

/* fx_db_q8_sum_vec of sixteen. */
static inline uint16x8x2_t sum_16(const struct tables *t, uint16x8x2_t a, uint16x8x2_t b)
{
    const struct neon_db_sum at =
        neon_db_sum_of_16(vabdq_u16(a.val[0], b.val[0]), vabdq_u16(a.val[1], b.val[1]));
    const uint16x8x2_t more_q13 = neon_look_up_more_q13(&t->sums, at);
    return (uint16x8x2_t){{vsraq_n_u16(vmaxq_u16(a.val[0], b.val[0]), more_q13.val[0], 5),
                           vsraq_n_u16(vmaxq_u16(a.val[1], b.val[1]), more_q13.val[1], 5)}};
}

/* Saturated to 16 bits. */
static inline int16x8x2_t narrow_16(int32x4x4_t x)
{
    return (int16x8x2_t){{vqmovn_high_s32(vqmovn_s32(x.val[0]), x.val[1]),
                          vqmovn_high_s32(vqmovn_s32(x.val[2]), x.val[3])}};
}

/* How far the next sixteen cells are displaced away from the radar, in sixteenths of a cell: those
 * that are not dark. */
static inline int16x8x2_t displace(const struct tables *t, const struct lm_k_layover *l,
                                   struct source *s, const uint16x8_t is_dark[2])
{
    const int32x4_t reference = vdupq_n_s32(l->reference_m_q14);
    const uint8x16_t code =
        vandq_u8(neon_lower_bytes(neon_lower_halves(vld1q_u32_x4(s->cell))), vdupq_n_u8(15));
    const uint16x8x2_t height = neon_words_of_16(t->height, code);
    int32x4x4_t terrain = vld1q_s32_x4(s->elevation_m_q14);
    s->cell += GROUP;
    s->elevation_m_q14 += GROUP;
    __asm__("" : "+r"(s->cell), "+r"(s->elevation_m_q14)); /* loads move them on, no sums */
    for (size_t k = 0; k < 4; k++) {
        terrain.val[k] = vqrdmulhq_n_s32(vsubq_s32(reference, terrain.val[k]), l->sixteenths_q31);
    }
    int16x8x2_t away = narrow_16(terrain);
    for (size_t n = 0; n < 2; n++) {
        away.val[n] = vbslq_s16(is_dark[n], vdupq_n_s16(NOWHERE),
                                vqsubq_s16(away.val[n], vreinterpretq_s16_u16(height.val[n])));
    }
    return away;
}

/* Set a pass for the cells of a group that are displaced least, `least` sixteenths, where some are.
 * Returns how far each of them is beyond the first, not as far as to lose its place. */
static inline int16x8x2_t set_pass(struct pass *p, int32_t group, int32_t least,
                                   const int16x8x2_t *away_16ths)
{
    const int16x8_t base = vdupq_n_s16((int16_t)(least & ~15));
    const int16x8x2_t beyond = {
        {vqsubq_s16(away_16ths->val[0], base), vqsubq_s16(away_16ths->val[1], base)}};
    p->first = group + (least >> 4);
    p->place_16ths = vqmovun_high_s16(vqmovun_s16(beyond.val[0]), beyond.val[1]);
    p->most_16ths = vmaxvq_u8(p->place_16ths);
    return beyond;
}

/* Take the cells of a pass out of a group; *is_last if there are no others. */
static inline void take(struct pass *p, int32_t group, int32_t least, int16x8x2_t *away_16ths,
                        bool *is_last)
{
    const int16x8x2_t beyond = set_pass(p, group, least, away_16ths);
    *is_last = p->most_16ths <= REACH_16THS;
    if (!*is_last) {
        const int16x8_t reach = vdupq_n_s16(REACH_16THS), nowhere = vdupq_n_s16(NOWHERE);
        const uint8x16_t is_now = vcleq_u8(p->place_16ths, vdupq_n_u8(REACH_16THS));
        p->most_16ths = vmaxvq_u8(vandq_u8(p->place_16ths, is_now));
        for (size_t n = 0; n < 2; n++) {
            away_16ths->val[n] =
                vbslq_s16(vcleq_s16(beyond.val[n], reach), nowhere, away_16ths->val[n]);
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
static inline void put(int16_t *to, uint32_t share, bool is_new)
{
    const int32_t level_db_q8 = (int32_t)share + LM_LEVEL_SHADOW;
    *to = (int16_t)(is_new ? level_db_q8 : fx_db_q8_sum_vec(level_db_q8, *to));
}

/* What is there, as a share. */
static inline uint16_t share_at(const int16_t *from)
{
    return (uint16_t)(*from ^ LM_LEVEL_SHADOW);
}

static inline void put_16(const struct tables *t, int16_t *to, uint16x8x2_t sum, bool is_new)
{
    store_16(to, is_new ? sum : sum_16(t, sum, load_16(to)));
}

/* Add a group of which no cell moves by more than one cell beyond the first. */
static inline void add_two(struct laid *laid, const struct tables *t, const struct pass *p,
                           uint16x8x2_t below, bool is_new)
{
    const int32_t first = apart(p->first);
    int16_t *const to = laid->level_db_q8 + first;
    const uint16x8_t before = vdupq_n_u16(is_new ? share_at(to) : 0);
    const uint16x8x2_t next = share(t, below, vabdq_u8(p->place_16ths, vdupq_n_u8(16)));
    const uint16x8x2_t own = share(t, below, p->place_16ths);
    put_16(t, to, sum_16(t, own, from_before(before, next, 1)), is_new);
    put(to + GROUP, vgetq_lane_u16(next.val[1], 7), is_new);
    laid->filled = is_new ? first + 1 + GROUP : fx_max_i32(laid->filled, first + 1 + GROUP);
}

static inline void add_three(struct laid *laid, const struct tables *t, const struct pass *p,
                             uint16x8x2_t below)
{
    const int32_t first = apart(p->first);
    int16_t *const to = laid->level_db_q8 + first;
    const bool is_new = first + 2 >= laid->filled;
    const uint16x8_t before = vdupq_n_u16(is_new ? share_at(to) : 0);
    const uint16x8_t before_second =
        vsetq_lane_u16(is_new ? share_at(to + 1) : 0, vdupq_n_u16(0), 7);
    const uint16x8x2_t next = share(t, below, vabdq_u8(p->place_16ths, vdupq_n_u8(16)));
    const uint16x8x2_t second = share(t, below, vsubq_u8(vdupq_n_u8(32), p->place_16ths));
    const uint16x8x2_t own = share(t, below, p->place_16ths);
    const uint16x8x2_t sum = sum_16(t, own, from_before(before, next, 1));
    put_16(t, to, sum_16(t, sum, from_before(before_second, second, 2)), is_new);
    put(to + GROUP,
        (uint32_t)fx_db_q8_sum_vec(vgetq_lane_u16(next.val[1], 7),
                                   vgetq_lane_u16(second.val[1], 6)),
        is_new);
    put(to + GROUP + 1, vgetq_lane_u16(second.val[1], 7), is_new);
    laid->filled = fx_max_i32(laid->filled, first + 2 + GROUP);
}

/* Add a group that moves by whole cells to where nothing is yet. */
static inline void copy(struct laid *laid, const struct tables *t, const struct pass *p,
                        uint16x8x2_t below)
{
    store_16(laid->level_db_q8 + p->first, share(t, below, p->place_16ths));
    laid->filled = p->first + GROUP;
}

static inline void lay(struct laid *laid, const struct tables *t, const struct pass *p,
                       uint16x8x2_t below)
{
    if (p->most_16ths == 0 && p->first >= laid->filled) {
        copy(laid, t, p, below);
    } else if (p->most_16ths <= 16) {
        add_two(laid, t, p, below, p->first + 1 >= laid->filled);
    } else {
        add_three(laid, t, p, below);
    }
}

/* The compiler must not see where the rows come from: it would load them again for each group. */
static inline struct tables load_tables(const uint8_t (*height_sixteenths)[LM_K_CODES])
{
    struct tables t = {.share = {vld1q_u8(shares_db_q8[0]), vld1q_u8(shares_db_q8[1])},
                       .height = {vld1q_u8(height_sixteenths[0]), vld1q_u8(height_sixteenths[1])}};
    t.sums = neon_sum_rows();
    __asm__("" : "+w"(t.share[0]), "+w"(t.share[1]), "+w"(t.height[0]), "+w"(t.height[1]));
    return t;
}

/* The number, widened once: the compiler would keep it with and without its sign. */
static inline int32_t least_of(int16x8x2_t away_16ths)
{
    return apart(vminvq_s16(vminq_s16(away_16ths.val[0], away_16ths.val[1])));
}

/* Whether a pass begins where the line is kept, of that many cells. */
static inline bool is_kept(const struct pass *p, uint32_t displayed)
{
    return (uint32_t)(p->first + LM_K_LAYOVER_MARGIN) < displayed;
}

/* Lay a group over the line, pass by pass. Returns what is filled then. Out of line, it takes no
 * registers from the groups that need one pass alone. */
static inline int32_t lay_in_passes(struct laid laid, int32_t number, int16x8x2_t away_16ths,
                                    uint16x8x2_t below, uint32_t displayed)
{
    struct tables t = {.share = {vld1q_u8(shares_db_q8[0]), vld1q_u8(shares_db_q8[1])}};
    t.sums = neon_sum_rows();
    struct pass p;
    bool is_last = false;
    while (!is_last) {
        const int32_t least = least_of(away_16ths);
        if (least == NOWHERE) {
            break;
        }
        take(&p, number, least, &away_16ths, &is_last);
        if (is_kept(&p, displayed)) {
            lay(&laid, &t, &p, below);
        }
    }
    return laid.filled;
}

/* Lay the next sixteen cells, of which `number` is the first, over the line. Those without power go
 * along with the first pass: they have no share to give, and ask for no pass of their own. */
static inline void lay_group(struct laid *laid, const struct tables *t,
                             const struct lm_k_layover *line, struct source *s, int32_t number,
                             uint32_t displayed)
{
    const int16x8_t most = vdupq_n_s16(LM_K_LAYOVER_MOST_DB_Q8);
    const int16x8x2_t level_db_q8 = vld1q_s16_x2(s->level_db_q8);
    s->level_db_q8 += GROUP;
    __asm__("" : "+r"(s->level_db_q8));
    const int16x8_t dark = vdupq_n_s16(LM_LEVEL_SHADOW / 2);
    const uint16x8_t is_dark[2] = {vcleq_s16(level_db_q8.val[0], dark),
                                   vcleq_s16(level_db_q8.val[1], dark)};
    int16x8x2_t away_16ths = displace(t, line, s, is_dark);
    const int32_t least = least_of(away_16ths);
    uint16x8x2_t below;
    struct pass p;
    if (least == NOWHERE) {
        return;
    }
    for (size_t n = 0; n < 2; n++) {
        const int16x8_t held = vminq_s16(level_db_q8.val[n], most);
        below.val[n] = veorq_u16(vreinterpretq_u16_s16(held), vdupq_n_u16(INT16_MAX));
        below.val[n] = vorrq_u16(below.val[n], is_dark[n]);
        away_16ths.val[n] = vbslq_s16(is_dark[n], vdupq_n_s16((int16_t)least), away_16ths.val[n]);
    }
    set_pass(&p, number, least, &away_16ths);
    if (p.most_16ths > 16 || !is_kept(&p, displayed) || p.first + 1 < laid->filled) {
        laid->filled = lay_in_passes(*laid, number, away_16ths, below, displayed);
    } else if (p.most_16ths == 0 && p.first >= laid->filled) {
        copy(laid, t, &p, below);
    } else {
        add_two(laid, t, &p, below, true);
    }
}

void lm_k_layover(const struct lm_k_layover *lent, int16_t *laid_db_q8)
{
    const struct lm_k_layover copy = *lent, *const line = &copy; /* no store can change it */
    const int32_t margin = LM_K_LAYOVER_MARGIN, cells = (int32_t)line->cells;
    const struct tables tables = load_tables(line->height_sixteenths);
    const int16x8_t dark = vdupq_n_s16(LM_LEVEL_SHADOW);
    struct laid laid = {laid_db_q8 + margin, -margin};
    struct source source = {line->cell, line->elevation_m_q14, line->level_db_q8};
    for (int32_t i = 0; i < margin + cells + margin; i += GROUP) {
        vst1q_s16(laid_db_q8 + i, dark);
        vst1q_s16(laid_db_q8 + i + 8, dark);
    }
    for (int32_t number = 0; number < cells; number += GROUP) {
        lay_group(&laid, &tables, line, &source, number, line->cells + LM_K_LAYOVER_MARGIN);
    }
}
