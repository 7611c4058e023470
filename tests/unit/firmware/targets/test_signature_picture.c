/* Targets with a signature in the pictures: a patch, the lines of a window, a sweep. */
#include "check.h"
#include "reference/reference.h"
#include "signature_image.h"

#include "lm/sar.h"
#include "lm/sector.h"
#include "lm/target_line.h"
#include "scales.h"

#include <stdlib.h>

enum { SIDE = 256, CELL_MM = 1000 };

static const double degree = 3.14159265358979323846 / 180;
static const double range_m = 20000, height_m = 6000; /* 16.7 degrees: the first depression */

struct fixture {
    struct signature_world world; /* first: see tear_down_signature_world */
    struct lm_radar radar;
    struct lm_sar sar;
    struct lm_line line;
    struct lm_tone tone;
    uint32_t cell_mm; /* of the patch: CELL_MM unless a test wants others */
    int16_t bare[SIDE][SIDE], picture[SIDE][SIDE];
};

/* Levels of a patch around 46 N 11 E, seen from the west. */
static void draw_patch(struct fixture *f, const struct lm_target_set *set,
                       int16_t picture[SIDE][SIDE])
{
    const struct lm_sar_command command = {.centre = {hs_bam(46), hs_bam(11)},
                                           .range_m = (uint32_t)range_m,
                                           .height_m_q6 = (int32_t)(height_m * 64),
                                           .look_azimuth = hs_bam(90),
                                           .cell_mm = f->cell_mm};
    const struct lm_sar_setup scene = {
        .targets = set, .chips = &f->world.chips, .epoch = 5, .sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_sar_start(&f->sar, &f->radar, &f->world.db, &command, &scene), LM_OK);
    lm_sar_prefetch_targets(&f->sar, &f->world.tiles);
    assert_true(serve_chips(&f->world));
    /* Of the lines, which are more than cells, those in the middle. */
    const int beside = ((int)f->sar.lines - SIDE) / 2;
    for (int k = -beside; k < SIDE + beside; k++) {
        const int16_t *level_q8 = lm_sar_draw_line(&f->sar, &f->world.tiles, &f->tone, &f->line);
        if (k >= 0 && k < SIDE) {
            memcpy(picture[k], level_q8, sizeof picture[k]);
        }
    }
}

static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    f->radar = lm_radar_default;
    f->cell_mm = CELL_MM;
    spec.shift0 = 12;
    spec.rows = spec.columns = 4;
    assert_int_equal(open_signature_world(&f->world, &spec), 0);
    assert_int_equal(lm_tone_set(&f->tone, &lm_radar_default.sar.tone), LM_OK);
    /* Once for the tiles: where they are not there yet, an ancestor answers. */
    const struct lm_target_set none = {0};
    draw_patch(f, &none, f->bare);
    while (!lm_tile_cache_is_idle(&f->world.tiles)) {
        lm_tile_cache_service(&f->world.tiles, 0, 2);
    }
    *state = f;
    return 0;
}

/* Power that a target adds within `reach` cells of a place, and its middle. Both pictures have the
 * same speckle, which is the last thing to be put on them: so what the target adds, against the
 * soil's own power, is the ratio of the two. */
struct found {
    double power, line, cell;
};

static struct found find(const struct fixture *f, double line, double cell, int reach)
{
    struct found found = {0, 0, 0};
    double soil = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        soil += pow(10, f->bare[k / SIDE][k % SIDE] / 2560.0) / (SIDE * SIDE);
    }
    for (int l = (int)line - reach; l <= (int)line + reach + 1; l++) {
        for (int c = (int)cell - reach; c <= (int)cell + reach + 1; c++) {
            const double more = soil * (pow(10, (f->picture[l][c] - f->bare[l][c]) / 2560.0) - 1);
            found.power += more;
            found.line += l * more;
            found.cell += c * more;
        }
    }
    found.line /= found.power;
    found.cell /= found.power;
    return found;
}

static double clutter_db(double width_m, double length_m, double at_m)
{
    const struct ref_view view = {height_m, 0, length_m};
    return 10 * log10(width_m * length_m * ref_grazing(&view, at_m, at_m - length_m));
}

