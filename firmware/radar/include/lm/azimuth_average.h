/* The ground across a sample: azimuths traced side by side, and the mean of what they show. Without
 * it, what is narrower than samples are apart would be met or missed. docs/EQUATIONS.md, "Real
 * beam".
 */
#ifndef LM_AZIMUTH_AVERAGE_H
#define LM_AZIMUTH_AVERAGE_H

#include <stdint.h>

#include "fx/types.h"
#include "lm/scan_line.h"

enum { LM_AZIMUTH_AVERAGE_LOG2_MAX = 3 }; /* eight azimuths */

/* The sum of the powers of the azimuths so far, as levels. */
struct lm_azimuth_average {
    int32_t sum_db_q8[LM_CELLS_ROOM];
};

/* How far to the right of the middle of a sample (signed BAM) the turn-th of 2^azimuths_log2
 * azimuths lies: the middles of as many equal parts of `spacing`, from the left and then from the
 * right, so that the last is one of those nearest to the sample's middle. */
int32_t lm_azimuth_average_offset(fx_bam_t spacing, uint32_t azimuths_log2, uint32_t turn);

/* The levels of the first azimuth. */
void lm_azimuth_average_begin(struct lm_azimuth_average *f, const int32_t *level_db_q8,
                              uint32_t cells);

/* Add those of another; each is good to 0.018 dB. Cost: see docs/benchmarks.md. */
void lm_azimuth_average_add(struct lm_azimuth_average *f, const int32_t *level_db_q8,
                            uint32_t cells);

/* Put the mean of all 2^azimuths_log2, 1..LM_AZIMUTH_AVERAGE_LOG2_MAX, in the place of the last
 * one's levels, which are not added before; LM_LEVEL_SHADOW or hardly more where every one is that.
 */
void lm_azimuth_average_mean(const struct lm_azimuth_average *f, uint32_t azimuths_log2,
                             int32_t *level_db_q8, uint32_t cells);

#endif
