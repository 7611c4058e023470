#include "lm/environment.h"

#include <stdbool.h>

#include "fx/sat.h"
#include "lm/status.h"
#include "lm/units.h"

/* True if the latitude is not beyond a pole. Every longitude is allowed. */
static bool is_on_earth(struct lm_position position)
{
    return fx_abs_u32((int32_t)position.latitude) <= FX_BAM_90;
}

static bool is_rain(const struct lm_rain *r)
{
    return is_on_earth(r->centre) && r->radius_m >= 100 && r->radius_m <= 100000 &&
           r->mm_per_h >= 1 && r->mm_per_h <= 150;
}

static bool is_jammer(const struct lm_jammer *j)
{
    return is_on_earth(j->position) && j->noise_ratio_db_q8 >= LM_DB_Q8(-20) &&
           j->noise_ratio_db_q8 <= LM_DB_Q8(80);
}

int lm_environment_check(const struct lm_environment *e)
{
    if (e->rain_count > LM_RAINS_MAX || e->jammer_count > LM_JAMMERS_MAX ||
        e->sea_state > LM_SEA_STATE_MAX) {
        return LM_ERR_RANGE;
    }
    for (uint32_t n = 0; n < e->rain_count; n++) {
        if (!is_rain(&e->rain[n])) {
            return LM_ERR_RANGE;
        }
    }
    for (uint32_t n = 0; n < e->jammer_count; n++) {
        if (!is_jammer(&e->jammer[n])) {
            return LM_ERR_RANGE;
        }
    }
    return LM_OK;
}
