#include "lm/illumination.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/const.h"
#include "lm/kernels_clutter.h"
#include "lm/units.h"
#include "tops.h"

_Static_assert((int)LM_CLASS_LUT_CODES == LM_K_CODES && (int)LM_DB_CLASSES == LM_K_CODES &&
                   (int)LM_LIT_SCRATCH >= LM_K_LIGHT_WORK,
               "lm/illumination.h has what lm/kernels_clutter.h wants");

enum { GRAZING_MIN_Q24 = 1 << 16 /* 1/256 */ };

/* g of the equations for cell i in Q24: the grazing angle's tangent of flat ground at the reference
 * elevation, (H - z0)/s_i - s_(i-1)/(2a), at least 1/256. `before_m_q8` is s_(i-1). */
static int64_t grazing_q24(const struct lm_range_grid *g, uint32_t i, uint32_t before_m_q8)
{
    /* The height difference is below 2^26, the inverse range below 2^31 in Q(17 + bits): products
     * are below 2^57. */
    const int64_t above_m_q10 = (int64_t)g->height_m_q10 - g->reference_m_q10;
    const int64_t grazing = (above_m_q10 * g->inverse_range[i] >> (3 + g->tangent_bits)) -
                            ((int64_t)before_m_q8 * LM_CURVATURE_Q48 >> 32);
    return grazing < GRAZING_MIN_Q24 ? GRAZING_MIN_Q24 : grazing;
}

/* Fall, inverse range and gain of a cell. `scale_q16` is the part of K that all cells share, as a
 * binary logarithm. */
static void set_cell(struct lm_range_grid *g, uint32_t i, uint32_t range_m_q8, int32_t scale_q16)
{
    /* Drop of the Earth: s^2 / (2a). The range is below 400 km = 2^26.6 in Q8. Its square is below
     * 2^33.2 in units of 16 m^2, and times the curvature below 2^57.2. */
    const int64_t drop_m_q14 =
        ((((int64_t)range_m_q8 * range_m_q8) >> 20) * LM_CURVATURE_Q48) >> 30;
    g->fall_m_q14[i] = (int32_t)(drop_m_q14 + lm_m_q14_of_m_q10(g->height_m_q10));
    /* No cell that is set lies nearer than LM_RANGE_MIN_M. The dividend is at most 2^57, the
     * divisor at least 2^(tangent_bits - 6). NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
    const uint64_t inverse =
        (((uint64_t)1 << (25 + g->tangent_bits)) + range_m_q8 / 2) / range_m_q8;
    g->inverse_range[i] = inverse < INT32_MAX ? (int32_t)inverse : INT32_MAX;

    /* K = s / (ds g), s being the range of the cell before. Tangents are times 2^tangent_bits,
     * which scale_q16 takes out again. */
    const uint32_t before_m_q8 = i == g->first ? range_m_q8 : range_m_q8 - g->cell_m_q8;
    const int32_t log2_q16 = fx_log2_q16(before_m_q8) + scale_q16 -
                             fx_log2_q16_u64((uint64_t)grazing_q24(g, i, before_m_q8));
    const int32_t gain_db_q8 = fx_db_q8_of_log2_q16(log2_q16) + LM_GAMMA_CODE_ZERO_DB_Q8;
    g->gain_db_q8[i] = fx_sat_i16(gain_db_q8 - LM_LEVEL_SHADOW);
}

/* First cell that is at LM_RANGE_MIN_M and at half the antenna's height, or beyond. `cells` if none
 * is. */
static uint32_t first_shown(const struct lm_range_grid *g, uint32_t first_m_q8)
{
    const int32_t half_height_m_q8 = g->height_m_q10 / 8;
    const uint32_t nearest_m_q8 = (uint32_t)fx_max_i32(half_height_m_q8, LM_M_Q8(LM_RANGE_MIN_M));
    if (first_m_q8 >= nearest_m_q8) {
        return 0;
    }
    const uint32_t before = (nearest_m_q8 - first_m_q8 + g->cell_m_q8 - 1) / g->cell_m_q8;
    return before < g->cells ? before : g->cells;
}

void lm_range_grid_set(struct lm_range_grid *g, const struct lm_illumination_config *config,
                       uint32_t first_m_q8, uint32_t cell_m_q8, uint32_t cells,
                       int32_t height_m_q10, int32_t reference_m_q10)
{
    g->cells = cells;
    g->cell_m_q8 = cell_m_q8;
    g->height_m_q10 = height_m_q10;
    g->reference_m_q10 = reference_m_q10;
    g->first = first_shown(g, first_m_q8);
    const uint32_t width_m_q8 = lm_m_q8_of_m(config->shore_width_m);
    const uint32_t shore_cells = (width_m_q8 + cell_m_q8 / 2) / cell_m_q8;
    g->shore_fall_db_q8 = config->shore_db_q8 / (int32_t)(shore_cells ? shore_cells : 1);
    /* Choose the format of tangents: the largest inverse, that of the first displayed cell, takes
     * 31 bits. If no cell is displayed, any format will do. */
    const uint32_t nearest_m_q8 =
        fx_max_u32(first_m_q8 + g->first * cell_m_q8, LM_M_Q8(LM_RANGE_MIN_M));
    g->tangent_bits = (uint32_t)(31 - fx_clz32(nearest_m_q8)) + 6;
    for (uint32_t i = 0; i < g->first; i++) {
        g->fall_m_q14[i] = g->inverse_range[i] = 0; /* read by kernels, not displayed */
        g->gain_db_q8[i] = 0;
    }
    const int32_t scale_q16 = (24 - (int32_t)g->tangent_bits) * 65536 - fx_log2_q16(cell_m_q8);
    for (uint32_t i = g->first; i < cells; i++) {
        set_cell(g, i, first_m_q8 + i * cell_m_q8, scale_q16);
    }
    if (g->first < cells) {
        /* The rise over flat ground is g ds / s. g is below 2^26 and ds below 2^20, so the factors
         * are below 2^36 and 2^22. Formats: Q32 + Q(17 + bits) - 49 shifts. A rise beyond the
         * format saturates: then the first cell is lit whatever it is. */
        const int64_t rise_q32 = grazing_q24(g, g->first, nearest_m_q8) * cell_m_q8;
        const int64_t rise = (rise_q32 >> 10) * (g->inverse_range[g->first] >> 9) >> 30;
        g->flat_rise = rise < INT32_MAX ? (int32_t)rise : INT32_MAX;
    }
}

