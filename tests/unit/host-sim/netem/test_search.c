/* Finding from where a chip was taken, and what is known of the chips. */
#include "check.h"
#include "netem/chip_list.h"
#include "netem/dataset.h"
#include "netem/search.h"
#include "netem/target_view.h"
#include "support.h"

#include "hs/rng.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { VIEWS = 36, SIDE = 24, CHIP = 40 };

/* A bar of blobs that turns with the view: a little longer and brighter to one side. */
static void draw_bar(double *picture, int side, double middle, double degrees, double x0, double y0)
{
    const double turn = degrees * 0.0174532925199433;
    for (int i = 0; i < side * side; i++) {
        const double x = i % side - middle - x0, y = i / side - middle - y0;
        const double along = x * cos(turn) + y * sin(turn), off = -x * sin(turn) + y * cos(turn);
        const double inside = along > -6 && along < 8 ? 1 : 0;
        picture[i] = 0.1 + inside * (0.3 + 0.03 * along) * exp(-off * off / 3);
    }
}

static void fill_library(struct nm_library *l)
{
    assert_int_equal(nm_library_open(l, VIEWS, SIDE), 0);
    for (int v = 0; v < VIEWS; v++) {
        draw_bar(l->pictures + (size_t)v * SIDE * SIDE, SIDE, SIDE / 2.0, v * 360.0 / VIEWS, 0, 0);
    }
}

TEST(azimuth_and_place_of_a_noisy_chip_are_found)
{
    struct nm_library library;
    struct nm_searcher s;
    struct nm_match match;
    struct nm_picture chip;
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    fill_library(&library);
    assert_int_equal(nm_searcher_open(&s, &library, CHIP, CHIP), 0);
    assert_int_equal(nm_match_open(&match, VIEWS), 0);
    assert_int_equal(nm_picture_open(&chip, CHIP, CHIP), 0);
    for (int v = 0; v < VIEWS; v++) {
        const int dx = (int)hs_rng_below(&rng, 9) - 4, dy = (int)hs_rng_below(&rng, 9) - 4;
        draw_bar(chip.pixels, CHIP, CHIP / 2.0, v * 360.0 / VIEWS, dx, dy);
        for (int i = 0; i < CHIP * CHIP; i++) {
            chip.pixels[i] = 3 * (chip.pixels[i] + 0.05 * hs_rng_normal(&rng));
        }
        int chosen;
        nm_search(&s, &chip, 6, &match);
        nm_choose_alone(&match, 1, VIEWS, &chosen);
        assert_int_equal(chosen, v);
        assert_int_equal(match.origins[v].x, (CHIP - SIDE) / 2 + dx);
        assert_int_equal(match.origins[v].y, (CHIP - SIDE) / 2 + dy);
        assert_true(match.scores[v] > 0.7 && match.scores[v] <= 1);
    }
    nm_picture_close(&chip);
    nm_match_close(&match);
    nm_searcher_close(&s);
    nm_library_close(&library);
}

/* Without noise the correlation coefficient of the right place is 1 whatever the brightness. */
TEST(the_score_of_a_perfect_match_is_one)
{
    struct nm_library library;
    struct nm_searcher s;
    struct nm_match match;
    struct nm_picture chip;
    fill_library(&library);
    assert_int_equal(nm_searcher_open(&s, &library, SIDE, SIDE), 0);
    assert_int_equal(nm_match_open(&match, VIEWS), 0);
    assert_int_equal(nm_picture_open(&chip, SIDE, SIDE), 0);
    for (int i = 0; i < SIDE * SIDE; i++) {
        chip.pixels[i] = 5 * library.pictures[7 * SIDE * SIDE + i] + 2;
    }
    nm_search(&s, &chip, 3, &match);
    assert_true(fabs(match.scores[7] - 1) < 1e-9);
    assert_int_equal(nm_searcher_open(&(struct nm_searcher){0}, &library, SIDE - 1, SIDE), -1);
    nm_picture_close(&chip);
    nm_match_close(&match);
    nm_searcher_close(&s);
    nm_library_close(&library);
}

