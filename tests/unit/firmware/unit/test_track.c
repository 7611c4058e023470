/* Tracks of a unit in flight: geometry against PROJ, what breaks a lock, and the radar equation. */
#include "check.h"
#include "hs/angle.h"
#include "lm/receiver.h"
#include "target_support.h"
#include "tracking.h"
#include "unit_rig.h"
#include "wgs84.h"

#include <math.h>

static struct lm_target moving; /* north of the aircraft */

static const struct lm_control track_it = {.kind = LM_CONTROL_TRACK},
                               range_it = {.kind = LM_CONTROL_RANGING},
                               drop_it = {.kind = LM_CONTROL_DROP};

static void is_near(double value, double wanted, double within)
{
    if (!(fabs(value - wanted) <= within)) {
        fail_msg("%.4f should be %.4f within %.4f", value, wanted, within);
    }
}

static void cursor_to(struct rig *r, double latitude, double longitude)
{
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = {hs_bam(latitude), hs_bam(longitude)}});
}

/* A rig in flight with its cursor at a place, which it then tracks. */
static struct rig *rig_at(double latitude, double longitude)
{
    struct rig *r = fly_rig();
    cursor_to(r, latitude, longitude);
    run(r, 0.2);
    return r;
}

static const struct lm_track *track_of(const struct rig *r)
{
    return &r->unit.track;
}

static void put_target(struct rig *r)
{
    seal_target(&moving);
    r->unit.map.target_set.items = &moving;
    r->unit.map.target_set.count = 1;
}

static struct rig *mover_rig(enum lm_sector_mode mode, double heading_deg, double speed_m_s,
                             double rcs_db)
{
    struct rig *r = rig_at(46, 11);
    moving = point_at(46, 11, 3, rcs_db);
    moving.flags = LM_TARGET_ABOVE_GROUND;
    moving.swerling = 0;
    moving.heading = hs_bam(heading_deg);
    moving.speed_mm_s = (uint32_t)lround(speed_m_s * 1000);
    moving.leg_m = 50000;
    put_target(r);
    const struct lm_mover_state at = lm_mover_state_at(&moving, r->unit.exercise.time_us);
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {(int32_t)mode, 0}});
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = at.position});
    command(r, track_it);
    run(r, 0.3);
    return r;
}

static struct rig *gmt_rig(double heading_deg, double speed_m_s, double rcs_db)
{
    return mover_rig(LM_SECTOR_GMT, heading_deg, speed_m_s, rcs_db);
}

/* Straight range between two points by their Cartesian coordinates. */
static double chord_m(const double a[3], const double b[3])
{
    double xyz[2][3];
    const double *p[2] = {a, b};
    const double e2 = 0.00669437999014;
    for (int i = 0; i < 2; i++) {
        const double lat = p[i][0] * M_PI / 180, lon = p[i][1] * M_PI / 180;
        const double n = 6378137 / sqrt(1 - e2 * sin(lat) * sin(lat));
        xyz[i][0] = (n + p[i][2]) * cos(lat) * cos(lon);
        xyz[i][1] = (n + p[i][2]) * cos(lat) * sin(lon);
        xyz[i][2] = (n * (1 - e2) + p[i][2]) * sin(lat);
    }
    return hypot(hypot(xyz[0][0] - xyz[1][0], xyz[0][1] - xyz[1][1]), xyz[0][2] - xyz[1][2]);
}

