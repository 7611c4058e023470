/* Unit weather: the environment that the radar meets. It is the commanded one, followed by that of
 * the bus as far as there is room. */
#ifndef LM_UNIT_WEATHER_H
#define LM_UNIT_WEATHER_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/environment.h"
#include "lm/weather_bus.h"

struct lm_unit_weather {
    struct lm_environment commanded; /* by a script or an instructor */
    struct lm_weather_bus bus;
    struct lm_environment now; /* both together: sweeps and patches read this one */
    bool is_stale;             /* the bus has not repeated its part, which will be removed */
};

/* Begin with fair weather and the sea state of the image. */
void lm_unit_weather_init(struct lm_unit_weather *w);

/* Take a commanded environment, which is copied, and update w->now. Returns LM_OK; or LM_ERR_RANGE,
 * and *w is unchanged, iff lm_environment_check refuses it. */
int lm_unit_weather_command(struct lm_unit_weather *w, const struct lm_environment *commanded,
                            uint64_t now_us);

/* Update w->now and w->is_stale as of `now_us`. Call in every step. */
void lm_unit_weather_at(struct lm_unit_weather *w, uint64_t now_us);

#endif
