/* The display unit as a whole, on a bus, a flash and a glass that misbehave on demand. */
#include "check.h"
#include "unit_rig.h"

#include <math.h>
#include <string.h>

TEST(a_good_flight_paints_a_sector_without_a_flag)
{
    struct rig *r = start_rig();
    command(r, range_10);
    run(r, 3);
    assert_int_equal(r->unit.flags & ~(uint32_t)LM_FLAG_OFF_MAP, 0);
    assert_true(lit_pixels(r) > 10000);
    assert_int_equal(r->unit.count.lines_dropped, 0);
    free_rig(r);
}

TEST(frames_come_thirty_times_a_second_and_lines_at_the_radars_rate)
{
    struct rig *r = start_rig();
    run(r, 1); /* nav must come first */
    const uint32_t frames = r->unit.count.frames, lines = r->unit.count.lines;
    run(r, 10);
    assert_in_range(r->unit.count.frames - frames, 294, 306); /* 30 Hz within 2 % */
    assert_in_range(r->unit.count.lines - lines, 2509, 2611); /* 256 a second within 2 % */
    free_rig(r);
}

TEST(two_runs_give_the_same_pixels)
{
    struct rig *a = start_rig(), *b = start_rig();
    run(a, 2);
    run(b, 2);
    assert_memory_equal(a->glass, b->glass, sizeof a->glass);
    free_rig(a);
    free_rig(b);
}

TEST(another_seed_gives_other_speckle)
{
    struct rig *a = start_rig(), *b = make_rig();
    b->board.lent.noise_seed = 1;
    assert_int_equal(lm_unit_init(&b->unit, &b->board.lent), LM_OK);
    run(a, 2);
    run(b, 2);
    assert_memory_not_equal(a->plane, b->plane, sizeof a->plane);
    free_rig(a);
    free_rig(b);
}

TEST(without_a_bus_the_glass_says_so_and_shows_no_picture)
{
    struct rig *r = start_rig();
    r->bus.is_down = 1;
    run(r, 2);
    assert_true(r->unit.flags & LM_FLAG_BUS);
    assert_true(r->unit.flags & LM_FLAG_NAV_DEAD);
    assert_int_equal(lit_pixels(r), 0);
    assert_true(r->unit.count.frames > 50); /* and the display lives */
    assert_true(r->unit.count.bus_errors > 0);
    free_rig(r);
}

/* The rig's bus without the true heading, 1133. */
static int hear_without_true_heading(void *ctx, struct lm_can_frame *frame)
{
    struct rig *r = ctx;
    int status;
    do {
        status = r->board.can.receive(r, frame);
    } while (status == 1 && frame->id == 1133);
    return status;
}

TEST(a_magnetic_heading_without_a_variation_is_said_on_the_glass)
{
    for (int is_magnetic = 0; is_magnetic < 2; is_magnetic++) {
        struct rig *r = make_rig();
        const struct lm_can can = {.ctx = r, .receive = hear_without_true_heading};
        r->board.lent.can = &can;
        r->board.lent.is_heading_magnetic = is_magnetic;
        assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
        command(r, range_10);
        run(r, 2);
        assert_int_equal((r->unit.flags & LM_FLAG_MAGNETIC) != 0, is_magnetic);
        assert_true(lit_pixels(r) > 10000);
        free_rig(r);
    }
}

TEST(stale_nav_freezes_the_sweep_then_removes_the_picture_then_recovers)
{
    struct rig *r = start_rig();
    command(r, range_10);
    run(r, 3);
    r->bus.stop_us = r->now_us;
    run(r, 0.5);
    assert_true(r->unit.flags & LM_FLAG_NAV_STALE);
    const uint32_t frozen = plane_sum(r), lines = r->unit.count.lines;
    run(r, 0.3);
    assert_int_equal(plane_sum(r), frozen);
    assert_int_equal(r->unit.count.lines, lines);
    run(r, 3);
    assert_true(r->unit.flags & LM_FLAG_NAV_DEAD);
    assert_int_equal(lit_pixels(r), 0);
    r->bus.stop_us = UINT64_MAX;
    r->bus.sent_us = r->now_us;
    run(r, 2);
    assert_int_equal(r->unit.flags & (LM_FLAG_NAV_DEAD | LM_FLAG_NAV_STALE | LM_FLAG_BUS), 0);
    assert_true(lit_pixels(r) > 10000);
    free_rig(r);
}