TEST(a_fixed_place_is_tracked_with_the_bearing_and_slant_range_of_double_precision)
{
    struct rig *r = rig_at(46.01, 11.03);
    command(r, track_it);
    run(r, 1);
    const struct lm_track *t = track_of(r);
    assert_int_equal(t->state, LM_TRACK_HELD);
    assert_int_equal(t->kind, LM_TRACK_FIXED);
    const struct lm_ownship *own = &r->unit.ownship;
    const double from[3] = {hs_degrees(own->latitude), hs_degrees(own->longitude),
                            own->height_m_q6 / 64.0};
    const double to[3] = {46.01, 11.03, t->seen.elevation_m_q10 / 1024.0};
    const struct geod_geodesic earth = wgs84();
    double metres, bearing;
    geod_inverse(&earth, from[0], from[1], to[0], to[1], &metres, &bearing, NULL);
    const double flown_m = 150 * LM_TRACK_STEP_US / 1e6;
    print_message("# slant %.2f m, double %.2f; bearing %.4f, PROJ %.4f\n",
                  t->seen.slant_m_q8 / 256.0, chord_m(from, to), hs_degrees(t->seen.bearing),
                  bearing);
    is_near(t->seen.slant_m_q8 / 256.0, chord_m(from, to), flown_m + 3);
    is_near(hs_degrees(t->seen.bearing), bearing, 0.15);
    is_near(t->seen.ground_m_q8 / 256.0, metres, flown_m + 2);
    const double bearing_rad = bearing * M_PI / 180;
    is_near(t->seen.range_rate_mm_s / 1000.0, -150 * cos(bearing_rad) * metres / chord_m(from, to),
            1);
    assert_true(says(r, "FTT"));
    run(r, 2);
    assert_int_equal(t->state, LM_TRACK_HELD);
    assert_int_equal(lit_pixels(r), 0); /* the picture is blanked */
    command(r, drop_it);
    run(r, 0.2);
    assert_int_equal(t->state, LM_TRACK_OFF);
    assert_int_equal(t->loss, LM_TRACK_SOUND);
    free_rig(r);
}

TEST(the_sweep_rests_while_a_track_is_held_and_goes_on_behind_it)
{
    struct rig *r = rig_at(46.01, 11.03);
    command(r, track_it);
    run(r, 0.5);
    const uint32_t lines = r->unit.count.lines;
    run(r, 1);
    assert_int_equal(r->unit.count.lines, lines);
    press(r, 17); /* the key ends it */
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_OFF);
    assert_true(r->unit.count.lines > lines + 100);
    free_rig(r);
}

TEST(the_key_held_ranges_instead_of_ending_the_track)
{
    struct rig *r = rig_at(46.01, 11.03);
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->kind, LM_TRACK_FIXED);
    hold(r, 17, 1);
    run(r, 0.5);
    assert_int_equal(track_of(r)->kind, LM_TRACK_RANGING);
    assert_int_not_equal(track_of(r)->state, LM_TRACK_OFF);
    hold(r, 17, 1); /* once more ends it */
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_OFF);
    free_rig(r);
}

/* Runs until the track ends; fails if it coasts for a time other than said. */
static void coasts_then_drops(struct rig *r, enum lm_track_loss loss)
{
    const struct lm_track *t = track_of(r);
    run(r, 0.5);
    assert_int_equal(t->state, LM_TRACK_COASTING);
    assert_int_equal(t->loss, loss);
    run(r, LM_TRACK_COAST_US / 1e6 - 1);
    assert_int_equal(t->state, LM_TRACK_COASTING);
    run(r, 1);
    assert_int_equal(t->state, LM_TRACK_OFF);
    assert_int_equal(t->loss, loss);
    assert_true(says(r, "LOST"));
}

TEST(a_turn_beyond_the_antennas_limit_breaks_the_lock_after_the_coast)
{
    struct rig *r = rig_at(46.01, 11.03);
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    r->bus.nose_deg = 200;
    coasts_then_drops(r, LM_TRACK_LIMITS);
    free_rig(r);
}

TEST(a_hill_between_breaks_the_lock_and_one_that_passes_does_not)
{
    struct rig *r = rig_at(46.03, 11.02);
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    r->bus.height_m = 90; /* below the crests */
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_COASTING);
    assert_int_equal(track_of(r)->loss, LM_TRACK_SHADOW);
    r->bus.height_m = 2000;
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    r->bus.height_m = 90;
    run(r, 0.5);
    coasts_then_drops(r, LM_TRACK_SHADOW);
    free_rig(r);
}

/* 1,824 m and 2,130 m away, both behind the crest 1,400 m east, which stands 50 m above the ground
 * below the aircraft. */