TEST_WITH(corners_are_where_they_stand_and_as_bright_from_every_side, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const double cell_m = CELL_MM / 1000.0, centre = (SIDE - 1) / 2.0;
    const struct lm_target_set none = {0};
    double worst_place = 0, worst_level = 0;
    draw_patch(f, &none, f->bare);
    for (int k = 0; k < 24; k++) {
        const double heading = k * 37;
        const struct lm_target t = target_with_signature(46, 11, heading);
        const struct lm_target_set set = set_with_signature(&f->world, &t, 1);
        draw_patch(f, &set, f->picture);
        for (int i = 0; i < CORNERS; i++) {
            double right_m, beyond_m;
            corner_place(&corners[i], (270 - heading) * degree, &right_m, &beyond_m);
            /* Lines are centred on the patch; cells count from its near edge. */
            const double line = centre + right_m / cell_m;
            const double cell = SIDE / 2.0 - 0.5 + beyond_m / cell_m;
            const struct found found = find(f, line, cell, 2);
            const double level =
                10 * log10(found.power) - (corners[i].dbsm - clutter_db(1, 1, range_m));
            worst_place = fmax(worst_place, hypot(found.line - line, found.cell - cell));
            worst_level = fmax(worst_level, fabs(level));
        }
    }
    print_message("# places within %.2f cells, levels within %.2f dB\n", worst_place, worst_level);
    assert_true(worst_place < 0.75); /* the chip is reduced to pixels of a cell */
    assert_true(worst_level < 0.1);
}

TEST_WITH(its_shadow_lies_behind_it_and_nowhere_else, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target_set none = {0};
    const struct lm_target t = target_with_signature(46, 11, 270);
    const struct lm_target_set set = set_with_signature(&f->world, &t, 1);
    draw_patch(f, &none, f->bare);
    draw_patch(f, &set, f->picture);
    double dark = 0;
    int inside = 0;
    for (int l = 0; l < SIDE; l++) {
        for (int c = 0; c < SIDE; c++) {
            /* From the origin: 6 m wide, from 1 to 12 m beyond; the corners are 6 m from it. */
            const double right_m = l - (SIDE - 1) / 2.0, beyond_m = c - (SIDE - 1) / 2.0;
            if (fabs(right_m) < 2 && beyond_m > 7.5 && beyond_m < 11) {
                dark += (f->bare[l][c] - f->picture[l][c]) / 256.0;
                inside++;
            } else if (fabs(right_m) > 19 || beyond_m < -19 || beyond_m > 19) {
                /* Beyond the side lobes, too. The floor of the patch is a little higher by what the
                 * target leaves in it. */
                assert_in_range(f->picture[l][c] - f->bare[l][c] + 26, 0, 52);
            }
        }
    }
    /* A soil whose floor is 17 dB below it. */
    assert_true(inside > 8 && dark / inside > 12);
}

/* Levels of all lines of a patch in dB. Returns how many there are. */
static size_t draw_all(struct fixture *f, const struct lm_target_set *set, double *level_db,
                       double *shadow_db)
{
    draw_patch(f, set, f->picture); /* for its chip */
    const struct lm_sar_command command = f->sar.command;
    const struct lm_sar_setup scene = {
        .targets = set, .chips = &f->world.chips, .epoch = 5, .sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_sar_start(&f->sar, &f->radar, &f->world.db, &command, &scene), LM_OK);
    assert_true(f->sar.lines <= LM_PATCH_LINES_MAX);
    for (uint32_t k = 0; k < f->sar.lines; k++) {
        const int16_t *level_q8 = lm_sar_draw_line(&f->sar, &f->world.tiles, &f->tone, &f->line);
        shadow_db[k] = f->sar.shadow_db_q8 / 256.0;
        for (int c = 0; c < SIDE; c++) {
            level_db[k * SIDE + (uint32_t)c] = level_q8[c] / 256.0;
        }
    }
    return f->sar.lines;
}

/* A chip is baked without the radar's response, so its strong points have the side lobes that
 * strong ground has: those that the reference gives the picture without any. */
