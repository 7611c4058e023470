/* Displays that hear one exercise clock show the same picture, whenever they were started. */
#include "bus_frames.h"
#include "check.h"
#include "glass_text.h"
#include "hs/angle.h"
#include "unit_rig.h"

#include "fx/crc32c.h"

#include <math.h>
#include <string.h>

enum { S = 1000000, TELL_US = S, QUEUE = 64 };

/* The exercise as the bus tells it: one for all displays. */
struct exercise {
    uint64_t start_us;            /* of the clock, 0 before */
    uint64_t freeze_us, go_on_us; /* it stands between these two */
    uint64_t silent_us;           /* nothing is told from then on */
    double rate;
    int32_t seed;
};

/* A display that was switched on at on_us of the world. */
struct display {
    struct rig *r;
    struct lm_can can;
    const struct exercise *exercise;
    uint64_t on_us, world_us, told_us;
    uint32_t part; /* next frame of the exercise to tell */
    bool is_half;  /* the second half of a latitude is next */
    uint8_t code;
    struct display *partner; /* hears what this one says; NULL: there is none */
    struct lm_can_frame said[QUEUE];
    uint32_t said_head, said_tail;
};

static double clock_ms(const struct exercise *x, uint64_t world_us)
{
    const double from = (double)x->start_us;
    double t = (double)world_us;
    if (t > (double)x->freeze_us) {
        t = fmax((double)x->freeze_us, t - (double)(x->go_on_us - x->freeze_us));
    }
    return 50000 + (t - from) * x->rate / 1000;
}

/* The rig's latitude as a DOUBLE. Of coarser positions a display keeps a past: docs/bus.md. */
static struct lm_can_frame half_latitude(struct display *d, bool is_low, uint64_t time_us)
{
    const struct fake_bus *b = &d->r->bus;
    const uint64_t bits =
        bus_double_bits(45.95 + b->speed_m_s * (double)b->now_us / 1e6 / 111132.0);
    d->is_half = !is_low;
    return bus_frame(1036, is_low ? LM_CANAS_DOUBLEL : LM_CANAS_DOUBLEH, d->code++,
                     (uint32_t)(is_low ? bits : bits >> 32), time_us);
}

static int hear(void *ctx, struct lm_can_frame *frame)
{
    struct display *d = ctx;
    const struct exercise *x = d->exercise;
    const uint64_t second_us = d->world_us / TELL_US * TELL_US;
    if (second_us >= x->start_us && second_us < x->silent_us && d->told_us != second_us) {
        const bool stands = second_us >= x->freeze_us && second_us < x->go_on_us;
        const uint32_t words[] = {(uint32_t)(int32_t)lround(clock_ms(x, second_us)),
                                  bus_float_bits(stands ? 0 : x->rate), (uint32_t)x->seed};
        *frame = bus_frame(1820 + d->part, d->part == 1 ? LM_CANAS_FLOAT : LM_CANAS_LONG, 0,
                           words[d->part], second_us - d->on_us);
        frame->time_us = d->world_us - d->on_us;
        d->part = (d->part + 1) % 3;
        d->told_us = d->part == 0 ? second_us : d->told_us;
        return 1;
    }
    struct display *other = d->partner;
    if (other && other->said_tail != other->said_head) {
        *frame = other->said[other->said_tail++ % QUEUE];
        frame->time_us = d->world_us - d->on_us;
        return 1;
    }
    if (d->is_half) {
        *frame = half_latitude(d, true, d->world_us - d->on_us);
        return 1;
    }
    const int status = d->r->board.can.receive(d->r, frame);
    frame->time_us -= d->on_us;
    if (status == 1 && frame->id == 1036) {
        *frame = half_latitude(d, false, frame->time_us);
    }
    return status;
}

