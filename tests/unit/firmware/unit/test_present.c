/* What is on the glass above the picture: the steerpoint, where it is marked and how long it is to
 * it; cells of the map that are longer than the picture's; an aircraft below the terrain. */
#include "check.h"
#include "glass_text.h"
#include "hs/angle.h"
#include "unit_rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Whether the glass says how long it is from the aircraft to a place on its meridian, within a
 * second. */
static bool says_time_to(const struct rig *r, double latitude_deg, double speed_m_s)
{
    const double own_deg = hs_degrees(r->unit.ownship.latitude);
    const double seconds = fabs(latitude_deg - own_deg) * 111150 / speed_m_s; /* at 46 degrees */
    for (int more = -1; more <= 1; more++) {
        char words[32];
        const int whole = (int)lround(seconds) + more;
        snprintf(words, sizeof words, "TTG %02d:%02d", whole / 60, whole % 60);
        if (says(r, words)) {
            return true;
        }
    }
    return false;
}

/* Corners of a diamond about a pixel that are of the symbols' colour. */
static int corners_at(const struct rig *r, int32_t x, int32_t y)
{
    const int32_t reach = HEIGHT * 65 / 4000;
    int corners = 0;
    for (int32_t side = -1; side <= 1; side += 2) {
        corners += r->glass[y * WIDTH + x + side * reach] == r->unit.palette.symbol;
        corners += r->glass[(y + side * reach) * WIDTH + x] == r->unit.palette.symbol;
    }
    return corners;
}

/* Whether a diamond stands on the pixel of a place, or on the one above, where it was a frame ago.
 */
static bool is_marked(const struct rig *r, double latitude_deg, double longitude_deg)
{
    const struct lm_position position = {hs_bam(latitude_deg), hs_bam(longitude_deg)};
    struct lm_offset o;
    assert_true(lm_view_find(&r->unit.picture.view, position, &o));
    const struct lm_point at = lm_view_point(&r->unit.picture.view, o);
    return corners_at(r, at.x, at.y) == 4 || corners_at(r, at.x, at.y - 1) == 4;
}

TEST(the_steerpoint_of_the_bus_is_marked_with_its_time_to_go_until_it_is_stale)
{
    struct rig *r = fly_rig();
    assert_false(says(r, "TTG"));
    r->bus.has_steerpoint = true;
    r->bus.steerpoint_deg[0] = 46.05, r->bus.steerpoint_deg[1] = 11.02;
    run(r, 1);
    assert_true(is_marked(r, 46.05, 11.02));
    r->bus.steerpoint_deg[1] = 11.001;
    run(r, 1);
    assert_true(is_marked(r, 46.05, 11.001));
    assert_true(says_time_to(r, 46.05, 150));
    r->bus.steerpoint_deg[0] = 46.6; /* 72 km: off the glass, and 8 minutes */
    run(r, 1);
    assert_true(says_time_to(r, 46.6, 150));
    r->bus.steerpoint_deg[0] = 46.05;
    run(r, 1);
    r->bus.has_steerpoint = false;
    r->bus.queue_next = 0;
    run(r, 2.8);
    assert_true(is_marked(r, 46.05, 11.001));
    run(r, 0.5);
    assert_false(is_marked(r, 46.05, 11.001));
    assert_false(says(r, "TTG"));
    free_rig(r);
}

TEST(a_commanded_steerpoint_goes_before_that_of_the_bus_until_it_is_dropped)
{
    struct rig *r = fly_rig();
    struct lm_control steer = {.kind = LM_CONTROL_STEERPOINT,
                               .steerpoint = {true, {hs_bam(46.03), hs_bam(10.99)}}};
    r->bus.has_steerpoint = true;
    r->bus.steerpoint_deg[0] = 46.05, r->bus.steerpoint_deg[1] = 11.02;
    command(r, steer);
    run(r, 1);
    assert_true(is_marked(r, 46.03, 10.99));
    assert_false(is_marked(r, 46.05, 11.02));
    r->bus.speed_m_s = 0; /* which puts it back to where it began */
    run(r, 1);
    assert_true(says(r, "TTG --:--"));
    r->bus.speed_m_s = 1; /* 148 minutes */
    run(r, 1);
    assert_true(says(r, "TTG --:--"));
    steer.steerpoint.is_set = false;
    command(r, steer);
    r->bus.speed_m_s = 150;
    run(r, 1);
    assert_true(is_marked(r, 46.05, 11.02));
    const uint32_t refused = r->unit.count.commands_refused;
    steer.steerpoint.is_set = true;
    steer.steerpoint.position.latitude = FX_BAM_90 + 1;
    command(r, steer);
    run(r, 0.1);
    assert_int_equal(r->unit.count.commands_refused, refused + 1);
    assert_true(is_marked(r, 46.05, 11.02));
    free_rig(r);
}

