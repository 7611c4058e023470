#include "lm/side_lobes.h"

#include <stdbool.h>

#include "fx/bits.h"
#include "fx/hash.h"
#include "fx/log.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"
#include "lm/lanes.h"
#include "lm/level.h"
#include "lm/units.h"

_Static_assert((int)LM_K_LOBES_REACH == LM_RESPONSE_REACH, "the kernels add all");
_Static_assert(2 * (int)LM_K_BESIDE == LM_RESPONSE_REACH, "the kernel looks as far");

/* The main lobe reaches to 1.66 cells: cells beside a point's own are in it, and so is a part of
 * those behind them. Its power is in the cell's level already. */
enum { FIRST_NULL_CELLS_Q8 = 426, NO_LOBE_DB_Q8 = INT16_MIN };

/* Places lie evenly in the cell: odd sixteenths from its middle. */
static int32_t off_cells_q8(int32_t place)
{
    return (2 * place - (LM_SIDE_LOBES_OFFSETS - 1)) * (256 / (2 * LM_SIDE_LOBES_OFFSETS));
}

/* Power of the response in a point's own cell, mean over its places, Q30. Amplitudes are below
 * 2^15. */
static uint32_t own_power_q30(void)
{
    uint32_t sum_q30 = 0;
    for (int32_t k = 0; k < LM_SIDE_LOBES_OFFSETS; k++) {
        const uint32_t here = fx_abs_u32(lm_response(off_cells_q8(k)));
        sum_q30 += here * here / LM_SIDE_LOBES_OFFSETS;
    }
    return sum_q30;
}

/* Level of a point's response `cells` cells away from the cell that holds it, over that in the cell
 * itself: 20 log10 h(x) - own_db_q8. */
static int16_t side_db_q8(int32_t cells, int32_t place, int32_t own_db_q8)
{
    const int32_t x_cells_q8 = lm_cells_q8_of_cells(cells) - off_cells_q8(place);
    const int32_t most = lm_cells_q8_of_cells(LM_RESPONSE_REACH);
    const uint32_t there = fx_abs_u32(lm_response(fx_clamp_i32(x_cells_q8, -most, most)));
    return (int16_t)(there != 0 && fx_abs_u32(x_cells_q8) >= FIRST_NULL_CELLS_Q8
                         ? 2 * fx_db_q8(there) - own_db_q8
                         : NO_LOBE_DB_Q8);
}

void lm_side_lobes_clear(struct lm_side_lobes *s, const struct lm_side_lobe_config *config)
{
    const int32_t own_db_q8 = fx_db_q8(own_power_q30());
    s->config = config;
    for (uint32_t k = 0; k < LM_SIDE_LOBES_LINES; k++) {
        s->line[k].count = 0;
    }
    int16_t *side = s->side_db_q8;
    for (int32_t k = 0; k < LM_SIDE_LOBES_OFFSETS; k++) {
        for (int32_t n = -LM_RESPONSE_REACH; n <= LM_RESPONSE_REACH; n++) {
            *side++ = side_db_q8(n, k, own_db_q8);
        }
    }
}

/* A line that is searched: its number and levels, and the level from which on a cell counts. */
struct search {
    struct lm_side_lobes *s;
    const int16_t *level_db_q8;
    uint32_t line, cells, seed;
    int16_t least_db_q8;
};

/* True if a strong cell comes before a cell: it is stronger, or as strong and nearer. */
static inline bool is_before(const struct lm_strong_cell *p, uint32_t cell, int32_t level_db_q8)
{
    return p->level_db_q8 > level_db_q8 ||
           (p->level_db_q8 == level_db_q8 && p->cell < (int32_t)cell);
}

/* Where the side lobes begin of one of the places, as drawn. */
static uint16_t side_of_place(uint32_t draw)
{
    return (uint16_t)(draw % LM_SIDE_LOBES_OFFSETS * LM_SIDE_LOBES_CELLS);
}

/* Insert a cell that stands out, by its level. The weakest drops out of a full line, and what is
 * weaker counts no more. Out of line, it takes no registers from the search. */
