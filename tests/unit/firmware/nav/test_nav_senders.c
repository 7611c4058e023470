/* Two good senders of one field that do not say the same. */
#include "check.h"
#include "lm/nav.h"

static void say(struct lm_nav *n, uint8_t field, uint8_t priority, int32_t value, uint64_t time_us)
{
    const struct lm_bus_event event = {.value = value,
                                       .time_us = time_us,
                                       .period_us = 100000,
                                       .stale_ms = 300,
                                       .dead_ms = 2000,
                                       .field = field,
                                       .priority = priority,
                                       .node = (uint8_t)(priority + 1)};
    lm_nav_take(n, &event);
}

/* Disagreements when a second sender says `second` 10 ms after the first said `first`. */
static uint32_t disagreements(uint8_t field, int64_t first, int64_t second)
{
    struct lm_nav n;
    lm_nav_init(&n);
    say(&n, field, 0, (int32_t)(uint32_t)first, 1000);
    say(&n, field, 1, (int32_t)(uint32_t)second, 11000);
    return n.disagreements;
}

TEST(each_field_has_its_tolerance)
{
    const int64_t degree = (1LL << 32) / 360;
    assert_int_equal(disagreements(LM_BUS_LATITUDE, 0, degree / 60), 0); /* a nautical mile */
    assert_int_equal(disagreements(LM_BUS_LATITUDE, 0, degree / 40), 1);
    assert_int_equal(disagreements(LM_BUS_LONGITUDE, 180 * degree - 5, -180 * degree + 5), 0);
    assert_int_equal(disagreements(LM_BUS_TRUE_HEADING, 358 * degree, 2 * degree), 0);
    assert_int_equal(disagreements(LM_BUS_TRUE_HEADING, 358 * degree, 4 * degree), 1);
    assert_int_equal(disagreements(LM_BUS_ROLL, -3 * degree, 3 * degree), 1);
    assert_int_equal(disagreements(LM_BUS_BARO_ALTITUDE, 0, 99 * 64), 0);
    assert_int_equal(disagreements(LM_BUS_BARO_ALTITUDE, 0, 101 * 64), 1);
    assert_int_equal(disagreements(LM_BUS_GROUND_SPEED, 100000, 119000), 0);
    assert_int_equal(disagreements(LM_BUS_GROUND_SPEED, 100000, 121000), 1);
    assert_int_equal(disagreements(LM_BUS_TRUE_TRACK, 0, 90 * degree), 0);
    assert_int_equal(disagreements(LM_BUS_STEERPOINT_LATITUDE, 0, 9 * degree), 0);
}

TEST(a_coarse_sender_may_be_wrong_by_its_step)
{
    struct lm_nav n;
    lm_nav_init(&n);
    struct lm_bus_event event = {.value = 0,
                                 .step = 150 * 64,
                                 .time_us = 1000,
                                 .stale_ms = 300,
                                 .dead_ms = 2000,
                                 .field = LM_BUS_BARO_ALTITUDE,
                                 .node = 1};
    lm_nav_take(&n, &event);
    say(&n, LM_BUS_BARO_ALTITUDE, 1, 240 * 64, 2000);
    assert_int_equal(n.disagreements, 0);
    say(&n, LM_BUS_BARO_ALTITUDE, 1, 260 * 64, 3000);
    assert_int_equal(n.disagreements, 1);
}

TEST(an_old_value_contradicts_nobody)
{
    struct lm_nav n;
    lm_nav_init(&n);
    say(&n, LM_BUS_BARO_ALTITUDE, 0, 0, 1000);
    say(&n, LM_BUS_BARO_ALTITUDE, 1, 5000 * 64, 400000);
    assert_int_equal(n.disagreements, 0);
    say(&n, LM_BUS_BARO_ALTITUDE, 0, 0, 500000);
    assert_int_equal(n.disagreements, 1);
    assert_int_equal(n.disagreeing, LM_BUS_BARO_ALTITUDE);
}

TEST(a_rival_is_named)
{
    struct lm_nav n;
    lm_nav_init(&n);
    say(&n, LM_BUS_PITCH, 0, 5, 1000);
    struct lm_bus_event event = {.value = 9,
                                 .time_us = 2000,
                                 .stale_ms = 300,
                                 .dead_ms = 2000,
                                 .field = LM_BUS_PITCH,
                                 .node = 77};
    lm_nav_take(&n, &event);
    assert_int_equal(n.rivals, 1);
    assert_int_equal(n.rival_node, 77);
    assert_int_equal(n.item[LM_BUS_PITCH][0].value, 5);
}

TEST(a_tolerance_is_kept_to_its_last_unit)
{
    static const struct {
        uint8_t field;
        int32_t most;
    } tolerances[] = {{LM_BUS_LATITUDE, 238609},          {LM_BUS_LONGITUDE, 238609},
                      {LM_BUS_ELLIPSOID_HEIGHT, 6400},    {LM_BUS_GROUND_SPEED, 20000},
                      {LM_BUS_PITCH, 59652324},           {LM_BUS_ROLL, 59652324},
                      {LM_BUS_HEADING, 59652324},         {LM_BUS_TRUE_HEADING, 59652324},
                      {LM_BUS_BARO_ALTITUDE, 6400},       {LM_BUS_TRUE_ALTITUDE, 6400},
                      {LM_BUS_ALTITUDE_RATE, 20000},      {LM_BUS_EAST_VELOCITY, 20000},
                      {LM_BUS_NORTH_VELOCITY, 20000},     {LM_BUS_UP_VELOCITY, 20000},
                      {LM_BUS_MAGNETIC_HEADING, 59652324}};
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
        const uint8_t field = tolerances[i].field;
        const int32_t most = tolerances[i].most;
        assert_int_equal(disagreements(field, 100, 100 + most), 0);
        assert_int_equal(disagreements(field, 100, 101 + most), 1);
        assert_int_equal(disagreements(field, 100 + most, 100), 0);
        assert_int_equal(disagreements(field, 101 + most, 100), 1);
    }
}