/* Two ships on their legs, and two points that fluctuate from scan to scan and pulse to pulse. */
static void add_targets(struct lm_unit *u)
{
    static const double places[][2] = {
        {46.02, 11.02}, {46.03, 10.98}, {46.05, 11.0}, {46.04, 11.03}};
    for (uint32_t i = 0; i < 4; i++) {
        u->map.targets[i] = (struct lm_target){.id = 40 + i,
                                               .latitude = hs_bam(places[i][0]),
                                               .longitude = hs_bam(places[i][1]),
                                               .elevation_m_q6 = 100 * 64,
                                               .swerling = (uint8_t)i,
                                               .mean_rcs_dbsm_q8 = 40 * 256,
                                               .speed_mm_s = i < 2 ? 30000 : 0,
                                               .leg_m = i < 2 ? 4000 : 0};
    }
    u->map.target_set.items = u->map.targets;
    u->map.target_set.count = 4;
}

static struct display switch_on(const struct exercise *x, double on_s, uint32_t board_seed)
{
    struct display d = {.r = make_rig(), .exercise = x, .on_us = (uint64_t)(on_s * S)};
    d.world_us = d.on_us;
    d.r->bus.sent_us = (d.on_us + 49999) / 50000 * 50000; /* on the grid of the others */
    d.r->board.lent.noise_seed = board_seed;
    return d;
}

/* Once the display is where it stays in memory. */
static void begin(struct display *d)
{
    d->can = (struct lm_can){.ctx = d, .receive = hear};
    d->r->board.lent.can = &d->can;
    assert_int_equal(lm_unit_init(&d->r->unit, &d->r->board.lent), LM_OK);
    add_targets(&d->r->unit);
}

static void fly(struct display *d, double until_s)
{
    for (; d->world_us < (uint64_t)(until_s * S); d->world_us += STEP_US) {
        d->r->bus.now_us = d->world_us;
        lm_unit_step(&d->r->unit, d->world_us - d->on_us);
    }
}

static uint32_t pixels_apart(const struct display *a, const struct display *b)
{
    uint32_t apart = 0;
    for (size_t i = 0; i < sizeof a->r->plane; i++) {
        apart += a->r->plane[i] != b->r->plane[i];
    }
    return apart;
}

static void assert_same(const struct display *a, const struct display *b)
{
    assert_int_equal(pixels_apart(a, b), 0);
    assert_true(lit_pixels(a->r) > 100);
}

static const struct exercise plain = {.start_us = 2 * S,
                                      .freeze_us = UINT64_MAX,
                                      .go_on_us = UINT64_MAX,
                                      .silent_us = UINT64_MAX,
                                      .rate = 1,
                                      .seed = 1234};

/* A pair: the second display is switched on later, or restarted, and has another seed. */
struct pair {
    struct display a, b;
};

static void command_both(struct pair *p, struct lm_control control)
{
    command(p->a.r, control);
    command(p->b.r, control);
}

static void fly_both(struct pair *p, double until_s)
{
    fly(&p->a, until_s);
    fly(&p->b, until_s);
}

static void begin_pair(struct pair *p, const struct exercise *x, double late_s)
{
    p->a = switch_on(x, 0, 1);
    p->b = switch_on(x, late_s, 2);
    begin(&p->a);
    begin(&p->b);
    command_both(p, range_10);
}

static void end_pair(struct pair *p)
{
    free_rig(p->a.r);
    free_rig(p->b.r);
}

static struct lm_control sector(enum lm_sector_mode mode, enum lm_fov fov)
{
    return (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {(uint8_t)mode, (uint8_t)fov}};
}

static const struct lm_control cursor_ahead = {
    .kind = LM_CONTROL_CURSOR,
    .cursor = {FX_BAM_DEG(46) + FX_BAM_DEG(3) / 100, FX_BAM_DEG(221) / 20}};

/* Compare at several places of a sweep. */
static void fly_and_compare(struct pair *p, double from_s)
{
    for (int i = 0; i < 4; i++) {
        fly_both(p, from_s + i * 1.234);
        assert_same(&p->a, &p->b);
    }
}

