#include <stdbool.h>

#include "../shore.h"
#include "fx/bits.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_clutter.h"
#include "lm/level.h"
#include "lm/tile_point.h"

/* Words that vectors look up: heights of the codes; of the classes, the brightness of the leading
 * edge times 2^LM_K_MARK_BITS, and the mark; and their gains. */
struct words {
    int32_t height_m_q14[LM_K_CODES], kind[LM_K_CODES], gain_db_q8[LM_K_CODES];
};

/* What is known of a line on the way. Cell i is entry LM_LANES + i, for what a cell is compared
 * with may stand before the line. */
struct work {
    int32_t kind[LM_LANES + LM_CELLS_ROOM + LM_K_SHORE_STRETCH];
    int32_t tangent[LM_LANES + LM_CELLS_ROOM]; /* of the cell's top */
    int32_t of_four[LM_LANES + LM_CELLS_ROOM]; /* the largest of the cell's and the three before */
    int32_t horizon[LM_LANES + LM_CELLS_ROOM]; /* before the cell */
    int32_t level_db_q8[LM_CELLS_ROOM];        /* by cell; first without rise and edges */
};
_Static_assert(sizeof(struct work) == LM_K_LIGHT_WORK * sizeof(int32_t), "the scratch is lent");

static void set_heights(const struct lm_k_tops *tops, int32_t height_m_q14[LM_K_CODES])
{
    for (uint32_t n = 0; n < LM_K_CODES; n++) {
        height_m_q14[n] = lm_k_height_m_q14(tops->height_dm_of_code[n]);
    }
}

static void set_words(const struct lm_k_lit_line *line, struct words *words)
{
    /* A mark is a bit, so that a product with it chooses without a comparison. */
    const int32_t unit = 32 << LM_K_MARK_BITS;
    const int32_t of_structure = line->edge_structure_db_q3 * (unit / LM_K_STRUCTURE);
    const int32_t of_trees = line->edge_trees_db_q3 * (unit / LM_K_TREES);
    set_heights(&line->tops, words->height_m_q14);
    for (uint32_t n = 0; n < LM_K_CODES; n++) {
        const int32_t mark = line->mark_of_class[n];
        words->kind[n] =
            (mark & LM_K_STRUCTURE) * of_structure + (mark & LM_K_TREES) * of_trees + mark;
        words->gain_db_q8[n] = line->class_gain_db_q8[n];
    }
}

/* What a cell shows by itself; its level but for the horizon's rise and the edges. Indices are
 * signed: then a loop of this becomes vector gathers. */
static void take_tops(const struct lm_k_lit_line *line, uint32_t end, struct work *restrict w)
{
    const struct lm_k_tops tops = line->tops;
    const int16_t *gain_db_q8 = line->gain_db_q8;
    struct words words;
    set_words(line, &words);
    for (uint32_t i = 0; i < end; i++) {
        const uint32_t cell = tops.cell[i];
        const int32_t height_m_q14 = words.height_m_q14[(int32_t)(cell % LM_K_CODES)];
        w->tangent[LM_LANES + i] = lm_k_tangent(&tops, i, height_m_q14);
        const int32_t class_index = (int32_t)((cell >> 4) % LM_K_CODES);
        w->kind[LM_LANES + i] = words.kind[class_index];
        w->level_db_q8[i] = (int32_t)(cell >> 8 & 255) * LM_GAMMA_CODE_STEP_DB_Q8 +
                            ((int32_t)cell >> 16) + LM_LEVEL_SHADOW +
                            fx_sat_i16(gain_db_q8[i] + words.gain_db_q8[class_index]);
    }
}

/* Before the first cell shown stands the horizon that the line starts with, and nothing that it
 * could be entered from; behind the last one, nothing that rises. */
static void set_ends(const struct lm_k_lit_line *line, struct work *w)
{
    int32_t *behind = w->tangent + LM_LANES + line->tops.cells;
    for (uint32_t i = 0; i < LM_LANES; i++) {
        w->tangent[i] = w->of_four[i] = w->horizon[i] = line->start;
    }
    for (uint32_t i = 0; i < LM_LANES; i++) {
        behind[i] = INT32_MIN;
    }
    const int32_t first_kind = w->kind[LM_LANES + line->tops.first];
    w->kind[LM_LANES - 1] = first_kind;
    for (uint32_t i = LM_LANES; i < LM_LANES + line->tops.first; i++) {
        w->tangent[i] = line->start;
        w->kind[i] = first_kind;
    }
}

static void max_of_four(uint32_t end, struct work *w)
{
    for (uint32_t i = LM_LANES; i < LM_LANES + end; i++) {
        const int32_t *t = w->tangent + i;
        w->of_four[i] = fx_max_i32(fx_max_i32(t[-3], t[-2]), fx_max_i32(t[-1], t[0]));
    }
}

