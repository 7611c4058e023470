/* Angles, and how a fixed-point number says where its point is.
 *
 * A name ending in `_qN` holds a value multiplied by 2^N: `gain_q8` = 640 means 2.5, and 1.0 in Q30
 * is 1 << 30. The suffix replaces a type for each format, because the width of the integer and the
 * place of the point are chosen apart. A quantity without a suffix is a whole number of its unit.
 *
 * A cost in these headers counts instructions of a Cortex-A53 (clang 14, -O2), constants included.
 * All of fixed/ relies on two's complement and on `>>` of a negative number rounding down, which C
 * leaves to the compiler and every compiler in use here promises. */
#ifndef FX_TYPES_H
#define FX_TYPES_H

#include <stdint.h>

/* A binary angle (BAM): 2^32 is a full circle, so that wrapping costs nothing and the difference of
 * two angles is right across north and across the antimeridian. It is the only angle type, latitude
 * and longitude included: one count is 8.4e-8 degree, or 9.3 mm along a meridian. Cast to int32_t
 * for the signed view, -180 (inclusive) to +180 degrees. */
typedef uint32_t fx_bam_t;

#define FX_BAM_90  ((fx_bam_t)0x40000000u)
#define FX_BAM_180 ((fx_bam_t)0x80000000u)

/* A whole number of degrees, -3600..3600, to the nearest count. Integer arithmetic only, so it
 * serves as a constant. Thirds, fifths and ninths of a count occur but never halves, hence
 * FX_BAM_DEG(-d) == -FX_BAM_DEG(d). */
#define FX_BAM_DEG(d) ((fx_bam_t)((((uint64_t)((int64_t)(d) + 3600) << 32) + 180u) / 360u))

#endif