TEST(the_warning_is_on_the_glass)
{
    struct rig *r = start_rig();
    run(r, 1);
    uint32_t before = 0, after = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        before += r->glass[i] == 0x00FFB020;
    }
    r->bus.stop_us = r->now_us;
    run(r, 0.8);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        after += r->glass[i] == 0x00FFB020;
    }
    assert_true(after > before + 100);
    free_rig(r);
}

TEST(an_unusable_database_is_shown_not_hidden)
{
    struct rig *r = make_rig();
    r->image.bytes[100] ^= 1;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 2);
    assert_true(r->unit.flags & LM_FLAG_DB);
    assert_int_equal(lit_pixels(r), 0);
    assert_true(r->unit.count.frames > 50);
    command(r, patch_here);
    run(r, 0.1);
    assert_int_equal(r->unit.count.commands_refused, 1);
    free_rig(r);
}

TEST(every_read_may_fail_once_and_the_sweep_goes_on)
{
    struct rig *clean = start_rig();
    command(clean, range_10);
    run(clean, 4);
    const uint32_t reads = clean->board.flash.reads;
    for (uint32_t bad = 4; bad < reads; bad += 3) { /* the first three are the database's tables */
        struct rig *r = make_rig();
        r->board.flash.fail_read = bad;
        assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
        command(r, range_10);
        run(r, 4);
        assert_int_equal(r->unit.count.lines, clean->unit.count.lines);
        assert_int_equal(r->unit.map.tiles.count.io_errors, 1);
        free_rig(r);
    }
    free_rig(clean);
}

TEST(a_record_damaged_in_flight_is_flagged_counted_and_answered_coarser)
{
    struct rig *r = start_rig();
    for (size_t i = 0; i < r->image.record_count; i++) {
        r->image.bytes[r->image.tiles_offset + i * LM_TILE_BYTES + 500] ^= 0x10;
    }
    command(r, range_10);
    run(r, 2);
    assert_true(r->unit.map.tiles.count.corrupt > 0);
    assert_true(r->unit.flags & LM_FLAG_TILE);
    assert_true(lit_pixels(r) > 10000); /* from the coarsest level, read before the damage */
    free_rig(r);
}

TEST(a_read_that_does_not_end_is_told_until_it_ends)
{
    struct rig *r = make_rig();
    r->board.lent.tile_pool_bytes = 44 * sizeof(struct lm_tile); /* too few to keep them all */
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 3);
    r->board.flash.busy_polls = UINT32_MAX;
    while (lm_tile_cache_is_idle(&r->unit.map.tiles)) {
        run(r, 0.1);
        assert_true(r->now_us < 60000000);
    }
    run(r, 0.9);
    assert_false(r->unit.flags & LM_FLAG_TILE);
    run(r, 0.4);
    assert_true(r->unit.flags & LM_FLAG_TILE);
    run(r, 10);
    assert_true(r->unit.flags & LM_FLAG_TILE);
    r->board.flash.busy_polls = r->board.flash.now.polls_left = 0;
    run(r, 0.2);
    assert_false(r->unit.flags & LM_FLAG_TILE);
    free_rig(r);
}

TEST(late_flash_never_holds_the_sweep)
{
    struct rig *r = start_rig();
    r->board.flash.busy_polls = 200;
    command(r, range_10);
    run(r, 3);
    assert_int_equal(r->unit.count.lines_dropped, 0);
    assert_true(r->unit.count.lines > 600);
    assert_true(r->unit.map.tiles.count.substituted > 0);
    free_rig(r);
}