TEST(the_cursor_can_be_put_at_a_place_and_is_designated_there)
{
    struct rig *r = fly_rig();
    const struct lm_position place = {hs_bam(46.03), hs_bam(11.10)};
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = place});
    run(r, 0.5);
    assert_int_equal(r->unit.cursor.position.latitude, place.latitude);
    assert_int_equal(r->unit.cursor.position.longitude, place.longitude);
    assert_true(r->unit.cursor.is_placed && !r->unit.cursor.is_home);
    const uint32_t refused = r->unit.count.commands_refused;
    const struct lm_position beyond = {FX_BAM_90 + 1, 0};
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = beyond});
    run(r, 0.1);
    assert_int_equal(r->unit.count.commands_refused, refused + 1);
    assert_int_equal(r->unit.cursor.position.latitude, place.latitude);
    command(r, lm_control_designate());
    run(r, 0.1);
    assert_int_equal(r->unit.picture.sar.command.centre.latitude, place.latitude);
    assert_int_equal(r->unit.picture.sar.command.centre.longitude, place.longitude);
    free_rig(r);
}

/* The rig's bus without its velocity, from some time on. */
static struct {
    struct rig *rig;
    uint64_t from_us;
} still;

static int hear_without_velocity(void *ctx, struct lm_can_frame *frame)
{
    int status;
    do {
        status = still.rig->board.can.receive(ctx, frame);
    } while (status == 1 && still.rig->now_us >= still.from_us &&
             (frame->id == 1039 || frame->id == 1040));
    return status;
}

TEST(without_a_velocity_nobody_knows_how_long_it_is_to_the_steerpoint)
{
    struct rig *r = make_rig();
    const struct lm_can can = {.ctx = r, .receive = hear_without_velocity};
    still.rig = r;
    still.from_us = 2000000;
    r->board.lent.can = &can;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    command(r, (struct lm_control){.kind = LM_CONTROL_STEERPOINT,
                                   .steerpoint = {true, {hs_bam(46.05), hs_bam(11)}}});
    run(r, 2);
    assert_true(says_time_to(r, 46.05, 150));
    run(r, 12);
    assert_true(says(r, "TTG --:--"));
    free_rig(r);
}

/* A unit that stands still, steered to the place under a pixel. */
static struct rig *steer_to_pixel(int32_t x, int32_t y)
{
    struct rig *r = make_rig();
    r->bus.speed_m_s = 0;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 1);
    const struct lm_view *view = &r->unit.picture.view;
    const struct lm_offset under = {(x - view->at.x) * 256 + 128, (view->at.y - y) * 256 - 128};
    const struct lm_position place = lm_view_position(view, under);
    command(r, (struct lm_control){.kind = LM_CONTROL_STEERPOINT, .steerpoint = {true, place}});
    run(r, 0.5);
    assert_true(says(r, "TTG"));
    return r;
}

/* Corners of a diamond about a pixel that lie in the frame. */
static int corners_within(const struct lm_frame *f, int32_t x, int32_t y)
{
    const int32_t reach = HEIGHT * 65 / 4000;
    const int32_t corners[][2] = {{x - reach, y}, {x + reach, y}, {x, y - reach}, {x, y + reach}};
    int within = 0;
    for (size_t i = 0; i < sizeof corners / sizeof *corners; i++) {
        const int32_t right = corners[i][0] - f->left_px, down = corners[i][1] - f->top_px;
        within += right >= 0 && right < f->width_px && down >= 0 && down < f->height_px;
    }
    return within;
}