TEST_WITH(strong_points_of_a_chip_have_side_lobes, set_up, tear_down_signature_world)
{
    enum { MOST = LM_PATCH_LINES_MAX * SIDE };
    static double wanted_db[MOST], found_db[MOST], before_db[MOST], shadow_db[LM_PATCH_LINES_MAX];
    struct fixture *f = *state;
    const struct lm_target t = target_with_signature(46, 11, 20);
    const struct lm_target_set set = set_with_signature(&f->world, &t, 1);
    const struct lm_side_lobe_config *config = &lm_radar_default.sar.side_lobes;
    const struct ref_side_lobes law = {config->over_shadow_db_q8 / 256.0,
                                       config->above_db_q8 / 256.0, config->a_line};
    int raised = 0;
    f->radar.sar.side_lobes.a_line = 0;
    size_t lines = draw_all(f, &set, before_db, shadow_db);
    memcpy(wanted_db, before_db, sizeof wanted_db);
    assert_int_equal(ref_side_lobes(&law, wanted_db, shadow_db, lines, SIDE, hs_bam(11)), 0);
    f->radar.sar.side_lobes = *config;
    lines = draw_all(f, &set, found_db, shadow_db);
    for (size_t i = 0; i < lines * SIDE; i++) {
        assert_true(fabs(found_db[i] - wanted_db[i]) < 0.5);
        raised += wanted_db[i] - before_db[i] > 3;
    }
    assert_true(raised > 20);
}

TEST_WITH(a_target_behind_the_horizon_shows_neither_itself_nor_its_shadow, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target_set none = {0};
    struct lm_target t = target_with_signature(46, 11, 45);
    const struct lm_target_set set = set_with_signature(&f->world, &t, 1);
    draw_patch(f, &none, f->bare);
    for (int is_hidden = 0; is_hidden < 2; is_hidden++) {
        t.elevation_m_q6 = is_hidden ? -4 * 64 : -2 * 64; /* it is 3 m high */
        seal_target(&t);
        draw_patch(f, &set, f->picture);
        assert_int_equal(memcmp(f->bare, f->picture, sizeof f->bare) == 0, is_hidden);
    }
}

TEST_WITH(a_mover_is_displaced_and_its_shadow_stays, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target_set none = {0};
    struct lm_target t = target_with_signature(46, 11, 270);
    t.speed_mm_s = 500; /* towards the radar: 20,000 m * 0.5 / 250 are 40 m to the left */
    t.leg_m = 1;
    seal_target(&t);
    const struct lm_target_set set = set_with_signature(&f->world, &t, 1);
    draw_patch(f, &none, f->bare);
    draw_patch(f, &set, f->picture);
    const struct found found = find(f, 127.5 - 40, 127.5, 12);
    assert_true(fabs(found.line - (127.5 - 40)) < 1.5);
    assert_true(f->picture[127][137] < f->bare[127][137] - 10 * 256);
    assert_true(f->picture[87][141] == f->bare[87][141]);
}

TEST_WITH(a_line_with_too_much_of_chips_leaves_whole_ones_out_and_counts_their_cells, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    struct lm_target crowd[LM_TARGET_CANDIDATES_MAX];
    f->radar.sar.cell_min_mm = f->cell_mm = 300; /* finer than the table: the chip spans more */
    for (uint32_t i = 0; i < LM_TARGET_CANDIDATES_MAX; i++) {
        crowd[i] = target_with_signature(46, 11, 270);
    }
    const struct lm_target_set few = set_with_signature(&f->world, crowd, 2);
    draw_patch(f, &few, f->bare);
    assert_int_equal(f->world.chips.count.cells_left_out, 0);
    const struct lm_target_set all = set_with_signature(&f->world, crowd, LM_TARGET_CANDIDATES_MAX);
    draw_patch(f, &all, f->picture);
    const uint32_t once = f->world.chips.count.cells_left_out;
    print_message("# %u cells of %d targets left out\n", once, LM_TARGET_CANDIDATES_MAX);
    assert_true(once > 0);
    draw_patch(f, &all, f->picture);
    assert_int_equal(f->world.chips.count.cells_left_out, 2 * once);
}

/* ---- lines ---- */

enum { LINES = 33, CELLS = 128 };
static const double cell_m = 2, spacing_m = 4;