TEST(a_patch_completes_and_stays)
{
    struct rig *r = start_rig();
    run(r, 1);
    command(r, patch_here);
    run(r, 4);
    assert_int_equal(r->unit.count.commands_refused, 0);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
    const uint32_t done = plane_sum(r);
    assert_true(lit_pixels(r) > 10000);
    run(r, 2);
    assert_int_equal(plane_sum(r), done);
    free_rig(r);
}

/* A patch from a commanded place in the air, so that it is the same whenever it is asked for. */
static const struct lm_control patch_from_afar = {
    .kind = LM_CONTROL_SAR,
    .sar = {
        .centre = {FX_BAM_DEG(46), FX_BAM_DEG(342) / 31},
        .cell_mm = 5000,
        .look_azimuth = FX_BAM_DEG(30),
        .range_m = 12000,
        .height_m_q6 = 2000 * 64,
    }};

/* The patch goes when navigation does, whether or not the display takes a frame. */
TEST(a_patch_that_loses_its_navigation_is_drawn_again_though_no_frame_is_shown)
{
    struct rig *r = start_rig();
    run(r, 1);
    command(r, patch_here);
    run(r, 4);
    assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
    r->board.acquire_status = LM_BUSY;
    r->bus.stop_us = r->now_us;
    run(r, 11);
    assert_true(r->unit.flags & LM_FLAG_NAV_DEAD);
    assert_int_equal(r->unit.picture.sar.line, 0);
    for (size_t i = 0; i < sizeof r->plane; i++) {
        assert_int_equal(r->plane[i], 0);
    }
    r->bus.stop_us = UINT64_MAX;
    r->bus.sent_us = r->now_us;
    run(r, 4);
    assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
    free_rig(r);
}

/* What the operator switches is no fault, and only the last few are kept. */
TEST(the_fault_log_keeps_the_last_faults_and_nothing_else)
{
    struct lm_fault_log log = {.count = 0};
    lm_fault_log_add(&log, LM_FLAG_FROZEN | LM_FLAG_SILENT | LM_FLAG_UNABLE, 1);
    assert_null(lm_fault_log_at(&log, 0));
    lm_fault_log_add(&log, LM_FLAG_BUS | LM_FLAG_DB | LM_FLAG_FROZEN, 2);
    assert_int_equal(log.count, 2);
    assert_int_equal(1u << lm_fault_log_at(&log, 0)->flag, LM_FLAG_BUS);
    assert_int_equal(1u << lm_fault_log_at(&log, 1)->flag, LM_FLAG_DB);
    for (uint64_t n = 0; n < 4; n++) {
        lm_fault_log_add(&log, LM_FLAG_TILE, 10 + n);
    }
    for (uint32_t age = 0; age < LM_FAULTS_KEPT; age++) {
        assert_int_equal(lm_fault_log_at(&log, age)->time_us, 13 - age);
    }
    assert_null(lm_fault_log_at(&log, LM_FAULTS_KEPT));
}

TEST(a_patch_takes_its_elevation_from_the_finest_tile_though_that_was_not_read)
{
    struct rig *cold = start_rig(), *warm = start_rig();
    command(cold, patch_from_afar);
    run(cold, 1.0 * STEP_US / 1e6);
    assert_true(cold->unit.page.picture == LM_PICTURE_PATCH &&
                cold->unit.picture.acquire.is_reading);
    const int32_t guessed_q10 = cold->unit.picture.sar.grid.reference_m_q10;
    run(cold, 4);
    command(warm, patch_from_afar);
    run(warm, 4);
    command(warm, patch_from_afar); /* all its tiles have been read */
    run(warm, 1.0 * STEP_US / 1e6);
    assert_int_equal(warm->unit.picture.sar.grid.reference_m_q10,
                     cold->unit.picture.sar.grid.reference_m_q10);
    assert_int_not_equal(guessed_q10, cold->unit.picture.sar.grid.reference_m_q10);
    run(warm, 4);
    assert_int_equal(cold->unit.picture.sar.line, cold->unit.picture.sar.lines);
    assert_int_equal(plane_sum(warm), plane_sum(cold));
    free_rig(cold);
    free_rig(warm);
}

