/* Weather of a line: loss and echo of rain, and noise of jammers, as one display line meets them.
 * Source: docs/EQUATIONS.md, "Rain" and "Noise". */
#ifndef LM_WEATHER_H
#define LM_WEATHER_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/environment.h"
#include "lm/scan_line.h"

struct lm_radar;
struct lm_receiver;

/* Position as seen from the antenna. */
struct lm_bearing {
    uint32_t distance_m_q8;
    fx_bam_t off; /* signed angle to the right of the line of sight */
};

/* Shower: a circle of rain as the antenna sees it. */
struct lm_shower {
    struct lm_bearing at; /* centre of the circle */
    uint32_t radius_m;
    uint32_t loss_db_per_m_q32; /* loss for each metre in the rain, both ways */
    int32_t echo_db_q8;         /* eta: cross section of a cubic metre of rain, dB of 1 m2/m3 */
};

/* Weather along one line. The caller owns it. */
struct lm_weather {
    int32_t noise_rise_db_q8;          /* rise of the noise by jammers; 0: none */
    bool has_rain;                     /* false: the arrays are not set */
    int32_t loss_db_q8[LM_CELLS_ROOM]; /* on the way to each bin and back; 0 or more */
    int32_t
        rain_db_q8[LM_CELLS_ROOM]; /* echo of each bin's own rain after that loss, dB of gamma */
};

/* Rise of the receiver's noise by jammers, with the antenna pointing along `azimuth` (from north):
 * 10 log10(1 + sum of their ratios to the noise). 0 if there are none. Jammers more than 11.25
 * degrees of latitude or longitude away are ignored. Cost: 600 instructions for each jammer. */
int32_t lm_noise_rise_db_q8(const struct lm_environment *environment, const struct lm_radar *radar,
                            struct lm_position antenna, fx_bam_t azimuth);

/* Compute the weather along `azimuth` (from north), for the bins of `receiver`, seen from
 * `antenna`. `environment` has passed lm_environment_check. Rain and jammers more than 11.25
 * degrees of latitude or longitude away are ignored. All pointers are borrowed for the call.
 *
 * Cost: 40 instructions in fair weather; 600 for each jammer and each circle of rain; 12 a bin for
 * each circle that the line meets. */
void lm_weather_line(struct lm_weather *w, const struct lm_environment *environment,
                     const struct lm_receiver *receiver, const struct lm_radar *radar,
                     struct lm_position antenna, fx_bam_t azimuth);

#endif
