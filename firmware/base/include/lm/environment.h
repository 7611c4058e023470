/* Environment: rain, jammers, the state of the sea and the wind over it.
 *
 * A script or an instructor sets it (LM_CONTROL_ENVIRONMENT), or the bus (lm/weather_bus.h).
 * Nothing of it comes from the map. Laws: docs/EQUATIONS.md, "Rain", "Noise", "Class
 * gain". */
#ifndef LM_ENVIRONMENT_H
#define LM_ENVIRONMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/geo.h"

enum { LM_RAINS_MAX = 4, LM_JAMMERS_MAX = 4 };

/* Sea states. LM_SEA_STATE_OF_IMAGE is the one that the image's water was made for. */
enum { LM_SEA_STATE_MAX = 8, LM_SEA_STATE_OF_IMAGE = 3 };

/* A round area of even rain. */
struct lm_rain {
    struct lm_position centre;
    uint32_t radius_m; /* 100..100,000 */
    uint16_t mm_per_h; /* 1..150 */
};

/* A noise jammer on the ground. */
struct lm_jammer {
    struct lm_position position;
    int16_t noise_ratio_db_q8; /* jammer to receiver noise, on the antenna's axis and at ten
                                  nautical miles: -20..80 dB */
};

/* The environment as a whole. The water of the image is shown as it is in sea state
 * LM_SEA_STATE_OF_IMAGE. */
struct lm_environment {
    struct lm_rain rain[LM_RAINS_MAX];
    struct lm_jammer jammer[LM_JAMMERS_MAX];
    uint8_t rain_count;    /* entries of `rain` in use, 0..LM_RAINS_MAX */
    uint8_t jammer_count;  /* entries of `jammer` in use, 0..LM_JAMMERS_MAX */
    uint8_t sea_state;     /* 0..LM_SEA_STATE_MAX: what it does is in lm/class_gain.h, lm/sea.h */
    bool is_sea_commanded; /* true: the sea state of the bus does not count */
    bool has_wind;         /* false: the sea looks alike from all sides */
    fx_bam_t wind_from;    /* direction that the wind over the sea blows from, from north */
};

/* Check an environment that comes from outside. The stages that use one do not check again.
 *
 * Returns LM_OK, or LM_ERR_RANGE if
 * - a count or the sea state is above its maximum,
 * - a rain or jammer in use has a number out of its range,
 * - a latitude is beyond a pole.
 *
 * `e` is borrowed for the call. Entries that are not in use may hold anything. */
int lm_environment_check(const struct lm_environment *e);

#endif