TEST(nothing_hides_what_is_nearer_than_2_km)
{
    for (int is_far = 0; is_far < 2; is_far++) {
        struct rig *r = rig_at(45.955, is_far ? 11.0275 : 11.0235);
        r->bus.nose_deg = 90;
        r->bus.height_m = 115;
        run(r, 1);
        command(r, track_it);
        run(r, 0.5);
        assert_int_equal(track_of(r)->loss, is_far ? LM_TRACK_SHADOW : LM_TRACK_SOUND);
        free_rig(r);
    }
}

TEST(a_radar_that_does_not_send_loses_its_lock)
{
    struct rig *r = rig_at(46.01, 11.03);
    command(r, track_it);
    run(r, 0.5);
    press(r, 4); /* OVRD */
    coasts_then_drops(r, LM_TRACK_SILENT);
    free_rig(r);
}

TEST(a_mover_is_acquired_with_range_and_speed_and_lost_when_it_crosses)
{
    struct rig *r = gmt_rig(180, 12, 20);
    const struct lm_track *t = track_of(r);
    run(r, 1);
    assert_int_equal(t->state, LM_TRACK_HELD);
    assert_int_equal(t->kind, LM_TRACK_MOVER);
    assert_int_equal(t->seen.speed_mm_s, 12000);
    is_near(t->seen.range_rate_mm_s / 1000.0, -162 * cos(t->seen.angle * 2 * M_PI / 4294967296.0),
            2);
    assert_true(says(r, "GMTT") && says(r, "23KT"));
    /* The glass shows where it goes: south, 150 degrees from what is up there. */
    struct lm_symbols s = {.view = r->unit.picture.view};
    s.view.up = hs_bam(30);
    lm_tracking_describe(&r->unit, &s);
    assert_true(s.has_track_course);
    is_near(s.track_course * 360.0 / 4294967296.0, 150, 0.1);
    moving.heading = hs_bam(90);
    moving.speed_mm_s = 12000;
    const struct lm_mover_state now = lm_mover_state_at(&moving, r->unit.exercise.time_us);
    moving.latitude += t->seen.position.latitude - now.position.latitude;
    moving.longitude += t->seen.position.longitude - now.position.longitude;
    coasts_then_drops(r, LM_TRACK_NOTCH);
    assert_true(says(r, "NOTCH"));
    free_rig(r);
}

TEST(nothing_near_the_cursor_is_no_track)
{
    struct rig *r = gmt_rig(180, 0.5, 20); /* slower than the gate */
    run(r, LM_TRACK_SEARCH_US / 1e6 + 0.2);
    assert_int_equal(track_of(r)->state, LM_TRACK_OFF);
    assert_int_equal(track_of(r)->loss, LM_TRACK_NOTCH);
    cursor_to(r, 46.1, 11.1);
    command(r, track_it);
    run(r, LM_TRACK_SEARCH_US / 1e6 + 0.2);
    assert_int_equal(track_of(r)->state, LM_TRACK_OFF);
    assert_int_equal(track_of(r)->loss, LM_TRACK_NOTHING);
    free_rig(r);
}

/* Albersheim's equation (1981) in double precision. */
TEST(a_track_needs_what_albersheim_says)
{
    for (uint32_t log2 = 0; log2 <= LM_LOOKS_LOG2_MAX; log2++) {
        const double a = log(0.62 / 1e-6), b = log(0.9 / 0.1), n = 1 << log2;
        const double db =
            -5 * log10(n) + (6.2 + 4.54 / sqrt(n + 0.44)) * log10(a + 0.12 * a * b + 1.7 * b);
        is_near(lm_track_needs_db_q8(log2) / 256.0, db, 0.01);
    }
}

/* The echo of a point against noise goes with sigma tau / R^4, less the air: in double precision
 * from the table's anchor. */
