/* Targets with a signature on ground that is not level: where the shadow falls in a patch and in a
 * window, against rays, and where the pixels are displayed in a patch, against the heights of what
 * they show. */
#include "check.h"
#include "reference/chip.h"
#include "reference/reference.h"
#include "signature_image.h"

#include "lm/line.h"
#include "lm/target_patch.h"

#include <stdlib.h>

/* A patch of 128 cells of a metre around 46 N 11 E, seen from the west, its ground traced 8 cells
 * before it and behind. */
enum {
    LINES = 128,
    CELLS = LINES,
    OVERSCAN = 8,
    TRACED = CELLS + 2 * OVERSCAN,
    SOIL_Q8 = 20 * 256,
    NOTHING_Q8 = -120 * 256
};
static const double range_m = 20000, height_m = 6000, lean = 0.3, middle = (LINES - 1) / 2.0;

struct fixture {
    struct signature_world world; /* first: see tear_down_signature_world */
    struct lm_target_patch points;
    int32_t elevation_m_q14[LINES][TRACED];
    int16_t level_q8[LINES][TRACED];
    struct lm_line line; /* of a window */
};

static int set_up(void **state)
{
    return set_up_signature_world(state, sizeof(struct fixture));
}

/* Ground about the target: it rises by this away from the radar and to the right, with waves. */
struct ground {
    double beyond, right, waves_m, long_m;
};

/* In this order, which the numbers of a test hang on. */
static struct ground drawn_ground(struct hs_rng *r)
{
    struct ground g;
    g.beyond = -0.25 + 0.9 * hs_rng_uniform(r);
    g.right = -0.3 + 0.6 * hs_rng_uniform(r);
    g.waves_m = hs_rng_uniform(r);
    g.long_m = 10 + 40 * hs_rng_uniform(r);
    return g;
}

static double rise_m(const struct ground *g, double right_m, double beyond_m)
{
    return g->beyond * beyond_m + g->right * right_m +
           g->waves_m * sin(beyond_m * 2 * acos(-1) / g->long_m);
}

static struct lm_patch_geometry geometry_of(double leans)
{
    return (struct lm_patch_geometry){.centre = {hs_bam(46), hs_bam(11)},
                                      .look = FX_BAM_90,
                                      .centre_m_q8 = (uint32_t)range_m * 256,
                                      .cell_m_q8 = 256,
                                      .lines = LINES,
                                      .cells = CELLS,
                                      .overscan = OVERSCAN,
                                      .traced = TRACED,
                                      .heights = {(int32_t)height_m * 1024, 0},
                                      .wavelength_um = X_BAND_UM,
                                      .lean_q16 = (int32_t)(leans * 65536),
                                      .dwell_ms = 2000};
}

/* The target in the centre, at the ground's height there, and that ground. */
static void stand(struct fixture *f, const struct lm_target *t, const struct ground *ground,
                  const struct lm_patch_geometry *g)
{
    const struct lm_target_set set = set_with_signature(&f->world, t, 1);
    const struct lm_target_query scene = {.position = g->centre, .reach_m = 2000};
    struct lm_target_candidates candidates;
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, g->centre);
    const struct lm_chip_query chips = {.centre = g->centre,
                                        .reach_m = scene.reach_m,
                                        .radar =
                                            lm_geo_direct(&origin, FX_BAM_DEG(270), g->centre_m_q8),
                                        .heights = g->heights,
                                        .cell_mm = 1000,
                                        .side_most = LM_CHIP_SIDE};
    lm_target_candidates_select(&candidates, &set, &scene);
    lm_chips_choose(&f->world.chips, &candidates, &chips);
    assert_true(serve_chips(&f->world));
    lm_target_patch_set(&f->points, &candidates, g);
    for (int k = 0; k < LINES; k++) {
        for (int i = 0; i < TRACED; i++) {
            const double beyond_m = i - OVERSCAN - middle;
            f->elevation_m_q14[k][i] =
                (int32_t)lround(16384 * rise_m(ground, k - middle, beyond_m));
        }
    }
    for (uint32_t k = 0; k < LINES; k++) {
        lm_target_patch_lean(&f->points, k, f->elevation_m_q14[k] + OVERSCAN, g);
    }
}

static void fill(struct fixture *f, int16_t level_q8)
{
    for (int k = 0; k < LINES * TRACED; k++) {
        f->level_q8[k / TRACED][k % TRACED] = level_q8;
    }
}

