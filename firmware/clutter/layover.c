#include "lm/layover.h"

#include "fx/sat.h"
#include "lm/kernels_clutter.h"
#include "lm/units.h"

_Static_assert((int)LM_LAYOVER_ROOM == (int)LM_K_LAYOVER_ROOM &&
                   (int)LM_CLASS_LUT_CODES == (int)LM_K_CODES,
               "the kernel's lines are as long");

/* Sixteenths of a cell that a structure is displaced: 16 (dm / 10) lean / cell. Up to 2^16 * 2^17 +
 * 2^32. */
static uint32_t sixteenths_of_dm(const struct lm_layover_view *view, uint32_t height_dm)
{
    const uint64_t per_cell = (uint64_t)160 * view->cell_m_q8;
    const uint64_t nearest = ((uint64_t)height_dm * view->lean_q16 + per_cell / 2) / per_cell;
    return nearest < INT16_MAX ? (uint32_t)nearest : INT16_MAX;
}

void lm_layover_set(struct lm_layover *l, const struct lm_classes *classes,
                    const struct lm_layover_view *view)
{
    /* 16 lean / cell, for metres in Q14, in Q31: below 2^17 * 2^13, and to the nearest. */
    const uint32_t sixteenths_q31 =
        ((view->lean_q16 << 13) + view->cell_m_q8 / 2) / view->cell_m_q8;
    *l = (struct lm_layover){.first = view->first,
                             .cells = view->cells,
                             .reference_m_q14 = (int32_t)lm_m_q14_of_m_q10(view->reference_m_q10),
                             .sixteenths_q31 = (int32_t)sixteenths_q31};
    for (uint32_t code = 0; code < LM_CLASS_LUT_CODES; code++) {
        const uint32_t sixteenths = sixteenths_of_dm(view, classes->height_dm[code]);
        l->height_sixteenths[0][code] = (uint8_t)sixteenths;
        l->height_sixteenths[1][code] = (uint8_t)(sixteenths >> 8);
    }
}

int16_t *lm_layover_run(const struct lm_layover *l, const struct lm_scan_line *ground,
                        int16_t *level_db_q8, int16_t *laid_db_q8)
{
    const struct lm_k_layover line = {.cell = ground->cell,
                                      .elevation_m_q14 = ground->elevation_m_q14,
                                      .level_db_q8 = level_db_q8,
                                      .cells = l->cells,
                                      .reference_m_q14 = l->reference_m_q14,
                                      .sixteenths_q31 = l->sixteenths_q31,
                                      .height_sixteenths = l->height_sixteenths};
    int16_t *const shown_db_q8 = laid_db_q8 + LM_K_LAYOVER_MARGIN;
    for (uint32_t i = line.cells; i % 16 != 0; i++) {
        level_db_q8[i] = LM_LEVEL_SHADOW;
    }
    lm_k_layover(&line, laid_db_q8);
    for (uint32_t i = 0; i < l->first; i++) {
        shown_db_q8[i] = LM_LEVEL_SHADOW;
    }
    return shown_db_q8;
}
