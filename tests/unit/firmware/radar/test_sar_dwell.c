/* How long a patch takes and which cannot be made, in flight: EQUATIONS.md, "Synthetic aperture".
 */
#include "check.h"
#include "unit_rig.h"

#include "hs/angle.h"
#include "wgs84.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double wavelength_m = 0.031228; /* 9.6 GHz */

/* A patch as far away as said, `bearing_deg` off the track, which is north. */
static struct lm_control patch_at(const struct rig *r, double bearing_deg, double range_m,
                                  double cell_m)
{
    double lat, lon;
    wgs84_direct(hs_degrees(r->unit.ownship.latitude), hs_degrees(r->unit.ownship.longitude),
                 bearing_deg, range_m, &lat, &lon);
    return (struct lm_control){.kind = LM_CONTROL_SAR,
                               .sar = {.centre = {hs_bam(lat), hs_bam(lon)},
                                       .cell_mm = (uint32_t)lround(cell_m * 1000),
                                       .is_from_ownship = true}};
}

static struct rig *fly_at(double speed_m_s, double nose_deg)
{
    struct rig *r = start_rig();
    r->bus.speed_m_s = speed_m_s;
    r->bus.nose_deg = nose_deg;
    run(r, 0.5);
    return r;
}

/* Flight time between the first line and the last, and what of that time the lines between them
 * are. */
static double seconds_of_patch(struct rig *r, struct lm_control control)
{
    uint64_t first_us = 0;
    uint32_t first =
        0; /* lines that stood when first_us was taken: the first waits for those ahead */
    command(r, control);
    run(r, 0.004);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    while (r->unit.picture.sar.line < r->unit.picture.sar.lines) {
        if (first_us == 0 &&
            r->now_us >= r->unit.picture.next_line_us - r->unit.picture.sar.line_us &&
            r->unit.picture.sar.line > 0) {
            first_us = r->now_us;
            first = r->unit.picture.sar.line;
        }
        assert_true(r->now_us < 100000000);
        run(r, 0.002);
    }
    const uint32_t lines = r->unit.picture.sar.lines;
    return (double)(r->now_us - first_us) / 1e6 * lines / (lines - first);
}

/* T = l R / (2 V d sin o) by hand: 20 nautical miles, 45 degrees, 250 m/s. */
TEST(the_dwell_is_that_of_the_formula_within_2_percent)
{
    static const struct {
        double cell_m, printed_s;
    } figures[] = {{0.6, 5.5}, {1, 3.3}, {3, 1.1}, {5, 0.7}};
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) {
        struct rig *r = fly_at(250, 0);
        const double took_s = seconds_of_patch(r, patch_at(r, -45, 20 * 1852, figures[i].cell_m));
        const double slant_m = hypot(20 * 1852, 1900);
        const double exact_s = wavelength_m * slant_m / (2 * 250 * figures[i].cell_m * sin(pi / 4));
        print_message("# cells of %.1f m: %.2f s, formula %.2f s\n", figures[i].cell_m, took_s,
                      exact_s);
        assert_true(fabs(took_s / exact_s - 1) < 0.02);
        assert_true(fabs(took_s - figures[i].printed_s) < 0.06);
        free_rig(r);
    }
}

