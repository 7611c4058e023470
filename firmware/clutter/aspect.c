#include "lm/aspect.h"

#include <stdbool.h>

#include "aspect_line.h"
#include "aspect_neon.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "shore.h"

enum { GRAZING_MIN_Q24 = 1 << 16 /* 1/256 */ };

/* g of the equations, Q24: the rise of flat ground from the cell before, at before_q8, to cell i,
 * as tan of a grazing angle. */
static int64_t grazing_q24(const struct lm_range_grid *g, uint32_t i, uint32_t before_q8)
{
    /* Height difference below 2^26, inverse range below 2^31 in Q(17 + bits). */
    const int64_t above_q10 = (int64_t)g->height_q10 - g->reference_q10;
    const int64_t grazing = (above_q10 * g->inverse_range[i] >> (3 + g->tangent_bits)) -
                            ((int64_t)before_q8 * LM_CURVATURE_Q48 >> 32);
    return grazing < GRAZING_MIN_Q24 ? GRAZING_MIN_Q24 : grazing;
}

/* `scale_q16`: what all cells have in common of K, as a binary logarithm. */
static void set_cell(struct lm_range_grid *g, uint32_t i, uint32_t range_q8, int32_t scale_q16)
{
    /* range < 400 km = 2^26.6 in Q8: squared, in units of 16 m^2, 2^33.2; times the curvature
     * 2^57.2. */
    const int64_t drop_q14 = ((((int64_t)range_q8 * range_q8) >> 20) * LM_CURVATURE_Q48) >> 30;
    g->fall_q14[i] = (int32_t)drop_q14 + g->height_q10 * 16;
    /* No cell that is set lies nearer than LM_RANGE_MIN_M: 2^57 at most, over 2^(tangent_bits - 6).
     * NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
    const uint64_t inverse = (((uint64_t)1 << (25 + g->tangent_bits)) + range_q8 / 2) / range_q8;
    g->inverse_range[i] = inverse < INT32_MAX ? (int32_t)inverse : INT32_MAX;

    /* K = s / (ds g) with the range of the cell before, and the rise comes times 2^bits. */
    const uint32_t before_q8 = i == g->first ? range_q8 : range_q8 - g->cell_q8;
    const int32_t log2_q16 = fx_log2_q16(before_q8) + scale_q16 -
                             fx_log2_q16_u64((uint64_t)grazing_q24(g, i, before_q8));
    g->gain_q8[i] = fx_db_q8_of_log2_q16(log2_q16) + LM_GAMMA_CODE_ZERO_Q8;
}

static uint32_t first_shown(const struct lm_range_grid *g, uint32_t first_q8)
{
    const uint32_t nearest_m = LM_RANGE_MIN_M;
    const int32_t half_height_q8 = g->height_q10 / 8;
    const uint32_t nearest_q8 =
        half_height_q8 > (int32_t)(nearest_m << 8) ? (uint32_t)half_height_q8 : nearest_m << 8;
    if (first_q8 >= nearest_q8) {
        return 0;
    }
    const uint32_t before = (nearest_q8 - first_q8 + g->cell_q8 - 1) / g->cell_q8;
    return before < g->cells ? before : g->cells;
}

void lm_range_grid_set(struct lm_range_grid *g, const struct lm_aspect_config *config,
                       uint32_t first_q8, uint32_t cell_q8, uint32_t cells, int32_t height_q10,
                       int32_t reference_q10)
{
    g->cells = cells;
    g->cell_q8 = cell_q8;
    g->height_q10 = height_q10;
    g->reference_q10 = reference_q10;
    g->first = first_shown(g, first_q8);
    const uint32_t width_q8 = (uint32_t)config->shore_width_m << 8;
    const uint32_t shore_cells = (width_q8 + cell_q8 / 2) / cell_q8;
    g->shore_fall_q8 = config->shore_q8 / (int32_t)(shore_cells ? shore_cells : 1);
    /* The largest inverse, that of the first cell shown, takes 31 bits. Where none is shown, any
     * format does. */
    const uint32_t nearest_q8 = fx_max_u32(first_q8 + g->first * cell_q8, LM_RANGE_MIN_M << 8);
    g->tangent_bits = (uint32_t)(31 - fx_clz32(nearest_q8)) + 6;
    for (uint32_t i = 0; i < g->first; i++) {
        g->fall_q14[i] = g->inverse_range[i] = g->gain_q8[i] = 0; /* read, but not shown */
    }
    const int32_t scale_q16 = (24 - (int32_t)g->tangent_bits) * 65536 - fx_log2_q16(cell_q8);
    for (uint32_t i = g->first; i < cells; i++) {
        set_cell(g, i, first_q8 + i * cell_q8, scale_q16);
    }
    if (g->first < cells) {
        /* g below 2^26, ds below 2^20: 2^36 and 2^22; Q32 + Q(17 + bits) - 49. It is g ds / s, and
         * so no more than the tangent of 90 degrees less a little; beyond the format, all is lit.
         */
        const int64_t rise_q32 = grazing_q24(g, g->first, nearest_q8) * cell_q8;
        const int64_t rise = (rise_q32 >> 10) * (g->inverse_range[g->first] >> 9) >> 30;
        g->flat_rise = rise < INT32_MAX ? (int32_t)rise : INT32_MAX;
    }
}