TEST(a_point_stands_over_noise_as_the_radar_equation_says)
{
    const struct lm_radar *radar = &lm_radar_default;
    double worst = 0;
    for (int k = 0; k < 40; k++) {
        const double r_m = 4000 + 1700 * k, h_m = 500 + 150 * k;
        const int row = k % 3;
        struct lm_receiver_floor f;
        lm_receiver_floor_at(&f, radar, (uint32_t)(r_m * 256), (int32_t)(h_m * 1024), (uint8_t)row,
                             LM_FOV_NORM);
        const double ra = radar->receiver.noise_range_m, ha = radar->receiver.noise_height_m;
        const double ground = sqrt(ra * ra - ha * ha);
        const double ga = ha / ground - ground / (8 / 3.0 * 6371000);
        const double tau = radar->range[row].pulse_ns[0], tau_a = radar->receiver.noise_pulse_ns;
        const double at_one = radar->receiver.noise_db_q8 / 256.0 - 30 * log10(ra) +
                              10 * log10(ga) - 20 * log10(tau / tau_a);
        const double beam =
            hs_degrees(radar->antenna.azimuth_beam) * M_PI / 180 * sqrt(M_PI / (8 * log(2)));
        const double noise_dbsm = at_one + 40 * log10(r_m) + 10 * log10(beam) +
                                  10 * log10(tau * 0.149896229) +
                                  r_m / 1000 * radar->receiver.air_loss_db_per_km_q16 / 65536;
        const double off = fabs((f.noise_db_q8 + f.area_db_q8) / 256.0 - noise_dbsm);
        worst = off > worst ? off : worst;
    }
    print_message("# worst %.3f dB\n", worst);
    assert_true(worst < 0.05);
}

/* A mover too weak for its range is not acquired; 3 dB around what the equation asks decide. */
TEST(the_radar_equation_decides_what_is_acquired)
{
    struct rig *r = gmt_rig(180, 12, 20);
    const double over = (track_of(r)->seen.signal_db_q8 -
                         lm_track_needs_db_q8(lm_radar_default.receiver.noise_looks_log2)) /
                        256.0;
    free_rig(r);
    r = gmt_rig(180, 12, 20 - over + 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    free_rig(r);
    r = gmt_rig(180, 12, 20 - over - 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_SEARCHING);
    assert_int_equal(track_of(r)->loss, LM_TRACK_WEAK);
    free_rig(r);
}

TEST(the_ground_ahead_is_ranged_where_the_nose_points_at_it)
{
    struct rig *r = fly_rig();
    command(r, range_it);
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_SEARCHING); /* the nose is level or above */
    assert_int_equal(track_of(r)->kind, LM_TRACK_RANGING);
    assert_true(says(r, "AGR"));
    /* Twenty degrees down, over a meridian on which the hills are 100 m high. */
    r->bus.pitch_deg = -20;
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    const double slant_m = 1900 / sin(20 * M_PI / 180);
    print_message("# slant %.1f m, a plane's %.1f\n", track_of(r)->seen.slant_m_q8 / 256.0,
                  slant_m);
    is_near(track_of(r)->seen.slant_m_q8 / 256.0, slant_m, 30);
    is_near(track_of(r)->seen.elevation_m_q10 / 1024.0, 100, 5);
    command(r, range_it);
    run(r, 0.2);
    assert_int_equal(track_of(r)->state, LM_TRACK_OFF);
    free_rig(r);
}

/* ---- what the picture makes of it ---- */

TEST(a_ship_is_tracked_as_a_mover_where_the_mode_shows_ships)
{
    struct rig *r = mover_rig(LM_SECTOR_SEA, 180, 12, 40);
    assert_int_equal(track_of(r)->kind, LM_TRACK_MOVER);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    assert_true(says(r, "GMTT"));
    free_rig(r);
}

/* Over a patch nothing that moves is tracked, whatever the sector's mode is. */
TEST(over_a_patch_a_place_is_tracked_marked_and_the_picture_stays)
{
    struct rig *r = fly_rig();
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GMT, 0}});
    struct lm_control patch = patch_here;
    patch.sar.centre = (struct lm_position){hs_bam(46.01), hs_bam(11.03)};
    command(r, patch);
    run(r, 4);
    cursor_to(r, 46.01, 11.03);
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->kind, LM_TRACK_FIXED);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    assert_true(says(r, "FTT"));
    assert_true(lit_pixels(r) > 1000);
    struct lm_symbols s = {.view = r->unit.picture.view, .antenna_azimuth = 77};
    lm_tracking_describe(&r->unit, &s);
    const struct lm_view *v = &s.view;
    assert_int_equal(s.track_shape, LM_SHAPE_FILLED);
    assert_in_range(s.track.x - v->middle.x + 2, 0, 4);
    assert_in_range(s.track.y - v->middle.y + 2, 0, 4);
    assert_int_equal(s.antenna_azimuth, 77); /* it makes no sweep that a track could stop */
    free_rig(r);
}

