/* Sectors in flight: how fast they are swept, where a window lies over the ground, and that no
 * picture outlives its mode. */
#include "hs/angle.h"
#include "lm/sar.h"

#include "check.h"
#include "reference/reference.h"
#include "sector_world.h"
#include "target_support.h"
#include "unit_rig.h"

#include <math.h>
#include <string.h>

static struct tiny_cell sea(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-40, TINY_WATER, 0};
}

/* A unit in flight over the sea, on the 10 nm scale. */
static struct rig *start_over_sea(double height_m, double speed_m_s)
{
    struct rig *r = make_rig();
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = sea;
    spec.shift0 = 12;
    spec.rows = spec.columns = 10;
    tiny_image_free(&r->image);
    assert_int_equal(tiny_image_build(&r->image, &spec), 0);
    memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
    r->bus.height_m = height_m;
    r->bus.speed_m_s = speed_m_s;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 0.5);
    return r;
}

static void step(struct rig *r)
{
    run(r, STEP_US / 1e6);
}

static void show(struct rig *r, enum lm_sector_mode mode, enum lm_fov field)
{
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR,
                                   .sector = {(int32_t)mode, (int32_t)field}});
    step(r);
}

static void finish_sweep(struct rig *r)
{
    const uint32_t sweep = r->unit.picture.sector.sweep;
    while (r->unit.picture.sector.sweep == sweep) {
        step(r);
    }
}

static struct ref_place ref_of(struct lm_position position)
{
    return (struct ref_place){hs_degrees(position.latitude), hs_degrees(position.longitude)};
}

/* Put the cursor somewhere from the ownship. */
static void put_cursor(struct rig *r, double azimuth_deg, double ground_m)
{
    const struct lm_ownship *own = &r->unit.ownship;
    const struct lm_position from = {own->latitude, own->longitude};
    const struct ref_place at = ref_geo_direct(ref_of(from), azimuth_deg, ground_m);
    r->unit.cursor.position =
        (struct lm_position){hs_bam(at.latitude_deg), hs_bam(at.longitude_deg)};
}

/* ---- from where it is seen ---- */

TEST(the_whole_sector_is_seen_from_where_the_aircraft_is_and_a_window_from_one_place)
{
    static const uint8_t fields[] = {LM_FOV_NORM, LM_FOV_EXP};
    struct rig *r = start_over_sea(3000, 250);
    const struct lm_sector *s = &r->unit.picture.sector;
    put_cursor(r, 5, 14000);
    for (int is_window = 0; is_window < 2; is_window++) {
        show(r, LM_SECTOR_GM, fields[is_window]);
        finish_sweep(r);
        uint32_t sweep = s->sweep - 1, moves = 0; /* within a sweep */
        struct lm_position last = s->origin.position;
        for (int k = 0; k < 400; k++) {
            const uint32_t samples = s->samples;
            step(r);
            if (s->samples != samples && s->is_begun) {
                assert_memory_equal(&s->origin.position, &s->platform.position, sizeof last);
                moves += s->sweep == sweep && memcmp(&s->origin.position, &last, sizeof last) != 0;
                last = s->origin.position;
                sweep = s->sweep;
            }
        }
        assert_true(is_window ? moves == 0 : moves > 20);
    }
    free_rig(r);
}

/* ---- timing ---- */

/* Degrees a second, from the first edge on, over so many seconds and up to a sweep's end. */
static double measured_rate(struct rig *r, double seconds)
{
    double swept_deg = 0;
    finish_sweep(r);
    const uint64_t begin_us = r->now_us;
    while ((double)(r->now_us - begin_us) < seconds * 1e6) {
        finish_sweep(r);
        swept_deg += hs_degrees(r->unit.picture.sector.width) * r->unit.picture.sector.lines;
    }
    return swept_deg * 1e6 / (double)(r->now_us - begin_us);
}

TEST(the_whole_sector_is_swept_at_the_rate_of_the_table_and_no_line_is_lost)
{
    const double sector_deg[LM_AZIMUTHS] = {120, 60, 20}, seconds[LM_AZIMUTHS] = {60, 10, 10};
    struct rig *r = start_rig();
    for (int azimuth = 0; azimuth < LM_AZIMUTHS; azimuth++) {
        command(r, (struct lm_control){.kind = LM_CONTROL_AZIMUTH, .azimuth_index = azimuth});
        run(r, 0.2);
        const double rate = measured_rate(r, seconds[azimuth]);
        const double swept_deg =
            hs_degrees(r->unit.picture.sector.width) * r->unit.picture.sector.lines;
        print_message("# %.0f degrees: %.2f degrees a second\n", sector_deg[azimuth], rate);
        assert_true(fabs(rate / 120 - 1) < 0.02);
        assert_true(fabs(swept_deg / sector_deg[azimuth] - 1) < 0.02);
    }
    assert_int_equal(r->unit.count.lines_dropped, 0);
    free_rig(r);
}

