/* What stands between the radar and the ground: rain, jammers, the state of the sea. Set by a
 * script or an instructor; nothing of it comes from the map. */
#ifndef LM_ENVIRONMENT_H
#define LM_ENVIRONMENT_H

#include <stdint.h>

#include "lm/geo.h"

enum { LM_RAINS_MAX = 4, LM_JAMMERS_MAX = 4 };
enum { LM_SEA_STATE_MAX = 8, LM_SEA_STATE_OF_IMAGE = 3 };

struct lm_rain {
    struct lm_position centre;
    uint32_t radius_m; /* 100..100,000 */
    uint16_t mm_per_h; /* 1..150 */
};

struct lm_jammer {
    struct lm_position position;
    int16_t noise_ratio_db_q8; /* to the noise, on the axis at ten nautical miles: -20..80 dB */
};

struct lm_environment {
    struct lm_rain rain[LM_RAINS_MAX];
    struct lm_jammer jammer[LM_JAMMERS_MAX];
    uint8_t rain_count, jammer_count;
    uint8_t sea_state; /* 0..LM_SEA_STATE_MAX (lm/speckle.h) */
};

/* Whether every number is within its range: LM_OK or LM_ERR_RANGE. For whoever takes an environment
 * from outside; the stages that use one take it for granted. */
int lm_environment_check(const struct lm_environment *e);

#endif