/* Scores that cannot tell a view from its opposite, the wrong one winning in a third of the chips.
 */
TEST(neighbours_tell_the_front_from_the_back)
{
    enum { CHIPS = 60, TURNS = 72 };
    struct nm_match matches[CHIPS];
    struct hs_rng rng;
    int truth[CHIPS], alone[CHIPS], in_order[CHIPS], wrong = 0;
    double step_deg;
    hs_rng_seed(&rng, 9);
    double azimuth = 200;
    for (int i = 0; i < CHIPS; i++) {
        azimuth += i == 35 ? 123 : -7 + 2 * hs_rng_normal(&rng);
        truth[i] = (int)lround((azimuth + 3600) / (360.0 / TURNS)) % TURNS;
        assert_int_equal(nm_match_open(&matches[i], TURNS), 0);
        const double opposite = hs_rng_below(&rng, 3) == 0 ? 1.05 : 0.85;
        for (int v = 0; v < TURNS; v++) {
            const double off = (v - truth[i]) * 6.283185307 / TURNS;
            matches[i].scores[v] =
                0.5 + 0.2 * fmax(exp(3 * cos(off) - 3), opposite * exp(-3 * cos(off) - 3));
        }
    }
    nm_choose_alone(matches, CHIPS, TURNS, alone);
    assert_int_equal(nm_choose_in_order(matches, CHIPS, TURNS, in_order, &step_deg), 0);
    for (int i = 0; i < CHIPS; i++) {
        wrong += abs(alone[i] - truth[i]) > 9 && abs(alone[i] - truth[i]) < TURNS - 9;
        const int off = abs(in_order[i] - truth[i]);
        assert_true(off <= 2 || off >= TURNS - 2);
        nm_match_close(&matches[i]);
    }
    assert_true(wrong > 10);
    assert_true(step_deg < -4 && step_deg > -11);
}

static int write_list(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    fputs(text, f);
    return fclose(f);
}

TEST(a_list_of_chips_is_read_back_as_it_was_written)
{
    char path[] = "/tmp/landmass-list-XXXXXX";
    struct nm_chip_list list, again;
    close(mkstemp(path));
    write_list(path,
               "# remark\na.png\nb.csv 282.95 15.04\n/c/d.017\t- - 3 -4 0.5 validation # x\n"
               "e 10 30 0 0 - training\n");
    assert_int_equal(nm_chip_list_read(&list, path), 0);
    assert_int_equal(list.count, 4);
    assert_string_equal(list.entries[0].path, "/tmp/a.png");
    assert_true(isnan(list.entries[0].azimuth_deg) && list.entries[0].set == NM_SET_OPEN);
    assert_true(list.entries[1].azimuth_deg == 282.95 && list.entries[1].depression_deg == 15.04);
    assert_string_equal(list.entries[2].path, "/c/d.017");
    assert_int_equal(list.entries[2].shift_x, 3);
    assert_int_equal(list.entries[2].shift_y, -4);
    assert_true(list.entries[2].gain == 0.5 && list.entries[2].set == NM_SET_VALIDATION);
    assert_true(isnan(list.entries[3].gain) && list.entries[3].set == NM_SET_TRAINING);
    assert_int_equal(nm_chip_list_write(&list, path, "again"), 0);
    assert_int_equal(nm_chip_list_read(&again, path), 0);
    assert_int_equal(again.count, 4);
    for (int i = 0; i < 4; i++) {
        assert_string_equal(again.entries[i].path, list.entries[i].path);
        assert_int_equal(again.entries[i].set, list.entries[i].set);
        assert_int_equal(again.entries[i].shift_y, list.entries[i].shift_y);
    }
    nm_chip_list_free(&list);
    nm_chip_list_free(&again);
    unlink(path);
}