TEST(windows_are_swept_at_the_rate_of_the_table_and_as_wide_as_they_are_seen)
{
    const struct {
        enum lm_fov field;
        double rate, half_window, half_max_deg;
    } cases[] = {
        {LM_FOV_EXP, 120, 0.125, 60}, {LM_FOV_DBS1, 15, 0.125, 15}, {LM_FOV_DBS2, 3, 0.03, 5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct rig *r = start_rig();
        command(r, range_10);
        run(r, 0.5);
        put_cursor(r, 30, 15000);
        show(r, LM_SECTOR_GM, cases[i].field);
        const double rate = measured_rate(r, 12);
        const double swept_deg =
            hs_degrees(r->unit.picture.sector.width) * r->unit.picture.sector.lines;
        double ground_m, bearing_deg;
        ref_geo_inverse(ref_of(r->unit.picture.sector.platform.position),
                        ref_of(r->unit.cursor.position), &bearing_deg, &ground_m);
        const double seen_deg =
            hs_degrees(hs_bam(asin(1.5 * cases[i].half_window * 18520 / ground_m) * 57.29578));
        print_message("# field %d: %.3f degrees a second over %.2f degrees\n", cases[i].field, rate,
                      swept_deg);
        assert_true(fabs(rate / cases[i].rate - 1) < 0.02);
        assert_true(fabs(swept_deg / (2 * fmin(seen_deg, cases[i].half_max_deg)) - 1) < 0.02);
        assert_int_equal(r->unit.count.lines_dropped, 0);
        free_rig(r);
    }
}

/* ---- geometry ---- */

struct pixel {
    double x, y;
};

/* Where a point is drawn: the mean of the pixels almost as bright as the brightest. */
static struct pixel bright_spot(const struct rig *r)
{
    struct pixel sum = {0, 0};
    double count = 0;
    uint8_t peak = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        peak = r->plane[i] > peak ? r->plane[i] : peak;
    }
    assert_true(peak > 120);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        if (r->plane[i] > 0.8 * peak) {
            sum.x += i % WIDTH;
            sum.y += i / WIDTH;
            count++;
        }
    }
    return (struct pixel){sum.x / count, sum.y / count};
}

static struct pixel middle_of(const struct rig *r)
{
    const struct lm_frame square = lm_frame_square(&r->unit.picture.frame);
    return (struct pixel){square.left_px + square.width_px / 2,
                          square.top_px + square.height_px / 2};
}

static bool is_near(struct pixel a, struct pixel b, double slack_px)
{
    const bool is = fabs(a.x - b.x) <= slack_px && fabs(a.y - b.y) <= slack_px;
    if (!is) {
        print_message("# drawn at %.1f %.1f, wanted at %.1f %.1f\n", a.x, a.y, b.x, b.y);
    }
    return is;
}

/* Slant range rightwards and upwards, metres, of a place on the sea as the window sees it. */
static struct pixel slant_offset(const struct rig *r, struct lm_position position)
{
    const struct lm_platform *from = &r->unit.picture.sector.platform;
    double azimuth_deg, ground_m;
    ref_geo_inverse(ref_of(from->position), ref_of(position), &azimuth_deg, &ground_m);
    const double slant_m = hypot(ground_m, from->height_m_q10 / 1024.0);
    const double turn = (azimuth_deg - hs_degrees(r->unit.picture.sector.up)) / 57.29577951;
    return (struct pixel){slant_m * sin(turn), slant_m * cos(turn)};
}

/* Where a place belongs when the cursor's is in the middle. */
static struct pixel wanted_at(const struct rig *r, struct lm_position position)
{
    const struct pixel at = slant_offset(r, position),
                       centre = slant_offset(r, r->unit.cursor.position);
    const struct lm_frame square = lm_frame_square(&r->unit.picture.frame);
    const double px_per_m = square.width_px / (2.0 * r->unit.picture.sector.half_m);
    const struct pixel middle = middle_of(r);
    return (struct pixel){middle.x + (at.x - centre.x) * px_per_m,
                          middle.y - (at.y - centre.y) * px_per_m};
}

static void put_target(struct rig *r, struct lm_position position, double rcs_db)
{
    r->unit.map.targets[0] =
        point_at(hs_degrees(position.latitude), hs_degrees(position.longitude), 10, rcs_db);
    r->unit.map.target_set = (struct lm_target_set){.items = r->unit.map.targets, .count = 1};
}

/* The window's place, and how bright a point must be to stand out well within the scale. Real beam
 * is sampled every 15/16 of a degree from the nose, and a point is put on the nearest sample: in
 * EXP the aircraft stands still and the point lies on one, 21 1/2 samples off the nose. */
