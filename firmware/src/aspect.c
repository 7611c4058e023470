#include "lm/aspect.h"

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

/* Heights by the height code of a cell as a signed number of four bits, -8..7, behind the eighth:
 * the lookup becomes a vector gather where its index has a sign. */
enum { CODES = 16, CODE_MIDDLE = 8 };

static inline int32_t signed_code(uint32_t cell)
{
    return (int32_t)(cell << 28) >> 28;
}

static void set_heights(int32_t height_q14_of[CODES], const struct lm_classes *classes)
{
    for (uint32_t code = 0; code < CODES; code++) {
        height_q14_of[signed_code(code) + CODE_MIDDLE] = classes->height_dm[code] * 8192 / 5;
    }
}

/* Tangent of each cell's top, in the horizon's place, and its level but for the horizon's rise and
 * the edges. */
static void look(const struct lm_range_grid *grid, const struct lm_scan_line *line,
                 const int32_t height_q14_of[CODES], struct lm_sight *restrict sight)
{
    const int32_t *const middle = height_q14_of + CODE_MIDDLE;
    for (uint32_t i = 0; i < grid->cells; i++) {
        const uint32_t cell = line->cell[i];
        /* Elevation below 2^29, height below 2^27, fall below 2^30: below 2^31, times 2^30. */
        const int32_t apparent_q14 =
            line->elevation_q14[i] + middle[signed_code(cell)] - grid->fall_q14[i];
        /* Without a sign, which the 32 bits kept do not see: vectors have no other shift. */
        const int64_t tangent = (int64_t)apparent_q14 * grid->inverse_range[i];
        sight->horizon[i + 1] = (int32_t)((uint64_t)tangent >> 30);
        sight->level_q8[i] = (int32_t)(cell >> 8) * LM_GAMMA_CODE_STEP_Q8 + grid->gain_q8[i];
    }
}

enum { CLASS_BITS = 0xF0 };

/* Whether each cell is of another class than the one before it. */
static void find_borders(const uint32_t *cell, uint32_t cells, uint8_t *restrict is_border)
{
    is_border[0] = 0;
    for (uint32_t i = 1; i < cells; i++) {
        is_border[i] = ((cell[i] ^ cell[i - 1]) & CLASS_BITS) != 0;
    }
    for (uint32_t i = cells; i < cells + LM_LANES; i++) {
        is_border[i] = 0;
    }
}

/* The first border from cell `i` on; `cells` when there is none. Borders are rare: eight cells are
 * looked at in one go. (The compiler makes one load of the eight bytes where this is their order in
 * memory.) */
static inline uint32_t next_border(const uint8_t *is_border, uint32_t i, uint32_t cells)
{
    for (; i < cells; i += 8) {
        const uint8_t *b = is_border + i;
        const uint64_t eight = b[0] | (uint64_t)b[1] << 8 | (uint64_t)b[2] << 16 |
                               (uint64_t)b[3] << 24 | (uint64_t)b[4] << 32 | (uint64_t)b[5] << 40 |
                               (uint64_t)b[6] << 48 | (uint64_t)b[7] << 56;
        if (eight != 0) {
            return i + (uint32_t)fx_ctz64(eight) / 8;
        }
    }
    return cells;
}

/* The far shore's brightness, from its first cell on. */
static void add_shore(const struct lm_range_grid *grid, int32_t shore_q8,
                      const uint8_t kind_of[LM_DB_CLASSES], const uint32_t *cell, uint32_t i,
                      int32_t *level_q8)
{
    for (; i < grid->cells && shore_q8 > 0; i++, shore_q8 -= grid->shore_fall_q8) {
        if (kind_of[cell[i] >> 4 & 15] == LM_KIND_WATER) {
            return;
        }
        level_q8[i] += shore_q8;
    }
}

/* Leading edges and far shores: E_i of the equations. The first cell shown enters nothing. */
static void add_edges(const struct lm_range_grid *grid, const struct lm_aspect_config *config,
                      const struct lm_classes *classes, const uint32_t *cell, int32_t *level_q8)
{
    uint8_t kind_of[LM_DB_CLASSES], is_border[LM_CELLS_ROOM];
    for (int i = 0; i < LM_DB_CLASSES; i++) {
        kind_of[i] = classes->entry[i].kind;
    }
    find_borders(cell, grid->cells, is_border);
    uint32_t i = next_border(is_border, grid->first + 1, grid->cells);
    for (; i < grid->cells; i = next_border(is_border, i + 1, grid->cells)) {
        const uint8_t kind = kind_of[cell[i] >> 4 & 15], before = kind_of[cell[i - 1] >> 4 & 15];
        if (kind == before) {
            continue;
        }
        if (kind == LM_KIND_STRUCTURE) {
            level_q8[i] += config->edge_structure_q8;
        } else if (kind == LM_KIND_TREES) {
            level_q8[i] += config->edge_trees_q8;
        }
        if (before == LM_KIND_WATER) {
            add_shore(grid, config->shore_q8, kind_of, cell, i, level_q8);
        }
    }
}

/* The running horizon: the only step in which a cell waits for the one before it. */
static void raise_horizon(const struct lm_range_grid *grid, int32_t start, int32_t *horizon)
{
    for (uint32_t i = 0; i <= grid->first; i++) {
        horizon[i] = start;
    }
    int32_t *const end = horizon + grid->cells + 1;
    for (int32_t *tangent = horizon + grid->first + 1; tangent < end; tangent++) {
        start = *tangent > start ? *tangent : start;
        *tangent = start;
    }
}

/* Light each cell by what it shows above the horizon; 32 bits without a sign hold the rise from any
 * tangent to any other. */
static void light(const int32_t *horizon, uint32_t cells, int32_t *restrict level_q8)
{
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t rise = (uint32_t)horizon[i + 1] - (uint32_t)horizon[i];
        const int32_t lit_q8 = level_q8[i] + fx_db_q8_of_many(rise);
        level_q8[i] = rise ? lit_q8 : LM_LEVEL_SHADOW;
    }
}

/* The horizon that a line starts with in its grid's format; what is beyond every tangent is as good
 * as far beyond. */
static int32_t start_of(const struct lm_range_grid *grid, const struct lm_sight *sight,
                        lm_horizon_q40_t horizon)
{
    const int64_t first = sight->horizon[grid->first + 1];
    const int64_t start =
        horizon == LM_HORIZON_OPEN ? first - grid->flat_rise : horizon >> (40 - grid->tangent_bits);
    return fx_sat_i32(start);
}

lm_horizon_q40_t lm_aspect_run(const struct lm_range_grid *grid,
                               const struct lm_aspect_config *config,
                               const struct lm_classes *classes, const struct lm_scan_line *line,
                               lm_horizon_q40_t horizon, struct lm_sight *sight)
{
    int32_t height_q14_of[CODES];
    set_heights(height_q14_of, classes);
    look(grid, line, height_q14_of, sight);
    if (grid->first < grid->cells) {
        add_edges(grid, config, classes, line->cell, sight->level_q8);
    }
    raise_horizon(grid, start_of(grid, sight, horizon), sight->horizon);
    light(sight->horizon, grid->cells, sight->level_q8);
    return grid->first < grid->cells
               ? sight->horizon[grid->cells] * ((int64_t)1 << (40 - grid->tangent_bits))
               : horizon;
}
