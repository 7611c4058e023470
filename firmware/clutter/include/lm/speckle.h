/* Speckle, texture, the state of the sea and the noise floor, in decibels. docs/EQUATIONS.md,
 * "Speckle and texture". */
#ifndef LM_SPECKLE_H
#define LM_SPECKLE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/db.h"
#include "lm/environment.h"
#include "lm/noise.h"
#include "lm/radar.h"

/* What the texture does to each class, in one word, so that a vector's machine looks up one: the
 * gain in 1/256 dB times 2^LM_TEXTURE_SHAPE_BITS, with a sign, and log2 of the shape, or
 * LM_TEXTURE_NONE, below it. */
enum { LM_TEXTURE_SHAPE_BITS = 3, LM_TEXTURE_LOSS_MAX_DB_Q8 = 64 * 256 };
struct lm_texture {
    int32_t of_class[LM_DB_CLASSES];
    uint8_t shape_log2[LM_NOISE_LOOKS_LOG2_MAX + 1]; /* those in use, rising */
    uint8_t shape_count;                             /* how many */
    bool has_gain;                                   /* of some class it is not 0 */
};

static inline int32_t lm_texture_shape(int32_t of_class)
{
    return of_class & ((1 << LM_TEXTURE_SHAPE_BITS) - 1);
}

/* Shapes by the kind of each class, and the level of water by the state of the sea, all of them
 * less loss_db_q8 (1/256 dB); `sea_state` is taken as LM_SEA_STATE_MAX when it is more, a shape
 * beyond LM_TEXTURE_NONE as none, a loss beyond LM_TEXTURE_LOSS_MAX_DB_Q8 as that. Cost: 150
 * instructions. */
void lm_texture_set(struct lm_texture *t, const struct lm_texture_config *config,
                    const struct lm_classes *classes, uint8_t sea_state, uint16_t loss_db_q8);

/* The stages below work in whole pairs of blocks, of LM_NOISE_BLOCK cells each: levels and classes
 * behind the last cell must have room, and what is written there means nothing. Costs: see
 * docs/benchmarks.md. */

/* Multiply each cell's power by the texture of its class, in place. `cell` as in lm_scan_line. A
 * level gains -113..34 dB, of which -64 for a loss, so that LM_LEVEL_SHADOW stays below -80 dB
 * also after speckle. */
void lm_texture_run(const struct lm_texture *t, const struct lm_noise_key *noise_key,
                    const uint32_t *cell, int32_t *level_db_q8, uint32_t cells);

/* Multiply each cell's power by its speckle, in place. */
void lm_speckle_run(const struct lm_speckle_config *config, const struct lm_noise_key *noise_key,
                    int32_t *level_db_q8, uint32_t cells);

/* The same over clutter and the receiver's noise, whose powers add: from levels to
 * 10 log10(10^(level/10) + 10^(floor/10)) and the cell's speckle. Levels and floor within 2^30 of
 * 0; the sum's worst error is 0.018 dB. */
void lm_speckle_floor_run(const struct lm_speckle_config *config, int32_t floor_db_q8,
                          const struct lm_noise_key *noise_key, const int32_t *level_db_q8,
                          int32_t *speckled_db_q8, uint32_t cells);

#endif