/* ---- shadow ---- */

/* Is a place dark by its ray, and how far is the ray from the edge of the chip's shadow: 6 m wide,
 * from 1 to 12 m behind the origin. */
static bool is_in_shadow(double right_m, double level_m, double *margin_m)
{
    const double inside_m = fmin(fmin(level_m - 1, 12 - level_m), 3 - fabs(right_m));
    *margin_m = fabs(inside_m);
    return inside_m > 0;
}

/* Every cell against its own ray; those within a cell of the shadow's edge are mixed. Behind ground
 * that stands in the way of a ray it is dark either way. Returns the darkest cell's distance. */
static double judge_shadow(struct fixture *f, const struct ground *ground, int *judged)
{
    double farthest_m = 0;
    for (int k = 0; k < LINES; k++) {
        double highest_m = -1e9;
        for (int i = 0; i < TRACED; i++) {
            const double right_m = k - middle, beyond_m = i - OVERSCAN - middle;
            const double level_m =
                ref_chip_level_m(height_m, range_m, beyond_m, rise_m(ground, right_m, beyond_m));
            const double gain_db = (f->level_q8[k][i] - SOIL_Q8) / 256.0;
            double margin_m;
            const bool is_dark = is_in_shadow(right_m, level_m, &margin_m);
            if (beyond_m > 0 && level_m >= highest_m && margin_m > 1.2) {
                assert_true(is_dark ? gain_db < -20 : gain_db == 0);
                *judged += is_dark;
            }
            highest_m = beyond_m > 0 ? fmax(highest_m, level_m) : highest_m;
            farthest_m = gain_db < -20 ? fmax(farthest_m, beyond_m) : farthest_m;
        }
    }
    return farthest_m;
}

static double shadow_on(struct fixture *f, const struct ground *ground, int *judged)
{
    const struct lm_patch_geometry g = geometry_of(lean);
    const struct lm_target t = target_with_signature(46, 11, 0);
    stand(f, &t, ground, &g);
    fill(f, SOIL_Q8);
    for (uint32_t k = 0; k < LINES; k++) {
        lm_target_patch_shade(&f->points, k, &g, f->elevation_m_q14[k] + OVERSCAN,
                              f->level_q8[k] + OVERSCAN);
    }
    return judge_shadow(f, ground, judged);
}

TEST_WITH(a_shadow_ends_where_the_ray_over_the_target_meets_the_ground, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    struct hs_rng r;
    int judged = 0;
    hs_rng_seed(&r, 5);
    for (int i = 0; i < 200; i++) {
        const struct ground ground = drawn_ground(&r);
        shadow_on(f, &ground, &judged);
    }
    print_message("# %d dark cells away from the shadow's edge\n", judged);
    assert_true(judged > 1000);
}

/* The tangent of the ray is 0.3, less what the Earth turns away: 12 m become 12 t / (t + slope). */
TEST_WITH(a_shadow_is_shorter_uphill_and_longer_downhill, set_up, tear_down_signature_world)
{
    static const double slopes[] = {0.3, 0.1, 0, -0.1, -0.2};
    struct fixture *f = *state;
    for (int i = 0; i < 5; i++) {
        const struct ground ground = {.beyond = slopes[i], .long_m = 1};
        int judged = 0;
        const double end_m = 12 * 0.2988 / (0.2988 + slopes[i]);
        assert_true(fabs(shadow_on(f, &ground, &judged) + 0.5 - end_m) < 1.5);
    }
}

/* Where ground falls more steeply than the ray the rest of the line is in the shadow. */
TEST_WITH(a_shadow_on_ground_that_falls_away_ends_with_the_line, set_up, tear_down_signature_world)
{
    const struct ground ground = {.beyond = -0.4, .long_m = 1};
    const struct lm_patch_geometry g = geometry_of(lean);
    const struct lm_target t = target_with_signature(46, 11, 0);
    struct fixture *f = *state;
    stand(f, &t, &ground, &g);
    fill(f, SOIL_Q8);
    for (uint32_t k = 0; k < LINES; k++) {
        lm_target_patch_shade(&f->points, k, &g, f->elevation_m_q14[k] + OVERSCAN,
                              f->level_q8[k] + OVERSCAN);
        for (int i = 0; i < TRACED; i++) {
            assert_true(f->level_q8[k][i] == SOIL_Q8 || i > middle);
        }
    }
}

