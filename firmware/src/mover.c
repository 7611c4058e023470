#include "lm/mover.h"

#include "fx/sat.h"
#include "fx/trig.h"

enum { RADIAN_BAM = 683565276 };

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

int32_t lm_mover_shift(int32_t closing_mm_s, uint32_t speed_mm_s, fx_bam_t off)
{
    const int64_t across_mm_s = (int64_t)speed_mm_s * fx_sin_q30(off) >> 30;
    /* Half a turn less one, so that its negative is one as well. */
    const int64_t limit = fx_min_u32(fx_abs_u32((int32_t)off), INT32_MAX);
    if (across_mm_s == 0) {
        return 0; /* at rest, or no side to go to */
    }
    const int64_t shift = (int64_t)closing_mm_s * RADIAN_BAM / across_mm_s;
    return (int32_t)(shift > limit ? limit : shift < -limit ? -limit : shift);
}