TEST(a_steerpoint_above_below_or_beside_the_frame_is_not_marked)
{
    const struct lm_frame f = lm_frame_of_display(WIDTH, HEIGHT);
    const int32_t left = f.left_px, right = left + f.width_px - 1, middle_x = (left + right) / 2;
    const int32_t top = f.top_px, bottom = top + f.height_px - 1, middle_y = (top + bottom) / 2;
    const struct {
        int32_t x, y, out_x, out_y; /* the last pixel inside on a side, and the way out of it */
    } sides[] = {{middle_x + 40, top, 0, -1},
                 {middle_x + 40, bottom, 0, 1},
                 {left, middle_y, -1, 0},
                 {right, middle_y, 1, 0}};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        for (int32_t out = -2; out <= 3; out++) {
            const int32_t x = sides[i].x + out * sides[i].out_x;
            const int32_t y = sides[i].y + out * sides[i].out_y;
            struct rig *r = steer_to_pixel(x, y);
            assert_int_equal(corners_at(r, x, y), out <= 0 ? corners_within(&f, x, y) : 0);
            free_rig(r);
        }
    }
}

/* The map's cells are 2^11 BAM of latitude: 19.1 m. */
TEST(the_length_of_the_maps_cells_is_on_the_glass_while_the_pictures_are_shorter)
{
    struct rig *r = fly_rig();
    run(r, 2); /* until a sweep has all tiles */
    assert_false(says(r, "MAP"));
    struct lm_control patch = patch_here;
    patch.sar.centre.longitude = hs_bam(11.03); /* the map ends at 11.055 */
    command(r, patch);
    run(r, 2);
    assert_true(says(r, "MAP 19M")); /* under cells of 5 m */
    command(r, (struct lm_control){.kind = LM_CONTROL_DROP});
    command(r,
            (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, LM_FOV_DBS2}});
    run(r, 2);
    assert_true(says(r, "MAP 19M")); /* under cells of 4.3 m */
    free_rig(r);
}

TEST(ancestors_that_answer_for_tiles_are_a_coarser_map)
{
    struct rig *r = start_rig();
    r->board.flash.fail_every = 1;
    command(r, range_10);
    run(r, 2);
    assert_true(r->unit.map.tiles.count.substituted > 0);
    const uint8_t coarsest = (uint8_t)(r->unit.map.db.lod_count - 1);
    char words[32];
    snprintf(words, sizeof words, "MAP %uM",
             (unsigned)((lm_db_cell_mm(&r->unit.map.db, coarsest) + 500) / 1000));
    assert_true(says(r, words));
    r->board.flash.fail_every = 0;
    run(r, 8);
    assert_false(says(r, "MAP"));
    free_rig(r);
}

/* Whether the glass warns with a word. */
static bool warns(const struct rig *r, const char *word)
{
    const struct lm_surface s = glass_of(r);
    return glass_find(&s, word, r->unit.palette.warning, r->unit.palette.ink, NULL);
}

/* Whether a fault of that word is in the log. */
static bool has_logged(const struct rig *r, const char *word)
{
    const struct lm_fault *fault;
    for (uint32_t age = 0; (fault = lm_fault_log_at(&r->unit.faults, age)) != NULL; age++) {
        if (strcmp(lm_flag_word(fault->flag), word) == 0) {
            return true;
        }
    }
    return false;
}

/* The terrain on the way is 100 m high. */
TEST(an_aircraft_below_the_terrain_is_told_so)
{
    static const struct {
        double height_m;
        bool is_below;
    } heights[] = {{2000, false}, {120, false}, {93, false}, {85, true}, {-100, true}};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        struct rig *r = make_rig();
        r->bus.height_m = heights[i].height_m;
        assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
        run(r, 2);
        assert_int_equal((r->unit.flags & LM_FLAG_BELOW) != 0, heights[i].is_below);
        assert_int_equal(warns(r, "BLW TERR"), heights[i].is_below);
        assert_int_equal(has_logged(r, "BLW TERR"), heights[i].is_below);
        assert_true(lit_pixels(r) > 0 || heights[i].height_m < 0); /* and the picture goes on */
        free_rig(r);
    }
}
