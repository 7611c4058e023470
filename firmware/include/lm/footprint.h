/* The ground across a sample: azimuths traced side by side, and the mean of what they show. Without
 * it, what is narrower than samples are apart would be met or missed. docs/DESIGN.md, "Real beam".
 */
#ifndef LM_FOOTPRINT_H
#define LM_FOOTPRINT_H

#include <stdint.h>

#include "fx/types.h"
#include "lm/scan_line.h"

enum { LM_FOOTPRINT_LOG2_MAX = 3 }; /* eight azimuths */

/* Mean power of the cells, as far as it is known: each azimuth adds its share. 1.0 in Q24 is 0 dB
 * of gamma. */
struct lm_footprint {
    uint32_t power_q24[LM_CELLS_ROOM];
};

/* How far to the right of the middle of a sample (signed BAM) the turn-th of 2^azimuths_log2
 * azimuths lies: the middles of as many equal parts of `spacing`. The last turn is one of those
 * nearest to the sample's middle. */
int32_t lm_footprint_offset(fx_bam_t spacing, uint32_t azimuths_log2, uint32_t turn);

void lm_footprint_clear(struct lm_footprint *f, uint32_t cells);

/* Add the levels of one of 2^azimuths_log2 azimuths, 1..LM_FOOTPRINT_LOG2_MAX. Shares are cut to
 * whole parts of 2^24. Cost: see docs/benchmarks.md. */
void lm_footprint_add(struct lm_footprint *f, const int32_t *level_q8, uint32_t cells,
                      uint32_t azimuths_log2);

/* The mean as levels; LM_LEVEL_SHADOW where there is none. */
void lm_footprint_levels(const struct lm_footprint *f, int32_t *level_q8, uint32_t cells);

#endif