static __attribute__((noinline)) void consider(struct search *of, uint32_t cell)
{
    const struct lm_side_lobe_config *const config = of->s->config;
    struct lm_strong_cell *const strong = of->s->line[of->line % LM_SIDE_LOBES_LINES].strong;
    uint32_t *const count = &of->s->line[of->line % LM_SIDE_LOBES_LINES].count;
    const int16_t level_db_q8 = of->level_db_q8[cell];
    const bool is_full = *count == config->a_line;
    if (is_full && is_before(&strong[*count - 1], cell, level_db_q8)) {
        return;
    }
    const uint32_t draw = fx_hash3(of->line, cell, of->seed);
    uint32_t at = is_full ? *count - 1 : (*count)++;
    for (; at > 0 && !is_before(&strong[at - 1], cell, level_db_q8); at--) {
        strong[at] = strong[at - 1];
    }
    strong[at] = (struct lm_strong_cell){.cell = (int16_t)cell,
                                         .level_db_q8 = level_db_q8,
                                         .right = side_of_place(draw),
                                         .beyond = side_of_place(draw / LM_SIDE_LOBES_OFFSETS)};
    if (*count == config->a_line) {
        of->least_db_q8 = strong[*count - 1].level_db_q8;
    }
}

/* Cells of a group at an end of the line that stand out. Beyond it the last cell is repeated: what
 * is as high as a cell changes nothing, and the cell itself stands out of none. */
static uint32_t cells_at_end(const struct search *of, uint32_t first)
{
    int16_t level_db_q8[LM_K_BESIDE + LM_K_HIGHEST_CELLS + LM_K_BESIDE];
    const uint32_t lead = first == 0 ? LM_K_BESIDE : 0, from = first + lead - LM_K_BESIDE;
    const uint32_t room = LM_K_BESIDE + LM_K_HIGHEST_CELLS + LM_K_BESIDE - lead;
    const uint32_t count = fx_min_u32(room, of->cells - from);
    for (uint32_t k = 0; k < lead; k++) {
        level_db_q8[k] = of->level_db_q8[0];
    }
    memcpy(level_db_q8 + lead, of->level_db_q8 + from, count * sizeof *level_db_q8);
    for (uint32_t k = count; k < room; k++) {
        level_db_q8[lead + k] = of->level_db_q8[of->cells - 1];
    }
    const uint32_t beyond = LM_K_HIGHEST_CELLS - fx_min_u32(LM_K_HIGHEST_CELLS, of->cells - first);
    return lm_k_stand_out(level_db_q8 + LM_K_BESIDE, of->least_db_q8, of->s->config->above_db_q8) &
           (((1u << LM_K_HIGHEST_CELLS) - 1) >> beyond);
}

/* Cells of a group that stand out, bit by bit. */
static inline uint32_t cells_of(const struct search *of, uint32_t first)
{
    if (first >= LM_K_BESIDE && first + LM_K_HIGHEST_CELLS + LM_K_BESIDE <= of->cells) {
        return lm_k_stand_out(of->level_db_q8 + first, of->least_db_q8, of->s->config->above_db_q8);
    }
    return cells_at_end(of, first);
}

/* Search a group of cells. */
static inline void search_group(struct search *of, uint32_t first)
{
    for (uint32_t mask = cells_of(of, first); mask != 0; mask &= mask - 1) {
        consider(of, first + 31 - (uint32_t)fx_clz32(mask & (0 - mask)));
    }
}

enum { GROUPS = (LM_CELLS_MAX + LM_K_HIGHEST_CELLS - 1) / LM_K_HIGHEST_CELLS, GROUPS_LOG2 = 6 };

_Static_assert(GROUPS <= 1 << GROUPS_LOG2, "a key holds the number of a group");

/* Groups are searched by their highest cells, the highest first: soon few count. A key is that
 * level, and in its lower bits what makes keys differ: the first of equal groups has the largest.
 */
