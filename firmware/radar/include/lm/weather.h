/* Rain and jammers as one line meets them. docs/EQUATIONS.md, "Rain" and "Noise". */
#ifndef LM_WEATHER_H
#define LM_WEATHER_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/environment.h"
#include "lm/scan_line.h"

struct lm_radar;
struct lm_receiver;

/* Where a place lies from the antenna. */
struct lm_bearing {
    uint32_t distance_m_q8; /* metres * 256 */
    fx_bam_t off;           /* of the line of sight, signed */
};

/* A circle of rain as the antenna sees it. */
struct lm_shower {
    struct lm_bearing at; /* its centre */
    uint32_t radius_m;
    uint32_t loss_db_per_m_q32; /* dB a metre, there and back */
    int32_t echo_db_q8;         /* eta, dB of a cross section of a metre squared in a metre cubed */
};

struct lm_weather {
    int32_t noise_rise_db_q8;          /* by jammers, dB; 0: none */
    bool has_rain;                     /* false: the arrays mean nothing */
    int32_t loss_db_q8[LM_CELLS_ROOM]; /* on the way to each bin and back, dB; >= 0 */
    int32_t rain_db_q8[LM_CELLS_ROOM]; /* what its own rain returns, so weakened, dB of gamma */
};

/* How far jammers raise the receiver's noise where the antenna points along `azimuth` (from north):
 * 10 log10(1 + sum of them), dB * 256; 0: none. Cost: 600 instructions for each. */
int32_t lm_noise_rise_db_q8(const struct lm_environment *environment, const struct lm_radar *radar,
                            struct lm_position antenna, fx_bam_t azimuth);

/* The weather along `azimuth` (from north) as seen by `receiver` from `antenna`. The environment
 * has been checked (lm_environment_check). Rain and jammers more than 11.25 degrees of latitude or
 * longitude away are not there. Cost: 40 instructions in fair weather; 600 for each jammer and each
 * circle of rain; 12 a bin for each circle that the line meets. */
void lm_weather_line(struct lm_weather *w, const struct lm_environment *environment,
                     const struct lm_receiver *receiver, const struct lm_radar *radar,
                     struct lm_position antenna, fx_bam_t azimuth);

#endif