TEST(a_list_that_makes_no_sense_is_refused)
{
    static const char *const wrong[] = {"",
                                        "a 1\n",
                                        "a 1 2 3\n",
                                        "a x 15\n",
                                        "a 10 95\n",
                                        "a 10 nan\n",
                                        "a 1 15 1 1 0\n",
                                        "a 1 15 9999 0\n",
                                        "a 1 15 0 0 1 both\n",
                                        "a 1 15 0 0 1 training more\n"};
    char path[] = "/tmp/landmass-list-XXXXXX";
    close(mkstemp(path));
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct nm_chip_list list;
        write_list(path, wrong[i]);
        if (nm_chip_list_read(&list, path) != -1) {
            fail_msg("accepted: %s", wrong[i]);
        }
    }
    unlink(path);
}

TEST(a_chip_is_turned_and_calibrated_by_its_clutter)
{
    char path[] = "/tmp/landmass-chip-XXXXXX.csv";
    struct nm_chip chip;
    close(mkstemps(path, 4));
    FILE *f = fopen(path, "w");
    for (int i = 0; i < 64; i++) {
        const int is_frame = i / 8 == 0 || i / 8 == 7 || i % 8 == 0 || i % 8 == 7;
        fprintf(f, "%g%c", is_frame ? 20.0 : i / 8 == 1 ? 400.0 : 0.0, i % 8 == 7 ? '\n' : ',');
    }
    fclose(f);
    struct nm_chip_entry e = {path, 30, 15, 0, 0, NAN, NM_SET_OPEN};
    const struct nm_calibration c = {.gain = NAN, .clutter = 0.05};
    assert_int_equal(nm_dataset_chip(&chip, &e, &c), 0);
    assert_true(fabs(e.gain - 0.0025) < 1e-12);
    assert_true(fabs(chip.picture.pixels[0] - tanh(0.05)) < 1e-12);
    assert_true(fabs(chip.picture.pixels[6 * 8 + 3] - tanh(1)) < 1e-12);
    assert_true(chip.picture.pixels[1 * 8 + 3] == 0);
    assert_true(chip.azimuth_deg == 30 && chip.depression_deg == 15);
    nm_picture_close(&chip.picture);
    unlink(path);
}

/* The file is that of the paper's authors. Its band is 72 of 107: a Taylor response of -35 dB whose
 * first nulls lie 107 / 72 samples apart. With 0.3 m between -3 dB points that is a spacing of 0.17
 * m, not of the 0.1 m cells that it is laid over there; ours is as wide as the radar's. */
TEST(the_kernel_of_the_papers_authors_is_ours_at_another_width)
{
    static double kernel[NM_LARGE * NM_LARGE];
    char path[512];
    if (!support_data_path("slicy/Impt108.csv", path, sizeof path)) {
        skip();
    }
    struct nm_chip theirs;
    assert_int_equal(nm_chip_read(&theirs, path), 0);
    assert_int_equal(theirs.picture.width, NM_LARGE);
    const double peak = theirs.picture.pixels[NM_LARGE * NM_LARGE / 2];
    nm_kernel_make(1.184 * NM_LARGE / 72, 1, 1, kernel);
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        assert_true(fabs(kernel[i] - theirs.picture.pixels[i] / peak) < 1e-6);
    }
    nm_picture_close(&theirs.picture);
}

TEST(the_fixed_kernel_is_as_wide_as_the_radars_resolution)
{
    static double kernel[NM_LARGE * NM_LARGE];
    nm_kernel_make(0.3, 0.1, 2, kernel);
    const double *line = kernel + NM_LARGE / 2 * NM_LARGE + NM_LARGE / 2;
    assert_true(line[0] == 2);
    /* 1.5 cells from the middle the power is half. */
    const double half = (line[1] * line[1] + line[2] * line[2]) / 2 / 4;
    assert_true(fabs(half - 0.5) < 0.03);
}

/* sqrt(4 pi) A / wavelength: RCS of a flat plate of 1 m^2 at 3 cm is 13963 m^2. */
TEST(the_kernels_gain_is_the_root_of_a_plates_cross_section)
{
    assert_true(fabs(pow(nm_kernel_gain(1, 0.03), 2) - 13962.6) < 0.1);
}
