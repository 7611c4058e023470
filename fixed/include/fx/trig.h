/* Sine, cosine, tangent and the angle of a vector. All angles are fx_bam_t (fx/types.h). */
#ifndef FX_TRIG_H
#define FX_TRIG_H

#include "fx/types.h"

/* Sine and cosine, -2^30..2^30 for -1..1. Exact at 0, 90, 180 and 270 degrees; sine exactly odd and
 * cosine exactly even, and both the same in every quadrant. Worst error TBM lsb (TBM), cost about
 * 30 instructions, five of them multiplications. */
int32_t fx_sin_q30(fx_bam_t angle);
int32_t fx_cos_q30(fx_bam_t angle);

/* The quick pair, -32768..32768 for -1..1, with the same symmetries and exact points. Worst error
 * TBM lsb over all angles, cost about 15 instructions. */
int32_t fx_sin_q15(fx_bam_t angle);
int32_t fx_cos_q15(fx_bam_t angle);

/* Tangent in Q16; beyond +-32768 it saturates at INT32_MIN or INT32_MAX, and at +-90 degrees it is
 * INT32_MAX. Worst error TBM for angles up to 89 degrees. Cost about 90 instructions. */
int32_t fx_tan_q16(fx_bam_t angle);

/* The angle from the x axis towards the y axis of the vector (x, y), for every pair of inputs
 * including INT32_MIN; atan2(0, 0) = 0. Exact along the axes and the diagonals. Worst error TBM
 * counts (TBM degree). Cost about 60 instructions, no division. */
fx_bam_t fx_atan2(int32_t y, int32_t x);

#endif