TEST(displays_started_at_different_times_paint_the_same_from_the_second_sweep_on)
{
    for (int mode = 0; mode < LM_SECTOR_MODES; mode++) {
        struct pair p;
        begin_pair(&p, &plain, 3.33);
        command_both(&p, sector((enum lm_sector_mode)mode, LM_FOV_NORM));
        fly_both(&p, 3.4);
        fly_and_compare(&p,
                        5.4 + 2 * 2.01); /* its sweep of 2 s under way, a part of one, and one */
        assert_int_equal(p.a.r->unit.count.lines_dropped, 0);
        end_pair(&p);
    }
}

TEST(and_without_a_clock_they_do_not)
{
    struct exercise none = plain;
    none.start_us = UINT64_MAX;
    struct pair p;
    begin_pair(&p, &none, 3.33);
    fly_both(&p, 12);
    assert_true(pixels_apart(&p.a, &p.b) > 1000);
    end_pair(&p);
}

/* Their sweeps take different times: the windows meet on a grid. */
TEST(windows_meet_too)
{
    static const enum lm_fov fields[] = {LM_FOV_EXP, LM_FOV_DBS1};
    for (int i = 0; i < 2; i++) {
        struct pair p;
        begin_pair(&p, &plain, 3.33);
        command_both(&p, sector(LM_SECTOR_GM, LM_FOV_NORM));
        fly_both(&p, 4);
        command_both(&p, cursor_ahead);
        command_both(&p, sector(LM_SECTOR_GM, fields[i]));
        fly_both(&p, 4);
        fly_both(&p, 16);
        fly_and_compare(&p, 16);
        const struct lm_picture *picture = &p.b.r->unit.picture;
        const struct lm_sector *s = &picture->sector;
        assert_true(lm_sector_is_window(s));
        const uint64_t turn_us = picture->turn.period_us - 1, quarter_us = S / 4;
        assert_int_equal(turn_us % quarter_us, 0);
        assert_in_range(turn_us - s->lines * lm_sector_line_us(s), 0, quarter_us - 1);
        end_pair(&p);
    }
}

/* A window's antenna rests until the next quarter of a second. Who asks for a window then joins at
 * the last line of the sweep that is over, of either direction. */
TEST(a_window_joined_while_its_antenna_rests_begins_at_the_last_line)
{
    struct display d = switch_on(&plain, 0, 1);
    begin(&d);
    command(d.r, range_10);
    fly(&d, 4);
    command(d.r, cursor_ahead);
    const struct lm_sector *s = &d.r->unit.picture.sector;
    uint32_t joined[2] = {0, 0};
    for (int k = 0; k < 60; k++) {
        const double at_s = 5 + k * 0.43;
        command(d.r, sector(LM_SECTOR_GM, LM_FOV_NORM));
        fly(&d, at_s);
        command(d.r, sector(LM_SECTOR_GM, LM_FOV_EXP));
        const uint32_t lines = d.r->unit.count.lines;
        while (d.r->unit.count.lines == lines) {
            assert_true(d.world_us < (uint64_t)((at_s + 0.4) * S));
            fly(&d, (double)(d.world_us + STEP_US) / S);
            assert_true(s->line < s->lines);
        }
        joined[s->is_leftward] += s->sweep != 0 && !s->is_begun;
    }
    print_message("# joined at rest: %u, %u\n", joined[0], joined[1]);
    assert_true(joined[0] > 0 && joined[1] > 0);
    free_rig(d.r);
}

/* Heights differ by less than what computes the ranges anew, when a display remembers an old one.
 */
TEST(a_climb_leaves_no_trace_of_the_past)
{
    struct pair p;
    begin_pair(&p, &plain, 3.33);
    for (double t = 3.4; t < 20; t += 0.1) {
        p.a.r->bus.height_m = p.b.r->bus.height_m = 2000 + 3 * t;
        fly_both(&p, t);
    }
    fly_and_compare(&p, 20.1);
    end_pair(&p);
}