/* A patch that is drawn needs no navigation; what is tracked over it does. */
TEST(over_a_patch_too_a_track_is_lost_without_navigation)
{
    for (int kind = 0; kind < 2; kind++) {
        struct rig *r = rig_at(46.01, 11.03);
        command(r, patch_here);
        run(r, 2);
        cursor_to(r, 46.01, 11.03);
        command(r, track_it);
        run(r, 0.5);
        assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
        assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
        r->bus.has_no_velocity = kind == 0;
        r->bus.is_down = kind == 1;
        run(r, 4);
        assert_int_equal(track_of(r)->loss, LM_TRACK_NO_NAV);
        if (kind == 0) { /* the speed heard last says nothing of now */
            assert_int_equal(track_of(r)->state, LM_TRACK_COASTING);
            assert_int_equal(track_of(r)->seen.range_rate_mm_s, 0);
        }
        free_rig(r);
    }
}

TEST(what_is_tracked_far_from_a_patch_is_told_and_not_marked)
{
    struct rig *r = fly_rig();
    command(r, (struct lm_control){.kind = LM_CONTROL_SAR,
                                   .sar = {.centre = patch_here.sar.centre,
                                           .cell_mm = 500,
                                           .range_m = 9000,
                                           .height_m_q6 = 2000 * 64}});
    run(r, 1);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    cursor_to(r, 45.98, 10.96); /* some 7 km, on a glass on which 6 km are 8,000 pixels */
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    assert_true(says(r, "FTT"));
    struct lm_symbols s = {.view = r->unit.picture.view};
    lm_tracking_describe(&r->unit, &s);
    assert_int_equal(s.track_shape, LM_SHAPE_NONE);
    free_rig(r);
}

/* A still target 30 dBsm strong, so far north of the cursor. */
static bool is_taken_at(const struct lm_control *picture, double away_m)
{
    struct rig *r = fly_rig();
    command(r, *picture);
    cursor_to(r, 46.01, 11.03);
    run(r, 2.5);
    moving = point_at(46.01 + away_m / 111150, 11.03, 120, 30);
    put_target(r);
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    const bool is_taken = track_of(r)->has_target;
    is_near(hs_degrees(track_of(r)->seen.position.latitude),
            46.01 + (is_taken ? away_m / 111150 : 0), 1e-6);
    free_rig(r);
    return is_taken;
}

/* A fortieth of the range, or of the side of a window or patch, four times less for what stands. */
TEST(what_stands_is_taken_within_a_share_of_what_the_glass_shows)
{
    const struct lm_radar *radar = &lm_radar_default;
    const struct lm_control whole = {.kind = LM_CONTROL_SECTOR,
                                     .sector = {LM_SECTOR_GM, LM_FOV_NORM}},
                            window = {.kind = LM_CONTROL_SECTOR,
                                      .sector = {LM_SECTOR_GM, LM_FOV_DBS1}};
    struct lm_control patch = patch_here;
    patch.sar.centre = (struct lm_position){hs_bam(46.01), hs_bam(11.03)};
    const struct {
        const struct lm_control *picture;
        double side_m;
    } views[] = {{&whole, 18520},
                 {&window, 2 * 18520 * radar->fov[LM_FOV_DBS1].window_permille / 1000.0},
                 {&patch, patch.sar.cell_mm * radar->sar.cells / 1000.0}};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        const double gate_m = views[i].side_m / 40 / 4;
        assert_true(is_taken_at(views[i].picture, gate_m * 0.85));
        assert_false(is_taken_at(views[i].picture, gate_m * 1.25));
    }
}

static uint32_t scale_nm(const struct rig *r)
{
    return r->unit.page.radar->range[r->unit.page.range_index].range_nm;
}