static struct lm_target_line line_of(int k)
{
    const double width = spacing_m / range_m * 4294967296.0 / (360 * degree);
    return (struct lm_target_line){
        .position = {hs_bam(46), hs_bam(11)},
        .azimuth = hs_bam(90) + (fx_bam_t)(int32_t)lround(width * (k - LINES / 2)),
        .width = (fx_bam_t)lround(width),
        .first_m_q8 = (uint32_t)lround((range_m - CELLS / 2 * cell_m) * 256),
        .cell_m_q8 = (uint32_t)(cell_m * 256),
        .cells = CELLS,
        .height_m_q10 = (int32_t)(height_m * 1024),
        .wavelength_um = X_BAND_UM};
}

static void near_of(struct fixture *f, const struct lm_target *t, bool has_chips,
                    struct lm_target_candidates *candidates)
{
    const struct lm_target_set set = set_with_signature(&f->world, t, 1);
    const struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = 30000};
    const struct lm_chip_query chips = {.centre = {t->latitude, t->longitude},
                                        .reach_m = 500,
                                        .radar = scene.position,
                                        .heights = {(int32_t)(height_m * 1024), 0},
                                        .cell_mm = PIXEL_MM, /* not reduced: places are exact */
                                        .side_most = LM_CHIP_SIDE};
    lm_target_candidates_select(candidates, &set, &scene);
    if (has_chips) {
        lm_chips_choose(&f->world.chips, candidates, &chips);
        assert_true(serve_chips(&f->world));
        assert_non_null(lm_chip_of(&candidates->candidate[0]));
    }
}

/* A place so far to the east and to the south of 46 N 11 E. */
static struct lm_target target_beyond(double east_m, double south_m, double heading)
{
    struct lm_geo_origin o;
    lm_geo_set_origin(&o, (struct lm_position){hs_bam(46), hs_bam(11)});
    const struct lm_position p = lm_geo_direct(
        &o, hs_bam(90) + (fx_bam_t)(int32_t)lround(south_m / east_m / degree * 4294967296.0 / 360),
        (uint32_t)lround(east_m * 256));
    struct lm_target t = target_with_signature(0, 0, heading);
    t.latitude = p.latitude;
    t.longitude = p.longitude;
    seal_target(&t);
    return t;
}

TEST_WITH(the_lines_of_a_window_share_a_chip_without_loss, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    double worst_level = 0, worst_place_m = 0, worst_dark = 0;
    for (int k = 0; k < 24; k++) {
        const double heading = k * 31, right_m = -20 + 1.7 * k, beyond_m = 1.3 * k - 15;
        const struct lm_target t = target_beyond(range_m + beyond_m, right_m, heading);
        struct lm_target_candidates candidates;
        double power = 0, across = 0, along = 0, dark_m2 = 0, truth[3] = {0};
        near_of(f, &t, true, &candidates);
        for (int l = 0; l < LINES; l++) {
            const struct lm_target_line line = line_of(l);
            int16_t level_q8[CELLS], bright_q8[CELLS];
            for (int c = 0; c < CELLS; c++) {
                level_q8[c] = -100 * 256;
                bright_q8[c] = 80 * 256; /* beside which the target is nothing */
            }
            lm_target_line_add(&candidates, &line, NULL, level_q8);
            lm_target_line_add(&candidates, &line, NULL, bright_q8);
            for (int c = 0; c < CELLS; c++) {
                const double p = pow(10, level_q8[c] / 2560.0);
                power += p;
                across += p * (l - LINES / 2) * spacing_m;
                along += p * (c - CELLS / 2) * cell_m;
                dark_m2 += (1 - pow(10, bright_q8[c] / 2560.0 - 8)) * cell_m * spacing_m;
            }
        }
        for (int i = 0; i < CORNERS; i++) {
            double r, b;
            corner_place(&corners[i], (270 - heading) * degree, &r, &b);
            const double p = pow(10, corners[i].dbsm / 10);
            truth[0] += p;
            truth[1] += p * (right_m + r);
            truth[2] += p * (beyond_m + b);
        }
        const double level = 10 * log10(power / truth[0]) + clutter_db(spacing_m, cell_m, range_m);
        worst_level = fmax(worst_level, fabs(level));
        worst_place_m = fmax(worst_place_m, hypot(across / power - truth[1] / truth[0],
                                                  along / power - truth[2] / truth[0]));
        worst_dark = fmax(worst_dark, fabs(dark_m2 / 66 - 1));
    }
    print_message("# levels within %.2f dB, places within %.2f m, shadow within %.1f %%\n",
                  worst_level, worst_place_m, 100 * worst_dark);
    assert_true(worst_level < 0.2);
    assert_true(worst_place_m < 0.3);
    assert_true(worst_dark < 0.06);
}