struct view_case {
    enum lm_fov field;
    double speed_m_s, height_m, azimuth_deg, ground_m, rcs_db;
};

static const double on_a_sample_deg = 21.5 * 15 / 16;

/* Push the cursor away from the aircraft, for a fifth of a second. */
static void push_cursor(struct rig *r, double azimuth_deg)
{
    const double azimuth = azimuth_deg / 57.29577951;
    command(r, lm_control_slew((int32_t)lround(900 * sin(azimuth)),
                               (int32_t)lround(900 * cos(azimuth))));
    run(r, 0.2);
    command(r, lm_control_slew(0, 0));
}

static void judge_window(const struct view_case *c)
{
    struct rig *r = start_over_sea(c->height_m, c->speed_m_s);
    put_cursor(r, c->azimuth_deg, c->ground_m);
    const struct lm_position first = r->unit.cursor.position;
    put_target(r, first, c->rcs_db);
    show(r, LM_SECTOR_GM, c->field);
    finish_sweep(r);
    assert_true(is_near(bright_spot(r), middle_of(r), 2));
    finish_sweep(r);
    assert_true(is_near(bright_spot(r), middle_of(r), 2));

    /* The cursor moves over the picture; the next sweep moves the picture under the cursor, what
     * is already drawn at once and what is drawn anew after it. Off the middle there is the scale's
     * rounding as well: a pixel more. */
    push_cursor(r, c->azimuth_deg);
    finish_sweep(r);
    while (!r->unit.picture.sector.is_begun) {
        step(r);
    }
    const struct pixel moved = wanted_at(r, first), middle = middle_of(r);
    assert_true(hypot(moved.x - middle.x, moved.y - middle.y) > 10);
    assert_true(moved.x < middle.x && moved.y > middle.y);
    assert_true(is_near(bright_spot(r), moved, 3));
    finish_sweep(r);
    assert_true(is_near(bright_spot(r), wanted_at(r, first), 3));
    put_target(r, r->unit.cursor.position, c->rcs_db);
    finish_sweep(r);
    finish_sweep(r);
    assert_true(is_near(bright_spot(r), middle_of(r), 2));
    free_rig(r);
}

TEST(a_point_at_the_cursor_is_drawn_in_the_middle_of_the_window)
{
    const struct view_case cases[] = {{LM_FOV_EXP, 0, 2000, on_a_sample_deg, 14000, 29},
                                      {LM_FOV_DBS1, 150, 2000, 40, 14000, 20},
                                      {LM_FOV_DBS2, 150, 2000, 40, 14000, 11}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        judge_window(&cases[i]);
    }
}

/* Five nautical miles of slant range at 6 km are 7,053 m over the ground. */
TEST(a_point_close_below_is_drawn_in_the_middle_of_the_window_too)
{
    const double ground_m = sqrt(9260.0 * 9260 - 6000.0 * 6000);
    const struct view_case cases[] = {{LM_FOV_EXP, 0, 6000, on_a_sample_deg, ground_m, 33},
                                      {LM_FOV_DBS1, 150, 6000, 40, ground_m, 24},
                                      {LM_FOV_DBS2, 150, 6000, 40, ground_m, 15}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        judge_window(&cases[i]);
    }
}

/* ---- changes of picture ---- */

enum { OLD = 1 }; /* grey of a picture that must go */

static void fill_frame(struct rig *r, uint8_t grey)
{
    const struct lm_frame *f = &r->unit.picture.frame;
    for (int y = 0; y < f->height_px; y++) {
        memset(r->plane + (f->top_px + y) * WIDTH + f->left_px, grey, f->width_px);
    }
}

/* What is left of it on the right, where the first lines of a new picture do not come. */
static uint32_t old_pixels(const struct rig *r)
{
    uint32_t count = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        count += i % WIDTH >= WIDTH / 2 && r->plane[i] == OLD;
    }
    return count;
}

/* Whether a pixel lies well within what the sweep paints, and so far out that noise alone makes it
 * grey at full gain. */
static bool is_swept(const struct rig *r, int x, int y)
{
    const struct lm_sector *s = &r->unit.picture.sector;
    const struct lm_view *v = &r->unit.picture.view;
    const bool is_window = s->half_m != 0;
    const struct lm_frame f =
        is_window ? lm_frame_square(&r->unit.picture.frame) : r->unit.picture.frame;
    const double right = x + 0.5 - v->at.x, up = v->at.y - (y + 0.5);
    const double azimuth_deg = atan2(right, up) * 57.29578, length_px = hypot(right, up);
    const double edge_deg = hs_degrees((fx_bam_t)s->left), slack_deg = hs_degrees(s->width);
    const double width_deg = hs_degrees(s->width) * s->lines;
    const bool is_inside =
        x >= f.left_px && x < f.left_px + f.width_px && y >= f.top_px && y < f.top_px + f.height_px;
    return is_inside && azimuth_deg > edge_deg + slack_deg &&
           azimuth_deg < edge_deg + width_deg - slack_deg &&
           length_px * v->scale_mm_per_px_q8 / 256e3 > 5500 &&
           (is_window || length_px < v->radius_px - 1);
}

