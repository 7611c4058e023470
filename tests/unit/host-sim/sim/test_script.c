/* What a line of a script makes the operator do, and when. */
#include "sim/script.h"

#include "hs/angle.h"
#include "lm/malfunction.h"
#include "lm/radar.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check.h"
#include "control_asserts.h"

enum { NOTHING = 99 };

/* Read `text` as a script. */
static int read_text(struct script *s, const char *text)
{
    char path[] = "/tmp/test-script-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    FILE *file = fdopen(fd, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    const int status = script_read(s, path, &lm_radar_default);
    unlink(path);
    return status;
}

/* The next control that is due at `seconds`, or one of kind NOTHING. */
static struct lm_control at(struct script *s, double seconds)
{
    struct lm_control c;
    script_advance(s, (uint64_t)(seconds * 1e6));
    if (s->port.next(s->port.ctx, &c) != 1) {
        c = (struct lm_control){.kind = (enum lm_control_kind)NOTHING};
    }
    return c;
}

TEST(a_press_goes_down_and_comes_up_a_tenth_of_a_second_later)
{
    struct script s;
    assert_int_equal(read_text(&s, "1 osb 19\n"), 0);
    assert_int_equal(at(&s, 0.999).kind, NOTHING);
    struct lm_control c = at(&s, 1);
    assert_int_equal(c.kind, LM_CONTROL_DOWN);
    assert_int_equal(c.button, 19);
    assert_int_equal(at(&s, 1.099).kind, NOTHING);
    c = at(&s, 1.1);
    assert_int_equal(c.kind, LM_CONTROL_UP);
    assert_int_equal(c.button, 19);
    assert_int_equal(at(&s, 99).kind, NOTHING);
    script_free(&s);
}

TEST(a_long_press_overlaps_what_the_next_lines_do)
{
    struct script s;
    assert_int_equal(read_text(&s, "1 osb 11 1.5\n2 gm\n2.2 picture now\n3 drop\n"), 0);
    assert_int_equal(at(&s, 1).kind, LM_CONTROL_DOWN);
    assert_int_equal(at(&s, 2.1).kind, LM_CONTROL_SECTOR);
    assert_int_equal(at(&s, 2.1).kind, NOTHING);
    assert_string_equal(script_advance(&s, 2200000), "now");
    assert_int_equal(at(&s, 2.49).kind, NOTHING);
    assert_int_equal(at(&s, 2.5).kind, LM_CONTROL_UP);
    assert_int_equal(at(&s, 3).kind, LM_CONTROL_DROP);
    script_free(&s);
}

TEST(a_patch_takes_the_effects_behind_it_and_no_other_word)
{
    static const struct {
        const char *words;
        int is_plan, is_steady;
    } cases[] = {{"", 0, 0}, {" plan", 1, 0}, {" steady", 0, 1}, {" steady plan", 1, 1}};
    for (size_t i = 0; i < 4; i++) {
        struct script s;
        char text[200];
        snprintf(text, sizeof text, "0 sar 46 11 5%s\n1 sarfrom 46 11 5 90 20000 3000%s\n",
                 cases[i].words, cases[i].words);
        assert_int_equal(read_text(&s, text), 0);
        for (int seconds = 0; seconds < 2; seconds++) {
            const struct lm_control c = at(&s, seconds);
            assert_int_equal(c.kind, LM_CONTROL_SAR);
            assert_int_equal(c.sar.is_plan, cases[i].is_plan);
            assert_int_equal(c.sar.is_steady, cases[i].is_steady);
            assert_int_equal(c.sar.is_from_ownship, seconds == 0);
        }
        script_free(&s);
    }
    struct script s;
    assert_int_equal(read_text(&s, "0 sar 46 11 5 upright\n"), -1);
}

TEST(a_slew_lasts_as_long_as_it_says)
{
    struct script s;
    assert_int_equal(read_text(&s, "0 slew 0.5 -1 2\n"), 0);
    struct lm_control c = at(&s, 0);
    assert_same_control(&c, lm_control_slew(500, -1000));
    assert_int_equal(at(&s, 1.99).kind, NOTHING);
    c = at(&s, 2);
    assert_same_control(&c, lm_control_slew(0, 0));
    script_free(&s);
}

TEST(rockers_and_knob_are_their_buttons_and_deflection)
{
    struct script s;
    assert_int_equal(read_text(&s, "0 rocker gain +1\n1 rocker con -1\n2 knob -0.25\n"), 0);
    assert_int_equal(at(&s, 0.5).button, lm_rocker_button(LM_ROCKER_GAIN, true));
    assert_int_equal(at(&s, 0.5).kind, LM_CONTROL_UP);
    assert_int_equal(at(&s, 1.5).button, lm_rocker_button(LM_ROCKER_CON, false));
    assert_int_equal(at(&s, 1.5).kind, LM_CONTROL_UP);
    const struct lm_control c = at(&s, 2);
    assert_same_control(&c, lm_control_knob(-250));
    script_free(&s);
}

