/* Ages of what comes over the bus in sets. */
#ifndef LM_NAV_AGE_H
#define LM_NAV_AGE_H

#include <stdint.h>

enum lm_age { LM_AGE_GOOD, LM_AGE_STALE, LM_AGE_DEAD };

/* A time up to the stale age ahead of the clock counts as now. Further ahead, the clock was set
 * back. */
static inline enum lm_age lm_age_of(uint32_t stale_us, uint32_t dead_us, uint64_t time_us,
                                    uint64_t now_us)
{
    if (time_us > now_us) {
        return time_us - now_us > stale_us ? LM_AGE_DEAD : LM_AGE_GOOD;
    }
    const uint64_t age_us = now_us - time_us;
    return age_us > dead_us ? LM_AGE_DEAD : age_us > stale_us ? LM_AGE_STALE : LM_AGE_GOOD;
}

#endif
