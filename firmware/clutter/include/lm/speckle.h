/* Speckle of a sector's line. Draws come from the noise table (lm/noise.h). Law: docs/EQUATIONS.md,
 * "Speckle". A patch has lm/grain.h. */
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

#endif