TEST_WITH(a_target_is_shaded_by_the_ray_over_it_uphill_and_downhill, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_patch_geometry g = geometry_of(0);
    int shaded = 0;
    for (double beyond_m = -6; beyond_m < 40; beyond_m += 1) {
        for (double up_m = -8; up_m < 6; up_m += 0.5) {
            struct lm_target targets[2] = {target_with_signature(46, 11, 0),
                                           point_at(46, 11, 0, 10)};
            struct lm_geo_origin o;
            lm_geo_set_origin(&o, g.centre);
            const struct lm_position at = lm_geo_direct(&o, hs_bam(beyond_m < 0 ? 270 : 90),
                                                        (uint32_t)lround(fabs(beyond_m) * 256));
            targets[1].latitude = at.latitude;
            targets[1].longitude = at.longitude;
            targets[1].elevation_m_q6 = (int32_t)(up_m * 64);
            seal_target(&targets[1]);
            const struct lm_target_set set = set_with_signature(&f->world, targets, 2);
            const struct lm_target_query scene = {.position = g.centre, .reach_m = 2000};
            struct lm_target_candidates candidates;
            const struct ground level = {.long_m = 1};
            stand(f, targets, &level, &g); /* for its chip */
            const struct lm_chip_slot *slot = f->points.chip[0].patch.slot;
            lm_target_candidates_select(&candidates, &set, &scene);
            candidates.candidate[0].chip = slot;
            lm_target_patch_set(&f->points, &candidates, &g);
            lm_target_patch_mark_shaded(&f->points, 1, &g);
            const double level_m = ref_chip_level_m(height_m, range_m, beyond_m, up_m);
            double margin_m;
            const bool wanted = is_in_shadow(0, level_m, &margin_m) && beyond_m > 0;
            if (margin_m > 1.5 && fabs(beyond_m) > 0.5) {
                assert_int_equal(f->points.scatterer[1].is_shaded, wanted);
                shaded += wanted;
            }
        }
    }
    assert_true(shaded > 100);
}

/* ---- shadow in a window ---- */

/* Lines and cells of a metre around the same target, which is in the middle line. */
enum { WINDOW_LINES = 25, WINDOW_CELLS = 160, ORIGIN = 40, BRIGHT_Q8 = 80 * 256 };

static void find_in_window(struct fixture *f, const struct lm_target *t, struct lm_position radar,
                           struct lm_target_candidates *candidates)
{
    const struct lm_target_set set = set_with_signature(&f->world, t, 1);
    const struct lm_target_query scene = {.position = radar, .reach_m = 30000};
    const struct lm_chip_query chips = {.centre = {t->latitude, t->longitude},
                                        .reach_m = 500,
                                        .radar = radar,
                                        .heights = {(int32_t)height_m * 1024, 0},
                                        .cell_mm = 1000,
                                        .side_most = 32};
    lm_target_candidates_select(candidates, &set, &scene);
    lm_chips_choose(&f->world.chips, candidates, &chips);
    assert_true(serve_chips(&f->world));
}

/* How much darker each cell of a line gets, so far to the right of the target, over open ground. */
static void shade_window_line(struct fixture *f, const struct ground *ground, int right_m,
                              double gain_db[WINDOW_CELLS])
{
    static const struct lm_target_candidates none;
    const struct lm_target t = target_with_signature(46, 11, 0);
    const struct lm_range_grid grid = {.cells = WINDOW_CELLS, .tangent_bits = 20};
    const fx_bam_t width = (fx_bam_t)lround(4294967296.0 / (2 * acos(-1) * range_m));
    struct lm_target_candidates candidates;
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, (struct lm_position){t.latitude, t.longitude});
    struct lm_line_targets targets = {
        .candidates = &candidates,
        .live = &none,
        .where = {.position = lm_geo_direct(&origin, FX_BAM_DEG(270), (uint32_t)range_m * 256),
                  .width = width,
                  .first_m_q8 = ((uint32_t)range_m - ORIGIN) * 256,
                  .cell_m_q8 = 256,
                  .cells = WINDOW_CELLS,
                  .height_m_q10 = (int32_t)height_m * 1024,
                  .wavelength_um = X_BAND_UM}};
    uint32_t distance_m_q8;
    lm_geo_inverse(targets.where.position, origin.position, &distance_m_q8, &targets.where.azimuth);
    targets.where.azimuth += (fx_bam_t)(right_m * (int32_t)width);
    find_in_window(f, &t, targets.where.position, &candidates);
    for (int i = 0; i < WINDOW_CELLS; i++) {
        f->line.lit.level_db_q8[i] = BRIGHT_Q8; /* beside which the target is nothing */
        f->line.lit.horizon[i] = -(1 << 30);
        f->line.ground.elevation_m_q14[i] =
            (int32_t)lround(16384 * rise_m(ground, right_m, i - ORIGIN));
    }
    (void)lm_line_add_targets(&f->line, &grid, &targets);
    for (int i = 0; i < WINDOW_CELLS; i++) {
        gain_db[i] = (f->line.lit.level_db_q8[i] - BRIGHT_Q8) / 256.0;
    }
}

