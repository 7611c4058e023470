/* Fixed-point conventions, and the binary angle (BAM).
 *
 * Formats. A name that ends in `_qN` holds a value multiplied by 2^N. The unit stands before it:
 *
 *     range_m_q8 = 640       2.5 metres
 *     sin_q30 = 1 << 30      1.0
 *     range_m = 640          640 metres: without a suffix, a whole number of the unit
 *
 * There is no type for each format, because the integer's width and the point are chosen
 * independently.
 *
 * Example: the north and east parts of a range.
 *
 *     const fx_bam_t azimuth = FX_BAM_DEG(30);
 *     const int32_t north_m_q8 = (int32_t)((int64_t)range_m_q8 * fx_cos_q30(azimuth) >> 30);
 *     const int32_t east_m_q8 = (int32_t)((int64_t)range_m_q8 * fx_sin_q30(azimuth) >> 30);
 *
 * Costs in these headers count instructions of a Cortex-A53 (clang 14, -O2), constants included.
 * No function keeps a state, allocates or waits.
 *
 * All of fixed/ relies on two's complement, and on `>>` of a negative number rounding down. C
 * leaves both to the compiler. Every compiler in use here promises them. */
#ifndef FX_TYPES_H
#define FX_TYPES_H

#include <stdint.h>

/* Binary angle (BAM): 2^32 is a full turn, hence angles wrap by themselves. The difference of two
 * angles is right across north and across the antimeridian.
 *
 * It is the only angle type, for latitude and longitude too. One unit is 8.4e-8 degree, or 9.3 mm
 * along a meridian. Cast to int32_t for a signed angle, -180 (included) to +180 degrees. */
typedef uint32_t fx_bam_t;

/* A quarter turn and a half turn. */
#define FX_BAM_90  ((fx_bam_t)0x40000000u)
#define FX_BAM_180 ((fx_bam_t)0x80000000u)

/* BAM of a whole number of degrees, -3600..3600, rounded to nearest. It may be used in constant
 * expressions. FX_BAM_DEG(-d) == -FX_BAM_DEG(d), because no degree ends at half a unit. */
#define FX_BAM_DEG(d) ((fx_bam_t)((((uint64_t)((int64_t)(d) + 3600) << 32) + 180u) / 360u))

#endif