static void search_groups(struct search *of)
{
    int16_t highest_db_q8[GROUPS + LM_LANES];
    int32_t key[GROUPS + LM_LANES];
    const uint32_t groups = (of->cells + LM_K_HIGHEST_CELLS - 1) / LM_K_HIGHEST_CELLS;
    const uint32_t room = (groups + LM_LANES - 1) / LM_LANES * LM_LANES; /* no vector has a rest */
    lm_k_highest(of->level_db_q8, highest_db_q8, of->cells);
    for (uint32_t n = groups; n < room; n++) {
        highest_db_q8[n] = INT16_MIN;
    }
    for (uint32_t n = 0; n < room; n++) {
        key[n] = highest_db_q8[n] * (1 << GROUPS_LOG2) + (int32_t)((1u << GROUPS_LOG2) - 1 - n);
    }
    for (uint32_t turn = 0; turn < groups; turn++) {
        int32_t most = INT32_MIN;
        for (uint32_t n = 0; n < room; n++) {
            most = fx_max_i32(most, key[n]);
        }
        if (most < of->least_db_q8 * (1 << GROUPS_LOG2)) {
            return;
        }
        const uint32_t group = ~(uint32_t)most % (1u << GROUPS_LOG2);
        key[group] = INT32_MIN;
        search_group(of, group * LM_K_HIGHEST_CELLS);
    }
}

void lm_side_lobes_find(struct lm_side_lobes *s, uint32_t line, const int16_t *level_db_q8,
                        uint32_t cells, int32_t shadow_db_q8, uint32_t seed)
{
    s->line[line % LM_SIDE_LOBES_LINES].count = 0;
    if (s->config->a_line != 0) {
        struct search of = {.s = s,
                            .level_db_q8 = level_db_q8,
                            .line = line,
                            .cells = cells,
                            .seed = seed,
                            .least_db_q8 = fx_sat_i16(shadow_db_q8 + s->config->over_shadow_db_q8)};
        search_groups(&of);
    }
}

/* Add a side lobe, if it is not 25 dB below what is there. The sum, which is not below that, is
 * held within 16 bits. */
static inline void add(int16_t *level_db_q8, int32_t side_lobe)
{
    const int32_t there = *level_db_q8;
    if (side_lobe > there - LM_K_LOBES_BELOW_DB_Q8) {
        *level_db_q8 = (int16_t)fx_min_i32(fx_db_q8_sum_vec(there, side_lobe), INT16_MAX);
    }
}

/* Side lobes of a point near an end of its line, in that line. */
static void add_along(const int16_t *side_db_q8, const struct lm_strong_cell *p,
                      int16_t *level_db_q8, int32_t cells)
{
    const int32_t first = p->cell - LM_RESPONSE_REACH, last = p->cell + LM_RESPONSE_REACH;
    for (int32_t i = fx_max_i32(first, 0); i <= fx_min_i32(last, cells - 1); i++) {
        add(&level_db_q8[i], p->level_db_q8 + side_db_q8[i - p->cell]);
    }
}

/* The kernel adds those along the line where it has all the cells. */
void lm_side_lobes_add(const struct lm_side_lobes *s, uint32_t line,
                       int16_t *const around[LM_SIDE_LOBES_CELLS], uint32_t cells)
{
    const uint32_t slot = line % LM_SIDE_LOBES_LINES;
    const struct lm_strong_cell *p = s->line[slot].strong;
    for (const struct lm_strong_cell *const end = p + s->line[slot].count; p != end; p++) {
        const int16_t *along_db_q8 = s->side_db_q8 + p->beyond + LM_RESPONSE_REACH;
        if (p->cell < LM_RESPONSE_REACH || p->cell + LM_RESPONSE_REACH >= (int32_t)cells) {
            add_along(along_db_q8, p, around[LM_RESPONSE_REACH], (int32_t)cells);
            along_db_q8 = NULL;
        }
        lm_k_side_lobes(along_db_q8, s->side_db_q8 + p->right + LM_RESPONSE_REACH, p->level_db_q8,
                        around, (uint32_t)p->cell);
    }
}