/* Every cell of a line against its own ray, but those within a cell and a half of the shadow's edge
 * and those that the ground hides. Returns how many are dark. */
static int judge_window_line(struct fixture *f, const struct ground *ground, int right_m)
{
    double gain_db[WINDOW_CELLS], highest_m = -1e9;
    int dark = 0;
    shade_window_line(f, ground, right_m, gain_db);
    for (int i = 0; i + 1 < WINDOW_CELLS; i++) {
        const double beyond_m = i - ORIGIN;
        const double level_m =
            ref_chip_level_m(height_m, range_m, beyond_m, rise_m(ground, right_m, beyond_m));
        const double next_m = ref_chip_level_m(height_m, range_m, beyond_m + 1,
                                               rise_m(ground, right_m, beyond_m + 1));
        double margin_m;
        const bool is_dark = is_in_shadow(right_m, level_m, &margin_m);
        if (beyond_m > 0 && level_m >= highest_m && next_m > level_m &&
            margin_m > 1.5 + (next_m - level_m) / 2) {
            assert_true(is_dark ? gain_db[i] < -8 : gain_db[i] > -0.1);
            dark += is_dark;
        }
        assert_true(beyond_m > -1 || gain_db[i] >= 0);
        highest_m = beyond_m > 0 ? fmax(highest_m, level_m) : highest_m;
    }
    return dark;
}

TEST_WITH(in_a_window_too_a_shadow_ends_where_the_ray_meets_the_ground, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    struct hs_rng r;
    int judged = 0;
    hs_rng_seed(&r, 5);
    for (int n = 0; n < 200; n++) {
        const struct ground ground = drawn_ground(&r);
        for (int right_m = -WINDOW_LINES / 2; right_m <= WINDOW_LINES / 2; right_m++) {
            judged += judge_window_line(f, &ground, right_m);
        }
    }
    print_message("# %d dark cells away from the shadow's edge\n", judged);
    assert_true(judged > 1000);
}

/* 11 m on level ground; the tangent as above. */
TEST_WITH(in_a_window_too_a_shadow_is_shorter_uphill_and_longer_downhill, set_up,
          tear_down_signature_world)
{
    static const double slopes[] = {0.6, 0.3, 0.1, 0, -0.1, -0.2};
    struct fixture *f = *state;
    for (int n = 0; n < 6; n++) {
        const struct ground ground = {.beyond = slopes[n], .long_m = 1};
        const double wanted_m = 11 * 0.2988 / (0.2988 + slopes[n]);
        double gain_db[WINDOW_CELLS], found_m = 0;
        shade_window_line(f, &ground, 0, gain_db);
        for (int i = 0; i < WINDOW_CELLS; i++) {
            found_m += 1 - pow(10, gain_db[i] / 10);
        }
        print_message("# slope %.1f: %.2f m, and %.2f m by the rays\n", slopes[n], found_m,
                      wanted_m);
        assert_true(fabs(found_m - wanted_m) < 0.05 * wanted_m);
    }
}

TEST_WITH(in_a_window_a_shadow_on_ground_that_falls_away_ends_with_the_line, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct ground ground = {.beyond = -0.4, .long_m = 1};
    double gain_db[WINDOW_CELLS];
    shade_window_line(f, &ground, 0, gain_db);
    for (int i = 0; i < WINDOW_CELLS; i++) {
        assert_true(gain_db[i] == 0 || i > ORIGIN);
    }
}

/* ---- layover ---- */