TEST(all_tiles_of_a_patch_are_there_before_its_first_line_a_few_lines_asked_for_a_step)
{
    struct rig *r = start_rig();
    const struct lm_unit *u = &r->unit;
    uint32_t before = 0;
    int step = 0;
    command(r, patch_from_afar);
    do {
        run(r, 1.0 * STEP_US / 1e6);
        assert_in_range(u->picture.acquire.lines_asked_for - before, 0, 32);
        before = u->picture.acquire.lines_asked_for;
        assert_true(u->page.picture == LM_PICTURE_PATCH && u->picture.sar.line == 0 &&
                    ++step < 250);
    } while (u->picture.acquire.is_reading);
    assert_int_equal(u->picture.acquire.lines_asked_for, u->picture.sar.lines);
    run(r, 4);
    assert_int_equal(u->picture.sar.line, u->picture.sar.lines);
    assert_int_equal(u->picture.coverage.cells_coarse, 0); /* no ancestor answered */
    free_rig(r);
}

/* Time from the command of a patch to the end of its reading, when a read of the flash is busy for
 * so many polls. */
static double reading_s(struct rig *r, uint32_t busy_polls)
{
    r->board.flash.busy_polls = busy_polls;
    command(r, patch_from_afar);
    const uint64_t from_us = r->now_us;
    do {
        run(r, 1.0 * STEP_US / 1e6);
        assert_true(r->now_us < from_us + 3000000);
    } while (r->unit.picture.acquire.is_reading);
    return (double)(r->now_us - from_us) / 1e6;
}

TEST(a_patch_waits_for_its_tiles_as_long_as_they_come_but_not_for_ever)
{
    struct rig *r = start_rig();
    const struct lm_unit *u = &r->unit;
    const double slow_s = reading_s(r, 20);
    run(r, 4);
    assert_int_equal(u->picture.sar.line, u->picture.sar.lines);
    assert_int_equal(u->picture.coverage.cells_coarse, 0);
    free_rig(r);
    r = start_rig();
    const double slower_s = reading_s(r, 100);
    free_rig(r);
    r = start_rig();
    const double hanging_s = reading_s(r, UINT32_MAX);
    free_rig(r);
    print_message("# read for %.3f, %.3f, %.3f s\n", slow_s, slower_s, hanging_s);
    assert_true(slow_s > 0.5 && slow_s < 2);
    assert_true(fabs(slower_s - 2) < 0.01);
    assert_true(fabs(hanging_s - 0.5) < 0.01);
}

/* Found by tests/fuzz: 256 cells do not fit 183 rows, and were painted beyond the plane. */
TEST(a_patch_on_the_smallest_glass_stays_within_its_frame)
{
    struct rig *r = make_rig();
    const size_t end = 256 * 256;
    memset(r->plane, 0xAA, sizeof r->plane);
    r->board.display.width_px = r->board.display.height_px = 256;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 1);
    command(r, patch_here);
    run(r, 4);
    assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
    const struct lm_frame *f = &r->unit.picture.frame;
    for (size_t i = 0; i < end; i++) {
        const size_t x = i % 256, y = i / 256;
        const int is_inside = x >= f->left_px && x - f->left_px < f->width_px && y >= f->top_px &&
                              y - f->top_px < f->height_px;
        assert_true(is_inside || r->plane[i] == 0);
    }
    for (size_t i = end; i < sizeof r->plane; i++) {
        assert_int_equal(r->plane[i], 0xAA);
    }
    assert_true(r->plane[128 * 256 + 128] > 0);
    free_rig(r);
}

