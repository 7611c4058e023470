#include "lm/aspect.h"

#include <stdbool.h>

#include "aspect_line.h"
#include "aspect_neon.h"
#include "fx/log.h"
#include "fx/sat.h"

enum { GRAZING_MIN_Q24 = 1 << 16 /* 1/256 */ };

/* g of the equations, Q24: the rise of flat ground from the cell before, at before_q8, to cell i,
 * as tan of a grazing angle. */
static int64_t grazing_q24(const struct lm_range_grid *g, uint32_t i, uint32_t before_q8)
{
    /* Height difference below 2^26, inverse range below 2^30 in Q(16 + bits). */
    const int64_t above_q10 = (int64_t)g->height_q10 - g->reference_q10;
    const int64_t grazing = (above_q10 * g->inverse_range[i] >> (2 + g->tangent_bits)) -
                            ((int64_t)before_q8 * LM_CURVATURE_Q48 >> 32);
    return grazing < GRAZING_MIN_Q24 ? GRAZING_MIN_Q24 : grazing;
}

static void set_cell(struct lm_range_grid *g, uint32_t i, uint32_t range_q8)
{
    /* range < 400 km = 2^26.6 in Q8: squared, in units of 16 m^2, 2^33.2; times the curvature
     * 2^57.2. */
    const int64_t drop_q14 = ((((int64_t)range_q8 * range_q8) >> 20) * LM_CURVATURE_Q48) >> 30;
    g->fall_q14[i] = (int32_t)drop_q14 + g->height_q10 * 16;
    /* No cell that is set lies nearer than LM_RANGE_MIN_M.
     * NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
    g->inverse_range[i] =
        (int32_t)((((uint64_t)1 << (24 + g->tangent_bits)) + range_q8 / 2) / range_q8);

    /* K = s / (ds g) with the range of the cell before, and the rise comes times 2^bits. */
    const uint32_t before_q8 = i == g->first ? range_q8 : range_q8 - g->cell_q8;
    const int32_t log2_q16 = fx_log2_q16(before_q8) - fx_log2_q16(g->cell_q8) -
                             fx_log2_q16_u64((uint64_t)grazing_q24(g, i, before_q8)) +
                             (24 - (int32_t)g->tangent_bits) * 65536;
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
    /* The largest inverse, that of the first cell shown, takes 30 bits. Where none is shown, any
     * format does. */
    const uint32_t nearest_q8 = fx_max_u32(first_q8 + g->first * cell_q8, LM_RANGE_MIN_M << 8);
    g->tangent_bits = (uint32_t)(31 - fx_clz32(nearest_q8)) + 6;
    for (uint32_t i = 0; i < g->first; i++) {
        g->fall_q14[i] = g->inverse_range[i] = g->gain_q8[i] = 0; /* read, but not shown */
    }
    for (uint32_t i = g->first; i < cells; i++) {
        set_cell(g, i, first_q8 + i * cell_q8);
    }
    if (g->first < cells) {
        /* g below 2^26, ds below 2^20: 2^36 and 2^22; Q32 + Q(16 + bits) - 48. It is g ds / s, and
         * so no more than the tangent of 90 degrees less a little; beyond the format, all is lit.
         */
        const int64_t rise_q32 = grazing_q24(g, g->first, nearest_q8) * cell_q8;
        const int64_t rise = (rise_q32 >> 10) * (g->inverse_range[g->first] >> 8) >> 30;
        g->flat_rise = rise < INT32_MAX ? (int32_t)rise : INT32_MAX;
    }
}

static void set_legend(struct legend *l, const struct lm_aspect_config *config,
                       const struct lm_classes *classes)
{
    const int32_t entry[LM_KINDS] = {
        [LM_KIND_WATER] = MARK_WATER,
        [LM_KIND_STRUCTURE] = config->edge_structure_q8 * (1 << MARK_BITS) + MARK_STRUCTURE,
        [LM_KIND_TREES] = config->edge_trees_q8 * (1 << MARK_BITS) + MARK_TREES};
    for (uint32_t n = 0; n < CODE_MIDDLE; n++) {
        l->height_q14[n] = classes->height_dm[n + CODE_MIDDLE] * 8192 / 5;
        l->height_q14[n + CODE_MIDDLE] = classes->height_dm[n] * 8192 / 5;
        l->kind[n] = entry[classes->entry[n + CODE_MIDDLE].kind & (LM_KINDS - 1)];
        l->kind[n + CODE_MIDDLE] = entry[classes->entry[n].kind & (LM_KINDS - 1)];
    }
}

/* Tangent of each cell's top, in the horizon's place; its kind, behind that of the cell before it;
 * and its level but for the horizon's rise and the edges. */
static void look(const struct lm_range_grid *grid, const struct lm_scan_line *line,
                 const struct legend *legend, int32_t *restrict kind,
                 struct lm_sight *restrict sight)
{
    for (uint32_t i = 0; i < grid->cells; i++) {
        const uint32_t cell = line->cell[i];
        sight->horizon[i + 1] = tangent_of(grid, line, legend, i);
        kind[i + 1] = kind_of(legend, cell);
        sight->level_q8[i] = (int32_t)(cell >> 8) * LM_GAMMA_CODE_STEP_Q8 + grid->gain_q8[i];
    }
}

/* The running horizon: tangents become the largest up to them. horizon[0] is where it starts. Eight
 * neighbours, each the largest of eight, wait for the eight before them, and not a cell for the one
 * before it. */