/* A ship's pixels are larger than the cells of a window, and its chip longer than LM_CHIP_SPAN of
 * them from corner to corner; what is not empty fits. */
TEST_WITH(a_chip_whose_pixels_are_larger_than_cells_is_shown_whole, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const double wide_m = 16, long_m = 4;
    f->world.signature.pixel_mm = (uint32_t)(wide_m * 1000);
    for (int k = 0; k < 8; k++) {
        const struct lm_target t = target_beyond(range_m, 0, k * 45);
        struct lm_target_candidates candidates;
        double power = 0;
        near_of(f, &t, true, &candidates);
        for (int l = 0; l < LINES; l++) {
            struct lm_target_line line = line_of(l);
            int16_t level_q8[CELLS];
            line.width *= (fx_bam_t)(wide_m / spacing_m);
            line.azimuth = hs_bam(90) + (fx_bam_t)((l - LINES / 2) * (int32_t)line.width);
            line.cell_m_q8 = (uint32_t)(long_m * 256);
            line.first_m_q8 = (uint32_t)lround((range_m - CELLS / 2 * long_m) * 256);
            for (int c = 0; c < CELLS; c++) {
                level_q8[c] = -100 * 256;
            }
            lm_target_line_add(&candidates, &line, NULL, level_q8);
            for (int c = 0; c < CELLS; c++) {
                power += pow(10, level_q8[c] / 2560.0);
            }
        }
        assert_true(fabs(10 * log10(power) + clutter_db(wide_m, long_m, range_m) - 22.5) < 0.2);
    }
}

/* Lines that pass by a target are told from its slack: of the largest pixels, a chip's corners are
 * 1.1 km from the target. */
TEST_WITH(the_slack_of_a_target_holds_the_corners_of_its_chip, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target t = target_beyond(range_m, 0, 0);
    const struct lm_target_query scene = {.position = {t.latitude, t.longitude}, .reach_m = 1000};
    struct lm_target_set set = set_with_signature(&f->world, &t, 1);
    struct lm_signature large = set.signatures[0];
    struct lm_target_candidates candidates;
    large.pixel_mm = LM_SIGNATURE_PIXEL_MAX_MM;
    set.signatures = &large;
    lm_target_candidates_select(&candidates, &set, &scene);
    assert_true(candidates.candidate[0].slack_m_q8 >
                hypot(LM_CHIP_SIDE / 2, LM_CHIP_SIDE) * large.pixel_mm / 1000 * 256);
}

TEST_WITH(a_chip_joins_the_ground_and_a_point_the_scatterers, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target t = target_beyond(range_m, 0, 77);
    for (int has_chip = 0; has_chip < 2; has_chip++) {
        struct lm_target_line line = line_of(LINES / 2);
        struct lm_target_candidates candidates;
        int16_t ground_q8[CELLS], steady_q8[CELLS];
        int on_ground = 0, steady = 0;
        for (int c = 0; c < CELLS; c++) {
            ground_q8[c] = steady_q8[c] = -100 * 256;
        }
        line.clutter_db_q8 = ground_q8;
        near_of(f, &t, has_chip, &candidates);
        assert_true(lm_target_line_add(&candidates, &line, NULL, steady_q8) > 0);
        for (int c = 0; c < CELLS; c++) {
            on_ground += ground_q8[c] > -90 * 256;
            steady += steady_q8[c] > -90 * 256;
        }
        assert_true(has_chip ? on_ground > 0 && steady == 0 : on_ground == 0 && steady > 0);
    }
}