/* The running horizon, and cells lit by what they show above it: E_i of the equations. The horizon
 * before a cell is the largest of eight tangents and of the horizon before those: eight neighbours
 * wait for the eight before them, and not a cell for the one before it. It rises by less than 2^31:
 * see `start`. Returns whether some cell is behind a shore. */
static bool light(uint32_t end, struct work *restrict w, int32_t *restrict line_horizon)
{
    int32_t left = 0;
    for (uint32_t i = 0; i < end; i++) {
        const uint32_t at = LM_LANES + i;
        const int32_t kind = w->kind[at], kind_before = w->kind[at - 1];
        const int32_t of_eight = fx_max_i32(w->of_four[at - 1], w->of_four[at - 5]);
        const int32_t horizon = fx_max_i32(of_eight, w->horizon[at - LM_LANES]);
        const int32_t next = fx_max_i32(horizon, w->tangent[at]);
        const int32_t edge_db_q8 = kind != kind_before ? kind >> LM_K_MARK_BITS : 0;
        const int32_t lit_db_q8 = w->level_db_q8[i] + edge_db_q8 + fx_db_q8_vec_i32(next - horizon);
        w->horizon[at] = line_horizon[i] = horizon;
        w->level_db_q8[i] = next != horizon ? lit_db_q8 : LM_LEVEL_SHADOW;
        left |= kind_before & ~kind;
    }
    return left & LM_K_WATER;
}

/* Apart from the loop before, which waits every eight cells: vectors of 16 bits hold sixteen. */
static void hold_levels(uint32_t end, const struct work *restrict w, int16_t *restrict level_db_q8)
{
    for (uint32_t i = 0; i < end; i++) {
        level_db_q8[i] = fx_sat_i16(w->level_db_q8[i]);
    }
}

/* Shores behind eight cells from `first` on, each of which has a byte of `eight`. */
static void add_shores_of(const struct lm_k_lit_line *line, uint64_t eight, uint32_t first)
{
    for (uint64_t left = eight & EACH_IS_WATER; left != 0; left &= left - 1) {
        add_shore(line, first + (uint32_t)fx_ctz64(left) / 8, line->shore_db_q8);
    }
}

/* Shores are rare: they are looked for where a stretch, which may end behind the line, has one. */
static void add_shores(const struct lm_k_lit_line *line, struct work *w)
{
    const uint32_t cells = line->tops.cells;
    int32_t *kind = w->kind + LM_LANES;
    for (uint32_t i = 0; i < LM_K_SHORE_STRETCH; i++) {
        kind[cells + i] = 0;
    }
    for (uint32_t first = 0; first < cells;
         first += LM_K_SHORE_STRETCH, kind += LM_K_SHORE_STRETCH) {
        const int32_t *before = kind - 1;
        uint64_t behind_shore[LM_K_SHORE_STRETCH / 8];
        int32_t left = 0;
        for (uint32_t i = 0; i < LM_K_SHORE_STRETCH; i++) {
            left |= before[i] & ~kind[i];
        }
        if (left & LM_K_WATER) {
            for (uint32_t i = 0; i < LM_K_SHORE_STRETCH; i++) {
                ((uint8_t *)behind_shore)[i] = (uint8_t)(before[i] & ~kind[i]);
            }
            for (uint32_t k = 0; k < LM_K_SHORE_STRETCH / 8; k++) {
                add_shores_of(line, behind_shore[k], first + 8 * k);
            }
        }
    }
}

void lm_k_light(const struct lm_k_lit_line *line)
{
    const uint32_t cells = line->tops.cells, end = (cells + LM_LANES - 1) / LM_LANES * LM_LANES;
    struct work *w = (struct work *)line->work;
    take_tops(line, end, w);
    set_ends(line, w);
    max_of_four(end, w);
    const bool has_shore = light(end, w, line->horizon);
    hold_levels(end, w, line->level_db_q8);
    if (has_shore) {
        add_shores(line, w);
    }
    const uint32_t last = LM_LANES + cells - 1;
    line->horizon[cells] = fx_max_i32(w->horizon[last], w->tangent[last]);
}

int32_t lm_k_highest_tangent(const struct lm_k_tops *tops)
{
    const struct lm_k_tops t = *tops;
    int32_t height_m_q14[LM_K_CODES], highest = INT32_MIN;
    set_heights(&t, height_m_q14);
    for (uint32_t i = t.first; i < t.cells; i++) {
        const int32_t code = (int32_t)(t.cell[i] % LM_K_CODES);
        highest = fx_max_i32(highest, lm_k_tangent(&t, i, height_m_q14[code]));
    }
    return highest;
}