TEST(an_automatic_scale_follows_what_is_tracked)
{
    struct rig *r = fly_rig();
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 40});
    run(r, 0.5);
    press(r, 2); /* AUTO */
    r->bus.pitch_deg = -20;
    run(r, 1);
    assert_int_equal(scale_nm(r), 40);
    const struct lm_position cursor = r->unit.cursor.position;
    command(r, range_it); /* some 5.5 km: less than 0.4 of 20 miles */
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    assert_int_equal(scale_nm(r), 10);
    assert_true(r->unit.cursor.is_home);
    assert_memory_equal(&r->unit.cursor.position, &cursor, sizeof cursor); /* and it stays */
    free_rig(r);
    r = rig_at(46.05, 11); /* 11 km away: less than 0.4 of 40 and of 20 miles */
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 40});
    run(r, 0.5);
    command(r, track_it);
    run(r, 0.5);
    press(r, 2);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    is_near(track_of(r)->seen.slant_m_q8 / 256.0, 11000, 800);
    assert_int_equal(scale_nm(r), 10);
    free_rig(r);
    r = make_rig_at(45.9, 11); /* 17.6 km away: more than 0.9 of 10 miles, less of 20 */
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 1.5);
    cursor_to(r, 45.945, 11);
    r->bus.jump_degrees = -0.065;
    run(r, 1);
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    assert_int_equal(scale_nm(r), 10);
    press(r, 2);
    run(r, 0.5);
    assert_int_equal(scale_nm(r), 20);
    free_rig(r);
}

/* A snowplow cursor is held where it is by the first press; the second one acts. */
TEST(a_cursor_ahead_of_the_aircraft_is_held_before_it_is_used)
{
    for (int is_track = 0; is_track < 2; is_track++) {
        struct rig *r = fly_rig();
        const struct lm_control act = is_track ? track_it : lm_control_designate();
        press(r, 8);
        const struct lm_position before = r->unit.cursor.position;
        run(r, 0.5);
        assert_int_not_equal(r->unit.cursor.position.latitude,
                             before.latitude); /* it moves along */
        command(r, act);
        run(r, 0.1);
        const struct lm_position held = r->unit.cursor.position;
        run(r, 0.5);
        assert_memory_equal(&r->unit.cursor.position, &held, sizeof held);
        assert_int_equal(r->unit.page.picture, LM_PICTURE_SECTOR);
        assert_int_equal(track_of(r)->state, LM_TRACK_OFF);
        cursor_to(r, 46.01, 11.03);
        command(r, act);
        run(r, 0.5);
        assert_int_equal(r->unit.page.picture, is_track ? LM_PICTURE_SECTOR : LM_PICTURE_PATCH);
        assert_int_equal(track_of(r)->state, is_track ? LM_TRACK_HELD : LM_TRACK_OFF);
        assert_int_equal(r->unit.count.commands_refused, 0);
        free_rig(r);
    }
}

/* ---- which target it is ---- */

enum { CROWD = 20 };
static struct lm_target crowd[CROWD];

/* A track of what is at the cursor, with so many of the crowd. */
static struct rig *rig_in_crowd(uint32_t count)
{
    struct rig *r = rig_at(46.01, 11.03);
    for (uint32_t i = 0; i < count; i++) {
        seal_target(&crowd[i]);
    }
    r->unit.map.target_set.items = crowd;
    r->unit.map.target_set.count = count;
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    return r;
}

/* Twenty around the cursor, more than a step looks at; each is the nearest once. */
TEST(of_many_targets_the_nearest_is_tracked)
{
    for (uint32_t nearest = 0; nearest < CROWD; nearest += 6) {
        for (uint32_t i = 0; i < CROWD; i++) {
            const double away_m = i == nearest ? 20 : 40 + (i * 7 % CROWD) * 3;
            crowd[i] = point_at(46.01 + (i % 2 ? away_m : -away_m) / 111150, 11.03, 120, 30);
            crowd[i].id = i;
        }
        struct rig *r = rig_in_crowd(CROWD);
        assert_true(track_of(r)->has_target);
        assert_int_equal(track_of(r)->index, nearest);
        free_rig(r);
    }
}

