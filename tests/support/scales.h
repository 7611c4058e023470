/* Range scales by their names: a test that says "scale 0" means another scale as soon as the radar
 * table has a new row. */
#ifndef SCALES_H
#define SCALES_H

#include <stdlib.h>

#include "lm/radar.h"

/* Index of the scale of `range_nm` nautical miles in lm_radar_default; the test ends if there is
 * none. */
static inline uint8_t scale_of(int32_t range_nm)
{
    const int32_t index = lm_radar_find_range(&lm_radar_default, range_nm);
    if (index < 0) {
        abort();
    }
    return (uint8_t)index;
}

#endif
