#include "lm/mover.h"

#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"

/* Millimetres along the leg, 0..leg, and whether it is the way back. There and back takes at most
 * 2 * 10^8 mm / (1 mm/s) = 2^47.6 us; the way within it, below 2 * 10^8 mm, is 2^47.6 before the
 * division. */
static uint64_t way_mm(const struct lm_target *t, uint64_t time_us, bool *is_back)
{
    const uint64_t leg_mm = (uint64_t)t->leg_m * 1000;
    const uint64_t round_us = 2 * leg_mm * 1000000 / t->speed_mm_s;
    const uint64_t gone_mm = time_us % round_us * t->speed_mm_s / 1000000;
    *is_back = gone_mm > leg_mm;
    return *is_back ? 2 * leg_mm - gone_mm : gone_mm;
}

struct lm_pose lm_target_pose(const struct lm_target *t, uint64_t time_us)
{
    struct lm_pose pose = {{t->latitude, t->longitude}, t->heading};
    if (t->speed_mm_s == 0) {
        return pose;
    }
    struct lm_geo_origin origin;
    bool is_back;
    const uint64_t mm = way_mm(t, time_us, &is_back);
    lm_geo_set_origin(&origin, pose.place);
    pose.place = lm_geo_direct(&origin, t->heading, (uint32_t)(mm * 32 / 125));
    pose.heading += is_back ? FX_BAM_180 : 0;
    return pose;
}

int32_t lm_closing_mm_s(uint32_t speed_mm_s, fx_bam_t heading, fx_bam_t back)
{
    return (int32_t)((int64_t)speed_mm_s * fx_cos_q30(heading - back) >> 30);
}

bool lm_mover_shift(int32_t closing_mm_s, uint32_t speed_mm_s, fx_bam_t off, int32_t *shift)
{
    *shift = 0;
    if (closing_mm_s == 0 || speed_mm_s == 0) {
        return true;
    }
    /* At most 2^30 and 2^21 * 2^30; what is kept is a cosine, its square 2^60. */
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
