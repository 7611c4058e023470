#include "lm/speckle.h"

#include "fx/sat.h"
#include "lm/kernels_clutter.h"
#include "lm/units.h"

_Static_assert((int)LM_NOISE_LOOKS_LOG2_MAX == (int)LM_LOOKS_LOG2_MAX,
               "looks of the noise table and of the radar table");

enum { SEA_STATE_STEP_DB_Q8 = LM_DB_Q8(5) }; /* Nathanson: -40 dB in state 3, -30 dB in state 5 */

_Static_assert((int)LM_TEXTURE_SHAPE_BITS == LM_K_SHAPE_BITS && (int)LM_DB_CLASSES == LM_K_CODES &&
                   (int)LM_NOISE_BLOCK == LM_LANES,
               "lm/speckle.h and lm/noise.h have what lm/kernels_clutter.h wants");

void lm_speckle_run(const struct lm_speckle_config *config, const struct lm_noise_key *noise_key,
                    int32_t *level_db_q8, uint32_t cells)
{
    struct lm_noise_line noise;
    lm_noise_line_set(&noise, noise_key, cells);
    lm_k_noise_add(lm_noise_db_q8[config->looks_log2], noise.entry, level_db_q8, cells);
}

void lm_speckle_floor_run(const struct lm_speckle_config *config, int32_t floor_db_q8,
                          const struct lm_noise_key *noise_key, const int32_t *level_db_q8,
                          int32_t *speckled_db_q8, uint32_t cells)
{
    struct lm_noise_line noise;
    lm_noise_line_set(&noise, noise_key, cells);
    lm_k_noise_floor(lm_noise_db_q8[config->looks_log2], noise.entry, floor_db_q8, level_db_q8,
                     speckled_db_q8, cells);
}

/* List the shapes in use, and note whether a class has a gain. */
static void summarize(struct lm_texture *t)
{
    t->shape_count = 0;
    t->has_gain = false;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        t->has_gain |= t->of_class[i] >> LM_TEXTURE_SHAPE_BITS != 0;
    }
    for (int32_t log2 = 0; log2 <= LM_NOISE_LOOKS_LOG2_MAX; log2++) {
        bool is_used = false;
        for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
            is_used |= lm_texture_shape(t->of_class[i]) == log2;
        }
        if (is_used) {
            t->shape_log2[t->shape_count++] = (uint8_t)log2;
        }
    }
}

void lm_texture_set(struct lm_texture *t, const struct lm_texture_config *config,
                    const struct lm_classes *classes, uint8_t lod, uint8_t sea_state,
                    uint16_t loss_db_q8)
{
    const int32_t above = fx_min_i32(sea_state, LM_SEA_STATE_MAX) - LM_SEA_STATE_OF_IMAGE;
    const int32_t off_db_q8 = fx_min_i32(loss_db_q8, LM_TEXTURE_LOSS_MAX_DB_Q8);
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const uint8_t kind = classes->entry[i].kind & (LM_KINDS - 1);
        const int32_t shape = fx_min_i32(config->shape_log2[kind], LM_TEXTURE_NONE);
        const int32_t sea_db_q8 = kind == LM_KIND_WATER ? above * SEA_STATE_STEP_DB_Q8 : 0;
        const int32_t gain_db_q8 =
            fx_clamp_i32(sea_db_q8 + classes->entry[i].lod_gain_db_q8[lod & (LM_DB_LODS_MAX - 1)],
                         -LM_CLASS_GAIN_MAX_DB_Q8, LM_CLASS_GAIN_MAX_DB_Q8) -
            off_db_q8;
        t->of_class[i] = gain_db_q8 * (1 << LM_TEXTURE_SHAPE_BITS) + shape;
    }
    summarize(t);
}

void lm_texture_run(const struct lm_texture *t, const struct lm_noise_key *noise_key,
                    const uint32_t *cell, int32_t *level_db_q8, uint32_t cells)
{
    struct lm_noise_line noise;
    if (t->has_gain) {
        lm_k_class_gain(t->of_class, cell, level_db_q8, cells);
    }
    lm_noise_line_set(&noise, noise_key, cells);
    for (uint32_t n = 0; n < t->shape_count; n++) {
        const uint8_t shape = t->shape_log2[n];
        lm_k_class_noise(t->of_class, shape, lm_noise_db_q8[shape], noise.entry, cell, level_db_q8,
                         cells);
    }
}
