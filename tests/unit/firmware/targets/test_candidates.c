/* Which targets a sweep, a patch or a line may meet, at the borders of what they reach. */
#include "check.h"
#include "hs/angle.h"
#include "lm/target_candidates.h"
#include "target_support.h"

#include <string.h>

enum { S = 1000000 };

static struct lm_live live;
static struct lm_target_candidates candidates;
static const struct lm_position antenna = {FX_BAM_DEG(46), FX_BAM_DEG(11)};
static const double metres_a_degree = 111150; /* of latitude at 46 degrees */

/* Nobody but target 5, which stands so far from the antenna and moves so fast. */
static struct lm_live_target *put(double north_m, double east_m, double north_m_s, double east_m_s)
{
    const double shorter = cos(46 * M_PI / 180);
    memset(&live, 0, sizeof live);
    live.count = 1;
    live.target[5] = (struct lm_live_target){
        .motion_us = 7 * S,
        .position = {hs_bam(46 + north_m / metres_a_degree),
                     hs_bam(11 + east_m / metres_a_degree / shorter)},
        .velocity = {(int16_t)lround(east_m_s * 20), (int16_t)lround(north_m_s * 20)},
        .rcs_dbsm_q8 = 20 * 256,
        .kind = LM_LIVE_REFLECTOR,
        .reckoning = LM_LIVE_RPB,
        .is_there = true};
    return &live.target[5];
}

static uint32_t met_within(uint32_t reach_m)
{
    const struct lm_target_set set = {.live = &live};
    const struct lm_target_query query = {
        .position = antenna, .reach_m = reach_m, .time_us = 7 * S};
    lm_target_candidates_select(&candidates, &set, &query);
    lm_target_candidates_add_live(&candidates, &query);
    assert_int_equal(candidates.left_out, 0);
    return candidates.count;
}

TEST(a_live_target_is_met_in_reach_in_each_direction_and_not_beyond)
{
    for (int away = 0; away < 4; away++) {
        const double north = away == 0 ? 1 : away == 1 ? -1 : 0;
        const double east = away == 2 ? 1 : away == 3 ? -1 : 0;
        put(north * 9500, east * 9500, 0, 0);
        assert_int_equal(met_within(9600), 1);
        assert_int_equal(candidates.candidate[0].index, 5);
        assert_true(fabs(candidates.candidate[0].north_m_q8 / 256.0 - north * 9500) < 60);
        assert_true(fabs(candidates.candidate[0].east_m_q8 / 256.0 - east * 9500) < 60);
        assert_int_equal(met_within(9000), 0);
    }
}

/* The plane is good for three degrees. What is farther is nowhere, the other side of the Earth
 * among it, where differences of angles are largest. */
TEST(a_live_target_far_away_is_not_met)
{
    static const double places[][2] = {{49.5, 11}, {42.5, 11},  {46, 30},  {46, -8},
                                       {-46, 11},  {46, -169},  {46, 191}, {-46, -169},
                                       {89.9, 11}, {-89.9, 100}};
    const struct lm_target_set set = {.live = &live};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        struct lm_live_target *t = put(0, 0, 100, 100);
        t->position = (struct lm_position){hs_bam(places[i][0]), hs_bam(places[i][1])};
        assert_int_equal(met_within(250000), 0);
        for (double azimuth_deg = -180; azimuth_deg < 180; azimuth_deg += 5) {
            const struct lm_target_query query = {
                .position = antenna, .reach_m = 250000, .time_us = 7 * S};
            const struct lm_live_line line = {.azimuth = hs_bam(azimuth_deg),
                                              .width = hs_bam(5),
                                              .beam = hs_bam(3),
                                              .end_m_q8 = 250000u * 256};
            lm_target_candidates_of_line(&candidates, &set, &query, &line);
            assert_int_equal(candidates.count, 0);
        }
    }
}

static uint32_t met_on_line(double azimuth_deg, double track_deg, double speed_m_s, bool is_doppler,
                            bool is_of_beacons)
{
    const struct lm_target_set set = {.live = &live};
    const struct lm_target_query query = {.position = antenna, .reach_m = 20000, .time_us = 7 * S};
    const struct lm_live_line line = {.azimuth = hs_bam(azimuth_deg),
                                      .width = hs_bam(0.5),
                                      .beam = hs_bam(3),
                                      .end_m_q8 = 20000u * 256,
                                      .is_doppler = is_doppler,
                                      .is_of_beacons = is_of_beacons,
                                      .speed_mm_s = (uint32_t)(speed_m_s * 1000),
                                      .track = hs_bam(track_deg)};
    lm_target_candidates_of_line(&candidates, &set, &query, &line);
    return candidates.count;
}