static void raise_horizon(uint32_t cells, int32_t *horizon)
{
    enum { HALF = 4, ALL = 8 };
    int32_t of_half[HALF + LM_CELLS_ROOM];
    for (uint32_t i = 0; i < HALF; i++) {
        of_half[i] = horizon[0];
    }
    for (uint32_t i = 1; i <= cells && i < HALF; i++) {
        of_half[HALF + i - 1] = fx_max_i32(of_half[HALF + i - 2], horizon[i]);
    }
    for (uint32_t i = HALF; i <= cells; i++) {
        const int32_t *t = horizon + i;
        of_half[i + HALF - 1] = fx_max_i32(fx_max_i32(t[-3], t[-2]), fx_max_i32(t[-1], t[0]));
    }
    for (uint32_t i = 1; i <= cells && i < ALL; i++) {
        horizon[i] = fx_max_i32(of_half[i - 1], of_half[i + HALF - 1]);
    }
    for (uint32_t i = ALL; i <= cells; i++) {
        const int32_t of_all = fx_max_i32(of_half[i - 1], of_half[i + HALF - 1]);
        horizon[i] = fx_max_i32(of_all, horizon[i - ALL]);
    }
}

/* Light cells by what they show above the horizon, and leading edges by what they are: E_i of the
 * equations. 32 bits without a sign hold the rise from any tangent to any other. Returns whether
 * some cell is behind a shore. */
static bool light(const int32_t *horizon, const int32_t *kind, uint32_t cells,
                  int32_t *restrict level_q8)
{
    int32_t left = 0;
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t rise = (uint32_t)horizon[i + 1] - (uint32_t)horizon[i];
        /* look() filled both. NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
        const int32_t edge_q8 = kind[i + 1] != kind[i] ? kind[i + 1] >> MARK_BITS : 0;
        const int32_t lit_q8 = level_q8[i] + edge_q8 + fx_db_q8_of_many(rise);
        level_q8[i] = rise ? lit_q8 : LM_LEVEL_SHADOW;
        left |= kind[i] & ~kind[i + 1];
    }
    return left & MARK_WATER;
}

/* One behind the last of `cells` cells that is behind a shore; 0 when none is. */
static uint32_t last_shore(const int32_t *kind, uint32_t cells)
{
    int32_t last = 0;
    for (int32_t i = 0; i < (int32_t)cells; i++) {
        /* As above. NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
        last = fx_max_i32(last, -(kind[i] & ~kind[i + 1] & MARK_WATER) & (i + 1));
    }
    return (uint32_t)last;
}

/* Far shores are rare: they are looked for where a stretch of cells has one. */
enum { STRETCH = 64, STRETCHES = LM_CELLS_MAX / STRETCH + 1 };

/* Horizon, level and edges of a line whose horizon starts with `start`. */
static void light_line(const struct lm_range_grid *grid, int32_t shore_q8,
                       const struct lm_scan_line *line, const struct legend *legend, int32_t start,
                       struct lm_sight *sight)
{
    const uint32_t cells = grid->cells;
    int32_t kind[1 + LM_CELLS_ROOM];
    bool has_shore[STRETCHES];
    look(grid, line, legend, kind, sight);
    for (uint32_t i = 0; i <= grid->first; i++) {
        sight->horizon[i] = start;
    }
    /* The first cell shown enters nothing.
     * NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): look() filled it */
    kind[grid->first] = kind[grid->first + 1];
    raise_horizon(cells, sight->horizon);
    for (uint32_t i = 0; i < cells; i += STRETCH) {
        has_shore[i / STRETCH] = light(sight->horizon + i, kind + i, fx_min_u32(cells - i, STRETCH),
                                       sight->level_q8 + i);
    }
    for (uint32_t i = 0; i < cells; i += STRETCH) {
        uint32_t left = has_shore[i / STRETCH] ? fx_min_u32(cells - i, STRETCH) : 0;
        while ((left = last_shore(kind + i, left)) != 0) {
            left--;
            add_shore(grid, shore_q8, line, legend, i + left, sight);
        }
    }
}

/* The horizon that a line starts with in its grid's format; what is beyond every tangent is as good
 * as far beyond. */
static int32_t start_of(const struct lm_range_grid *grid, int32_t first_tangent,
                        lm_horizon_q40_t horizon)
{
    const int64_t start = horizon == LM_HORIZON_OPEN ? (int64_t)first_tangent - grid->flat_rise
                                                     : horizon >> (40 - grid->tangent_bits);
    return fx_sat_i32(start);
}

lm_horizon_q40_t lm_aspect_run(const struct lm_range_grid *grid,
                               const struct lm_aspect_config *config,
                               const struct lm_classes *classes, const struct lm_scan_line *line,
                               lm_horizon_q40_t horizon, struct lm_sight *sight)
{
    struct legend legend;
    set_legend(&legend, config, classes);
    const int32_t start = start_of(grid, tangent_of(grid, line, &legend, grid->first), horizon);
    if (FX_HAS_NEON) {
        light_line_neon(grid, config->shore_q8, line, &legend, start, sight);
    } else {
        light_line(grid, config->shore_q8, line, &legend, start, sight);
    }
    return grid->first < grid->cells
               ? sight->horizon[grid->cells] * ((int64_t)1 << (40 - grid->tangent_bits))
               : horizon;
}
