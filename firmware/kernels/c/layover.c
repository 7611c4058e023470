#include <stdbool.h>

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_clutter.h"
#include "lm/level.h"

enum {
    GROUP = 16,
    NOWHERE = INT16_MAX, /* displacement of a cell without power */
    REACH_16THS = 32,    /* what one pass takes: displacements up to two cells apart */
    NOT_NOW = 255,       /* place of a cell that takes no part in a pass */
    NOTHING_DB_Q8 = LM_LEVEL_SHADOW
};

/* 10 log10 of 1 - n / 16. The last is that of no share: 256 dB. */
static const int32_t share_db_q8[17] = {0,    -72,   -148,  -231,  -320,  -417,  -523,  -640,  -771,
                                        -919, -1090, -1293, -1541, -1861, -2312, -3083, -65535};

/* The line as it is laid over. */
struct laid {
    int16_t *level_db_q8; /* of cell 0; nothing is there yet from entry `filled` on */
    int32_t filled;
};

/* Part of a group: the cells that are displaced by `first_16ths` to two cells more. */
struct pass {
    int32_t first;      /* where cell 0 of the group would be with first_16ths, a whole cell */
    int32_t most_16ths; /* of those below */
    int32_t place_16ths[GROUP]; /* each cell's displacement from there: 0..32, or NOT_NOW */
};

/* How far the cells of a group are displaced away from the radar, in sixteenths of a cell. Products
 * are below 2^30 * 2^31. `height_16ths` is that by the height code. */
static void displace(const struct lm_k_layover *l, const int32_t height_16ths[LM_K_CODES],
                     uint32_t group, int32_t away_16ths[GROUP])
{
    const int32_t *elevation_m_q14 = l->elevation_m_q14 + group;
    const int16_t *level_db_q8 = l->level_db_q8 + group;
    const uint32_t *cell = l->cell + group;
    for (uint32_t k = 0; k < GROUP; k++) {
        const int64_t below_m_q14 = l->reference_m_q14 - elevation_m_q14[k];
        const int64_t terrain = (below_m_q14 * l->sixteenths_q31 + (1 << 30)) >> 31;
        const int32_t away =
            fx_sat_i16(fx_sat_i16((int32_t)terrain) - height_16ths[cell[k] % LM_K_CODES]);
        away_16ths[k] = level_db_q8[k] <= LM_LEVEL_SHADOW / 2 ? NOWHERE : away;
    }
}

/* Take the cells out of a group that are displaced least. False if none is left. */
static bool take(struct pass *restrict p, uint32_t group, int32_t *restrict away_16ths)
{
    int32_t least = NOWHERE, most = 0;
    for (uint32_t k = 0; k < GROUP; k++) {
        least = fx_min_i32(least, away_16ths[k]);
    }
    if (least == NOWHERE) {
        return false;
    }
    const int32_t base = least & ~15;
    p->first = (int32_t)group + (least >> 4);
    for (uint32_t k = 0; k < GROUP; k++) {
        const int32_t away = away_16ths[k], place = away - base;
        p->place_16ths[k] = place <= REACH_16THS ? place : NOT_NOW;
        away_16ths[k] = place <= REACH_16THS ? NOWHERE : away;
        most = fx_max_i32(most, place <= REACH_16THS ? place : 0);
    }
    p->most_16ths = most;
    return true;
}

/* Share of a power, as a level: `gone_16ths` of it are not in it; none of it for other numbers. */
static inline int32_t share(int32_t level_db_q8, int32_t gone_16ths)
{
    const int32_t gone_db_q8 = share_db_q8[gone_16ths < 0 || gone_16ths > 16 ? 16 : gone_16ths];
    const int32_t most_db_q8 = fx_min_i32(level_db_q8, LM_K_LAYOVER_MOST_DB_Q8);
    return fx_max_i32(most_db_q8 + gone_db_q8, NOTHING_DB_Q8);
}

/* Sums of shares, from the pass's first cell on: those of the cells at hand, and what the cells
 * before them have left there, if these were the last so far. Returns their number. */