/* Found by tests/golden: ten degrees are 9.99999998 as a binary angle, and were shown as 009. */
TEST(the_line_of_sight_is_shown_to_the_nearest_degree)
{
    struct rig *r[2];
    for (int i = 0; i < 2; i++) {
        r[i] = start_rig();
        command(r[i], (struct lm_control){.kind = LM_CONTROL_SAR,
                                          .sar = {.centre = patch_here.sar.centre,
                                                  .cell_mm = 5000,
                                                  .look_azimuth = FX_BAM_DEG(10) + (i ? 1000 : 0),
                                                  .range_m = 20000}});
        lm_unit_step(&r[i]->unit, 0); /* the page, before the first line */
        assert_int_equal(r[i]->unit.page.picture, LM_PICTURE_PATCH);
    }
    assert_memory_equal(r[0]->glass, r[1]->glass, sizeof r[0]->glass);
    free_rig(r[0]);
    free_rig(r[1]);
}

TEST(a_mode_change_leaves_nothing_of_the_last_picture)
{
    struct rig *r = start_rig();
    command(r, range_10);
    run(r, 3);
    command(r, patch_here);
    r->bus.now_us = r->now_us;
    lm_unit_step(&r->unit, r->now_us);
    assert_int_equal(lit_pixels(r), 0);
    free_rig(r);
}

TEST(a_jump_of_the_aircraft_starts_the_picture_anew)
{
    struct rig *r = start_rig();
    command(r, range_10);
    run(r, 3);
    const uint32_t lit = lit_pixels(r);
    r->bus.jump_degrees = 0.02;
    run(r, 0.08);
    assert_true(r->unit.nav.position_jumps > 0);
    assert_true(lit_pixels(r) < lit / 4);
    free_rig(r);
}

TEST(hostile_commands_are_refused_and_counted)
{
    struct rig *r = start_rig();
    run(r, 1);
    const struct lm_control bad[] = {
        {.kind = LM_CONTROL_RANGE, .range_nm = 160},
        {.kind = LM_CONTROL_RANGE, .range_nm = -1},
        {.kind = LM_CONTROL_AZIMUTH, .azimuth_index = 3},
        {.kind = LM_CONTROL_AZIMUTH, .azimuth_index = -1},
        {.kind = LM_CONTROL_GAIN, .gain_db = 31},
        {.kind = LM_CONTROL_GAIN, .gain_db = -31},
        {.kind = LM_CONTROL_SECTOR, .sector = {.mode = -1}},
        {.kind = LM_CONTROL_SECTOR, .sector = {.mode = LM_SECTOR_CHOICES}},
        {.kind = LM_CONTROL_SECTOR, .sector = {.fov = -1}},
        {.kind = LM_CONTROL_SECTOR, .sector = {.fov = LM_FOVS}},
        {.kind = (enum lm_control_kind)99},
        {.kind = LM_CONTROL_SAR, .sar = {.cell_mm = 1, .range_m = 20000}},
        {.kind = LM_CONTROL_SAR, .sar = {.cell_mm = 5000, .range_m = 0xFFFFFFFF}},
        {.kind = LM_CONTROL_SAR,
         .sar = {.cell_mm = 5000, .range_m = 20000, .height_m_q6 = INT32_MIN}},
        {.kind = LM_CONTROL_SAR,
         .sar = {.centre = {0xE0000000, 0}, .cell_mm = 5000, .is_from_ownship = true}},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        command(r, bad[i]);
        run(r, 0.01);
        assert_int_equal(r->unit.count.commands_refused, i + 1);
        assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    }
    free_rig(r);
}

TEST(freeze_holds_the_picture_and_says_so)
{
    struct rig *r = start_rig();
    run(r, 2);
    command(r, (struct lm_control){.kind = LM_CONTROL_FREEZE, .is_frozen = true});
    run(r, 0.1);
    const uint32_t frozen = plane_sum(r);
    run(r, 1);
    assert_int_equal(plane_sum(r), frozen);
    assert_true(r->unit.flags & LM_FLAG_FROZEN);
    free_rig(r);
}

