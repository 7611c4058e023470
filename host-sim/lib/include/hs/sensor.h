/* Sensors that a database can be made for. A class table has values for each, a reflectivity raster
 * carries the name of its own, and so does the image. */
#ifndef HS_SENSOR_H
#define HS_SENSOR_H

enum hs_sensor {
    HS_SENSOR_X,   /* radar, 8..12 GHz */
    HS_SENSOR_KU,  /* radar, 12..18 GHz */
    HS_SENSOR_KA,  /* radar, 27..40 GHz */
    HS_SENSOR_MMW, /* radar at millimetre waves, 94 GHz */
    HS_SENSOR_IR,  /* thermal infrared, 8..12 um */
    HS_SENSOR_COUNT
};

/* The names "x", "ku", ... in their order, for an option of HS_CHOICE. */
#define HS_SENSOR_WORDS "x|ku|ka|mmw|ir"

/* The name of a sensor as above. */
const char *hs_sensor_name(enum hs_sensor sensor);

/* What a message calls it: "X band", "the infrared". */
const char *hs_sensor_title(enum hs_sensor sensor);

/* The sensor of that name, or -1. */
int hs_sensor_find(const char *name);

#endif