TEST(a_line_of_beacons_has_nothing_else)
{
    put(10000, 0, 0, 0)->kind = LM_LIVE_BEACON;
    assert_int_equal(met_on_line(0, 0, 100, false, true), 1);
    assert_int_equal(met_on_line(0, 0, 100, false, false), 1);
    put(10000, 0, 0, 0);
    assert_int_equal(met_on_line(0, 0, 100, false, true), 0);
    assert_int_equal(met_on_line(0, 0, 100, false, false), 1);
}

/* A mover at 10 km that closes at 10 m/s while the antenna flies at 200 m/s across: it is displaced
 * by -v r / (V sin o) = 500 m, which is 2.9 degrees. */
TEST(a_sharpened_line_has_the_movers_that_appear_on_it_and_not_where_they_are)
{
    put(10000, 0, -10, 0);
    const double shift_deg = 10.0 / 200 * 180 / M_PI;
    int where[2] = {0, 0};
    for (int side = 0; side < 2; side++) {
        const double azimuth_deg = side == 0 ? -shift_deg : shift_deg;
        where[side] = (int)met_on_line(azimuth_deg, 90 + azimuth_deg, 200, true, false);
        assert_int_equal(met_on_line(azimuth_deg, 90 + azimuth_deg, 200, false, false), 0);
    }
    assert_int_equal(where[0] + where[1], 1);
    assert_int_equal(met_on_line(0, 90, 200, true, false), 0);
    assert_int_equal(met_on_line(0, 90, 200, false, false), 1);
    /* An antenna that stands displaces nothing. */
    assert_int_equal(met_on_line(0, 90, 0, true, false), 1);
    /* Along the track nobody can tell where it appears: a beam and a quarter aside is looked at. */
    assert_int_equal(met_on_line(3, 0, 200, true, false), 1);
    assert_int_equal(met_on_line(3, 0, 200, false, false), 0);
    assert_int_equal(met_on_line(6, 0, 200, true, false), 0);
}

/* At a crawl along the track a mover is displaced by more than any beam shows. */
TEST(what_is_displaced_out_of_the_beam_is_on_no_sharpened_line)
{
    put(10000, 0, -10, 0);
    int met = 0;
    for (int azimuth = -60; azimuth <= 60; azimuth++) {
        met += (int)met_on_line(azimuth, 90, 20, true, false);
    }
    assert_int_equal(met, 0);
}

TEST(a_set_has_any_target_if_it_has_one_of_the_image_or_a_live_one)
{
    struct lm_target_set set = {0};
    assert_false(lm_target_set_is_live(&set) || lm_target_set_has_any(&set));
    memset(&live, 0, sizeof live);
    set.live = &live;
    assert_false(lm_target_set_is_live(&set) || lm_target_set_has_any(&set));
    live.count = 1;
    assert_true(lm_target_set_is_live(&set) && lm_target_set_has_any(&set));
    set = (struct lm_target_set){.count = 1};
    assert_true(lm_target_set_has_any(&set) && !lm_target_set_is_live(&set));
}

/* The plane that comes first is wider than the reach, by what it may be wrong. */
TEST(of_a_target_that_goes_away_reach_ends_once)
{
    uint32_t ends = 0, before = 1;
    for (int away_m = 9000; away_m < 16000; away_m += 3) {
        put(away_m, 0, 0, 0);
        const uint32_t count = met_within(9000);
        ends += count != before;
        before = count;
    }
    assert_int_equal(ends, 1);
    assert_int_equal(before, 0);
}

/* What comes first asks for north and east, each by itself: reach is a circle, not that square. */
TEST(a_target_in_the_corner_of_the_square_around_the_reach_is_not_met)
{
    put(95000, 0, 0, 0);
    assert_int_equal(met_within(100000), 1);
    put(0, 95000, 0, 0);
    assert_int_equal(met_within(100000), 1);
    put(95000, 95000, 0, 0);
    assert_int_equal(met_within(100000), 0);
}

