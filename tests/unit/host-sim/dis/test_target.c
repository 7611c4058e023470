/* What a target's frames carry, read back from their bytes by docs/bus.md, and what the display
 * makes of them between two sets. */
#include "check.h"
#include "dis/target.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct dis_sea_level no_geoid = {NULL, 0};
static const struct dis_kind car = {.kind = 2, .rcs_dbsm = (double)NAN, .is_on_ground = true};
static const struct dis_kind jet = {.kind = 7, .rcs_dbsm = 4.5, .signature = 3};

/* A motion at a place with local velocity east, north, up and a heading, wings level. */
static struct dis_motion local_motion(const struct dis_place *at, const double speed[3],
                                      double heading_deg, uint8_t algorithm)
{
    const double pi = 3.14159265358979323846, h = heading_deg * pi / 180;
    const struct dis_axes x = dis_axes_at(at);
    struct dis_motion m = {.algorithm = algorithm};
    double ahead[3], right[3];
    dis_place_back(at, m.place_m);
    for (int i = 0; i < 3; i++) {
        m.velocity_m_s[i] = speed[0] * x.east[i] + speed[1] * x.north[i] + speed[2] * x.up[i];
        ahead[i] = sin(h) * x.east[i] + cos(h) * x.north[i];
        right[i] = cos(h) * x.east[i] - sin(h) * x.north[i];
    }
    /* Rows of the turn from world to body: ahead, right, down. */
    m.psi_rad = atan2(ahead[1], ahead[0]);
    m.theta_rad = asin(-ahead[2]);
    m.phi_rad = atan2(right[2], -x.up[2]);
    return m;
}

static uint32_t word_of(const struct lm_can_frame *frames, int count, uint32_t id)
{
    for (int i = 0; i < count; i++) {
        if (frames[i].id == id) {
            const uint8_t *d = frames[i].data;
            return (uint32_t)d[4] << 24 | (uint32_t)d[5] << 16 | (uint32_t)d[6] << 8 | d[7];
        }
    }
    fail_msg("frame %u is not in the set", id);
    return 0;
}

