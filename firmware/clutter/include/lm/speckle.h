/* Speckle and texture of a line, with the sea state and the noise floor. Draws come from the noise
 * table (lm/noise.h). Laws: docs/EQUATIONS.md, "Speckle and texture" and "Noise".
 *
 *     levels --lm_texture_run--> ground's own variation --lm_speckle_run--> a patch or sample
 *                                                       --lm_speckle_floor_run--> with noise floor
 */
#ifndef LM_SPECKLE_H
#define LM_SPECKLE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/db.h"
#include "lm/environment.h"
#include "lm/noise.h"
#include "lm/radar.h"
#include "lm/units.h"

enum {
    LM_TEXTURE_SHAPE_BITS = 3,
    LM_TEXTURE_LOSS_MAX_DB_Q8 = LM_DB_Q8(64),
    LM_CLASS_GAIN_MAX_DB_Q8 = LM_DB_Q8(25) /* what the highest sea state gives water */
};

/* Texture: gain and shape of each class. Prepared once a sector or patch.
 *
 * A class has one word, so that a vector machine makes one look-up:
 *
 *     bits 31..3   gain in dB * 256, signed
 *     bits 2..0    log2 of the shape nu, or LM_TEXTURE_NONE */
struct lm_texture {
    int32_t of_class[LM_DB_CLASSES];
    uint8_t shape_log2[LM_NOISE_LOOKS_LOG2_MAX + 1]; /* shapes in use, ascending */
    uint8_t shape_count;                             /* entries of shape_log2 in use */
    bool has_gain;                                   /* true if a class has a gain other than 0 */
};

/* Shape of a class's word: log2 nu, or LM_TEXTURE_NONE. */
static inline int32_t lm_texture_shape(int32_t of_class)
{
    return of_class & ((1 << LM_TEXTURE_SHAPE_BITS) - 1);
}

/* Prepare the texture. The shape follows the kind of each class. The gain is that of the class in
 * the LOD that the map is read from, plus that of the sea state for water, less loss_db_q8 for all.
 *
 * - An LOD is below LM_DB_LODS_MAX.
 * - A gain of class and sea state beyond LM_CLASS_GAIN_MAX_DB_Q8 either way counts as that.
 * - A sea state above LM_SEA_STATE_MAX counts as that.
 * - A shape above LM_TEXTURE_NONE counts as none.
 * - A loss above LM_TEXTURE_LOSS_MAX_DB_Q8 counts as that.
 *
 * `config` and `classes` are borrowed for the call. Cost: 250 instructions. */
void lm_texture_set(struct lm_texture *t, const struct lm_texture_config *config,
                    const struct lm_classes *classes, uint8_t lod, uint8_t sea_state,
                    uint16_t loss_db_q8);

/* The stages below work on whole pairs of blocks, of LM_NOISE_BLOCK cells each. Arrays of levels
 * and cells have room for whole pairs, and what is written behind the last cell means nothing.
 * `cells` is at most LM_CELLS_MAX. Pointers are borrowed for the call. Costs: see
 * docs/benchmarks.md. */

/* Multiply the power of each cell by the texture of its class, in place. `cell` is that of struct
 * lm_scan_line. A level changes by -123..34 dB, of which -64 is for a loss. Hence LM_LEVEL_SHADOW
 * stays below -80 dB, also after speckle. */
void lm_texture_run(const struct lm_texture *t, const struct lm_noise_key *noise_key,
                    const uint32_t *cell, int32_t *level_db_q8, uint32_t cells);

/* Multiply the power of each cell by its speckle, in place. */
void lm_speckle_run(const struct lm_speckle_config *config, const struct lm_noise_key *noise_key,
                    int32_t *level_db_q8, uint32_t cells);

/* Add the noise floor to the power of each cell, and multiply the sum by its speckle:
 * 10 log10(10^(level/10) + 10^(floor/10)) plus the draw. Levels and floor are within 2^30 of 0. The
 * worst error of the sum is 0.018 dB. The two arrays must not overlap. */
void lm_speckle_floor_run(const struct lm_speckle_config *config, int32_t floor_db_q8,
                          const struct lm_noise_key *noise_key, const int32_t *level_db_q8,
                          int32_t *speckled_db_q8, uint32_t cells);

#endif