/* The nearest crosses, so that the clutter hides it: the other one is tracked, whichever comes
 * first. */
TEST(a_mover_that_cannot_be_seen_does_not_stand_before_one_that_can)
{
    for (uint32_t hidden = 0; hidden < 2; hidden++) {
        struct rig *r = rig_at(46, 11);
        for (uint32_t i = 0; i < 2; i++) {
            crowd[i] = point_at(46 + (i == hidden ? 0 : 60 / 111150.0), 11, 3, 20);
            crowd[i].flags = LM_TARGET_ABOVE_GROUND;
            crowd[i].heading = hs_bam(i == hidden ? 90 : 180);
            crowd[i].speed_mm_s = 12000;
            crowd[i].leg_m = 50000;
            seal_target(&crowd[i]);
        }
        r->unit.map.target_set.items = crowd;
        r->unit.map.target_set.count = 2;
        const struct lm_mover_state at =
            lm_mover_state_at(&crowd[hidden], r->unit.exercise.time_us);
        command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GMT, 0}});
        command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = at.position});
        command(r, track_it);
        run(r, 0.3);
        assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
        assert_int_equal(track_of(r)->index, 1 - hidden);
        free_rig(r);
    }
}

TEST(what_moves_is_not_tracked_as_what_stands)
{
    crowd[0] = point_at(46.01, 11.03, 120, 30);
    crowd[0].speed_mm_s = 100;
    crowd[0].leg_m = 100;
    struct rig *r = rig_in_crowd(1);
    assert_int_equal(track_of(r)->kind, LM_TRACK_FIXED);
    assert_false(track_of(r)->has_target); /* the place itself */
    free_rig(r);
}

/* A sphere of 20 m radius has pi r^2: 31 dBsm, from any side and with a point's law. */
TEST(a_target_of_bodies_is_as_strong_as_they_are)
{
    double over_noise_db[2];
    for (int is_body = 0; is_body < 2; is_body++) {
        crowd[0] = point_at(46.01, 11.03, 120, is_body ? -40 : 10 * log10(M_PI * 400));
        if (is_body) {
            add_scatterer(&crowd[0], LM_SHAPE_SPHERE, 20000, 0, 0, 0, 0, 0);
        }
        struct rig *r = rig_in_crowd(1);
        assert_true(track_of(r)->has_target);
        over_noise_db[is_body] = track_of(r)->seen.signal_db_q8 / 256.0;
        free_rig(r);
    }
    is_near(over_noise_db[1], over_noise_db[0], 0.1);
}

TEST(a_mover_faster_than_the_gates_is_in_no_track)
{
    const double most_m_s = lm_radar_default.mode[LM_SECTOR_GMT].gate_mm_s[1] / 1000.0;
    struct rig *r = gmt_rig(180, most_m_s * 0.98, 20);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    free_rig(r);
    r = gmt_rig(180, most_m_s * 1.03, 20);
    assert_int_equal(track_of(r)->state, LM_TRACK_SEARCHING);
    assert_int_equal(track_of(r)->loss, LM_TRACK_NOTCH);
    free_rig(r);
}

/* ---- where it may be ---- */

static enum lm_track_loss loss_at(double height_m, double ahead_m)
{
    struct rig *r = make_rig();
    r->bus.height_m = height_m;
    r->bus.speed_m_s = 0; /* at 45.95 N */
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 1.5);
    cursor_to(r, 45.95 + ahead_m / 111150, 11);
    command(r, track_it);
    run(r, 1);
    const enum lm_track_loss loss = track_of(r)->loss;
    assert_int_equal(track_of(r)->state == LM_TRACK_HELD, loss == LM_TRACK_SOUND);
    free_rig(r);
    return loss;
}

