/* Sensor: the band in which an image's reflectivity was made, and in which a radar sees. Ground
 * returns another level in another band, so a radar shows images of its own band alone. */
#ifndef LM_SENSOR_H
#define LM_SENSOR_H

#include <stdint.h>

/* Bands by IEEE Std 521-2002. The numbers are those of the image's header. */
enum lm_sensor {
    LM_SENSOR_X,   /* 8 to 12 GHz */
    LM_SENSOR_KU,  /* 12 to 18 GHz */
    LM_SENSOR_KA,  /* 27 to 40 GHz */
    LM_SENSOR_MMW, /* 40 to 300 GHz */
    LM_SENSOR_IR,  /* thermal infrared: no radar's */
    LM_SENSORS
};

/* The word for a sensor, at most three capitals, in static memory; "" for numbers that are no
 * sensor. */
const char *lm_sensor_word(uint32_t sensor);

#endif