static void judge_completeness(const struct rig *r)
{
    uint32_t swept = 0, empty = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            if (is_swept(r, x, y)) {
                swept++;
                empty += r->plane[y * WIDTH + x] == 0;
            }
        }
    }
    print_message("# %u pixels swept, %u left empty\n", swept, empty);
    assert_true(swept > 20000);
    assert_int_equal(empty, 0);
}

TEST(a_change_of_picture_leaves_nothing_behind_and_takes_one_sweep)
{
    const struct {
        enum lm_sector_mode mode;
        enum lm_fov field;
    } cases[] = {{LM_SECTOR_GM, LM_FOV_EXP},   {LM_SECTOR_GM, LM_FOV_DBS1},
                 {LM_SECTOR_GM, LM_FOV_DBS2},  {LM_SECTOR_GM, LM_FOV_NORM},
                 {LM_SECTOR_SEA, LM_FOV_NORM}, {LM_SECTOR_SEA, LM_FOV_EXP},
                 {LM_SECTOR_GMT, LM_FOV_EXP},  {LM_SECTOR_GMT, LM_FOV_NORM}};
    struct rig *r = start_rig();
    command(r, range_10);
    command(r, (struct lm_control){.kind = LM_CONTROL_GAIN, .gain_db = 30});
    run(r, 1.5);
    put_cursor(r, 45, 14000);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fill_frame(r, OLD);
        show(r, cases[i].mode, cases[i].field);
        assert_int_equal(old_pixels(r), 0);
        finish_sweep(r);
        judge_completeness(r);
    }
    fill_frame(r, OLD);
    command(r, patch_here);
    step(r);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(old_pixels(r), 0);
    fill_frame(r, OLD);
    command(r, lm_control_drop());
    step(r);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(old_pixels(r), 0);
    free_rig(r);
}

/* Once the tiles are there: the ground's elevation is taken when a patch is commanded. */
TEST(a_patch_drawn_twice_is_the_same)
{
    struct rig *r = start_rig();
    struct lm_control patch = patch_here;
    patch.sar.is_from_ownship = false;
    patch.sar.look_azimuth = FX_BAM_DEG(30);
    patch.sar.range_m = 20000;
    patch.sar.height_m_q6 = 3000 * 64;
    uint32_t sums[3];
    run(r, 0.5);
    for (int i = 0; i < 3; i++) {
        command(r, patch);
        step(r);
        assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
        while (r->unit.picture.sar.line < r->unit.picture.sar.lines) {
            step(r);
        }
        assert_true(lit_pixels(r) > 10000);
        sums[i] = plane_sum(r);
    }
    assert_int_equal(sums[1], sums[2]);
    free_rig(r);
}

/* Through fields of view, there and back. */
TEST(a_look_that_was_kept_is_what_the_beam_would_see_anew)
{
    static const uint8_t fields[] = {LM_FOV_NORM, LM_FOV_EXP, LM_FOV_NORM, LM_FOV_DBS1,
                                     LM_FOV_NORM};
    struct rig *r = start_rig();
    const struct lm_sector *s = &r->unit.picture.sector;
    uint32_t kept = 0;
    run(r, 0.5);
    put_cursor(r, 5, 14000);
    for (size_t i = 0; i < sizeof fields; i++) {
        show(r, LM_SECTOR_GM, fields[i]);
        for (int k = 0; k < 400; k++) {
            step(r);
            for (int parity = 0; parity < 2; parity++) {
                const struct lm_sector_taps *aim = &s->taps[parity];
                struct lm_beam beam = {.fineness = 0};
                struct lm_beam_taps anew;
                lm_beam_set_taps(&beam, s->radar, aim->azimuth, 256, &anew);
                assert_true(!aim->is_kept || memcmp(&anew, &aim->taps, sizeof anew) == 0);
                kept += aim->is_kept;
            }
        }
    }
    assert_true(kept > 1500);
    free_rig(r);
}

TEST(a_sweep_that_has_no_lines_yet_begins_again_at_its_first)
{
    static struct lm_sector s;
    memset(&s, 0, sizeof s);
    s.is_leftward = true;
    s.line = 7;
    lm_sector_begin_again(&s);
    assert_int_equal(s.line, 0);
    s.lines = 5;
    lm_sector_begin_again(&s);
    assert_int_equal(s.line, 4);
}
