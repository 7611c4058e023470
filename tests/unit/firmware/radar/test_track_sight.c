/* What a track sees of the map where the map has nothing, or says another thing near by than from
 * far. */
#include "check.h"
#include "hs/angle.h"
#include "lm/level.h"
#include "tiny_map.h"
#include "track_sight.h"

#include <math.h>

enum { TILES = 600 };

static struct tiny_map map;
static struct lm_scan_line line;

static struct tiny_cell soil(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return (struct tiny_cell){-20, p->east_m > 200 ? TINY_NONE : TINY_SOIL, 0};
}

/* A plain at 500 m with a canyon of 57 m along a meridian. Where cells are three times as wide, it
 * is no more than a shallow valley. */
static double canyon_m(void *ctx, const struct tiny_place *p)
{
    const double middle_deg = *(const double *)ctx;
    const double away_posts = (p->longitude_deg - middle_deg) / 360 * 4294967296.0 / 512;
    return fabs(away_posts) <= 6 ? 0 : 500;
}

TEST(ground_without_data_and_off_the_map_returns_nothing)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.rows = spec.columns = 3;
    spec.cell = soil;
    tiny_map_open(&map, &spec, 40);
    static const double east[] = {10.998, 11.004, 20};
    for (int i = 0; i < 3; i++) {
        const struct lm_position at = {hs_bam(46), hs_bam(east[i])};
        (void)lm_track_ground_db_q8(&map.tiles, at);
        tiny_map_read_tiles(&map);
        const int32_t db_q8 = lm_track_ground_db_q8(&map.tiles, at);
        assert_int_equal(db_q8, i == 0 ? -20 * 256 : LM_LEVEL_SHADOW);
    }
    tiny_map_close(&map);
}

/* A strip of ground to the north of 46 N 11 E, 15 km long. */
static struct tiny_spec strip(double (*elevation_m)(void *ctx, const struct tiny_place *place),
                              void *ctx)
{
    struct tiny_spec spec = tiny_spec_at(46.05, 11);
    spec.rows = 50;
    spec.columns = 3;
    spec.cell = soil;
    spec.elevation_m = elevation_m;
    spec.ctx = ctx;
    return spec;
}

/* From 800 m the nose points 3 degrees down, along the canyon. By the coarse LOD there is a plain 6
 * to 10 km ahead. Near by there is nothing as high: the canyon's floor is 15 km ahead. */
TEST(ground_that_is_there_from_far_alone_is_ranged_where_it_was_found)
{
    const fx_bam_t middle = hs_bam(11) & ~(fx_bam_t)511;
    double middle_deg = hs_degrees(middle);
    struct tiny_spec spec = strip(canyon_m, &middle_deg);
    spec.level_count = 6;
    tiny_map_open(&map, &spec, TILES);
    const struct lm_track_scene s = {
        .radar = &lm_radar_default,
        .tiles = &map.tiles,
        .platform = {.position = {hs_bam(46), middle}, .height_m_q10 = 800 * 1024},
        .pitch = -(int32_t)FX_BAM_DEG(3),
        .range_index = 1,
        .line = &line};
    struct lm_position at = {0, 0};
    int32_t elevation_m_q10;
    for (int i = 0; i < 4; i++) {
        (void)lm_track_ahead(&s, &at, &elevation_m_q10);
        tiny_map_read_tiles(&map);
    }
    assert_true(lm_track_ahead(&s, &at, &elevation_m_q10));
    const double ahead_m = (hs_degrees(at.latitude) - 46) * 111150;
    print_message("# ground at %.0f m\n", ahead_m);
    assert_true(ahead_m > 5700 && ahead_m < 12000);
    tiny_map_close(&map);
}

/* A ridge of 200 m, rounded and 2 km wide, 5 km to the north of 46 N. */
static double ridge_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const double away_m = (p->latitude_deg - 46) * 111150 - 5000;
    return 200 * exp(-pow(away_m / 600, 2));
}

/* From 300 m the line over the ridge, 100 m below, is another 100 m lower 10 km away: a target
 * there is seen above 100 m, less what the Earth and the air bend. */
TEST(a_target_is_seen_above_the_line_over_a_ridge_and_hidden_below_it)
{
    static struct lm_track track;
    const struct tiny_spec spec = strip(ridge_m, NULL);
    tiny_map_open(&map, &spec, TILES);
    const struct lm_track_scene s = {
        .radar = &lm_radar_default,
        .tiles = &map.tiles,
        .platform = {.position = {hs_bam(46), hs_bam(11)}, .height_m_q10 = 300 * 1024},
        .range_index = 1,
        .line = &line};
    struct lm_track_seen seen = {.ground_m_q8 = 10000 * 256};
    for (int i = 0; i < 4; i++) {
        (void)lm_track_sees(&track, &s, &seen);
        tiny_map_read_tiles(&map);
    }
    int32_t least_m = 0;
    while (seen.elevation_m_q10 = least_m * 1024, !lm_track_sees(&track, &s, &seen)) {
        assert_true(++least_m < 1000);
    }
    print_message("# seen from %d m\n", least_m);
    assert_in_range(least_m, 95, 112);
    seen.elevation_m_q10 = (least_m + 500) * 1024;
    assert_true(lm_track_sees(&track, &s, &seen));
    tiny_map_close(&map);
}

static double plateau_m(void *ctx, const struct tiny_place *p)
{
    (void)p;
    return *(const double *)ctx;
}

/* Signal of a place 8 km to the north, seen from 2000 m above a plain of this elevation. */
static int32_t plain_signal_db_q8(double plain_m)
{
    static struct lm_track track;
    const struct lm_target_set none = {0};
    const struct lm_environment fair = {0};
    const struct lm_malfunctions sound = {0};
    const struct tiny_spec spec = strip(plateau_m, &plain_m);
    tiny_map_open(&map, &spec, TILES);
    const struct lm_track_scene s = {.radar = &lm_radar_default,
                                     .tiles = &map.tiles,
                                     .targets = &none,
                                     .environment = &fair,
                                     .malfunctions = &sound,
                                     .platform = {.position = {hs_bam(46), hs_bam(11)},
                                                  .height_m_q10 = (int32_t)(plain_m + 2000) * 1024},
                                     .range_index = 1,
                                     .is_sending = true,
                                     .is_nav_good = true,
                                     .line = &line};
    const struct lm_position place = {hs_bam(46 + 8000 / 111150.0), hs_bam(11)};
    lm_track_begin(&track, LM_TRACK_FIXED, place, 100, 0);
    for (uint64_t now_us = 0; now_us < 10 * LM_TRACK_STEP_US; now_us += LM_TRACK_STEP_US) {
        lm_track_step(&track, &s, now_us);
        tiny_map_read_tiles(&map);
    }
    assert_int_equal(track.state, LM_TRACK_HELD);
    tiny_map_close(&map);
    return track.seen.signal_db_q8;
}

/* Noise in a cell goes with the grazing angle, hence with the height above the ground. */
TEST(a_place_on_a_plateau_is_as_strong_as_one_by_the_sea)
{
    const int32_t low_db_q8 = plain_signal_db_q8(0), high_db_q8 = plain_signal_db_q8(2500);
    print_message("# %.2f dB by the sea, %.2f on the plateau\n", low_db_q8 / 256.0,
                  high_db_q8 / 256.0);
    assert_in_range(low_db_q8 - high_db_q8 + 26, 0, 52);
}