TEST(a_live_target_without_room_is_counted_as_left_out)
{
    struct lm_target items[LM_TARGET_CANDIDATES_MAX];
    put(1000, 0, 0, 0);
    for (int i = 0; i < LM_TARGET_CANDIDATES_MAX; i++) {
        items[i] = point_at(46, 11, 0, 10);
    }
    const struct lm_target_set set = {
        .items = items, .count = LM_TARGET_CANDIDATES_MAX, .live = &live};
    const struct lm_target_query query = {.position = antenna, .reach_m = 9000, .time_us = 7 * S};
    lm_target_candidates_select(&candidates, &set, &query);
    assert_int_equal(candidates.left_out, 0);
    lm_target_candidates_add_live(&candidates, &query);
    assert_int_equal(candidates.count, LM_TARGET_CANDIDATES_MAX);
    assert_int_equal(candidates.left_out, 1);
}

TEST(a_target_that_is_not_there_is_no_candidate)
{
    const struct lm_target item = point_at(46, 11, 100, 10);
    const struct lm_target_set set = {.items = &item, .count = 1, .live = &live},
                               no_live = {.items = &item, .count = 1};
    const struct lm_target_query query = {.position = antenna, .time_us = 7 * S};
    struct lm_target_candidate c, untouched;
    put(1000, 0, 0, 0)->has_height = true;
    live.target[5].height_m_q6 = 77 * 64;
    memset(&c, 0x5A, sizeof c);
    untouched = c;
    assert_false(lm_target_candidate_of(&c, &set, false, 1, &query));
    assert_false(lm_target_candidate_of(&c, &set, false, UINT32_MAX, &query));
    assert_false(lm_target_candidate_of(&c, &set, true, 4, &query));
    assert_false(lm_target_candidate_of(&c, &set, true, LM_LIVE_MAX, &query));
    assert_false(lm_target_candidate_of(&c, &set, true, UINT32_MAX, &query));
    assert_false(lm_target_candidate_of(&c, &no_live, true, 5, &query));
    assert_memory_equal(&c, &untouched, sizeof c);
    assert_true(lm_target_candidate_of(&c, &set, true, 5, &query));
    assert_int_equal(c.index, 5);
    assert_int_equal(c.elevation_m_q6, 77 * 64);
    assert_true(lm_target_candidate_of(&c, &set, false, 0, &query));
    assert_int_equal(c.elevation_m_q6, 100 * 64);
}

/* Signatures are counted from 1 on the bus. One that the image has not, or that was lost, leaves a
 * point. */
TEST(a_live_target_has_the_signature_that_it_names)
{
    static const struct lm_signature signatures[3] = {
        {.aspects = 4, .depressions = 1}, {.aspects = 0}, {.aspects = 8, .depressions = 1}};
    const struct lm_target_set set = {
        .live = &live, .signatures = signatures, .signature_count = 3, .live_signatures = 3};
    const struct lm_target_query query = {.position = antenna, .time_us = 7 * S};
    for (uint8_t told = 0; told < 6; told++) {
        struct lm_target_candidate c;
        put(1000, 0, 0, 0)->signature = told;
        assert_true(lm_target_candidate_of(&c, &set, true, 5, &query));
        const struct lm_signature *s = lm_target_signature(&set, &c.body);
        assert_ptr_equal(s, told == 1 ? &signatures[0] : told == 3 ? &signatures[2] : NULL);
        assert_int_equal(c.body.flags, s ? LM_TARGET_HAS_SIGNATURE : 0);
        assert_int_equal(c.body.mean_rcs_dbsm_q8, 20 * 256);
    }
}

/* 77,000 BAM are 717 m of latitude. */
TEST(targets_are_selected_again_when_the_antenna_has_gone_some_way_or_time_has)
{
    const struct lm_target item = point_at(46, 11, 100, 10);
    const struct lm_target_set set = {.items = &item, .count = 1};
    const struct {
        int32_t north, east;
        uint64_t time_us;
        bool is_again;
    } steps[] = {
        {0, 0, 7 * S, true},       {0, 0, 7 * S, false},         {76999, 0, 7 * S, false},
        {77000, 0, 7 * S, true},   {0, 0, 7 * S, true},          {0, 76999, 7 * S, false},
        {0, -76999, 7 * S, false}, {0, 77000, 7 * S, true},      {0, 0, 7 * S, true},
        {-77000, 0, 7 * S, true},  {-77000, 0, 7 * S + 1, true}, {-77000, 0, 7 * S + 1, false}};
    memset(&candidates, 0, sizeof candidates);
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const struct lm_target_query query = {
            .position = {antenna.latitude + (uint32_t)steps[i].north,
                         antenna.longitude + (uint32_t)steps[i].east},
            .reach_m = 5000,
            .time_us = steps[i].time_us};
        assert_int_equal(lm_target_candidates_refresh(&candidates, &set, &query),
                         steps[i].is_again);
        assert_int_equal(candidates.count, 1);
    }
}