/* 20 s of standing: two looks at it differ in nothing, although the aircraft's clock goes on. */
TEST(an_exercise_that_stands_is_painted_over_and_over)
{
    struct exercise x = plain;
    x.freeze_us = 10 * S;
    x.go_on_us = 30 * S;
    struct pair p;
    begin_pair(&p, &x, 13.33); /* the second one is switched on while it stands */
    p.a.r->bus.speed_m_s = p.b.r->bus.speed_m_s = 0; /* the aircraft stands as well */
    fly_and_compare(&p, 18.5);
    const uint32_t sum = plane_sum(p.a.r), lines = p.a.r->unit.count.lines;
    assert_int_equal(p.a.r->unit.exercise.time_us, 58ull * S);
    fly_both(&p, 24.5);
    assert_int_equal(plane_sum(p.a.r), sum);
    assert_true(p.a.r->unit.count.lines > lines + 400);
    static const struct lm_control wider = {.kind = LM_CONTROL_RANGE, .range_nm = 20};
    command_both(&p, wider); /* keys work */
    fly_both(&p, 29);
    assert_same(&p.a, &p.b);
    fly_and_compare(&p, 35);
    assert_int_not_equal(plane_sum(p.a.r), sum);
    end_pair(&p);
}

TEST(twice_as_fast_and_half_as_fast_they_agree)
{
    static const double rates[] = {2, 0.5, 16};
    for (int i = 0; i < 3; i++) {
        struct exercise x = plain;
        x.rate = rates[i];
        struct pair p;
        begin_pair(&p, &x, 3.33);
        fly_and_compare(&p, 10);
        /* The antenna turns no faster. */
        assert_in_range(p.a.r->unit.count.lines, 9 * 256, 15 * 256);
        end_pair(&p);
    }
}

/* The clock steps by an hour and a bit, in the middle of a sweep. */
TEST(after_a_step_of_the_clock_they_agree_again)
{
    struct exercise x = plain;
    struct pair p;
    begin_pair(&p, &x, 3.33);
    fly_both(&p, 10.8);
    x.start_us -= S / 2;
    x.rate = 1.0625; /* by a fifth of a second a second: 500 ms and more */
    fly_and_compare(&p, 18);
    assert_true(p.a.r->unit.exercise.count.steps > 0);
    end_pair(&p);
}

/* Where a ship of 30 m/s is painted, by the law of its leg, at the time of the sweep. */
TEST(movers_are_where_the_exercise_has_them)
{
    struct pair p;
    begin_pair(&p, &plain, 3.33);
    fly_both(&p, 12);
    const struct lm_sector *s = &p.a.r->unit.picture.sector;
    const uint64_t sweep = s->sweep - 1234, period = p.a.r->unit.picture.turn.period_us;
    assert_int_equal(s->platform.time_us, sweep * period);
    assert_in_range(p.a.r->unit.exercise.time_us - s->platform.time_us, 0, 2 * S + 8000);
    assert_int_equal(p.a.r->unit.exercise.time_us, 60ull * S - 2000);
    assert_int_equal(s->is_leftward, s->sweep % 2);
    end_pair(&p);
}

/* A patch asked for at one moment: movers and speckle are those of the exercise. */
TEST(patches_agree)
{
    struct pair p;
    begin_pair(&p, &plain, 3.33);
    fly_both(&p, 6);
    command_both(&p, patch_here);
    fly_both(&p, 6.1);
    assert_int_equal(p.a.r->unit.picture.sar.time_us, p.b.r->unit.picture.sar.time_us);
    assert_in_range(p.a.r->unit.picture.sar.time_us, 54ull * S - 10000, 54ull * S + 10000);
    fly_both(&p, 30);
    assert_same(&p.a, &p.b);
    end_pair(&p);
}

