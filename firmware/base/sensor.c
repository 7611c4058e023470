#include "lm/sensor.h"

const char *lm_sensor_word(uint32_t sensor)
{
    static const char words[LM_SENSORS][4] = {[LM_SENSOR_X] = "X",
                                              [LM_SENSOR_KU] = "KU",
                                              [LM_SENSOR_KA] = "KA",
                                              [LM_SENSOR_MMW] = "MMW",
                                              [LM_SENSOR_IR] = "IR"};
    return sensor < LM_SENSORS ? words[sensor] : "";
}