static uint8_t eighths_of(int32_t edge_q8)
{
    return (uint8_t)(fx_clamp_i32(edge_q8, 0, LM_EDGE_MAX_Q8) / 32);
}

void lm_legend_set(struct lm_legend *legend, const struct lm_aspect_config *config,
                   const struct lm_classes *classes)
{
    const uint8_t mark_of[LM_KINDS] = {[LM_KIND_WATER] = MARK_WATER,
                                       [LM_KIND_STRUCTURE] = MARK_STRUCTURE,
                                       [LM_KIND_TREES] = MARK_TREES};
    const uint8_t edge_q3[CODES] = {[MARK_STRUCTURE] = eighths_of(config->edge_structure_q8),
                                    [MARK_TREES] = eighths_of(config->edge_trees_q8)};
    for (uint32_t n = 0; n < CODES; n++) {
        const uint16_t height_dm = classes->height_dm[n];
        const uint8_t mark = mark_of[classes->entry[n].kind & (LM_KINDS - 1)];
        legend->height_q14[n] = (int32_t)(height_dm * (uint32_t)Q19_OF_DM >> 5);
        legend->kind[n] = edge_q3[mark] * (32 << MARK_BITS) + mark;
        legend->bytes.mark[n] = mark;
        legend->bytes.edge_q3[n] = edge_q3[n];
        for (uint32_t upper = 0; upper < 2; upper++) {
            legend->bytes.height_dm[upper][n] = (uint8_t)(height_dm >> 8 * upper);
        }
    }
    legend->shore_q8 = config->shore_q8;
}

/* What a cell shows by itself; its level but for the horizon's rise and the edges. */
static void look(const struct lm_range_grid *grid, const struct lm_legend *legend,
                 const struct lm_scan_line *line, uint32_t end, struct lm_sight_work *restrict w,
                 int32_t *restrict level_q8)
{
    for (uint32_t i = 0; i < end; i++) {
        const uint32_t cell = line->cell[i];
        w->tangent[LM_LANES + i] = tangent_of(grid, legend, line, i);
        w->kind[LM_LANES + i] = kind_of(legend, cell);
        level_q8[i] = (int32_t)(cell >> 8) * LM_GAMMA_CODE_STEP_Q8 + grid->gain_q8[i];
    }
}

/* Before the first cell shown stands the horizon that the line starts with, and nothing that it
 * could be entered from; behind the last one, nothing that rises. */
static void set_ends(const struct lm_range_grid *grid, int32_t start, struct lm_sight_work *w)
{
    int32_t *behind = w->tangent + LM_LANES + grid->cells;
    for (uint32_t i = 0; i < LM_LANES; i++) {
        w->tangent[i] = w->of_four[i] = w->horizon[i] = start;
    }
    for (uint32_t i = 0; i < LM_LANES; i++) {
        behind[i] = INT32_MIN;
    }
    const int32_t first_kind = w->kind[LM_LANES + grid->first];
    w->kind[LM_LANES - 1] = first_kind;
    for (uint32_t i = LM_LANES; i < LM_LANES + grid->first; i++) {
        w->tangent[i] = start;
        w->kind[i] = first_kind;
    }
}

static void join_fours(uint32_t end, struct lm_sight_work *w)
{
    for (uint32_t i = LM_LANES; i < LM_LANES + end; i++) {
        const int32_t *t = w->tangent + i;
        w->of_four[i] = fx_max_i32(fx_max_i32(t[-3], t[-2]), fx_max_i32(t[-1], t[0]));
    }
}

/* The running horizon, and cells lit by what they show above it: E_i of the equations. The horizon
 * before a cell is the largest of eight tangents and of the horizon before those: eight neighbours
 * wait for the eight before them, and not a cell for the one before it. It rises by less than 2^31:
 * see start_of. Returns whether some cell is behind a shore. */