TEST(the_buttons_of_the_rockers_are_all_different_and_follow_the_osbs)
{
    uint32_t seen = 0;
    for (int rocker = 0; rocker < LM_ROCKERS; rocker++) {
        for (int more = 0; more < 2; more++) {
            const int32_t button = lm_rocker_button((enum lm_rocker)rocker, more);
            assert_in_range(button, LM_OSBS + 1, LM_BUTTONS);
            seen |= 1u << (button - LM_OSBS - 1);
        }
    }
    assert_int_equal(seen, 0xFF);
}

TEST(a_mode_takes_any_of_its_fields_and_without_one_the_whole_sector)
{
    const struct lm_radar *radar = &lm_radar_default;
    for (int mode = 0; mode < LM_SECTOR_CHOICES; mode++) {
        const char *name = lm_radar_mode_name(radar, (uint32_t)mode);
        struct script s;
        char text[40];
        snprintf(text, sizeof text, "0 %s\n", name);
        assert_int_equal(read_text(&s, text), 0);
        const struct lm_control plain = at(&s, 0);
        assert_int_equal(plain.kind, LM_CONTROL_SECTOR);
        assert_int_equal(plain.sector.mode, mode);
        assert_int_equal(plain.sector.fov, LM_FOV_NORM);
        script_free(&s);
        for (int field = 0; field < LM_FOVS; field++) {
            snprintf(text, sizeof text, "0 %s %s\n", name, radar->fov[field].name);
            const bool has_field = field <= (int)lm_radar_fov_last(radar, (uint32_t)mode);
            assert_int_equal(read_text(&s, text), has_field ? 0 : -1);
            if (has_field) {
                const struct lm_control c = at(&s, 0);
                assert_int_equal(c.sector.mode, mode);
                assert_int_equal(c.sector.fov, field);
            }
            script_free(&s);
        }
    }
}

TEST(words_of_the_table_are_taken_in_small_letters)
{
    struct script s;
    assert_int_equal(read_text(&s, "0 gm dbs1\n1 GMT exp\n"), 0);
    assert_int_equal(at(&s, 0).sector.fov, LM_FOV_DBS1);
    assert_int_equal(at(&s, 1).sector.mode, LM_SECTOR_GMT);
    script_free(&s);
}

TEST(a_scale_is_one_of_the_tables_in_nautical_miles)
{
    struct script s;
    char text[40];
    for (uint32_t i = 0; i < lm_radar_default.ranges; i++) {
        snprintf(text, sizeof text, "0 range %u\n", (unsigned)lm_radar_default.range[i].range_nm);
        assert_int_equal(read_text(&s, text), 0);
        const struct lm_control c = at(&s, 0);
        assert_int_equal(c.kind, LM_CONTROL_RANGE);
        assert_int_equal(c.range_nm, lm_radar_default.range[i].range_nm);
        script_free(&s);
    }
    assert_int_equal(read_text(&s, "0 range 39\n"), -1);
    assert_int_equal(read_text(&s, "0 range 40.5\n"), -1);
    assert_int_equal(read_text(&s, "0 azimuth 30\n"), 0);
    assert_int_equal(at(&s, 0).azimuth_index, 1);
    script_free(&s);
    assert_int_equal(read_text(&s, "0 azimuth 31\n"), -1);
}

TEST(a_start_that_a_mode_does_not_have_is_refused)
{
    struct script s;
    assert_int_equal(read_text(&s, "0 sea dbs1\n"), -1);
    assert_int_equal(read_text(&s, "0 range 80\n1 gmt\n"), -1);
    assert_int_equal(read_text(&s, "0 gm dbs2\n1 range 80\n"), -1);
    assert_int_equal(read_text(&s, "0 range 80\n1 range 40\n2 gmt\n"), 0);
    script_free(&s);
    /* A key may have selected another scale: the unit will tell. */
    assert_int_equal(read_text(&s, "0 range 80\n1 osb 19\n2 gmt\n"), 0);
    script_free(&s);
}

TEST(a_steerpoint_is_a_place_or_off)
{
    struct script s;
    assert_int_equal(read_text(&s, "1 steer 45 -90.5\n2 steer off\n"), 0);
    struct lm_control c = at(&s, 1);
    assert_int_equal(c.kind, LM_CONTROL_STEERPOINT);
    assert_true(c.steerpoint.is_set);
    assert_int_equal(c.steerpoint.position.latitude, hs_bam(45));
    assert_int_equal(c.steerpoint.position.longitude, hs_bam(-90.5));
    c = at(&s, 2);
    assert_int_equal(c.kind, LM_CONTROL_STEERPOINT);
    assert_false(c.steerpoint.is_set);
    script_free(&s);
}

