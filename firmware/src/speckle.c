#include "lm/speckle.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "speckle_neon.h"

enum { SEA_STATE_STEP_Q8 = 5 * 256 }; /* Nathanson: -40 dB in state 3, -30 dB in state 5 */

void lm_speckle_run(const struct lm_speckle_config *config, const uint32_t *noise,
                    int32_t *restrict level_q8, uint32_t cells)
{
    const struct lm_speckle_config looks = *config;
    for (uint32_t i = 0; i < cells; i++) {
        level_q8[i] += lm_speckle_of_q8(&looks, noise[i]);
    }
}

void lm_texture_set(struct lm_texture *t, const struct lm_texture_config *config,
                    const struct lm_classes *classes, uint8_t sea_state)
{
    const int32_t above = fx_min_i32(sea_state, LM_SEA_STATE_MAX) - LM_SEA_STATE_OF_IMAGE;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const uint8_t kind = classes->entry[i].kind & (LM_KINDS - 1);
        const int32_t row = config->shape_log2[kind];
        const bool has_texture = row <= LM_SPECKLE_LOOKS_LOG2_MAX;
        t->entry[i] = has_texture ? row * LM_SPECKLE_SLICES : 0;
        t->among[i] = has_texture ? LM_SPECKLE_SLICES - 1 : 0;
        t->gain_q8[i] = (kind == LM_KIND_WATER ? above * SEA_STATE_STEP_Q8 : 0) -
                        (has_texture ? 0 : lm_speckle_q8[0][0]);
    }
}

void lm_texture_run(const struct lm_texture *t, const uint32_t *cell, const uint32_t *noise,
                    int32_t *restrict level_q8, uint32_t cells)
{
    /* The rows as one, and signed indices: so that it becomes gathers. */
    const int32_t *const table_q8 = lm_speckle_q8[0];
    for (uint32_t i = texture_neon(t, cell, noise, level_q8, cells); i < cells; i++) {
        const int32_t class_index = (int32_t)cell[i] >> 4 & 15;
        const int32_t slice = (int32_t)noise[i] >> 12 & t->among[class_index];
        level_q8[i] += t->gain_q8[class_index] + table_q8[t->entry[class_index] + slice];
    }
}

void lm_floor_run(int32_t floor_q8, int32_t *restrict level_q8, uint32_t cells)
{
    for (uint32_t i = floor_neon(floor_q8, level_q8, cells); i < cells; i++) {
        level_q8[i] = fx_db_q8_sum_of_many(level_q8[i], floor_q8);
    }
}
