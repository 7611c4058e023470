/* Receiver of a sector's line: pulse length, weather, noise, logarithm and the roll-off behind the
 * STC. Bins are those of lm/slant.h. Source: docs/EQUATIONS.md, "Pulse", "Noise" and "Receiver". */
#ifndef LM_RECEIVER_H
#define LM_RECEIVER_H

#include <stdint.h>

#include "lm/radar.h"
#include "lm/slant.h"
#include "lm/weather.h"

enum { LM_PULSE_REACH_MAX = 4 }; /* most bins on either side that a pulse covers */

/* Receiver settings that depend only on range scale, height and field of view. They are computed
 * once for many lines. The caller owns them. */
struct lm_receiver {
    uint32_t first_m_q8, cell_m_q8; /* slant range of bin 0's centre, and between centres */
    uint32_t cells;                 /* number of bins */
    uint32_t unlit;                 /* of them before ground that the beam lights: none leaks */
    uint32_t looks_log2;            /* looks of the noise */
    int32_t loss_db_q8, rise_db_q8; /* by malfunctions: of the signal, and of the noise */
    /* Pulse: weight of each bin m to either side in a bin's power. weight_q16[0] plus twice the
     * others is 65536. weight_q16[0] is all of it if the pulse is not longer than a bin. */
    uint32_t weight_q16[LM_PULSE_REACH_MAX + 1];
    uint32_t grain_step_q16; /* columns of the grain a bin: a column is a bin or a pulse long,
                                whichever is longer; 1..65536 */
    int32_t noise_db_q8[LM_CELLS_ROOM];  /* mean noise of each bin before the fall, dB of gamma */
    int32_t fall_db_q8[LM_CELLS_ROOM];   /* loss of clear air and behind the STC's end; 0 or more */
    int32_t volume_db_q8[LM_CELLS_ROOM]; /* 10 log10(r b / g): gamma of scatterers that fill the
                                            beam with a cross section of 1 m2/m3 */
};

/* Compute the settings for the bins of `slant`, over flat ground `height_m_q10` below the antenna
 * (within 30 km). `range_index` is an index into radar->range; its row has the pulse of `fov`, and
 * a pulse longer than 9 bins smears over 9. Pointers are borrowed for the call. Cost: about 180
 * instructions a bin. */
void lm_receiver_set(struct lm_receiver *r, const struct lm_radar *radar,
                     const struct lm_slant *slant, int32_t height_m_q10, uint8_t range_index,
                     enum lm_fov fov);

/* Weaken the signal by `loss_db_q8` and raise the noise by `rise_db_q8`, both 0 or more, once after
 * each lm_receiver_set. It costs nothing in a line. */
void lm_receiver_impair(struct lm_receiver *r, int32_t loss_db_q8, int32_t rise_db_q8);

/* What an echo at one slant range stands against, dB: without malfunctions, jammers and rain. */
struct lm_receiver_floor {
    int32_t noise_db_q8; /* mean noise, of gamma, with what clear air takes of the echo */
    int32_t area_db_q8;  /* of a resolution cell: a cross section less this is the gamma of a point
                            in the beam's middle */
};

/* Compute the floor at a slant range, over flat ground `height_m_q10` below the antenna (within
 * 30 km). Cost: about 500 instructions. */
void lm_receiver_floor_at(struct lm_receiver_floor *f, const struct lm_radar *radar,
                          uint32_t slant_m_q8, int32_t height_m_q10, uint8_t range_index,
                          enum lm_fov fov);

/* Replace the power of each bin by its mean over the pulse. Cost: 9 instructions a bin where the
 * pulse is longer than a bin. */
void lm_receiver_pulse(const struct lm_receiver *r, uint32_t *power_q24);

/* Add the power of scatterers, which have no speckle of the ground. Cost: 1 instruction a bin. */
void lm_receiver_join(const struct lm_receiver *r, const uint32_t *steady_q24, uint32_t *power_q24);

/* Compute the level of each bin from its power, behind all of the above; 1.0 in Q24 is 0 dB of
 * gamma. `weather` is NULL in fair weather without jammers. `line` and `sweep` choose the noise.
 *
 * Levels are within 500 dB of 0. They are within 0.05 dB of the equations, apart from the power's
 * own step of 2^-24. Cost: 7 instructions a bin on a machine with vectors of eight; rain takes 2
 * more. */
void lm_receiver_run(const struct lm_receiver *r, const struct lm_weather *weather, uint32_t line,
                     uint32_t sweep, const uint32_t *power_q24, int16_t *level_db_q8);

#endif
