/* Dead reckoning of live targets: the algorithms of DIS integrated in small steps, and PROJ's
 * geodesics. */
#include "check.h"
#include "hs/angle.h"
#include "lm/live.h"
#include "wgs84.h"

#include <math.h>

enum { S = 1000000 };

struct truth {
    double east_m, north_m, ve, vn, heading_deg;
};

/* IEEE 1278.1, annex on dead reckoning: what the three letters say, in 20,000 steps. */
static struct truth integrate(const struct lm_live_target *t, double seconds)
{
    static const char letters[LM_LIVE_RECKONINGS][4] = {"FPW", "",    "FPW", "RPW", "RVW",
                                                        "FVW", "FPB", "RPB", "RVB", "FVB"};
    const char *is = letters[t->reckoning];
    const double ve = t->velocity[0] * 0.05, vn = t->velocity[1] * 0.05;
    const double ae = is[1] == 'V' ? t->acceleration[0] * 0.01 : 0;
    const double an = is[1] == 'V' ? t->acceleration[1] * 0.01 : 0;
    const double turn = t->turn * 0.01, steps = 20000;
    struct truth x = {0, 0, ve, vn, hs_degrees(t->heading) + (is[0] == 'R' ? turn * seconds : 0)};
    if (is[0] == '\0') {
        return (struct truth){.heading_deg = hs_degrees(t->heading)};
    }
    const bool is_in_body = is[2] == 'B' && is[0] == 'R';
    for (int i = 0; i <= steps; i++) {
        const double at = seconds * fmin((i + 0.5) / steps, 1);
        const double angle = is_in_body ? turn * at * M_PI / 180 : 0;
        const double e = ve + ae * at, n = vn + an * at;
        x.ve = e * cos(angle) + n * sin(angle);
        x.vn = n * cos(angle) - e * sin(angle);
        x.east_m += i < steps ? x.ve * seconds / steps : 0;
        x.north_m += i < steps ? x.vn * seconds / steps : 0;
    }
    return x;
}

static double miss_m(const struct lm_live_target *t, const struct lm_live_state *s,
                     const struct truth *x)
{
    double latitude, longitude;
    wgs84_direct(hs_degrees(t->position.latitude), hs_degrees(t->position.longitude),
                 atan2(x->east_m, x->north_m) * 180 / M_PI, hypot(x->east_m, x->north_m), &latitude,
                 &longitude);
    return wgs84_metres(latitude, longitude, hs_degrees(s->position.latitude),
                        hs_degrees(s->position.longitude));
}

static double apart_deg(double a, double b)
{
    return fabs(remainder(a - b, 360));
}

static struct lm_live_target example(uint8_t reckoning)
{
    return (struct lm_live_target){.motion_us = 100 * S,
                                   .position = {hs_bam(46), hs_bam(11)},
                                   .heading = hs_bam(70),
                                   .velocity = {3000, -1500}, /* 150, -75 m/s */
                                   .acceleration = {250, 600},
                                   .turn = 1200,
                                   .reckoning = reckoning,
                                   .is_there = true};
}

TEST(each_algorithm_is_that_of_dis_before_and_after_the_message)
{
    static const double seconds[] = {-5, -1, -0.02, 0, 0.5, 1, 3, 10};
    for (uint8_t reckoning = 0; reckoning < LM_LIVE_RECKONINGS; reckoning++) {
        const struct lm_live_target t = example(reckoning);
        double worst_m = 0;
        for (size_t i = 0; i < sizeof seconds / sizeof *seconds; i++) {
            const struct lm_live_state s =
                lm_live_at(&t, (uint64_t)(100 * S + (int64_t)(seconds[i] * S)));
            const struct truth x = integrate(&t, seconds[i]);
            worst_m = fmax(worst_m, miss_m(&t, &s, &x));
            assert_in_range((int64_t)(apart_deg(hs_degrees(s.heading), x.heading_deg) * 1e5), 0, 2);
            assert_true(fabs(s.speed_mm_s * 1e-3 - hypot(x.ve, x.vn)) < 0.02);
            if (reckoning != LM_LIVE_STATIC) {
                const double course = atan2(x.ve, x.vn) * 180 / M_PI;
                assert_true(apart_deg(hs_degrees(s.course), course) < 0.01);
            }
        }
        print_message("# algorithm %u: within %.2f m\n", reckoning, worst_m);
        assert_true(worst_m < (reckoning == LM_LIVE_RVB ? 8 : 0.3));
    }
}

/* A ship, a fast aircraft near a pole, and one across the antimeridian. */
TEST(a_straight_way_is_a_geodesic_anywhere)
{
    static const double places[][2] = {{0, 0}, {46, 11}, {-70, 179.999}, {88, -120}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        for (int course = 0; course < 360; course += 45) {
            struct lm_live_target t = {.motion_us = S,
                                       .position = {hs_bam(places[i][0]), hs_bam(places[i][1])},
                                       .reckoning = LM_LIVE_FPW};
            t.velocity[0] = (int16_t)lround(6000 * sin(course * M_PI / 180));
            t.velocity[1] = (int16_t)lround(6000 * cos(course * M_PI / 180));
            const struct lm_live_state s = lm_live_at(&t, 11 * S);
            const struct truth x = integrate(&t, 10);
            assert_true(miss_m(&t, &s, &x) < 0.3);
        }
    }
}

TEST(a_full_circle_ends_where_it_began)
{
    struct lm_live_target t = example(LM_LIVE_RPB);
    t.turn = 3600; /* a turn in ten seconds */
    const struct lm_live_state s = lm_live_at(&t, 110 * S), half = lm_live_at(&t, 105 * S);
    const struct truth nowhere = {0};
    assert_true(miss_m(&t, &s, &nowhere) < 0.3);
    /* Half-way it is a diameter away: speed times time over half pi. */
    assert_true(fabs(miss_m(&t, &half, &nowhere) - hypot(150, 75) * 5 * 2 / M_PI) < 1);
    assert_true(apart_deg(hs_degrees(half.heading), 250) < 1e-4);
}

TEST(nothing_is_reckoned_for_longer_than_12_s)
{
    const struct lm_live_target t = example(LM_LIVE_FVW);
    const struct lm_live_state after = lm_live_at(&t, 112 * S), late = lm_live_at(&t, UINT64_MAX);
    assert_memory_equal(&late.position, &after.position, sizeof late.position);
    const struct lm_live_state before = lm_live_at(&t, 88 * S), early = lm_live_at(&t, 0);
    assert_memory_equal(&early.position, &before.position, sizeof early.position);
}

TEST(the_greatest_numbers_stay_in_range)
{
    for (uint8_t reckoning = 0; reckoning < LM_LIVE_RECKONINGS; reckoning++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const struct lm_live_target t = {
                .motion_us = 100 * S,
                .position = {FX_BAM_DEG(60), 0},
                .velocity = {0, (int16_t)(sign * LM_LIVE_SPEED_MAX)},
                .acceleration = {(int16_t)(sign < 0 ? INT16_MIN : INT16_MAX), INT16_MIN},
                .turn = (int16_t)(sign * LM_LIVE_TURN_MAX),
                .reckoning = reckoning};
            const struct lm_live_state s = lm_live_at(&t, 112 * S);
            const struct truth x = integrate(&t, 12);
            assert_true(s.speed_mm_s < 1 << 20);
            assert_true(miss_m(&t, &s, &x) < (reckoning == LM_LIVE_RVB ? 3000 : 5));
        }
    }
}
