#include "lm/class_gain.h"

#include "fx/sat.h"
#include "lm/kernels_clutter.h"

enum { SEA_STATE_STEP_DB_Q8 = LM_DB_Q8(5) }; /* Nathanson: -40 dB in state 3, -30 dB in state 5 */

_Static_assert((int)LM_DB_CLASSES == LM_K_CODES, "as many classes as lm/kernels_clutter.h has");

void lm_class_gain_set(struct lm_class_gain *g, const struct lm_classes *classes, uint8_t lod,
                       uint8_t sea_state, uint16_t loss_db_q8)
{
    const int32_t above = fx_min_i32(sea_state, LM_SEA_STATE_MAX) - LM_SEA_STATE_OF_IMAGE;
    const int32_t off_db_q8 = fx_min_i32(loss_db_q8, LM_CLUTTER_LOSS_MAX_DB_Q8);
    g->is_any = false;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const uint8_t kind = classes->entry[i].kind & (LM_KINDS - 1);
        const int32_t sea_db_q8 = kind == LM_KIND_WATER ? above * SEA_STATE_STEP_DB_Q8 : 0;
        const int32_t lod_db_q8 = classes->entry[i].lod_gain_db_q8[lod & (LM_DB_LODS_MAX - 1)];
        g->of_class_db_q8[i] =
            fx_clamp_i32(sea_db_q8 + lod_db_q8, -LM_CLASS_GAIN_MAX_DB_Q8, LM_CLASS_GAIN_MAX_DB_Q8) -
            off_db_q8;
        g->is_any |= g->of_class_db_q8[i] != 0;
    }
}

void lm_class_gain_run(const struct lm_class_gain *g, const uint32_t *cell, int32_t *level_db_q8,
                       uint32_t cells)
{
    if (g->is_any) {
        lm_k_class_gain(g->of_class_db_q8, cell, level_db_q8, cells);
    }
}
