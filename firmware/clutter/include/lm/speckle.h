/* Speckle of a line, alone or with the noise floor. Draws come from the noise table (lm/noise.h).
 * Laws: docs/EQUATIONS.md, "Speckle" and "Noise". */
#ifndef LM_SPECKLE_H
#define LM_SPECKLE_H

#include <stdint.h>

#include "lm/noise.h"
#include "lm/radar.h"

/* The stages below work on whole pairs of blocks, of LM_NOISE_BLOCK cells each. Arrays of levels
 * have room for whole pairs, and what is written behind the last cell means nothing.
 * `cells` is at most LM_CELLS_MAX. Pointers are borrowed for the call. Costs: see
 * docs/benchmarks.md. */

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