static float float_of(uint32_t word)
{
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

TEST(a_jets_frames_are_those_of_the_bus)
{
    const struct dis_place at = {47.25, -122.5, 3040};
    const double speed[3] = {200, -100, 5};
    const struct dis_motion m = local_motion(&at, speed, 120, DIS_FPW);
    const struct dis_sea_level sea = {NULL, 40};
    struct dis_target t;
    struct lm_can_frame f[DIS_SET_MAX];
    assert_int_equal(dis_target_of(&m, &jet, &sea, 0, &t), DIS_FIT);
    const int n = dis_target_frames(&t, 60, 17, 99, f);
    assert_int_equal(n, 7);
    for (int i = 0; i < n; i++) {
        assert_true(f[i].data[0] == 60 && f[i].data[2] == 17 && f[i].data[3] == 99);
        assert_int_equal(f[i].length, 8);
    }
    assert_int_equal(f[0].id, 1815);
    assert_int_equal(f[0].data[1], 16);
    assert_int_equal(word_of(f, n, 1815), 7U << 24 | 2U << 16 | 3U << 8 | (1 | 2 | 4 | 8));
    assert_int_equal((int32_t)word_of(f, n, 1810), 472500000);
    assert_int_equal((int32_t)word_of(f, n, 1811), -1225000000);
    assert_true(fabs((double)float_of(word_of(f, n, 1812)) - 3000) < 0.01);
    assert_int_equal((int16_t)(word_of(f, n, 1813) >> 16), 4000);
    assert_int_equal((int16_t)word_of(f, n, 1813), -2000);
    assert_true(abs((int16_t)(word_of(f, n, 1814) >> 16) - 120 * 32768 / 180) <= 1);
    assert_int_equal((int16_t)word_of(f, n, 1814), 0);
    assert_true(float_of(word_of(f, n, 1816)) == 4.5F);
}

TEST(what_stands_on_the_ground_and_has_its_kinds_cross_section_needs_four_frames)
{
    const struct dis_place at = {-33, 151, 77};
    const double still[3] = {0, 0, 0};
    const struct dis_motion m = local_motion(&at, still, -90, DIS_STATIC);
    struct dis_target t;
    struct lm_can_frame f[DIS_SET_MAX];
    assert_int_equal(dis_target_of(&m, &car, &no_geoid, 100, &t), DIS_FIT);
    const int n = dis_target_frames(&t, 1, 0, 0, f);
    assert_int_equal(n, 4);
    assert_int_equal(word_of(f, n, 1815), 2U << 24 | 1U << 16 | 4);
    assert_true(abs((int16_t)(word_of(f, n, 1814) >> 16) + 16384) <= 1);
}

TEST(a_turn_to_the_right_is_positive)
{
    const struct dis_place at = {60, 10, 100};
    const double speed[3] = {0, 20, 0};
    struct dis_motion m = local_motion(&at, speed, 0, DIS_RPW);
    struct dis_target t;
    m.turn_rad_s[2] = 0.1; /* about the body's z, which points down */
    assert_int_equal(dis_target_of(&m, &car, &no_geoid, 0, &t), DIS_FIT);
    assert_int_equal(t.turn_0d01_s, 573);
    m.turn_rad_s[2] = 5; /* a spinning thing: the display refuses more than 60 degrees a second */
    assert_int_equal(dis_target_of(&m, &car, &no_geoid, 0, &t), DIS_FIT);
    assert_int_equal(t.turn_0d01_s, 6000);
    m.turn_rad_s[2] = 0.1;
    assert_int_equal(dis_target_of(&m, &car, &no_geoid, 2, &t), DIS_FIT);
    assert_true(abs(t.heading_bam16 - (int)(11.459 / 180 * 32768)) <= 2);
}

TEST(what_points_upwards_has_no_heading)
{
    const struct dis_place at = {0, 0, 100};
    const double still[3] = {0, 0, 0};
    struct dis_motion m = local_motion(&at, still, 90, DIS_FPW);
    struct dis_target t;
    assert_int_equal(dis_target_of(&m, &jet, &no_geoid, 0, &t), DIS_FIT);
    assert_true((t.parts & DIS_PART_HEADING) != 0);
    m.psi_rad = m.theta_rad = m.phi_rad = 0; /* along x, which is up here */
    assert_int_equal(dis_target_of(&m, &jet, &no_geoid, 0, &t), DIS_FIT);
    assert_true((t.parts & DIS_PART_HEADING) == 0 && t.heading_bam16 == 0);
}

TEST(what_the_bus_cannot_carry_is_said)
{
    const struct dis_place high = {10, 10, 20000}, low = {10, 10, 100};
    const double fast[3] = {800, 700, 0}, slow[3] = {1, 1, 0};
    const struct dis_motion a = local_motion(&high, slow, 0, DIS_FPW);
    const struct dis_motion b = local_motion(&low, fast, 0, DIS_FPW);
    struct dis_target t;
    assert_int_equal(dis_target_of(&a, &jet, &no_geoid, 0, &t), DIS_TOO_HIGH);
    assert_int_equal(dis_target_of(&b, &jet, &no_geoid, 0, &t), DIS_TOO_FAST);
}

/* The display reckons on a plane from rounded numbers: between two heartbeats of a second it must
 * stay with the entity for every model. */
TEST(between_two_heartbeats_the_display_is_with_the_entity)
{
    const struct dis_place at = {48, 11, 500};
    const struct dis_axes x = dis_axes_at(&at);
    for (uint8_t algorithm = 1; algorithm <= 9; algorithm++) {
        const double speed[3] = {30, 40, 0}, ahead[3] = {50, 0, 0};
        struct dis_motion m = local_motion(&at, speed, 36.87, algorithm);
        struct dis_target then, now;
        for (int i = 0; i < 3; i++) {
            m.acceleration_m_s2[i] = 2 * x.east[i];
        }
        if (algorithm >= 6) {
            memcpy(m.velocity_m_s, ahead, sizeof ahead);
            m.acceleration_m_s2[0] = 1;
            m.acceleration_m_s2[1] = m.acceleration_m_s2[2] = 0;
        }
        m.turn_rad_s[2] = 0.2;
        assert_int_equal(dis_target_of(&m, &jet, &no_geoid, 0.7, &then), DIS_FIT);
        assert_int_equal(dis_target_of(&m, &jet, &no_geoid, 1.7, &now), DIS_FIT);
        const struct dis_error e = dis_target_error(&then, 1, &now);
        assert_true(e.metres < 0.3 && e.degrees < 0.05 && !e.is_other);
        const struct dis_error stood = dis_target_error(&then, 0, &now);
        assert_true(algorithm == 1 || stood.metres > 40);
    }
}

TEST(a_target_that_crosses_the_date_line_or_north_is_not_far_off)
{
    const struct dis_target then = {.longitude_1e7 = 1799999990, .heading_bam16 = 32767};
    const struct dis_target now = {.longitude_1e7 = -1799999990, .heading_bam16 = -32768};
    const struct dis_error e = dis_target_error(&then, 0, &now);
    assert_true(e.metres < 0.3 && e.degrees < 0.01);
}
