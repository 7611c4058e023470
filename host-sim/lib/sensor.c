#include "hs/sensor.h"

#include <string.h>

static const char *const names[HS_SENSOR_COUNT] = {"x", "ku", "ka", "mmw", "ir"};
static const char *const titles[HS_SENSOR_COUNT] = {"X band", "Ku band", "Ka band",
                                                    "the millimetre band", "the infrared"};

const char *hs_sensor_name(enum hs_sensor sensor)
{
    return names[sensor];
}

const char *hs_sensor_title(enum hs_sensor sensor)
{
    return titles[sensor];
}

int hs_sensor_find(const char *name)
{
    for (int i = 0; i < HS_SENSOR_COUNT; i++) {
        if (strcmp(names[i], name) == 0) {
            return i;
        }
    }
    return -1;
}
