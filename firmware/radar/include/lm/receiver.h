/* The receiver of a real-beam line: pulse, weather, noise, logarithm and the end of the time gain.
 * Bins are those of lm/slant.h. docs/EQUATIONS.md, "Real beam". */
#ifndef LM_RECEIVER_H
#define LM_RECEIVER_H

#include <stdint.h>

#include "lm/radar.h"
#include "lm/slant.h"
#include "lm/weather.h"

enum { LM_PULSE_REACH_MAX = 4 }; /* bins to either side that a pulse may cover */

/* What depends on scale, height and field alone, worked out once for many lines. */
struct lm_receiver {
    uint32_t first_m_q8,
        cell_m_q8; /* slant range of bin 0's centre, and between centres; metres * 256 */
    uint32_t cells;
    uint32_t looks_log2; /* of the noise */
    /* Share of the bins m to either side in a bin's power: 65536 in all, weight_q16[0] alone when
     * the pulse is not longer than a bin. */
    uint32_t weight_q16[LM_PULSE_REACH_MAX + 1];
    int32_t noise_db_q8[LM_CELLS_ROOM];       /* mean, dB of gamma */
    int32_t stc_rolloff_db_q8[LM_CELLS_ROOM]; /* behind the time gain's end, dB; >= 0 */
    int32_t volume_db_q8[LM_CELLS_ROOM]; /* 10 log10(r b / g): gamma of scatterers that fill the
                                         beam with a cross section of 1 in a metre cubed */
};

/* Bins of `slant` over flat ground `height_m_q10` (metres * 1024, within 30 km) below the antenna,
 * on scale `range_index` (index into radar->range_m), seen with a pulse of `pulse_ns` (any). Cost:
 * about 170 instructions a bin. */
void lm_receiver_set(struct lm_receiver *r, const struct lm_radar *radar,
                     const struct lm_slant *slant, int32_t height_m_q10, uint8_t range_index,
                     uint32_t pulse_ns);

/* Level of each bin, 1/256 dB, from its power (1.0 in Q24 is 0 dB of gamma), which is changed.
 * `weather` is NULL when it is fair and nobody jams. `line` and `sweep` choose the noise. Levels
 * are within 500 dB of 0, and within 0.05 dB of the equations but for the power's own step of
 * 2^-24. Cost: 7 instructions a bin on a machine with vectors of eight; a pulse longer than a bin
 * takes 9 more, rain 2. */
void lm_receiver_run(const struct lm_receiver *r, const struct lm_weather *weather, uint32_t line,
                     uint32_t sweep, uint32_t *power_q24, int32_t *level_db_q8);

#endif