TEST(a_busy_or_broken_display_is_counted_and_survived)
{
    struct rig *r = start_rig();
    run(r, 1);
    r->board.acquire_status = LM_BUSY;
    run(r, 0.1);
    assert_true(r->unit.count.display_busy > 0);
    r->board.acquire_status = LM_ERR_IO;
    run(r, 0.1);
    assert_true(r->unit.count.display_errors > 0);
    r->board.acquire_status = LM_OK;
    const uint32_t frames = r->unit.count.frames;
    run(r, 1);
    assert_in_range(r->unit.count.frames - frames, 28, 32);
    free_rig(r);
}

TEST(a_display_of_a_size_nobody_promised_is_refused)
{
    struct rig *r = make_rig();
    r->board.display.width_px = 255;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_ERR_RANGE);
    r->board.display.width_px = 1025;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_ERR_RANGE);
    r->board.display.width_px = WIDTH;
    r->board.display.height_px = 255;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_ERR_RANGE);
    r->board.display.height_px = 1025;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_ERR_RANGE);
    r->board.display.height_px = HEIGHT;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    free_rig(r);
}

TEST(a_pool_for_fewer_than_20_tiles_is_refused)
{
    struct rig *r = make_rig();
    r->board.lent.tile_pool_bytes = 20 * sizeof(struct lm_tile) - 1;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_ERR_NO_MEMORY);
    r->board.lent.tile_pool_bytes = 20 * sizeof(struct lm_tile);
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    free_rig(r);
}

/* Steps of 30 ms have time for fewer lines than become due in them: those come with later steps. */
TEST(a_patch_is_the_same_however_seldom_the_unit_is_stepped)
{
    struct rig *often = start_rig(), *seldom = start_rig();
    struct rig *both[2] = {often, seldom};
    for (int i = 0; i < 2; i++) {
        const uint64_t step_us = i == 0 ? STEP_US : 30000;
        command(both[i], patch_from_afar);
        for (uint64_t now_us = 0; now_us < 9000000; now_us += step_us) {
            both[i]->bus.now_us = now_us;
            lm_unit_step(&both[i]->unit, now_us);
        }
        assert_int_equal(both[i]->unit.picture.sar.line, both[i]->unit.picture.sar.lines);
    }
    assert_int_equal(plane_sum(often), plane_sum(seldom));
    free_rig(often);
    free_rig(seldom);
}

/* From some time on, latitude and longitude come from another table's sender. */
static struct {
    struct rig *rig;
    uint64_t from_us;
} other;

static int hear_from_another(void *ctx, struct lm_can_frame *frame)
{
    const int status = other.rig->board.can.receive(ctx, frame);
    if (status == 1 && other.rig->now_us >= other.from_us &&
        (frame->id == 1036 || frame->id == 1037)) {
        frame->id -= 1036 - 700;
    }
    return status;
}

static struct rig *rig_with_another(uint64_t from_us)
{
    static const struct lm_bus_row rows[] = {{.name = "latitude",
                                              .id = 700,
                                              .field = LM_BUS_LATITUDE,
                                              .stale_ms = 500,
                                              .dead_ms = 5000,
                                              .period_us = 100000,
                                              .low = -90,
                                              .high = 90,
                                              .types = 1u << LM_CANAS_FLOAT,
                                              .per_unit = 1},
                                             {.name = "longitude",
                                              .id = 701,
                                              .field = LM_BUS_LONGITUDE,
                                              .stale_ms = 500,
                                              .dead_ms = 5000,
                                              .period_us = 100000,
                                              .low = -180,
                                              .high = 180,
                                              .types = 1u << LM_CANAS_FLOAT,
                                              .per_unit = 1}};
    static const struct lm_bus_profile profile = {.name = "other", .rows = rows, .row_count = 2};
    static struct lm_can can;
    struct rig *r = make_rig();
    can = (struct lm_can){.ctx = r, .receive = hear_from_another};
    other.rig = r;
    other.from_us = from_us;
    r->board.lent.can = &can;
    r->board.lent.tables[0] = (struct lm_board_table){&profile, 0};
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    return r;
}

