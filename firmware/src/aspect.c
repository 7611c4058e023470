#include "lm/aspect.h"

#include "fx/log.h"

/* 1 / (2 * 4/3 * 6,371,000 m) in Q48. */
static const int64_t curvature_q48 = 16567747;

enum { GRAZING_MIN_Q24 = 1 << 16 }; /* 1/256 */

/* Decibels (Q8) of a number whose binary logarithm is given in Q16: 10 log10(2) = 3.0103, here 770.637 / 256. */
static int32_t db_q8_of_log2_q16(int32_t log2_q16)
{
    return (int32_t)(((int64_t)log2_q16 * 50504453 + ((int64_t)1 << 31)) >> 32);
}

static void set_cell(struct lm_range_grid *g, uint32_t i, uint32_t range_q8)
{
    /* range < 400 km = 2^26.6 in Q8; squared 2^53.2; the drop stays below 10 km. */
    const int64_t drop_q10 = ((((int64_t)range_q8 * range_q8) >> 14) * curvature_q48) >> 40;
    g->fall_q10[i] = (int32_t)drop_q10 + g->height_q10;
    g->inverse_range_q40[i] = (uint32_t)((((uint64_t)1 << 48) - 1) / range_q8);

    const int64_t above_q10 = (int64_t)g->height_q10 - g->reference_q10;
    int64_t grazing_q24 = (above_q10 * g->inverse_range_q40[i] >> 26) -
                          ((int64_t)range_q8 * curvature_q48 >> 32);
    if (grazing_q24 < GRAZING_MIN_Q24) {
        grazing_q24 = GRAZING_MIN_Q24;
    }
    /* K = s / (ds g), and the tangent's rise d comes in Q30. */
    const int32_t log2_q16 = fx_log2_q16(range_q8) - fx_log2_q16(g->cell_q8) -
                             fx_log2_q16_u64((uint64_t)grazing_q24) + (24 - 30) * 65536;
    g->gain_q8[i] = db_q8_of_log2_q16(log2_q16);
    if (i == g->first) {
        g->flat_rise_q30 =
            (int32_t)(((grazing_q24 * g->cell_q8 >> 8) * g->inverse_range_q40[i]) >> 34);
    }
}

void lm_range_grid_set(struct lm_range_grid *g, const struct lm_aspect_config *config,
                       uint32_t first_q8, uint32_t cell_q8, uint32_t cells, int32_t height_q10,
                       int32_t reference_q10)
{
    g->cells = cells;
    g->cell_q8 = cell_q8;
    g->height_q10 = height_q10;
    g->reference_q10 = reference_q10;
    g->first = 0;
    const uint32_t width_q8 = (uint32_t)config->shore_width_m << 8;
    const uint32_t shore_cells = (width_q8 + cell_q8 / 2) / cell_q8;
    g->shore_fall_q8 = config->shore_q8 / (int32_t)(shore_cells ? shore_cells : 1);
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t range_q8 = first_q8 + i * cell_q8;
        if (range_q8 < (uint32_t)LM_RANGE_MIN_M << 8) {
            g->first = i + 1;
        } else {
            set_cell(g, i, range_q8);
        }
    }
}

/* What the line has passed, as far as the next cell cares. */
struct passage {
    uint8_t kind;
    int32_t shore_q8; /* what is left of the far shore's brightness */
};

/* Leading edge and far shore: E_i of the equations. */
static inline int32_t edge_q8(struct passage *p, uint8_t kind, const struct lm_aspect_config *config,
                              int32_t shore_fall_q8)
{
    int32_t leading_q8 = 0;
    if (kind == p->kind) {
        p->shore_q8 = p->shore_q8 > shore_fall_q8 ? p->shore_q8 - shore_fall_q8 : 0;
        return p->shore_q8;
    }
    if (kind == LM_KIND_WATER) {
        p->shore_q8 = 0;
    } else if (p->kind == LM_KIND_WATER) {
        p->shore_q8 = config->shore_q8;
    } else {
        p->shore_q8 = p->shore_q8 > shore_fall_q8 ? p->shore_q8 - shore_fall_q8 : 0;
    }
    if (kind == LM_KIND_STRUCTURE) {
        leading_q8 = config->edge_structure_q8;
    } else if (kind == LM_KIND_TREES) {
        leading_q8 = config->edge_trees_q8;
    }
    p->kind = kind;
    return leading_q8 + p->shore_q8;
}

lm_horizon_q30_t lm_aspect_run(const struct lm_range_grid *grid,
                               const struct lm_aspect_config *config,
                               const struct lm_classes *classes, const struct lm_scan_line *line,
                               lm_horizon_q30_t horizon, int32_t *level_q8)
{
    uint8_t kind_of[LM_DB_CLASSES];
    int32_t height_q10_of[16];
    for (int i = 0; i < LM_DB_CLASSES; i++) {
        kind_of[i] = classes->entry[i].kind;
        height_q10_of[i] = classes->height_dm[i] * 512 / 5; /* decimetres to Q10 metres */
    }
    struct passage passage = {.kind = LM_KIND_GROUND, .shore_q8 = 0};
    for (uint32_t i = 0; i < grid->first; i++) {
        level_q8[i] = LM_LEVEL_SHADOW;
    }
    for (uint32_t i = grid->first; i < grid->cells; i++) {
        const uint32_t cell = line->cell[i];
        const uint32_t class_index = cell >> 4 & 15;
        const int32_t edge = edge_q8(&passage, kind_of[class_index], config, grid->shore_fall_q8);
        /* Apparent height: |z + h - fall| < 2^25, times 2^32: 2^57. */
        const int32_t apparent_q10 =
            line->elevation_q10[i] + height_q10_of[cell & 15] - grid->fall_q10[i];
        const int64_t tangent = (int64_t)apparent_q10 * grid->inverse_range_q40[i] >> 20;
        if (horizon == LM_HORIZON_OPEN) {
            horizon = tangent - grid->flat_rise_q30;
        }
        const int64_t rise = tangent - horizon;
        if (rise <= 0 || class_index == LM_DB_CLASS_NONE) {
            level_q8[i] = LM_LEVEL_SHADOW;
            continue;
        }
        horizon = tangent;
        const uint32_t rise_q30 = rise > UINT32_MAX ? UINT32_MAX : (uint32_t)rise;
        level_q8[i] = (int32_t)(cell >> 8) * LM_GAMMA_CODE_STEP_Q8 + LM_GAMMA_CODE_ZERO_Q8 +
                      fx_db_q8(rise_q30) + grid->gain_q8[i] + edge;
    }
    return horizon;
}
