#include "lm/speckle.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/scan_line.h"
#include "speckle_neon.h"

_Static_assert((int)LM_NOISE_LOOKS_LOG2_MAX == (int)LM_LOOKS_LOG2_MAX,
               "what the table may ask for");

enum { SEA_STATE_STEP_Q8 = 5 * 256 }; /* Nathanson: -40 dB in state 3, -30 dB in state 5 */

static void add_draws(uint32_t looks_log2, const struct lm_noise_line *noise,
                      int32_t *restrict level_q8, uint32_t cells)
{
    int32_t draw_q8[LM_CELLS_ROOM];
    if (FX_HAS_NEON) {
        speckle_neon(lm_noise_q8[looks_log2], noise, level_q8, cells);
        return;
    }
    lm_noise_draw(noise, looks_log2, draw_q8, cells);
    for (uint32_t i = 0; i < cells; i++) {
        level_q8[i] += draw_q8[i];
    }
}

void lm_speckle_run(const struct lm_speckle_config *config, const struct lm_raster *raster,
                    int32_t *restrict level_q8, uint32_t cells)
{
    struct lm_noise_line noise;
    lm_noise_line_set(&noise, raster, cells);
    add_draws(config->looks_log2, &noise, level_q8, cells);
}

void lm_speckle_floor_run(const struct lm_speckle_config *config, int32_t floor_q8,
                          const struct lm_raster *raster, const int32_t *level_q8,
                          int32_t *restrict speckled_q8, uint32_t cells)
{
    struct lm_noise_line noise;
    lm_noise_line_set(&noise, raster, cells);
    if (FX_HAS_NEON) {
        speckle_floor_neon(lm_noise_q8[config->looks_log2], &noise, floor_q8, level_q8, speckled_q8,
                           cells);
        return;
    }
    for (uint32_t i = 0; i < cells; i++) {
        speckled_q8[i] = fx_db_q8_sum_of_many(level_q8[i], floor_q8);
    }
    add_draws(config->looks_log2, &noise, speckled_q8, cells);
}

/* Which shapes the classes have, and whether some gain. */
static void summarize(struct lm_texture *t)
{
    t->shapes = 0;
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
            t->shape_log2[t->shapes++] = (uint8_t)log2;
        }
    }
}

void lm_texture_set(struct lm_texture *t, const struct lm_texture_config *config,
                    const struct lm_classes *classes, uint8_t sea_state, uint16_t loss_q8)
{
    const int32_t above = fx_min_i32(sea_state, LM_SEA_STATE_MAX) - LM_SEA_STATE_OF_IMAGE;
    const int32_t off_q8 = fx_min_i32(loss_q8, LM_TEXTURE_LOSS_MAX_Q8);
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const uint8_t kind = classes->entry[i].kind & (LM_KINDS - 1);
        const int32_t shape = fx_min_i32(config->shape_log2[kind], LM_TEXTURE_NONE);
        const int32_t gain_q8 = (kind == LM_KIND_WATER ? above * SEA_STATE_STEP_Q8 : 0) - off_q8;
        t->of_class[i] = gain_q8 * (1 << LM_TEXTURE_SHAPE_BITS) + shape;
    }
    summarize(t);
}

static int32_t word_of(const struct lm_texture *t, uint32_t cell)
{
    return t->of_class[(int32_t)cell >> 4 & (LM_DB_CLASSES - 1)]; /* signed: becomes a gather */
}

static void add_gains(const struct lm_texture *t, const uint32_t *cell, int32_t *restrict level_q8,
                      uint32_t cells)
{
    if (FX_HAS_NEON) {
        gain_neon(t, cell, level_q8, cells);
        return;
    }
    for (uint32_t i = 0; i < cells; i++) {
        level_q8[i] += word_of(t, cell[i]) >> LM_TEXTURE_SHAPE_BITS;
    }
}

/* The draws of one shape, for the cells of the classes that have it. */
static void add_texture(const struct lm_texture *t, const struct lm_noise_line *noise,
                        int32_t shape, const uint32_t *cell, int32_t *restrict level_q8,
                        uint32_t cells)
{
    int32_t draw_q8[LM_CELLS_ROOM];
    if (FX_HAS_NEON) {
        texture_neon(t, noise, shape, cell, level_q8, cells);
        return;
    }
    lm_noise_draw(noise, (uint32_t)shape, draw_q8, cells);
    for (uint32_t i = 0; i < cells; i++) {
        level_q8[i] += lm_texture_shape(word_of(t, cell[i])) == shape ? draw_q8[i] : 0;
    }
}

void lm_texture_run(const struct lm_texture *t, const struct lm_raster *raster,
                    const uint32_t *cell, int32_t *restrict level_q8, uint32_t cells)
{
    struct lm_noise_line noise;
    if (t->has_gain) {
        add_gains(t, cell, level_q8, cells);
    }
    lm_noise_line_set(&noise, raster, cells);
    for (uint32_t n = 0; n < t->shapes; n++) {
        add_texture(t, &noise, t->shape_log2[n], cell, level_q8, cells);
    }
}