TEST(the_cursor_is_put_at_a_place)
{
    struct script s;
    assert_int_equal(read_text(&s, "1 cursor 45 -90.5\n"), 0);
    const struct lm_control c = at(&s, 1);
    assert_int_equal(c.kind, LM_CONTROL_CURSOR);
    assert_int_equal(c.cursor.latitude, hs_bam(45));
    assert_int_equal(c.cursor.longitude, hs_bam(-90.5));
    script_free(&s);
}

TEST(rain_and_jammers_add_up_until_the_weather_is_fair)
{
    struct script s;
    assert_int_equal(read_text(&s,
                               "1 rain 45 -90 10 30\n2 jam -45 90 12.5\n3 rain 0 0 0.1 150\n"
                               "4 seastate 6 -90\n5 weather fair\n6 jam 0 45 -20\n7 seastate 2\n"),
                     0);
    struct lm_environment e = at(&s, 1).environment;
    assert_int_equal(e.rain_count, 1);
    assert_int_equal(e.jammer_count, 0);
    assert_int_equal(e.sea_state, LM_SEA_STATE_OF_IMAGE);
    assert_false(e.is_sea_commanded);
    assert_int_equal(e.rain[0].centre.latitude, hs_bam(45));
    assert_int_equal(e.rain[0].centre.longitude, hs_bam(-90));
    assert_int_equal(e.rain[0].radius_m, 10000);
    assert_int_equal(e.rain[0].mm_per_h, 30);
    e = at(&s, 2).environment;
    assert_int_equal(e.rain_count, 1);
    assert_int_equal(e.jammer_count, 1);
    assert_int_equal(e.jammer[0].position.latitude, hs_bam(-45));
    assert_int_equal(e.jammer[0].position.longitude, hs_bam(90));
    assert_int_equal(e.jammer[0].noise_ratio_db_q8, 3200);
    e = at(&s, 3).environment;
    assert_int_equal(e.rain_count, 2);
    assert_int_equal(e.rain[1].radius_m, 100);
    e = at(&s, 4).environment;
    assert_int_equal(e.sea_state, 6);
    assert_true(e.is_sea_commanded);
    assert_int_equal(e.rain_count, 2);
    e = at(&s, 5).environment;
    assert_int_equal(e.rain_count + e.jammer_count, 0);
    assert_int_equal(e.sea_state, 6); /* the sea outlasts the weather */
    assert_true(e.has_wind);
    assert_int_equal(e.wind_from, hs_bam(270));
    e = at(&s, 6).environment;
    assert_int_equal(e.jammer_count, 1);
    assert_int_equal(e.jammer[0].noise_ratio_db_q8, -5120);
    assert_int_equal(lm_environment_check(&e), LM_OK);
    e = at(&s, 7).environment;
    assert_int_equal(e.sea_state, 2);
    assert_false(e.has_wind); /* nobody says where it comes from now */
    script_free(&s);
}

/* `count` times the line, and whether a script of it is accepted. */
static bool is_accepted(const char *line, int count)
{
    char text[1000] = "";
    for (int i = 0; i < count; i++) {
        strcat(text, line);
    }
    struct script s;
    const bool is_read = read_text(&s, text) == 0;
    script_free(&s);
    return is_read;
}

TEST(there_is_no_more_rain_and_jamming_than_the_unit_has_room_for)
{
    freopen("/dev/null", "w", stderr);
    assert_true(is_accepted("0 rain 1 2 3 4\n", LM_RAINS_MAX));
    assert_false(is_accepted("0 rain 1 2 3 4\n", LM_RAINS_MAX + 1));
    assert_true(is_accepted("0 jam 1 2 3\n", LM_JAMMERS_MAX));
    assert_false(is_accepted("0 jam 1 2 3\n", LM_JAMMERS_MAX + 1));
    assert_true(is_accepted("0 rain 1 2 3 4\n0 weather fair\n", LM_RAINS_MAX + 1));
}

TEST(what_a_script_says_of_an_exercise_is_for_the_bus_and_no_control)
{
    struct script s;
    assert_int_equal(read_text(&s,
                               "2.5 clock 100 4711\n3 break lost-sector=-30,10 4\n4 clock rate 0\n"
                               "5 break no-transmit\n6 designate\n"),
                     0);
    assert_int_equal(s.count, 1);
    assert_int_equal(at(&s, 6).kind, LM_CONTROL_DESIGNATE);
    const struct nav_exercise *x = &s.exercise;
    assert_true(x->has_clock && x->has_seed);
    assert_int_equal(x->seed, 4711);
    assert_true(nav_exercise_ms(x, 2.5) == 100000 && nav_exercise_ms(x, 9) == 101500);
    assert_int_equal(x->malfunction_count, 2);
    assert_int_equal(x->malfunction[0].number, LM_MALFUNCTION_LOST_FROM);
    assert_true(x->malfunction[0].from_s == 3 && x->malfunction[0].until_s == 7);
    assert_true(x->malfunction[0].value[0] == -30 && x->malfunction[0].value[1] == 10);
    assert_int_equal(x->malfunction[1].number, LM_MALFUNCTION_NO_TRANSMIT);
    assert_true(x->malfunction[1].from_s == 5 && isinf(x->malfunction[1].until_s));
    script_free(&s);
}

