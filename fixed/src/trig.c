#include "fx/trig.h"

#include "fx/const.h"
#include "fx/recip.h"
#include "fx/sat.h"
#include "fx/tables.h"

#include <stdbool.h>

/* An angle folded to the first quadrant, whose sine has the same magnitude. Folding is exact, hence
 * the symmetries of sine and cosine are exact. */
struct quadrant {
    uint32_t angle; /* 0..2^30 for 0..90 degrees */
    bool is_negative;
};

static inline struct quadrant fold(fx_bam_t angle)
{
    const uint32_t into = angle & (FX_BAM_90 - 1u);
    const bool is_falling = (angle & FX_BAM_90) != 0;
    return (struct quadrant){is_falling ? FX_BAM_90 - into : into, angle >= FX_BAM_180};
}

/* sin(a + d) = sin a + cos a * sin d - sin a * (1 - cos d)
 *
 * a is the nearest multiple of 90/256 degrees, an entry of the table. Then |d| <= 2^21 BAM =
 * 0.00307 radian. d - d^3/6 is sin d to 2.3e-15, and d^2/2 is 1 - cos d to 3.7e-12. */
int32_t fx_sin_q30(fx_bam_t angle)
{
    const struct quadrant q = fold(angle);
    const uint32_t i = (q.angle + (1u << 21)) >> 22; /* 0..256 */
    const int64_t d = (int64_t)q.angle - ((int64_t)i << 22);
    /* 2 pi converts BAM to radians in Q38. 2^21 * 2^28.7 fits. */
    const int64_t d_q38 = d * FX_TWO_PI_Q26 >> 20;  /* |.| < 2^29.7 */
    const int64_t square_q46 = d_q38 * d_q38 >> 30; /* < 2^29.4 */
    const int64_t sin_d_q38 = d_q38 - (d_q38 * square_q46 >> 46) / 6;
    const int64_t sin_a_q31 = fx_table_sin_q31[i]; /* <= 2^31 */
    const int64_t cos_a_q31 = fx_table_sin_q31[256u - i];
    /* Both products stay below 2^61 and are brought to Q69 (square_q46 / 2 is Q47 of 1 - cos d). */
    const int64_t step_q69 = cos_a_q31 * sin_d_q38 - (sin_a_q31 * square_q46 >> 9);
    const int64_t sine_q31 = sin_a_q31 + (step_q69 >> 38);
    const int32_t sine_q30 = (int32_t)((sine_q31 + 1) >> 1);
    return q.is_negative ? -sine_q30 : sine_q30;
}

int32_t fx_cos_q30(fx_bam_t angle)
{
    return fx_sin_q30(angle + FX_BAM_90);
}

/* Sine by chords between entries 90/256 degrees apart.
 *
 * A chord lies below the sine by at most 1/8 * (pi/512)^2 = 4.7e-6, or 0.154 lsb of Q15. Half of
 * that is added with the rounding: 0.5 + 0.077 lsb. At 0 and 90 degrees the table is exact, and
 * 0.577 lsb is less than one. Hence both are exact. */
int32_t fx_sin_q15(fx_bam_t angle)
{
    const uint32_t half_and_bias_q31 = 37814; /* 0.577 * 65536 */
    const struct quadrant q = fold(angle);
    const uint32_t i = q.angle >> 22; /* 0..256, and there is an entry 257 */
    const int64_t part_q22 = q.angle & 0x3fffffu;
    const int64_t rise_q31 = (int64_t)fx_table_sin_q31[i + 1] - fx_table_sin_q31[i]; /* < 2^24 */
    const int64_t sine_q31 = fx_table_sin_q31[i] + (rise_q31 * part_q22 >> 22);
    const int32_t sine_q15 = (int32_t)((sine_q31 + half_and_bias_q31) >> 16);
    return q.is_negative ? -sine_q15 : sine_q15;
}

int32_t fx_cos_q15(fx_bam_t angle)
{
    return fx_sin_q15(angle + FX_BAM_90);
}

int32_t fx_tan_q16(fx_bam_t angle)
{
    const int32_t sine_q30 = fx_sin_q30(angle);
    const int32_t cosine_q30 = fx_cos_q30(angle);
    if (cosine_q30 == 0) {
        return INT32_MAX;
    }
    /* The product is at most 2^30 * 2^32. |cosine| is 1..2^30, so its reciprocal has s = 31..61 and
     * the shift below is 15..45. */
    int s = 0;
    const uint32_t recip = fx_recip_q(fx_abs_u32(cosine_q30), &s);
    const uint64_t product = (uint64_t)fx_abs_u32(sine_q30) * recip;
    const int64_t size_q16 = (int64_t)((product + (1ull << (s - 17))) >> (s - 16));
    return fx_sat_i32((sine_q30 < 0) != (cosine_q30 < 0) ? -size_q16 : size_q16);
}

/* atan(r0 + h) = atan r0 + t - r0 t^2 + (r0^2 - 1/3) t^3 ..., where t = h / (1 + r0^2)
 *
 * r0 is the nearest of 257 nodes, so |t| <= |h| <= 1/512. The cubic term is left out. It is at most
 * 2.5e-9 radian or 1.7 BAM. `ratio_q31` is 0..2^31. The result is 0..2^29, up to 45 degrees. */
static uint32_t atan_of_ratio(uint32_t ratio_q31)
{
    const uint32_t i = (ratio_q31 + (1u << 22)) >> 23; /* 0..256 */
    const int64_t h_q31 = (int64_t)ratio_q31 - ((int64_t)i << 23);
    const int64_t t_q40 = h_q31 * fx_table_atan_slope_q31[i] >> 22;   /* |.| <= 2^31 */
    const int64_t bend_q40 = (t_q40 * t_q40 >> 40) * (int64_t)i >> 8; /* <= 2^22 */
    const int64_t step_bam_q2 = (t_q40 - bend_q40) * FX_BAM_PER_RADIAN_Q2 >> 40;
    return (uint32_t)((fx_table_atan_bam_q2[i] + step_bam_q2 + 2) >> 2);
}

fx_bam_t fx_atan2(int32_t y, int32_t x)
{
    const uint32_t along = fx_abs_u32(x);
    const uint32_t across = fx_abs_u32(y);
    const uint32_t small = fx_min_u32(along, across);
    const uint32_t large = fx_max_u32(along, across);
    if (large == 0) {
        return 0;
    }
    /* small <= large <= 2^31, and the reciprocal of 2^31 itself is 2^31. So twice the product stays
     * below 2^64. The ratio is at most 2^31, because the reciprocal is rounded down. */
    int s = 0;
    const uint64_t product = (uint64_t)small * fx_recip_q(large, &s);
    const uint32_t ratio_q31 = (uint32_t)(((product << 1 >> (s - 31)) + 1) >> 1);
    fx_bam_t angle = atan_of_ratio(ratio_q31);
    if (across > along) {
        angle = FX_BAM_90 - angle;
    }
    if (x < 0) {
        angle = FX_BAM_180 - angle;
    }
    return y < 0 ? 0u - angle : angle;
}
