/* How the radar sees a target: the angle and the slant range, against the formula in doubles. */
#include "check.h"
#include "lm/target_view.h"
#include "target_support.h"

/* Effective Earth of 4/3 of its radius. */
static double drop_m(double range_m)
{
    return range_m * range_m / (2 * 6371000.0 * 4 / 3);
}

/* A radar at 3,000 m, targets from a shore below the sea's level to the highest ground. */
TEST(a_target_on_high_ground_is_seen_from_less_far_above)
{
    const struct lm_target_heights heights = {.antenna_m_q10 = 3000 * 1024};
    static const int elevation_m[] = {-400, 0, 25, 1500, 2990, 8000};
    static const int range_m[] = {2000, 10000, 40000, 100000};
    for (size_t i = 0; i < sizeof elevation_m / sizeof *elevation_m; i++) {
        for (size_t k = 0; k < sizeof range_m / sizeof *range_m; k++) {
            const struct lm_target_candidate candidate = {.elevation_m_q6 = elevation_m[i] * 64};
            struct lm_target_view view;
            lm_target_view_of(&view, &candidate, 0, (uint32_t)range_m[k] * 256, &heights);
            const double above_m = 3000 - elevation_m[i] - drop_m(range_m[k]);
            const double elevation_deg = atan2(above_m, range_m[k]) * 180 / acos(-1);
            assert_true(fabs(hs_degrees(view.elevation) - elevation_deg) < 0.01);
            assert_true(fabs(view.range_mm / 1000.0 - hypot(above_m, range_m[k])) < 1);
        }
    }
}