/* Relative variance, over the sweeps of a window, of its strongest bin of the first. */
static double boiling(struct fixture *f, struct lm_chips *chips)
{
    enum { SWEEPS = 100, BINS = 600 };
    const struct lm_target t = target_with_signature(46, 11, 77);
    const struct lm_target_set set = set_with_signature(&f->world, &t, 1);
    const struct lm_sector_command command = {
        .range_index = scale_of(10), .fov = LM_FOV_DBS2, .centre = {t.latitude, t.longitude}};
    struct lm_geo_origin o;
    lm_geo_set_origin(&o, command.centre);
    const struct lm_platform platform = {.position = lm_geo_direct(&o, hs_bam(270), 15000 * 256),
                                         .height_m_q10 = (int32_t)(height_m * 1024),
                                         .heading = hs_bam(50),
                                         .track = hs_bam(50),
                                         .speed_mm_s = 250000};
    struct lm_sector *s = calloc(1, sizeof *s);
    uint32_t best = 0, line = 0, bin = 0;
    double sum = 0, squares = 0;
    lm_sector_start(s, &f->radar, &command, 1);
    s->targets = &set;
    s->chips = chips;
    for (int sweep = -1; sweep < SWEEPS;) { /* in the first, tiles and chip come */
        const uint32_t drawn =
            lm_sector_draw_line(s, &f->world.tiles, &platform, &f->tone, &f->line);
        for (uint32_t i = 0; sweep == 0 && i < s->slant.cells; i++) {
            if (s->power_q24[i] > best) {
                best = s->power_q24[i];
                line = drawn;
                bin = i;
            }
        }
        if (sweep > 0 && drawn == line) {
            sum += s->power_q24[bin];
            squares += (double)s->power_q24[bin] * s->power_q24[bin];
        }
        lm_chips_service(&f->world.chips, &f->world.tiles);
        lm_tile_cache_service(&f->world.tiles, 0, 64);
        sweep += lm_sector_is_at_edge(s);
    }
    free(s);
    const double mean = sum / (SWEEPS - 1);
    return squares / (SWEEPS - 1) / (mean * mean) - 1;
}

/* The looks of DBS2 at this speed and angle: some six to eleven. */
TEST_WITH(in_the_sweeps_of_a_window_a_chip_boils_and_a_point_stands, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const double chip = boiling(f, &f->world.chips), point = boiling(f, NULL);
    print_message("# relative variance of a chip %.4f, of a point %.4f\n", chip, point);
    assert_true(chip > 0.04 && chip < 0.3);
    assert_true(point < 0.01);
}

TEST_WITH(without_its_chip_a_target_is_a_point_of_its_cross_section, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target t = target_beyond(range_m, 0, 77);
    struct lm_target_candidates candidates;
    double power = 0;
    near_of(f, &t, false, &candidates);
    for (int l = 0; l < LINES; l++) {
        const struct lm_target_line line = line_of(l);
        int16_t level_q8[CELLS];
        for (int c = 0; c < CELLS; c++) {
            level_q8[c] = -100 * 256;
        }
        (void)lm_target_line_add(&candidates, &line, NULL, level_q8);
        for (int c = 0; c < CELLS; c++) {
            power += pow(10, level_q8[c] / 2560.0);
        }
    }
    const double level = 10 * log10(power) + clutter_db(spacing_m, cell_m, range_m);
    assert_true(fabs(level - 22.5) < 0.1);
}

TEST_WITH(a_chip_behind_the_horizon_adds_nothing_to_a_line_and_says_so, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target t = target_beyond(range_m, 0, 77);
    const struct lm_target_line line = line_of(LINES / 2);
    struct lm_target_candidates candidates;
    near_of(f, &t, true, &candidates);
    for (int is_hidden = 0; is_hidden < 2; is_hidden++) {
        int32_t horizon[CELLS];
        int16_t level_q8[CELLS];
        const struct lm_target_horizon sight = {horizon, 26};
        int changed = 0;
        for (int c = 0; c < CELLS; c++) {
            horizon[c] = is_hidden ? 1 << 26 : -(1 << 26);
            level_q8[c] = -100 * 256;
        }
        const uint32_t added = lm_target_line_add(&candidates, &line, &sight, level_q8);
        for (int c = 0; c < CELLS; c++) {
            changed += level_q8[c] != -100 * 256;
        }
        assert_int_equal(added == 0, is_hidden);
        assert_int_equal(changed == 0, is_hidden);
    }
}