/* Where the power of a patch is within a few cells of a place. */
struct found {
    double power, line, cell;
};

static struct found find(const struct fixture *f, double line, double cell)
{
    struct found found = {0, 0, 0};
    for (int k = 0; k < LINES * TRACED; k++) {
        const double l = k / TRACED, c = k % TRACED - OVERSCAN;
        if (fabs(l - line) < 2.6 && fabs(c - cell) < 2.6 &&
            f->level_q8[k / TRACED][k % TRACED] > NOTHING_Q8) {
            const double power = pow(10, f->level_q8[k / TRACED][k % TRACED] / 2560.0);
            found.power += power;
            found.line += power * l;
            found.cell += power * c;
        }
    }
    found.line /= found.power;
    found.cell /= found.power;
    return found;
}

/* Where a corner is displayed: it stands on the slope, and leans by its height. */
struct shown {
    double line, cell;
};

static struct shown shown_at(int corner, double heading, const struct ground *ground, double leans)
{
    double right_m, beyond_m;
    corner_place(&corners[corner], (270 - heading) * acos(-1) / 180, &right_m, &beyond_m);
    return (struct shown){middle + right_m,
                          middle + beyond_m - leans * rise_m(ground, right_m, beyond_m)};
}

/* Corners that are displayed beside each other are not told apart. */
static bool is_alone(int corner, double heading, const struct ground *ground, double leans)
{
    const struct shown here = shown_at(corner, heading, ground, leans);
    bool is_alone = true;
    for (int i = 0; i < CORNERS; i++) {
        const struct shown other = shown_at(i, heading, ground, leans);
        is_alone = is_alone && (i == corner || fabs(here.line - other.line) > 5 ||
                                fabs(here.cell - other.cell) > 5);
    }
    return is_alone;
}

TEST_WITH(the_pixels_of_a_target_lean_with_the_slope_it_stands_on, set_up,
          tear_down_signature_world)
{
    static const struct {
        double beyond, right, leans;
    } cases[] = {{0, 0, 0.3},  {0.3, 0, 0.3},   {-0.3, 0, 0.3},    {0, 0.4, 0.3},
                 {0, -0.4, 1}, {0.4, 0.3, 0.7}, {-0.5, -0.4, 0.8}, {0.6, 0, 1}};
    enum { CASES = sizeof cases / sizeof cases[0], HEADINGS = 12 };
    struct fixture *f = *state;
    const struct ref_view view = {height_m, 0, 1};
    const double area_m2 = ref_grazing(&view, range_m, range_m - 1);
    double worst_place = 0, worst_level = 0;
    int judged = 0;
    /* A place on the chip is right within 3/4 of a cell, and its height as much as the ground
     * leans.
     */
    for (int n = 0; n < CASES * HEADINGS; n++) {
        const struct ground ground = {cases[n / HEADINGS].beyond, cases[n / HEADINGS].right, 0, 1};
        const double heading = n % HEADINGS * 31, leans = cases[n / HEADINGS].leans;
        const struct lm_patch_geometry g = geometry_of(leans);
        const struct lm_target t = target_with_signature(46, 11, heading);
        stand(f, &t, &ground, &g);
        fill(f, NOTHING_Q8);
        for (uint32_t k = 0; k < LINES; k++) {
            assert_int_equal(lm_target_patch_add_chips(&f->points, k, &g,
                                                       f->elevation_m_q14[k] + OVERSCAN,
                                                       f->level_q8[k] + OVERSCAN),
                             0);
        }
        for (int i = 0; i < CORNERS; i++) {
            const struct shown at = shown_at(i, heading, &ground, leans);
            if (is_alone(i, heading, &ground, leans)) {
                const struct found found = find(f, at.line, at.cell);
                const double level_db = 10 * log10(found.power * area_m2) - corners[i].dbsm;
                const double away = hypot(found.line - at.line, found.cell - at.cell);
                const double slope = fabs(ground.beyond) + fabs(ground.right);
                worst_place = fmax(worst_place, away / (1 + leans * slope));
                worst_level = fmax(worst_level, fabs(level_db));
                judged++;
            }
        }
    }
    print_message("# %d corners, places within %.2f cells, levels within %.2f dB\n", judged,
                  worst_place, worst_level);
    assert_true(judged > 150);
    assert_true(worst_place < 0.75);
    assert_true(worst_level < 0.2);
}
