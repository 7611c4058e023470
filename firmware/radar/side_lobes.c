#include "lm/side_lobes.h"

#include <stdbool.h>

#include "fx/hash.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/lanes.h"
#include "lm/level.h"
#include "lm/units.h"

/* A point within a quarter of a cell of the middle has its first null before the second cell: the
 * cell beside its own is in the main lobe, whose power the cell's level holds already. */
enum { BESIDE = LM_RESPONSE_REACH / 2, NEAREST = 2 };

/* Level of a point's response `cells` cells away from the cell that holds it, `off_cells_q8` from
 * its middle, over that in the cell itself: 20 log10(h(x) / h(off)). Amplitudes are below 2^15. */
static int16_t side_db_q8(int32_t cells, int32_t off_cells_q8)
{
    const int32_t x_cells_q8 = lm_cells_q8_of_cells(cells) - off_cells_q8;
    const int32_t most = lm_cells_q8_of_cells(LM_RESPONSE_REACH);
    const uint32_t there = fx_abs_u32(lm_response(fx_clamp_i32(x_cells_q8, -most, most)));
    const uint32_t here = fx_abs_u32(lm_response(off_cells_q8));
    return (int16_t)(2 * (fx_db_q8(there) - fx_db_q8(here)));
}

void lm_side_lobes_clear(struct lm_side_lobes *s)
{
    s->found = 0;
    for (uint32_t k = 0; k < LM_SIDE_LOBES_LINES; k++) {
        s->line[k].count = 0;
    }
    for (int32_t k = 0; k < LM_SIDE_LOBES_OFFSETS; k++) {
        for (int32_t n = -LM_RESPONSE_REACH; n <= LM_RESPONSE_REACH; n++) {
            s->side_db_q8[k][n + LM_RESPONSE_REACH] =
                side_db_q8(n, 16 * (k - LM_SIDE_LOBES_OFFSETS / 2));
        }
    }
}

/* True if the cell stands far above the ends of its surroundings, and is the highest of them. */
static inline bool stands_out(const int32_t *level_db_q8, uint32_t cell, uint32_t cells)
{
    const uint32_t first = cell > BESIDE ? cell - BESIDE : 0;
    const uint32_t last = fx_min_u32(cell + BESIDE, cells - 1);
    const int32_t most_db_q8 = level_db_q8[cell] - LM_SIDE_LOBES_ABOVE_DB_Q8;
    if (level_db_q8[first] > most_db_q8 || level_db_q8[last] > most_db_q8) {
        return false;
    }
    for (uint32_t i = first; i <= last; i++) {
        if (level_db_q8[i] > level_db_q8[cell]) {
            return false;
        }
    }
    return true;
}

/* Insert a strong cell by its level. The weakest drops out of a full line. */
static void insert(struct lm_side_lobes *s, uint32_t line, uint32_t cell, int32_t level_db_q8,
                   uint32_t seed)
{
    const uint32_t slot = line % LM_SIDE_LOBES_LINES, draw = fx_hash3(line, cell, seed);
    struct lm_strong_cell *const strong = s->line[slot].strong;
    uint32_t at = s->line[slot].count;
    if (at == LM_SIDE_LOBES_A_LINE && strong[at - 1].level_db_q8 >= level_db_q8) {
        return;
    }
    at = fx_min_u32(at, LM_SIDE_LOBES_A_LINE - 1);
    for (; at > 0 && strong[at - 1].level_db_q8 < level_db_q8; at--) {
        strong[at] = strong[at - 1];
    }
    strong[at] = (struct lm_strong_cell){(int32_t)cell, level_db_q8,
                                         (int32_t)(draw & 7) - LM_SIDE_LOBES_OFFSETS / 2,
                                         (int32_t)(draw >> 3 & 7) - LM_SIDE_LOBES_OFFSETS / 2};
    s->line[slot].count = fx_min_u32(s->line[slot].count + 1, LM_SIDE_LOBES_A_LINE);
}

void lm_side_lobes_find(struct lm_side_lobes *s, uint32_t line, const int32_t *level_db_q8,
                        uint32_t cells, int32_t least_db_q8, uint32_t seed)
{
    s->line[line % LM_SIDE_LOBES_LINES].count = 0;
    s->found = line + 1;
    for (uint32_t first = 0; first < cells; first += LM_LANES) {
        const uint32_t end = fx_min_u32(first + LM_LANES, cells);
        int32_t highest_db_q8 = level_db_q8[first];
        for (uint32_t i = first; i < first + LM_LANES; i++) {
            highest_db_q8 = fx_max_i32(highest_db_q8, level_db_q8[i]);
        }
        for (uint32_t i = first; i < end && highest_db_q8 >= least_db_q8; i++) {
            if (level_db_q8[i] >= least_db_q8 && stands_out(level_db_q8, i, cells)) {
                insert(s, line, i, level_db_q8[i], seed);
            }
        }
    }
}

/* Side lobe of a point, `cells` cells from its own. */
static inline int32_t side_lobe_db_q8(const struct lm_side_lobes *s, const struct lm_strong_cell *p,
                                      int32_t off_16ths, int32_t cells)
{
    return p->level_db_q8 +
           s->side_db_q8[off_16ths + LM_SIDE_LOBES_OFFSETS / 2][cells + LM_RESPONSE_REACH];
}

/* Add a side lobe, if it is not 25 dB below what is there. */
static inline void add(int32_t *level_db_q8, int32_t side_lobe)
{
    if (side_lobe > *level_db_q8 - LM_DB_Q8(25)) {
        *level_db_q8 = fx_db_q8_sum_vec(*level_db_q8, side_lobe);
    }
}

static void add_along(const struct lm_side_lobes *s, const struct lm_strong_cell *p,
                      int32_t *level_db_q8, int32_t cells)
{
    const int32_t first = fx_max_i32(p->cell - LM_RESPONSE_REACH, 0);
    const int32_t last = fx_min_i32(p->cell + LM_RESPONSE_REACH, cells - 1);
    for (int32_t i = first; i <= last; i++) {
        if (fx_abs_u32(i - p->cell) >= NEAREST) {
            add(&level_db_q8[i], side_lobe_db_q8(s, p, p->beyond_16ths, i - p->cell));
        }
    }
}

void lm_side_lobes_add(const struct lm_side_lobes *s, uint32_t line, int32_t *level_db_q8,
                       uint32_t cells)
{
    const uint32_t first = line > LM_RESPONSE_REACH ? line - LM_RESPONSE_REACH : 0;
    const uint32_t end = fx_min_u32(line + LM_RESPONSE_REACH + 1, s->found);
    for (uint32_t n = first; n < end; n++) {
        const uint32_t slot = n % LM_SIDE_LOBES_LINES;
        const int32_t beside = (int32_t)line - (int32_t)n;
        for (uint32_t k = 0; k < s->line[slot].count; k++) {
            const struct lm_strong_cell *p = &s->line[slot].strong[k];
            if (beside == 0) {
                add_along(s, p, level_db_q8, (int32_t)cells);
            } else if (fx_abs_u32(beside) >= NEAREST) {
                add(&level_db_q8[p->cell], side_lobe_db_q8(s, p, p->right_16ths, beside));
            }
        }
    }
}
