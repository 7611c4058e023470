/* Trigonometry: sine, cosine, tangent and the angle of a vector. Angles are BAM (fx/types.h). */
#ifndef FX_TRIG_H
#define FX_TRIG_H

#include "fx/types.h"

/* Sine and cosine, -2^30..2^30.
 *
 * Exact at 0, 90, 180 and 270 degrees. Sine is exactly odd, cosine exactly even, and all quadrants
 * have the same values. Worst error: 0.76 lsb (7.1e-10) over 2^24 angles.
 * Cost: 38 instructions, six of them multiplications. */
int32_t fx_sin_q30(fx_bam_t angle);
int32_t fx_cos_q30(fx_bam_t angle);

/* Fast sine and cosine, -32768..32768, with the symmetries and exact points of the pair above.
 * Worst error: 0.58 lsb over 2^24 angles. Cost: 21 instructions, one multiplication. */
int32_t fx_sin_q15(fx_bam_t angle);
int32_t fx_cos_q15(fx_bam_t angle);

/* Tangent. Beyond +-32768.0 it saturates at INT32_MIN or INT32_MAX. At +-90 degrees it is
 * INT32_MAX. Worst error: 0.51 lsb up to 60 degrees, 0.7 lsb up to 89. Cost: 180 instructions. */
int32_t fx_tan_q16(fx_bam_t angle);

/* Angle of the vector (x, y), from the x axis towards the y axis. An azimuth is
 * fx_atan2(east, north).
 *
 * Every pair of arguments is allowed, INT32_MIN included. The angle of (0, 0) is 0. Exact along the
 * axes and the diagonals. Worst error: 2.6 BAM (2.2e-7 degree).
 * Cost: 100 instructions, no division. */
fx_bam_t fx_atan2(int32_t y, int32_t x);

#endif