/* Whoever tells it. */
TEST(a_cursor_that_was_put_before_the_first_position_stays_where_it_is)
{
    const struct lm_position place = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20};
    for (int is_other = 0; is_other < 2; is_other++) {
        struct rig *r = rig_with_another(is_other ? 0 : UINT64_MAX);
        r->bus.is_down = 1;
        command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = place});
        run(r, 0.5);
        r->bus.is_down = 0;
        run(r, 1.5);
        assert_true(lit_pixels(r) > 1000);
        assert_memory_equal(&r->unit.cursor.position, &place, sizeof place);
        free_rig(r);
    }
}

TEST(a_position_of_another_sender_starts_the_picture_anew_and_sends_the_cursor_home)
{
    struct rig *r = rig_with_another(UINT64_MAX);
    run(r, 2);
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
    run(r, 1);
    const uint16_t rank = r->unit.ownship.position_origin.rank;
    other.from_us = r->now_us;
    uint32_t least = lit_pixels(r);
    assert_true(least > 10000);
    for (int i = 0; i < 1000 && r->unit.ownship.position_origin.rank == rank; i++) {
        run(r, 0.01);
    }
    run(r, 0.05);
    assert_true(lit_pixels(r) < least / 4);
    assert_true(r->unit.cursor.is_home);
    run(r, 3);
    assert_true(lit_pixels(r) > 10000);
    free_rig(r);
}

/* Whatever is first in the same step. */
TEST(a_cursor_that_goes_home_while_the_aircraft_jumps_is_at_home)
{
    enum { OSB_HOME = 9, STEPS = 26 }; /* the bus tells a position every 25 steps */
    struct rig *r = fly_rig();
    for (uint32_t step = 0; step < STEPS; step++) {
        command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                       .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
        run(r, 0.1);
        assert_false(r->unit.cursor.is_home);
        const uint32_t jumps = r->unit.nav.position_jumps;
        r->bus.jump_degrees += step % 2 ? 0.1 : -0.1;
        run(r, step * STEP_US * 1e-6);
        press(r, OSB_HOME);
        run(r, 0.1);
        assert_true(r->unit.nav.position_jumps > jumps);
        assert_true(r->unit.cursor.is_home && r->unit.cursor.is_placed);
    }
    free_rig(r);
}

TEST(a_radar_table_that_breaks_its_contract_is_refused)
{
    struct rig *r = make_rig();
    struct lm_radar radar = lm_radar_default;
    radar.mode[LM_SECTOR_GM].bars = 0;
    r->board.lent.radar = &radar;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_ERR_TABLE);
    free_rig(r);
}

/* From the cell on for which the scan line reads a LOD, and no earlier, that LOD is fine enough. */
TEST(a_picture_is_coarse_where_the_map_has_longer_cells_than_a_scan_line_allows)
{
    struct rig *r = start_rig();
    run(r, 1);
    const struct lm_db *db = &r->unit.map.db;
    const struct lm_coverage fine = {0};
    assert_true(db->lod_count > 1);
    for (uint8_t lod = 1; lod < db->lod_count; lod++) {
        uint32_t cell_mm = 1;
        for (uint32_t step = 1u << 24; step > 0; step /= 2) {
            cell_mm += lm_scan_lod(db, cell_mm + step) < lod ? step : 0;
        }
        assert_int_equal(lm_coverage_coarse_mm(&fine, db, lod, cell_mm), lm_db_cell_mm(db, lod));
        assert_int_equal(lm_coverage_coarse_mm(&fine, db, lod, cell_mm + 1), 0);
    }
    free_rig(r);
}
