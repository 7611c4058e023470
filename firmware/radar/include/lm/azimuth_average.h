/* Azimuth average: mean power of several azimuths traced side by side for one sample. Without it,
 * an object narrower than the distance between samples would be met or missed by chance.
 *
 * Order of the calls for a sample of n = 2^azimuths_log2 azimuths: _begin with the first, _add with
 * the second to the last but one, _mean with the last. Source: docs/EQUATIONS.md, "Azimuth
 * average".
 */
#ifndef LM_AZIMUTH_AVERAGE_H
#define LM_AZIMUTH_AVERAGE_H

#include <stdint.h>

#include "fx/types.h"
#include "lm/scan_line.h"

enum { LM_AZIMUTH_AVERAGE_LOG2_MAX = 3 }; /* eight azimuths */

/* Sum of the powers of the azimuths so far, as levels. The caller owns it. */
struct lm_azimuth_average {
    int16_t sum_db_q8[LM_CELLS_ROOM];
};

/* Offset of an azimuth from the middle of its sample, signed BAM, right positive. The azimuths are
 * the middles of 2^azimuths_log2 equal parts of `spacing`. `turn` numbers them in the order of
 * tracing: from the left edge inwards, then from the right edge inwards. For four azimuths:
 *
 *     left edge | turn 0 | turn 1 | turn 3 | turn 2 | right edge
 *
 * The last one traced is therefore next to the sample's middle. */
int32_t lm_azimuth_average_offset(fx_bam_t spacing, uint32_t azimuths_log2, uint32_t turn);

/* Begin with the levels of the first azimuth. */
void lm_azimuth_average_begin(struct lm_azimuth_average *f, const int16_t *level_db_q8,
                              uint32_t cells);

/* Add the levels of another azimuth. Each addition is good to 0.018 dB. Cost: docs/benchmarks.md.
 */
void lm_azimuth_average_add(struct lm_azimuth_average *f, const int16_t *level_db_q8,
                            uint32_t cells);

/* Replace `level_db_q8`, the levels of the last azimuth, by the mean power of all 2^azimuths_log2.
 * The last azimuth must not have been added before. azimuths_log2 is
 * 1..LM_AZIMUTH_AVERAGE_LOG2_MAX. Cells in shadow in every azimuth stay within 1/256 dB of
 * LM_LEVEL_SHADOW. */
void lm_azimuth_average_mean(const struct lm_azimuth_average *f, uint32_t azimuths_log2,
                             int16_t *level_db_q8, uint32_t cells);

#endif
