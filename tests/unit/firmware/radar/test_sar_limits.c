/* The limits of a patch, with radar tables and flights that only their checks bound: docs of
 * lm/sar.h. */
#include "check.h"
#include "hs/angle.h"
#include "lm/sar.h"
#include "target_support.h"
#include "tiny_map.h"

#include <math.h>
#include <string.h>

enum { NEAREST_M = 16 * 256 /* 16 LM_RANGE_MIN_M */ };

static struct tiny_map map;
static struct lm_tone tone;
static struct lm_sar sar;
static struct lm_line line;

static int open_map(void **state)
{
    (void)state;
    tiny_map_open_soil(&map, 32, &tone);
    return 0;
}

static int close_map(void **state)
{
    (void)state;
    tiny_map_close(&map);
    return 0;
}

TEST_GROUP(open_map, close_map);

static struct lm_sar_command command_of(uint32_t range_m, uint32_t cell_mm, int32_t height_m)
{
    return (struct lm_sar_command){.centre = {hs_bam(46), hs_bam(11)},
                                   .range_m = range_m,
                                   .height_m_q6 = height_m * 64,
                                   .look_azimuth = hs_bam(90),
                                   .cell_mm = cell_mm};
}

static int start(const struct lm_radar *radar, const struct lm_sar_command *command,
                 const struct lm_sar_setup *setup)
{
    return lm_sar_start(&sar, radar, &map.db, command, setup);
}

/* Lines k of n = 2 ceil(C S / 2 near), with C cells: 512 cells of 100 m need 1,056 lines where the
 * patch begins at 0.485 of its centre's range. */
TEST(a_patch_of_more_lines_than_there_is_room_for_is_refused_as_too_near)
{
    struct lm_radar radar = lm_radar_default;
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    radar.sar.cells = 512;
    radar.sar.cell_max_mm = 100000;
    for (uint32_t range_m = 40000; range_m <= 60000; range_m += 500) {
        const struct lm_sar_command c = command_of(range_m, 100000, 9000);
        const double near_m = range_m - 25600.0;
        const uint32_t lines = 2 * (uint32_t)ceil(512 * range_m / near_m / 2);
        assert_true(near_m > NEAREST_M);
        assert_int_equal(lm_sar_judge(&radar, &c, &setup),
                         lines > LM_PATCH_LINES_MAX ? LM_REFUSED_NEAR : LM_REFUSED_NOT);
    }
}

TEST(a_patch_that_is_refused_is_not_started)
{
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    const struct lm_sar_command good = command_of(20000, 4000, 6000);
    const struct lm_sar_command bad = command_of(20000, 400, 6000); /* of too fine cells */
    assert_int_equal(start(&lm_radar_default, &good, &setup), LM_OK);
    assert_int_equal(start(&lm_radar_default, &bad, &setup), LM_ERR_RANGE);
    assert_int_equal(sar.command.cell_mm, 4000);
}

/* However deep the valley before a patch, what is traced of it begins no nearer than a patch may.
 */
TEST(what_layover_brings_in_begins_no_nearer_than_a_patch_may)
{
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE,
                                       .relief = {.near_fall_m_q10 = 2000 * 1024}};
    uint32_t limited = 0;
    for (uint32_t range_m = 4740; range_m < 6000; range_m += 20) {
        const struct lm_sar_command c = command_of(range_m, 5000, 5000);
        const double near_m = range_m - 128 * 5.0;
        assert_int_equal(start(&lm_radar_default, &c, &setup), LM_OK);
        assert_true(near_m - sar.overscan * 5.0 >= NEAREST_M);
        limited += near_m - sar.overscan * 5.0 < NEAREST_M + 5;
        assert_true(sar.overscan > 0 || near_m < NEAREST_M + 5);
    }
    assert_true(limited > 5 && limited < 40);
}

/* A patch of so many cells that fewer than LM_SAR_OVERSCAN_MAX have room on each side. */
TEST(what_layover_brings_in_takes_all_the_room_that_a_wide_patch_leaves)
{
    const struct lm_sar_setup setup = {
        .sea_state = LM_SEA_STATE_OF_IMAGE,
        .relief = {.near_fall_m_q10 = 4000 * 1024, .far_rise_m_q10 = 4000 * 1024}};
    const struct lm_sar_command c = command_of(30000, 4000, 6000);
    struct lm_radar radar = lm_radar_default;
    for (uint32_t room = LM_SAR_OVERSCAN_MAX - 2; room < LM_SAR_OVERSCAN_MAX + 2; room++) {
        const uint32_t most = room < LM_SAR_OVERSCAN_MAX ? room : LM_SAR_OVERSCAN_MAX;
        radar.sar.cells = (uint16_t)(LM_CELLS_MAX - 2 * room);
        assert_int_equal(start(&radar, &c, &setup), LM_OK);
        assert_int_equal(sar.overscan, most);
        assert_int_equal(sar.traced, radar.sar.cells + 2 * most);
    }
}

/* Ground nearer than half the antenna's height is not shown: from twice as high as the patch is
 * far, nothing of the foreground is, and the patch has no horizon to begin with. */
TEST(nothing_before_a_patch_hides_it_from_an_antenna_far_above)
{
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    for (int is_high = 0; is_high < 2; is_high++) {
        const struct lm_sar_command c = command_of(8000, 5000, is_high ? 15500 : 5000);
        assert_int_equal(start(&lm_radar_default, &c, &setup), LM_OK);
        const int16_t *level_q8 = lm_sar_draw_line(&sar, &map.tiles, &tone, &line);
        assert_int_equal(sar.horizon == LM_HORIZON_OPEN, is_high);
        assert_true(level_q8[250] > LM_LEVEL_SHADOW / 2);
    }
}

/* A millimetre a second across the line of sight, which no more than a table's longest dwell and
 * coarsest cells allow: a target far away may be displaced into the patch. */
TEST(the_slowest_flight_displaces_no_target_out_of_the_arithmetic)
{
    struct lm_radar radar = lm_radar_default;
    const struct lm_sar_flight flight = {
        .speed_mm_s = 1, .track = 0, .bearing = FX_BAM_90, .heading = FX_BAM_90};
    struct lm_target mover = point_at(46.9, 11, 3, 40); /* 100 km north */
    mover.speed_mm_s = 100000;
    mover.leg_m = 1000;
    seal_target(&mover);
    const struct lm_target_set set = {.items = &mover, .count = 1};
    const struct lm_sar_setup setup = {
        .flight = &flight, .targets = &set, .sea_state = LM_SEA_STATE_OF_IMAGE};
    radar.wavelength_um = LM_WAVELENGTH_MIN_UM;
    radar.sar.cells = 32;
    radar.sar.cell_max_mm = 100000;
    radar.sar.dwell_max_ms = (1 << 17) - 1;
    const struct lm_sar_command c = command_of(19000, 100000, 6000);
    assert_int_equal(start(&radar, &c, &setup), LM_OK);
    lm_sar_prefetch_targets(&sar, &map.tiles);
    assert_int_equal(sar.candidates.count, 1);
}
