#include "nav/simulator.h"

#include "nav/track.h"

#include <math.h>

void nav_told_blank(struct nav_told *t)
{
    *t = (struct nav_told){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN,
                           NAN, NAN, NAN, NAN, NAN, -1,  -1,  -1};
}

static bool is_within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static double limited_rate(double rate)
{
    return fmax(-170, fmin(170, rate));
}

enum nav_told_fault nav_told_judge(struct nav_told *t)
{
    const bool is_near = is_within(t->latitude_deg, -90, 90) &&
                         is_within(t->longitude_deg, -180, 180) &&
                         is_within(t->height_m, -1000, 30000);
    const bool is_turned = is_within(t->heading_deg, -360, 360) &&
                           is_within(t->pitch_deg, -90, 90) && is_within(t->roll_deg, -180, 180);
    const bool is_moved =
        is_within(hypot(t->north_ms, t->east_ms), 0, 1500) && is_within(t->up_ms, -500, 500);
    const bool is_told_well = (isnan(t->magnetic_deg) || is_within(t->magnetic_deg, -360, 360)) &&
                              (isnan(t->elapsed_s) || is_within(t->elapsed_s, 0, 1e9));
    if (!is_near || !is_turned || !is_moved || !is_told_well) {
        return NAV_TOLD_RANGE;
    }
    t->heading_deg = nav_wrap_180(t->heading_deg);
    t->magnetic_deg = nav_wrap_180(t->magnetic_deg);
    t->roll_rate = limited_rate(t->roll_rate);
    t->pitch_rate = limited_rate(t->pitch_rate);
    t->yaw_rate = limited_rate(t->yaw_rate);
    return NAV_TOLD_OK;
}