/* A second database comes, here one that is none, and goes. */
TEST(when_the_map_changes_the_antenna_does_not_wait_for_the_next_sweep)
{
    struct display d = switch_on(&plain, 0, 1);
    d.r->board.lent.images[1].offset = 4096;
    begin(&d);
    command(d.r, range_10);
    command(d.r, sector(LM_SECTOR_GMT, LM_FOV_NORM));
    for (uint32_t i = 0; i < 8; i++) {
        fly(&d, 10 + i * 1.3);
        command(d.r, (struct lm_control){.kind = LM_CONTROL_IMAGE,
                                         .image = {.place = 2, .bytes = i % 2 == 0 ? 9000 : 0}});
        const uint32_t lines = d.r->unit.count.lines;
        fly(&d, 10.3 + i * 1.3);
        assert_true(d.r->unit.count.lines > lines + 20); /* of 128 a second */
        assert_int_equal(lm_unit_map_refused(&d.r->unit.map), i % 2 == 0);
    }
    free_rig(d.r);
}

TEST(silence_is_said_on_the_glass_and_nothing_jumps)
{
    struct exercise x = plain;
    x.silent_us = 10 * S;
    struct pair p;
    begin_pair(&p, &x, 3.33);
    fly_both(&p, 11.5);
    assert_false(p.a.r->unit.flags & LM_FLAG_EXERCISE);
    fly_both(&p, 12.5);
    assert_true(p.a.r->unit.flags & LM_FLAG_EXERCISE);
    const struct lm_surface glass = glass_of(p.a.r);
    const struct lm_palette *palette = &p.a.r->unit.palette;
    assert_true(glass_find(&glass, "EXC", palette->warning, palette->ink, NULL));
    assert_int_equal(lm_fault_log_at(&p.a.r->unit.faults, 0)->flag, 12);
    fly_and_compare(&p, 30); /* both run on by their own clocks, which agree here */
    end_pair(&p);
}

/* ---- two displays, one bus ---- */

static int say(void *ctx, const struct lm_can_frame *frame)
{
    struct display *d = ctx;
    assert_in_range(d->said_head - d->said_tail, 0, QUEUE - 1);
    d->said[d->said_head++ % QUEUE] = *frame;
    return LM_OK;
}

static void sit(struct display *d, struct display *partner, uint8_t node, uint8_t other)
{
    d->partner = partner;
    d->r->board.lent.bus_node = node;
    d->r->board.lent.bus_partner = other;
    begin(d);
    d->can.send = say;
}

/* Step by step, as on one bus. */
static void fly_together(struct pair *p, double until_s)
{
    while (p->a.world_us < (uint64_t)(until_s * S)) {
        const double next_s = (double)(p->a.world_us + STEP_US) / S;
        fly(&p->a, next_s);
        fly(&p->b, next_s);
    }
}

static bool warns(const struct display *d, const char *words)
{
    const struct lm_surface glass = glass_of(d->r);
    const struct lm_palette *palette = &d->r->unit.palette;
    return glass_find(&glass, words, palette->warning, palette->ink, NULL);
}

static void choose(struct display *d, int mode, const struct lm_control *range, int gain_db)
{
    command(d->r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {.mode = mode}});
    command(d->r, *range);
    command(d->r, (struct lm_control){.kind = LM_CONTROL_GAIN, .gain_db = gain_db});
}

static void begin_two(struct pair *p)
{
    static const struct lm_control range_20 = {.kind = LM_CONTROL_RANGE, .range_nm = 20};
    p->a = switch_on(&plain, 0, 1);
    p->b = switch_on(&plain, 0, 2);
    sit(&p->a, &p->b, 20, 21);
    sit(&p->b, &p->a, 21, 20);
    choose(&p->a, LM_SECTOR_GM, &range_10, -3);
    choose(&p->b, LM_SECTOR_SEA, &range_20, 4);
    fly_together(p, 5);
    command(p->b.r, lm_control_button(true, 15)); /* SWAP */
    command(p->b.r, lm_control_button(false, 15));
    fly_together(p, 5.2);
    assert_int_equal(p->a.r->unit.page.mode, LM_SECTOR_SEA);
    assert_int_equal(p->b.r->unit.page.mode, LM_SECTOR_GM);
    assert_int_equal(p->b.r->unit.page.gain_db, -3);
}