static uint32_t sum_shares(const struct pass *p, const int16_t *level_db_q8,
                           const int16_t *left_db_q8, int32_t sum_db_q8[GROUP + 2])
{
    int32_t own[GROUP], next[GROUP + 1], second[GROUP + 2];
    next[0] = left_db_q8[0];
    second[0] = NOTHING_DB_Q8;
    second[1] = left_db_q8[1];
    for (uint32_t k = 0; k < GROUP; k++) {
        own[k] = share(level_db_q8[k], p->place_16ths[k]);
        next[k + 1] = share(level_db_q8[k], (int32_t)fx_abs_u32(p->place_16ths[k] - 16));
        second[k + 2] = share(level_db_q8[k], 32 - p->place_16ths[k]);
    }
    for (uint32_t k = 0; k < GROUP; k++) {
        sum_db_q8[k] = fx_db_q8_sum_vec(own[k], next[k]);
    }
    sum_db_q8[GROUP] = next[GROUP];
    if (p->most_16ths <= 16) {
        return GROUP + 1;
    }
    for (uint32_t k = 0; k < GROUP; k++) {
        sum_db_q8[k] = fx_db_q8_sum_vec(sum_db_q8[k], second[k]);
    }
    sum_db_q8[GROUP] = fx_db_q8_sum_vec(next[GROUP], second[GROUP]);
    sum_db_q8[GROUP + 1] = second[GROUP + 1];
    return GROUP + 2;
}

/* Add a group that moves by whole cells to where nothing is yet. */
static void copy(struct laid *laid, const struct pass *p, const int16_t *level_db_q8)
{
    for (uint32_t k = 0; k < GROUP; k++) {
        const int32_t own_db_q8 = share(level_db_q8[k], p->place_16ths[k]);
        laid->level_db_q8[p->first + (int32_t)k] = (int16_t)own_db_q8;
    }
    laid->filled = p->first + GROUP;
}

/* A line's levels together are at most LM_K_LAYOVER_MOST_DB_Q8 and 27 dB: sums take 16 bits. */
static void add(struct laid *laid, const struct pass *p, const int16_t *level_db_q8)
{
    const int16_t nothing_db_q8[2] = {NOTHING_DB_Q8, NOTHING_DB_Q8};
    int32_t sum_db_q8[GROUP + 2];
    int16_t *const to_db_q8 = laid->level_db_q8 + p->first;
    const int32_t beyond = p->first + (p->most_16ths <= 16 ? 1 : 2);
    const bool is_new = beyond >= laid->filled;
    const uint32_t count = sum_shares(p, level_db_q8, is_new ? to_db_q8 : nothing_db_q8, sum_db_q8);
    if (is_new) {
        for (uint32_t k = 0; k < GROUP; k++) {
            to_db_q8[k] = (int16_t)sum_db_q8[k];
        }
    } else {
        for (uint32_t k = 0; k < GROUP; k++) {
            to_db_q8[k] = (int16_t)fx_db_q8_sum_vec(sum_db_q8[k], to_db_q8[k]);
        }
    }
    for (uint32_t k = GROUP; k < count; k++) {
        const int32_t all_db_q8 =
            is_new ? sum_db_q8[k] : fx_db_q8_sum_vec(sum_db_q8[k], to_db_q8[k]);
        to_db_q8[k] = (int16_t)all_db_q8;
    }
    laid->filled = fx_max_i32(laid->filled, beyond + GROUP);
}

void lm_k_layover(const struct lm_k_layover *line, int16_t *laid_db_q8)
{
    const int32_t margin = LM_K_LAYOVER_MARGIN, cells = (int32_t)line->cells;
    struct laid laid = {laid_db_q8 + margin, -margin};
    int32_t height_16ths[LM_K_CODES];
    for (uint32_t code = 0; code < LM_K_CODES; code++) {
        height_16ths[code] =
            line->height_sixteenths[0][code] + line->height_sixteenths[1][code] * 256;
    }
    for (int32_t i = 0; i < margin + (cells + GROUP - 1) / GROUP * GROUP + margin; i++) {
        laid_db_q8[i] = LM_LEVEL_SHADOW;
    }
    for (uint32_t group = 0; group < line->cells; group += GROUP) {
        const int16_t *level_db_q8 = line->level_db_q8 + group;
        int32_t away_16ths[GROUP];
        struct pass p;
        displace(line, height_16ths, group, away_16ths);
        while (take(&p, group, away_16ths)) {
            const bool is_copy = p.most_16ths == 0 && p.first >= laid.filled;
            if (p.first >= -margin && p.first < cells) {
                (is_copy ? copy : add)(&laid, &p, level_db_q8);
            }
        }
    }
}