TEST(the_dwell_follows_squint_speed_and_range)
{
    static const struct {
        double squint_deg, speed_m_s, range_m, cell_m;
    } cases[] = {
        {16, 250, 30000, 2}, {90, 120, 60000, 4}, {-30, 300, 90000, 5}, {55, 200, 20000, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        /* The nose follows half-way, so that the antenna reaches what is abeam. */
        struct rig *r = fly_at(cases[i].speed_m_s, cases[i].squint_deg / 2);
        const double took_s = seconds_of_patch(
            r, patch_at(r, cases[i].squint_deg, cases[i].range_m, cases[i].cell_m));
        const double exact_s =
            wavelength_m * hypot(cases[i].range_m, 1900) /
            (2 * cases[i].speed_m_s * cases[i].cell_m * fabs(sin(cases[i].squint_deg * pi / 180)));
        assert_true(fabs(took_s / exact_s - 1) < 0.02);
        free_rig(r);
    }
}

static bool is_refused(double speed_m_s, double nose_deg, double bearing_deg, double range_m,
                       double cell_m)
{
    struct rig *r = fly_at(speed_m_s, nose_deg);
    command(r, patch_at(r, bearing_deg, range_m, cell_m));
    run(r, 0.01);
    const bool is_made = r->unit.page.picture == LM_PICTURE_PATCH;
    assert_int_equal(r->unit.count.commands_refused, !is_made);
    assert_int_equal((r->unit.flags & LM_FLAG_UNABLE) != 0, !is_made);
    free_rig(r);
    return !is_made;
}

/* 15 degrees off the velocity, either way and ahead or astern. */
TEST(squints_below_the_tables_are_refused)
{
    assert_true(is_refused(250, 0, 0, 20000, 5));
    for (int side = -1; side <= 1; side += 2) {
        assert_true(is_refused(250, 0, 14.9 * side, 20000, 5));
        assert_false(is_refused(250, 0, 15.1 * side, 20000, 5));
        assert_true(is_refused(250, 180, 165.1 * side, 20000, 5));
        assert_false(is_refused(250, 180, 164.9 * side, 20000, 5));
    }
}

/* 60 degrees off the nose, wherever the aircraft drifts. */
TEST(directions_beyond_the_antennas_limit_are_refused)
{
    for (int nose_deg = -10; nose_deg <= 10; nose_deg += 10) {
        for (int side = -1; side <= 1; side += 2) {
            assert_true(is_refused(250, nose_deg, nose_deg + 60.1 * side, 20000, 5));
            assert_false(is_refused(250, nose_deg, nose_deg + 59.9 * side, 20000, 5));
        }
    }
}

/* One minute: at 30 degrees and 100 km with cells of 0.5 m, 104.3 m/s make it. */
TEST(a_dwell_beyond_the_tables_is_refused_and_so_is_an_aircraft_at_rest)
{
    const double needed_m_s = wavelength_m * hypot(100000, 1900) / (2 * 0.5 * 0.5 * 60);
    assert_true(is_refused(needed_m_s * 0.98, 0, 30, 100000, 0.5));
    assert_false(is_refused(needed_m_s * 1.02, 0, 30, 100000, 0.5));
    assert_true(is_refused(0, 0, 30, 10000, 5));
}

/* Seen from a commanded place no limit holds; the pace is that of 250 m/s abeam. */
TEST(a_commanded_geometry_has_no_limits_and_the_reference_pace)
{
    struct rig *r = fly_at(0, 0);
    struct lm_control control = patch_at(r, 0, 20000, 1);
    control.sar.is_from_ownship = false;
    control.sar.range_m = 20000;
    control.sar.height_m_q6 = 3000 * 64;
    const double exact_s = wavelength_m * hypot(20000, 2900) / (2 * 250 * 1);
    assert_true(fabs(seconds_of_patch(r, control) / exact_s - 1) < 0.02);
    free_rig(r);
}

TEST(the_time_to_go_falls_to_nothing_as_the_lines_are_drawn)
{
    struct rig *r = fly_at(250, 0);
    command(r, patch_at(r, 45, 37040, 1));
    run(r, 0.6); /* the tiles are there */
    const double total_s = wavelength_m * hypot(37040, 1900) / (2 * 250 * sin(pi / 4));
    while (r->unit.picture.sar.line < r->unit.picture.sar.lines) {
        const double left_s = (double)lm_sar_time_to_go_us(&r->unit.picture.sar) / 1e6;
        const struct lm_sar *sar = &r->unit.picture.sar;
        const double expected_s = total_s * (sar->lines - sar->line) / sar->lines;
        assert_true(fabs(left_s - expected_s) < 0.02 * total_s);
        run(r, 0.05);
    }
    assert_true(lm_sar_time_to_go_us(&r->unit.picture.sar) == 0);
    free_rig(r);
}
