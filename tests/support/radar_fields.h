/* Fields of a radar table by their number, as lm_radar_field lists them. */
#ifndef RADAR_FIELDS_H
#define RADAR_FIELDS_H

#include "lm/radar_check.h"

#include <string.h>

/* Set element `index` of a field. Of a value that does not fit the field the low bits are kept. */
static inline void radar_field_set(struct lm_radar *radar, const struct lm_radar_field *f,
                                   uint32_t index, int64_t value)
{
    const uint8_t one = (uint8_t)value;
    const uint16_t two = (uint16_t)value;
    const uint32_t four = (uint32_t)value;
    memcpy((uint8_t *)radar + f->offset + (size_t)index * f->stride,
           f->size == 1   ? (const void *)&one
           : f->size == 2 ? (const void *)&two
                          : &four,
           f->size);
}

#endif