/* The map's hills are 100 m high on this meridian. */
TEST(a_place_steeper_than_the_antenna_tilts_is_beyond_its_limits)
{
    const double most = tan(hs_degrees(lm_radar_default.antenna.tilt_max) * M_PI / 180);
    assert_int_equal(loss_at(3100, 3000 / most * 1.05), LM_TRACK_SOUND);
    assert_int_equal(loss_at(3100, 3000 / most * 0.95), LM_TRACK_LIMITS);
    /* Nothing stands between the aircraft and what is nearer than two kilometres. */
    assert_int_equal(loss_at(400, 1500), LM_TRACK_SOUND);
}

/* A jump of the navigation takes the aircraft 555 km away. */
TEST(what_is_beyond_300_km_is_lost)
{
    struct rig *r = rig_at(46.01, 11.03);
    command(r, track_it);
    run(r, 0.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    r->bus.jump_degrees = -5;
    run(r, LM_TRACK_COAST_US / 1e6 + 2);
    assert_int_equal(track_of(r)->state, LM_TRACK_OFF);
    assert_int_equal(track_of(r)->loss, LM_TRACK_LIMITS);
    free_rig(r);
}

/* So steep and so low that the ground lies in the first cell of the way, on the longest scale. */
TEST(the_ground_is_ranged_close_below_too)
{
    struct rig *r = make_rig();
    r->bus.height_m = 400;
    r->bus.speed_m_s = 0;
    r->bus.pitch_deg = -29;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 80});
    run(r, 1.5);
    command(r, range_it);
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    is_near(track_of(r)->seen.ground_m_q8 / 256.0, 300 / tan(29 * M_PI / 180), 25);
    free_rig(r);
}

/* The map ends some 12 km ahead; the nose meets the plane of its ground at 24 km, where nothing is.
 */
TEST(there_is_nothing_to_range_where_the_map_ends)
{
    struct rig *r = fly_rig();
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 20});
    r->bus.speed_m_s = 0;
    r->bus.pitch_deg = -atan2(1900, 8000) * 180 / M_PI;
    command(r, range_it);
    run(r, 1.5);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    is_near(track_of(r)->seen.ground_m_q8 / 256.0, 8000, 150);
    r->bus.pitch_deg = -atan2(1900, 24000) * 180 / M_PI;
    run(r, 2);
    assert_int_equal(track_of(r)->state, LM_TRACK_SEARCHING);
    assert_int_equal(track_of(r)->loss, LM_TRACK_NOTHING);
    free_rig(r);
}

TEST(a_track_that_is_off_stays_as_it_is)
{
    static const struct lm_track_scene nothing;
    struct lm_track t = {.state = LM_TRACK_OFF, .loss = LM_TRACK_WEAK, .number = 5};
    const struct lm_track before = t;
    lm_track_step(&t, &nothing, 1000000);
    assert_memory_equal(&t, &before, sizeof t);
}

TEST(a_held_snowplow_cursor_stays_held_when_another_key_acts)
{
    struct rig *r = fly_rig();
    press(r, 8);
    run(r, 0.5);
    command(r, lm_control_designate());
    run(r, 0.1);
    const struct lm_position held = r->unit.cursor.position;
    press(r, 20);
    run(r, 1);
    assert_int_equal(scale_nm(r), 20);
    assert_memory_equal(&r->unit.cursor.position, &held, sizeof held);
    free_rig(r);
}

TEST(a_search_forgets_the_best_it_had_when_targets_get_other_numbers)
{
    struct rig *r = rig_at(46, 11);
    put_target(r);
    r->unit.track.search.has_best = true;
    r->unit.track.search.next = 1;
    lm_tracking_renumber(&r->unit, 0, 0);
    assert_false(r->unit.track.search.has_best);
    assert_int_equal(r->unit.track.search.next, 0);
    free_rig(r);
}

TEST(what_is_held_is_measured_twenty_times_a_second)
{
    struct rig *r = rig_at(46.01, 11.03);
    command(r, track_it);
    run(r, 1);
    assert_int_equal(track_of(r)->state, LM_TRACK_HELD);
    uint64_t before = track_of(r)->returned_us;
    int measured = 0;
    for (int step = 0; step < 500; step++) {
        run(r, 0.002);
        measured += track_of(r)->returned_us != before;
        before = track_of(r)->returned_us;
    }
    assert_in_range(measured, 16, 20);
    free_rig(r);
}
