/* Binary angles (fx/types.h) from degrees, and back. */
#ifndef HS_ANGLE_H
#define HS_ANGLE_H

#include "fx/types.h"

#include <math.h>

/* To the nearest count, modulo the circle; |degrees| below 1e9. */
static inline fx_bam_t hs_bam(double degrees)
{
    return (fx_bam_t)(int64_t)llround(degrees / 360 * 4294967296.0);
}

/* -180 (inclusive) to 180, exactly. */
static inline double hs_degrees(fx_bam_t angle)
{
    return (int32_t)angle * (360 / 4294967296.0);
}

#endif