static uint8_t edge_db_q3_of(int32_t edge_db_q8)
{
    return (uint8_t)(fx_clamp_i32(edge_db_q8, 0, LM_EDGE_MAX_DB_Q8) / 32);
}

void lm_class_lut_set(struct lm_class_lut *class_lut, const struct lm_illumination_config *config,
                      const struct lm_classes *classes)
{
    const uint8_t mark_of[LM_KINDS] = {[LM_KIND_WATER] = LM_K_WATER,
                                       [LM_KIND_STRUCTURE] = LM_K_STRUCTURE,
                                       [LM_KIND_TREES] = LM_K_TREES};
    for (uint32_t n = 0; n < LM_CLASS_LUT_CODES; n++) {
        class_lut->height_dm[n] = classes->height_dm[n];
        class_lut->mark[n] = mark_of[classes->entry[n].kind & (LM_KINDS - 1)];
    }
    class_lut->edge_structure_db_q3 = edge_db_q3_of(config->edge_structure_db_q8);
    class_lut->edge_trees_db_q3 = edge_db_q3_of(config->edge_trees_db_q8);
    class_lut->shore_db_q8 = config->shore_db_q8;
}

/* Tangent of a cell's top. */
static int64_t tangent_of(const struct lm_k_tops *tops, uint32_t i)
{
    const uint32_t code = tops->cell[i] % LM_CLASS_LUT_CODES;
    return lm_k_tangent(tops, i, lm_k_height_m_q14(tops->height_dm_of_code[code]));
}

/* Horizon at the start of a line, in its grid's format. From the antenna, the first cell shows what
 * flat ground would. Behind a foreground it rises as the second does over it; the foreground's own
 * last cell is too long to tell.
 *
 * Range: tangents are apparent heights times s_0 / s, in steps of 2^-14 m. Ground is -16..33 km
 * high, structures 6.6 km, the antenna is within 30 km, and the Earth drops by 9.4 km in 400 km.
 * Any two heights are less than 70 km = 2^30.1 steps apart, so that the rise between two cells fits
 * 32 bits. The start is limited to 2^30 below the first tangent, so that the first rise fits, too.
 */
static int32_t start_tangent(const struct lm_range_grid *grid, const struct lm_k_tops *tops,
                             lm_horizon_q40_t horizon)
{
    const int64_t first = tangent_of(tops, grid->first), lowest = first - (1 << 30);
    int64_t start = first - grid->flat_rise;
    if (horizon != LM_HORIZON_OPEN) {
        const int64_t foreground = horizon >> (40 - grid->tangent_bits);
        const int64_t rise =
            grid->first + 1 < grid->cells ? tangent_of(tops, grid->first + 1) - first : 0;
        start = rise > 0 ? first - rise : start;
        start = foreground > start ? foreground : start;
    }
    return fx_sat_i32(start < lowest ? lowest : start);
}

lm_horizon_q40_t lm_illuminate(const struct lm_range_grid *grid,
                               const struct lm_class_lut *class_lut,
                               const struct lm_class_gain *class_gain,
                               const struct lm_scan_line *line, lm_horizon_q40_t horizon,
                               struct lm_lit_line *lit)
{
    static const int16_t none_db_q8[LM_K_CODES] = {0};
    const struct lm_k_tops tops = tops_of(grid, class_lut, line);
    const struct lm_k_lit_line kernel_line = {
        .tops = tops,
        .gain_db_q8 = grid->gain_db_q8,
        .class_gain_db_q8 = class_gain ? class_gain->of_class_db_q8 : none_db_q8,
        .mark_of_class = class_lut->mark,
        .edge_structure_db_q3 = class_lut->edge_structure_db_q3,
        .edge_trees_db_q3 = class_lut->edge_trees_db_q3,
        .shore_db_q8 = class_lut->shore_db_q8,
        .shore_fall_db_q8 = grid->shore_fall_db_q8,
        .start = start_tangent(grid, &tops, horizon),
        .horizon = lit->horizon,
        .level_db_q8 = lit->level_db_q8,
        .work = lit->scratch,
    };
    lm_k_light(&kernel_line);
    return grid->first < grid->cells
               ? lit->horizon[grid->cells] * ((int64_t)1 << (40 - grid->tangent_bits))
               : horizon;
}