TEST(there_are_no_more_malfunctions_and_rates_than_room)
{
    freopen("/dev/null", "w", stderr);
    assert_true(is_accepted("0 break noise=6\n", NAV_MALFUNCTIONS));
    assert_false(is_accepted("0 break noise=6\n", NAV_MALFUNCTIONS + 1));
    char text[400] = "0 clock 0\n";
    for (int i = 1; i < NAV_EXERCISE_RATES; i++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d clock rate 2\n", i);
    }
    assert_true(is_accepted(text, 1));
    strcat(text, "9 clock rate 2\n");
    assert_false(is_accepted(text, 1));
}

TEST(commands_that_are_none_are_refused)
{
    const char *const bad[] = {"0 clock\n",
                               "0 clock -1\n",
                               "0 clock 2147484\n",
                               "0 clock 1 -1\n",
                               "0 clock 1 0.5\n",
                               "0 clock 1 2 3\n",
                               "0 clock 1\n1 clock 1\n",
                               "0 clock rate 1\n",
                               "0 clock 1\n1 clock rate\n",
                               "0 clock 1\n1 clock rate 17\n",
                               "0 clock 1\n1 clock rate -1\n",
                               "0 clock 1\n1 clock rate nan\n",
                               "0 clock 1\n1 clock rate 1 1\n",
                               "0 clock 1\n0 clock rate 2\n",
                               "0 break\n",
                               "0 break heart\n",
                               "0 break noise\n",
                               "0 break noise=61\n",
                               "0 break noise=6 0\n",
                               "0 break noise=6 nan\n",
                               "0 break noise=6@1\n",
                               "0 break noise=6 1 1\n",
                               "0 break lost-sector=10,-10\n",
                               "0 break dead-key=29\n",
                               "0 break noise=6666666666666666666666666666666666666666\n",
                               "0 osb\n",
                               "0 osb 0\n",
                               "0 osb 21\n",
                               "0 osb 1.5\n",
                               "0 osb 1 -1\n",
                               "0 osb 1 1 1\n",
                               "0 rocker gain\n",
                               "0 rocker gain 1\n",
                               "0 rocker hue +1\n",
                               "0 knob\n",
                               "0 knob 1.1\n",
                               "0 slew 1 1\n",
                               "0 slew 2 0 1\n",
                               "0 slew 0 0 -1\n",
                               "0 slew nan 0 1\n",
                               "0 designate 1\n",
                               "0 drop it\n",
                               "1 osb 1\n0 osb 1\n",
                               "0 slew 0 0 1 1\n",
                               "0 osb 1x\n",
                               "0 gm dbs3\n",
                               "0 gm norm exp\n",
                               "0 sea of\n",
                               "0 gmtx\n",
                               "0 dbs1\n",
                               "0 rain\n",
                               "0 rain 91 0 1 1\n",
                               "0 rain 0 181 1 1\n",
                               "0 rain 0 0 0.09 1\n",
                               "0 rain 0 0 101 1\n",
                               "0 rain 0 0 1 0.9\n",
                               "0 rain 0 0 1 151\n",
                               "0 rain 0 0 1\n",
                               "0 rain 0 0 1 1 1\n",
                               "0 rain nan 0 1 1\n",
                               "0 jam 0 0\n",
                               "0 jam 0 0 81\n",
                               "0 jam 0 0 -21\n",
                               "0 jam -91 0 1\n",
                               "0 jam 0 0 1 1\n",
                               "0 jam 0 0 x\n",
                               "0 cursor\n",
                               "0 cursor 91 0\n",
                               "0 cursor 45 9 1\n",
                               "0 steer\n",
                               "0 steer on\n",
                               "0 steer 91 0\n",
                               "0 steer 45\n",
                               "0 steer 45 9 1\n",
                               "0 weather\n",
                               "0 weather foul\n",
                               "0 weather fair 1\n",
                               "0 seastate\n",
                               "0 seastate 9\n",
                               "0 seastate -1\n",
                               "0 seastate 2.5\n",
                               "0 seastate 1 361\n",
                               "0 seastate 1 1 1\n"};
    freopen("/dev/null", "w", stderr);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct script s;
        if (read_text(&s, bad[i]) == 0) {
            fail_msg("accepted: %s", bad[i]);
        }
    }
}