/* The second display stops, and starts again with the settings that its board kept. */
static void restart_second(struct pair *p, double off_s, struct lm_settings *kept)
{
    lm_settings_give(&p->b.r->unit, kept);
    const uint64_t now_us = p->a.world_us + (uint64_t)(off_s * S);
    free_rig(p->b.r);
    fly(&p->a, (double)now_us / S);
    p->b = switch_on(&plain, (double)now_us / S, 3);
    p->b.r->board.lent.settings = kept;
    sit(&p->b, &p->a, 21, 20);
}

TEST(a_display_that_restarts_says_so_and_shows_the_same_as_the_one_that_did_not)
{
    struct pair p;
    struct lm_settings kept;
    begin_two(&p);
    choose(&p.a, LM_SECTOR_GM, &range_10, -3); /* as the other one, which restarts */
    fly_together(&p, 9);
    const struct lm_page before = p.b.r->unit.page;
    const struct lm_position cursor = p.b.r->unit.cursor.position;
    restart_second(&p, 1.3, &kept);
    assert_memory_equal(&p.b.r->unit.page.format, &before.format, LM_PAGE_BYTES);
    fly_together(&p, 11.5);
    assert_true(warns(&p.b, "RESTART") && !warns(&p.a, "RESTART"));
    assert_memory_equal(&p.b.r->unit.cursor.position, &cursor, sizeof cursor);
    fly_together(&p, 22);
    assert_false(warns(&p.b, "RESTART"));
    for (uint32_t i = 0; i < 20; i++) {
        assert_same(&p.a, &p.b);
        fly_together(&p, 22.5 + i * 0.5);
    }
    command(p.b.r, lm_control_button(true, 15)); /* and the two still exchange pages */
    fly_together(&p, 33);
    assert_int_equal(p.a.r->unit.count.swaps, 2);
    assert_int_equal(p.b.r->unit.count.swaps, 1);
    end_pair(&p);
}

TEST(settings_that_are_damaged_are_not_taken)
{
    struct pair p;
    struct lm_settings kept;
    begin_two(&p);
    lm_settings_give(&p.b.r->unit, &kept);
    kept.page[2] = LM_SECTOR_BEACON + 1;
    p.b.r->board.lent.settings = &kept;
    assert_int_equal(lm_unit_init(&p.b.r->unit, &p.b.r->board.lent), LM_OK);
    assert_false(p.b.r->unit.is_restored);
    assert_int_equal(p.b.r->unit.page.mode, LM_SECTOR_GM);
    assert_int_equal(p.b.r->unit.page.gain_db, 0);
    end_pair(&p);
}

/* A patch showed a moment that is gone. */
TEST(a_patch_does_not_outlive_a_restart_but_its_cursor_does)
{
    struct pair p;
    struct lm_settings kept;
    begin_two(&p);
    command(p.b.r, patch_here);
    fly_together(&p, 8);
    assert_int_equal(p.b.r->unit.page.picture, LM_PICTURE_PATCH);
    restart_second(&p, 0.5, &kept);
    fly_together(&p, 10);
    assert_int_equal(p.b.r->unit.page.picture, LM_PICTURE_SECTOR);
    assert_int_equal(p.b.r->unit.page.cell_mm, p.b.r->board.lent.settings->cell_mm);
    assert_memory_equal(&p.b.r->unit.cursor.position, &kept.cursor, sizeof kept.cursor);
    end_pair(&p);
}
