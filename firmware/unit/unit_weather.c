#include "lm/unit_weather.h"

#include "fx/mem.h"
#include "lm/status.h"

void lm_unit_weather_init(struct lm_unit_weather *w)
{
    memset(w, 0, sizeof *w);
    w->commanded.sea_state = w->now.sea_state = LM_SEA_STATE_OF_IMAGE;
}

int lm_unit_weather_command(struct lm_unit_weather *w, const struct lm_environment *commanded,
                            uint64_t now_us)
{
    if (lm_environment_check(commanded) != LM_OK) {
        return LM_ERR_RANGE;
    }
    w->commanded = *commanded;
    lm_unit_weather_at(w, now_us); /* lines and patches of this step meet it already */
    return LM_OK;
}

void lm_unit_weather_at(struct lm_unit_weather *w, uint64_t now_us)
{
    w->now = w->commanded;
    w->is_stale = lm_weather_bus_at(&w->bus, now_us, &w->now);
}