static bool light(uint32_t end, struct lm_sight_work *restrict w, struct lm_sight *restrict sight)
{
    int32_t left = 0;
    for (uint32_t i = 0; i < end; i++) {
        const uint32_t at = LM_LANES + i;
        const int32_t kind = w->kind[at], kind_before = w->kind[at - 1];
        const int32_t of_eight = fx_max_i32(w->of_four[at - 1], w->of_four[at - 5]);
        const int32_t horizon = fx_max_i32(of_eight, w->horizon[at - LM_LANES]);
        const int32_t next = fx_max_i32(horizon, w->tangent[at]);
        const int32_t edge_q8 = kind != kind_before ? kind >> MARK_BITS : 0;
        const int32_t lit_q8 = sight->level_q8[i] + edge_q8 + fx_db_q8_of_many_i32(next - horizon);
        w->horizon[at] = sight->horizon[i] = horizon;
        sight->level_q8[i] = next != horizon ? lit_q8 : LM_LEVEL_SHADOW;
        left |= kind_before & ~kind;
    }
    return left & MARK_WATER;
}

/* Shores are rare: they are looked for where a stretch, which may end behind the line, has one. */
static void add_shores(const struct lm_range_grid *grid, const struct lm_legend *legend,
                       const struct lm_scan_line *line, struct lm_sight_work *w,
                       struct lm_sight *sight)
{
    const uint32_t cells = grid->cells;
    int32_t *kind = w->kind + LM_LANES;
    for (uint32_t i = 0; i < LM_SHORE_STRETCH; i++) {
        kind[cells + i] = 0;
    }
    for (uint32_t first = 0; first < cells; first += LM_SHORE_STRETCH, kind += LM_SHORE_STRETCH) {
        const int32_t *before = kind - 1;
        uint64_t behind_shore[LM_SHORE_STRETCH / 8];
        int32_t left = 0;
        for (uint32_t i = 0; i < LM_SHORE_STRETCH; i++) {
            left |= before[i] & ~kind[i];
        }
        if (left & MARK_WATER) {
            for (uint32_t i = 0; i < LM_SHORE_STRETCH; i++) {
                ((uint8_t *)behind_shore)[i] = (uint8_t)(before[i] & ~kind[i]);
            }
            for (uint32_t k = 0; k < LM_SHORE_STRETCH / 8; k++) {
                add_shores_of(grid, legend, line, behind_shore[k], first + 8 * k, sight);
            }
        }
    }
}

/* Horizon, level and edges of a line whose horizon starts with `start`. */
static void light_line(const struct lm_range_grid *grid, const struct lm_legend *legend,
                       const struct lm_scan_line *line, int32_t start, struct lm_sight *sight)
{
    const uint32_t cells = grid->cells, end = (cells + LM_LANES - 1) / LM_LANES * LM_LANES;
    struct lm_sight_work *w = &sight->work;
    look(grid, legend, line, end, w, sight->level_q8);
    set_ends(grid, start, w);
    join_fours(end, w);
    if (light(end, w, sight)) {
        add_shores(grid, legend, line, w, sight);
    }
    const uint32_t last = LM_LANES + cells - 1;
    sight->horizon[cells] = fx_max_i32(w->horizon[last], w->tangent[last]);
}

/* The horizon that a line starts with in its grid's format; what is beyond every tangent is as good
 * as far beyond. No rise takes 31 bits: tangents are apparent heights times s_0 / s, in steps of
 * 2^-14 m. Ground is -16..33 km high, structures 6.6 km, the antenna within 30 km, and the Earth
 * drops by 9.4 km in 400: any two are less than 70 km apart, 2^30.1. */
static int32_t start_of(const struct lm_range_grid *grid, int32_t first_tangent,
                        lm_horizon_q40_t horizon)
{
    const int64_t start = horizon == LM_HORIZON_OPEN ? (int64_t)first_tangent - grid->flat_rise
                                                     : horizon >> (40 - grid->tangent_bits);
    const int64_t lowest = (int64_t)first_tangent - (1 << 30);
    return fx_sat_i32(start < lowest ? lowest : start);
}

lm_horizon_q40_t lm_aspect_run(const struct lm_range_grid *grid, const struct lm_legend *legend,
                               const struct lm_scan_line *line, lm_horizon_q40_t horizon,
                               struct lm_sight *sight)
{
    const int32_t start = start_of(grid, tangent_of(grid, legend, line, grid->first), horizon);
    if (FX_HAS_NEON) {
        light_line_neon(grid, legend, line, start, sight);
    } else {
        light_line(grid, legend, line, start, sight);
    }
    return grid->first < grid->cells
               ? sight->horizon[grid->cells] * ((int64_t)1 << (40 - grid->tangent_bits))
               : horizon;
}
