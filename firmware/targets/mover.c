#include "lm/mover.h"

#include "fx/const.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/units.h"

/* Length of all legs. At most 32 * 10^8 mm, below 2^32. */
static uint32_t path_mm(const struct lm_target *t)
{
    uint32_t sum_mm = t->path[0].length_mm;
    for (uint32_t i = 1; i < t->path_legs; i++) {
        sum_mm += t->path[i].length_mm;
    }
    return sum_mm;
}

/* Distance travelled along a way of `whole_mm`, 0..whole_mm, and whether it is the way back.
 *
 * A round trip takes at most 6.4 * 10^9 mm / (1 mm/s) = 2^52.6 us. It takes at least 1 m / (2^20
 * mm/s) = 953 us, so the division is safe. The product before the last division is the distance in
 * a round trip, below 6.4 * 10^9 mm, times 10^6: 2^52.6. */
static uint32_t travelled_mm(const struct lm_target *t, uint64_t time_us, uint32_t whole_mm,
                             bool *is_back)
{
    const uint64_t round_mm = t->path_is_round ? whole_mm : (uint64_t)whole_mm * 2;
    const uint64_t round_us = round_mm * 1000000 / t->speed_mm_s;
    const uint64_t mm = time_us % round_us * t->speed_mm_s / 1000000;
    *is_back = mm > whole_mm;
    return (uint32_t)(*is_back ? round_mm - mm : mm);
}

/* Position at `mm` along a leg. */
static struct lm_position position_on_leg(const struct lm_path_leg *leg, uint32_t mm)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, (struct lm_position){leg->latitude, leg->longitude});
    return lm_geo_direct(&origin, leg->heading, lm_m_q8_of_mm_u32(mm));
}

/* Leg of a path at the distance *mm, which becomes the distance from the beginning of that leg. */
static const struct lm_path_leg *find_leg(const struct lm_target *t, uint32_t *mm)
{
    const struct lm_path_leg *leg = t->path;
    while (*mm > leg->length_mm && leg + 1 < t->path + t->path_legs) {
        *mm -= leg->length_mm;
        leg++;
    }
    return leg;
}

struct lm_mover_state lm_mover_state_at(const struct lm_target *t, uint64_t time_us)
{
    struct lm_path_leg straight = {t->latitude, t->longitude, t->heading, lm_mm_of_m(t->leg_m)};
    if (t->speed_mm_s == 0) {
        return (struct lm_mover_state){{t->latitude, t->longitude}, t->heading, t->heading, 0};
    }
    const bool has_path = (t->flags & LM_TARGET_HAS_PATH) != 0;
    bool is_back;
    uint32_t mm = travelled_mm(t, time_us, has_path ? path_mm(t) : straight.length_mm, &is_back);
    const struct lm_path_leg *leg = has_path ? find_leg(t, &mm) : &straight;
    const fx_bam_t heading = leg->heading + (is_back ? FX_BAM_180 : 0);
    return (struct lm_mover_state){position_on_leg(leg, mm), heading, heading, t->speed_mm_s};
}

int32_t lm_mover_closing_mm_s(uint32_t speed_mm_s, fx_bam_t course, fx_bam_t back)
{
    return (int32_t)((int64_t)speed_mm_s * fx_cos_q30(course - back) >> 30);
}

/* o' = acos(cos o + v / V), on the same side of the velocity as o; the shift is |o| - o', with the
 * sign of o. The sine of o' is sqrt(1 - cos^2 o'), and an arc tangent of both is exact near 0 and
 * 180 degrees. */
bool lm_mover_shift(int32_t closing_mm_s, uint32_t speed_mm_s, fx_bam_t off, int32_t *shift)
{
    *shift = 0;
    if (closing_mm_s == 0 || speed_mm_s == 0) {
        return true;
    }
    /* V cos(o') = V cos(o) + v, so the cosine grows by v / V. The numerator is below 2^21 * 2^30. A
     * cosine that passes the test is within 2^30, its square within 2^60. */
    const int64_t one_q30 = 1 << 30;
    const int64_t cos_q30 = fx_cos_q30(off) + closing_mm_s * one_q30 / (int64_t)speed_mm_s;
    if (cos_q30 > one_q30 || cos_q30 < -one_q30) {
        return false;
    }
    const uint32_t sin_q30 = fx_sqrt_u64((uint64_t)(one_q30 * one_q30 - cos_q30 * cos_q30));
    const fx_bam_t appears = fx_atan2((int32_t)sin_q30, (int32_t)cos_q30);
    const fx_bam_t nearer = fx_abs_u32((int32_t)off) - appears;
    *shift = (int32_t)((int32_t)off < 0 ? 0 - nearer : nearer);
    return true;
}

/* V B is below 2^21 * 2^27.9. A BAM is 2 pi / 2^32 radian: V B is cut by 20 bits and times 2 pi,
 * 2^30.7, is below 2^59.6; in Q14 of mm/s it is below 2^33.6, and times a sine below 2^48.6. */
uint32_t lm_mover_clutter_mm_s(uint32_t speed_mm_s, fx_bam_t beam, fx_bam_t off)
{
    const uint64_t product = (uint64_t)speed_mm_s * beam >> 20;
    const uint64_t spread_mm_s_q14 = product * FX_TWO_PI_Q28 >> 26;
    return (uint32_t)(spread_mm_s_q14 * fx_abs_u32(fx_sin_q15(off)) >> (14 + 15 + 1));
}
