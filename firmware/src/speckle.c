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

void lm_speckle_floor_run(const struct lm_speckle_config *config, int32_t floor_q8,
                          const uint32_t *noise, const int32_t *level_q8,
                          int32_t *restrict speckled_q8, uint32_t cells)
{
    const struct lm_speckle_config looks = *config; /* once, and not in the loop */
    uint32_t i = speckle_floor_neon(&looks, floor_q8, noise, level_q8, speckled_q8, cells);
    for (; i < cells; i++) {
        const int32_t sum_q8 = fx_db_q8_sum_of_many(level_q8[i], floor_q8);
        speckled_q8[i] = sum_q8 + lm_speckle_of_q8(&looks, noise[i]);
    }
}

void lm_texture_set(struct lm_texture *t, const struct lm_texture_config *config,
                    const struct lm_classes *classes, uint8_t sea_state, uint16_t loss_q8)
{
    const int32_t above = fx_min_i32(sea_state, LM_SEA_STATE_MAX) - LM_SEA_STATE_OF_IMAGE;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const uint8_t kind = classes->entry[i].kind & (LM_KINDS - 1);
        const int32_t row = config->shape_log2[kind];
        const bool has_texture = row <= LM_SPECKLE_LOOKS_LOG2_MAX;
        const int32_t entry = has_texture ? (row + 1) * LM_SPECKLE_SLICES - 1 : 0;
        /* Below 2^17 either way, so that it fits above the entry. */
        const int32_t gain_q8 = (kind == LM_KIND_WATER ? above * SEA_STATE_STEP_Q8 : 0) -
                                (has_texture ? 0 : lm_speckle_q8[0][0]) - loss_q8;
        t->of_class[i] = gain_q8 * (1 << LM_TEXTURE_ENTRY_BITS) + entry;
    }
}

void lm_texture_run(const struct lm_texture *t, const uint32_t *cell, const uint32_t *noise,
                    int32_t *restrict level_q8, uint32_t cells)
{
    /* The rows as one, and signed indices: so that it becomes gathers. */
    const int32_t *const table_q8 = lm_speckle_q8[0];
    for (uint32_t i = texture_neon(t, cell, noise, level_q8, cells); i < cells; i++) {
        const int32_t of_class = t->of_class[(int32_t)cell[i] >> 4 & (LM_DB_CLASSES - 1)];
        const int32_t slice = (int32_t)noise[i] >> 12 & (LM_SPECKLE_SLICES - 1);
        const int32_t entry = of_class & (TEXTURE_ROWS | slice);
        level_q8[i] += (of_class >> LM_TEXTURE_ENTRY_BITS) + table_q8[entry];
    }
}
