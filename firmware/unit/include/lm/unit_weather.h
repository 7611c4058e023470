/* Weather that the radar meets: what was commanded, and behind it, where there is room, what the
 * bus tells. */
#ifndef LM_UNIT_WEATHER_H
#define LM_UNIT_WEATHER_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/environment.h"
#include "lm/weather_bus.h"

struct lm_unit_weather {
    struct lm_environment commanded; /* by a script or an instructor */
    struct lm_weather_bus bus;
    struct lm_environment now; /* of both, as sweeps and patches meet it */
    bool is_stale;             /* the bus's part was not told anew and will be removed */
};

/* Fair weather, and the sea of the image. */
void lm_unit_weather_init(struct lm_unit_weather *w);

/* Take what is commanded. LM_OK; LM_ERR_RANGE, and *w unchanged, when lm_environment_check refuses
 * it. */
int lm_unit_weather_command(struct lm_unit_weather *w, const struct lm_environment *commanded,
                            uint64_t now_us);

/* Put w->now together as of `now_us`. */
void lm_unit_weather_at(struct lm_unit_weather *w, uint64_t now_us);

#endif
