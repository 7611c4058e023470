/* What the radar sees of a line, against the geometry in double precision: docs/EQUATIONS.md,
 * "Illumination". Lines are made by hand; the classes are those of tests/support/tiny_image.
 */
#include "check.h"
#include "hs/rng.h"
#include "lm/illumination.h"
#include "tiny_image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double effective_earth_m = 4.0 / 3 * 6371000;

struct scene {
    struct lm_illumination_config config;
    struct lm_range_grid grid;
    struct lm_scan_line line;
    struct lm_lit_line lit;
};

static uint32_t cell_of(double gamma_db, uint32_t class_index, uint32_t height_code)
{
    return (uint32_t)lround((gamma_db + 80) * 2) << 8 | class_index << 4 | height_code;
}

static double height_m_of(uint32_t cell)
{
    return tiny_classes()->height_dm[cell & 15] / 10.0;
}

static double range_m(const struct scene *s, uint32_t i, double first_m)
{
    return first_m + i * (s->grid.cell_m_q8 / 256.0);
}

/* Flat soil of -20 dB at z_m everywhere. */
static void make_flat(struct scene *s, double z_m)
{
    memset(&s->line, 0, sizeof s->line);
    for (uint32_t i = 0; i < LM_CELLS_MAX; i++) {
        s->line.cell[i] = cell_of(-20, TINY_SOIL, 0);
        s->line.elevation_m_q14[i] = (int32_t)lround(z_m * 16384);
    }
}

static void set_grid(struct scene *s, double first_m, double cell_m, uint32_t cells,
                     double height_m, double reference_m)
{
    lm_range_grid_set(&s->grid, &s->config, (uint32_t)lround(first_m * 256),
                      (uint32_t)lround(cell_m * 256), cells, (int32_t)lround(height_m * 1024),
                      (int32_t)lround(reference_m * 1024));
}

static lm_horizon_q40_t run(struct scene *s, lm_horizon_q40_t horizon)
{
    struct lm_class_lut class_lut;
    lm_class_lut_set(&class_lut, &s->config, tiny_classes());
    return lm_illuminate(&s->grid, &class_lut, NULL, &s->line, horizon, &s->lit);
}

static double tangent(double antenna_m, double top_m, double s_m)
{
    return (top_m - antenna_m) / s_m - s_m / (2 * effective_earth_m);
}

static int is_lit(const struct scene *s, uint32_t i)
{
    return s->lit.level_db_q8[i] != LM_LEVEL_SHADOW;
}

/* A ground-map line of `cells` from the antenna. */
static void set_gm(struct scene *s, double range_nm, double height_m, double reference_m)
{
    const double cell_m = range_nm * 1852 / 256;
    set_grid(s, cell_m / 2, cell_m, 256, height_m, reference_m);
}

TEST(flat_ground_shows_its_gamma_at_every_range_of_a_ground_map)
{
    static struct scene s;
    static const double ranges_nm[] = {10, 20, 40, 80}, heights_m[] = {600, 3000, 9000, 14000};
    double worst = 0;
    for (int r = 0; r < 4; r++) {
        for (int h = 0; h < 4; h++) {
            make_flat(&s, 100);
            set_gm(&s, ranges_nm[r], heights_m[h], 100);
            run(&s, LM_HORIZON_OPEN);
            for (uint32_t i = 0; i < 256; i++) {
                const double s_m = (i + 0.5) * (s.grid.cell_m_q8 / 256.0);
                const double slope = (heights_m[h] - 100) / s_m - s_m / (2 * effective_earth_m);
                if (i < s.grid.first) {
                    assert_true(s_m < fmax(256, heights_m[h] / 2) + 0.01);
                    assert_false(is_lit(&s, i));
                } else if (slope > 1.0 / 256 + 1e-4) {
                    assert_true(s_m >= fmax(256, heights_m[h] / 2) - 0.01);
                    worst = fmax(worst, fabs(s.lit.level_db_q8[i] / 256.0 + 20));
                }
            }
        }
    }
    print_message("# ground map, flat ground: at most %.3f dB from gamma\n", worst);
    assert_true(worst < 0.25);
}

TEST(flat_ground_shows_its_gamma_in_patches_of_every_cell_and_range)
{
    static struct scene s;
    static const double cells_m[] = {0.5, 1, 5, 40}, ranges_m[] = {12000, 40000, 100000};
    double worst = 0;
    for (int c = 0; c < 4; c++) {
        for (int r = 0; r < 3; r++) {
            make_flat(&s, 40);
            set_grid(&s, ranges_m[r] - 130 * cells_m[c], cells_m[c], 260, 3000, 40);
            run(&s, LM_HORIZON_OPEN);
            for (uint32_t i = 0; i < 260; i++) {
                worst = fmax(worst, fabs(s.lit.level_db_q8[i] / 256.0 + 20));
            }
        }
    }
    print_message("# patches, flat ground: at most %.3f dB from gamma\n", worst);
    assert_true(worst < 0.25);
}

/* Where the ray over a top meets flat ground again: t(s) = -H / s - s / (2 a) is the ray's tangent
 * at the nearer root of s^2 / (2 a) + t s + H = 0. With a flat Earth that is h / tan psi behind the
 * top. */
static double end_of_shadow_m(double antenna_m, double ray)
{
    return -effective_earth_m * (ray + sqrt(ray * ray - 2 * antenna_m / effective_earth_m));
}

TEST(the_shadow_of_a_wall_is_h_over_tan_psi_long)
{
    static struct scene s;
    static const double heights_m[] = {1500, 3000, 6000, 9000}, ranges_m[] = {12000, 20000, 30000};
    int walls = 0;
    for (int n = 0; n < 4 * 3 * 15; n++) {
        const double antenna_m = heights_m[n % 4], first_m = ranges_m[n / 4 % 3], cell_m = 2;
        const uint32_t code = 1 + (uint32_t)n / 12;
        make_flat(&s, 0);
        set_grid(&s, first_m, cell_m, 512, antenna_m, 0);
        s.line.cell[20] = cell_of(0, TINY_STRUCTURE, code);
        const double wall_m = height_m_of(s.line.cell[20]), s_m = range_m(&s, 20, first_m);
        const double ray = tangent(antenna_m, wall_m, s_m);
        const double length = (end_of_shadow_m(antenna_m, ray) - s_m) / cell_m;
        if (length > 480) {
            continue;
        }
        walls++;
        run(&s, LM_HORIZON_OPEN);
        uint32_t dark = 0;
        while (!is_lit(&s, 21 + dark)) {
            dark++;
        }
        assert_true(is_lit(&s, 20));
        assert_true(fabs(dark - length) <= 1);
        /* The Earth bends away by less than 6 % of the ray's slope here. */
        const double on_a_plane = wall_m / ((antenna_m - wall_m) / s_m) / cell_m;
        assert_true(fabs(dark - on_a_plane) <= 1 + 0.06 * on_a_plane);
        for (uint32_t i = 21 + dark; i < 512; i++) {
            assert_true(is_lit(&s, i));
        }
    }
    assert_true(walls > 100);
}

/* Lit or not, by the definition. */
struct truth {
    double rise[LM_CELLS_MAX], tangent[LM_CELLS_MAX];
};

static void find_truth(const struct scene *s, double first_m, double antenna_m, double horizon,
                       struct truth *t)
{
    for (uint32_t i = 0; i < s->grid.cells; i++) {
        const double top_m = s->line.elevation_m_q14[i] / 16384.0 + height_m_of(s->line.cell[i]);
        t->tangent[i] = tangent(antenna_m, top_m, range_m(s, i, first_m));
        t->rise[i] = i < s->grid.first ? 0 : t->tangent[i] - horizon;
        horizon = i < s->grid.first ? horizon : fmax(horizon, t->tangent[i]);
    }
}

static double flat_rise(double height_m, double s_m, double cell_m)
{
    return fmax(height_m / s_m - s_m / (2 * effective_earth_m), 1.0 / 256) * cell_m / s_m;
}

/* The law of the equations for a cell that is not the first. */
static double level_db(const struct scene *s, const struct truth *t, uint32_t i, double first_m,
                       double height_m)
{
    const double cell_m = s->grid.cell_m_q8 / 256.0, s_m = range_m(s, i, first_m);
    const double flat =
        height_m * cell_m / (s_m * (s_m - cell_m)) - cell_m / (2 * effective_earth_m);
    const double least = cell_m / (s_m - cell_m) / 256;
    return (s->line.cell[i] >> 8) / 2.0 - 80 + 10 * log10(t->rise[i] / fmax(flat, least));
}

TEST(rough_ground_is_lit_and_hidden_as_the_equations_say)
{
    static struct scene s;
    static struct truth truth;
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    double worst = 0;
    for (int n = 0; n < 200; n++) {
        const double cell_m = 0.5 * (1 << hs_rng_below(&rng, 11));
        const double height_m = 500 + 10000 * hs_rng_uniform(&rng);
        const double first_m = height_m + 300 + hs_rng_uniform(&rng) * 50000;
        const double rough_m = cell_m * hs_rng_uniform(&rng);
        set_grid(&s, first_m, cell_m, 500, height_m, 0);
        double z_m = 0;
        for (uint32_t i = 0; i < 500; i++) {
            z_m = 0.99 * z_m + rough_m * (hs_rng_uniform(&rng) - 0.5);
            s.line.cell[i] = cell_of(-20, TINY_SOIL,
                                     hs_rng_below(&rng, 8) ? 0 : (uint32_t)hs_rng_below(&rng, 16));
            s.line.elevation_m_q14[i] = (int32_t)lround(z_m * 16384);
        }
        run(&s, LM_HORIZON_OPEN);
        const double top_m = s.line.elevation_m_q14[0] / 16384.0 + height_m_of(s.line.cell[0]);
        const double first_q8_m = round(first_m * 256) / 256;
        const double antenna_m = round(height_m * 1024) / 1024;
        find_truth(&s, first_q8_m, antenna_m,
                   tangent(antenna_m, top_m, first_q8_m) - flat_rise(antenna_m, first_q8_m, cell_m),
                   &truth);
        const double flat = flat_rise(antenna_m, first_q8_m + 500 * cell_m, cell_m);
        for (uint32_t i = 1; i < 500; i++) {
            /* A hundredth of what flat ground shows is 20 dB below it. */
            if (fabs(truth.rise[i]) > flat / 50) {
                assert_int_equal(is_lit(&s, i), truth.rise[i] > 0);
            }
            if (truth.rise[i] > flat / 4) {
                const double want_db = level_db(&s, &truth, i, first_q8_m, antenna_m);
                worst = fmax(worst, fabs(s.lit.level_db_q8[i] / 256.0 - want_db));
            }
        }
    }
    print_message("# rough ground: at most %.3f dB from the equations\n", worst);
    assert_true(worst < 0.25);
}

TEST(a_hill_hides_what_lies_behind_it)
{
    static struct scene s;
    static struct truth truth;
    const double first_m = 15000, cell_m = 10, antenna_m = 2000;
    make_flat(&s, 0);
    set_grid(&s, first_m, cell_m, 400, antenna_m, 0);
    for (int i = 100; i <= 140; i++) {
        /* A cone of 100 m, steeper behind than the ray. */
        s.line.elevation_m_q14[i] = (100 - 5 * abs(i - 120)) * 16384;
    }
    run(&s, LM_HORIZON_OPEN);
    find_truth(&s, first_m, antenna_m,
               tangent(antenna_m, 0, first_m) - flat_rise(antenna_m, first_m, cell_m), &truth);
    uint32_t dark = 0;
    for (uint32_t i = 0; i < 400; i++) {
        assert_int_equal(is_lit(&s, i), truth.rise[i] > 0);
        dark += !is_lit(&s, i);
    }
    /* From the top, 100 m over the ground at 16,200 m: 100 / tan psi with tan psi = 1900 / 16,200.
     */
    const double length = 100 / (1900.0 / 16200) / cell_m;
    assert_true(fabs(dark - length) <= 1 + 0.01 * length);
    /* The slope towards the radar, 1 in 2, is brighter than flat ground by its share of the ray. */
    assert_true(s.lit.level_db_q8[110] > s.lit.level_db_q8[50] + 6 * 256);
}

TEST(the_horizon_never_falls_and_goes_on_from_line_to_line)
{
    static struct scene whole, near, far;
    struct hs_rng rng;
    hs_rng_seed(&rng, 8);
    const double first_m = 20000, cell_m = 4;
    set_grid(&whole, first_m, cell_m, 400, 1500, 0);
    set_grid(&near, first_m, cell_m, 150, 1500, 0);
    set_grid(&far, first_m + 150 * cell_m, cell_m, 250, 1500, 0);
    for (uint32_t i = 0; i < 400; i++) {
        whole.line.cell[i] = cell_of(-20, TINY_SOIL, 0);
        whole.line.elevation_m_q14[i] = (int32_t)hs_rng_below(&rng, 4 * 16384);
        struct lm_scan_line *part = i < 150 ? &near.line : &far.line;
        part->cell[i % 150 + (i >= 300 ? 150 : 0)] = whole.line.cell[i];
        part->elevation_m_q14[i < 150 ? i : i - 150] = whole.line.elevation_m_q14[i];
    }
    for (uint32_t i = 0; i < 250; i++) {
        far.line.cell[i] = cell_of(-20, TINY_SOIL, 0);
    }
    const lm_horizon_q40_t end = run(&whole, LM_HORIZON_OPEN);
    const lm_horizon_q40_t middle = run(&near, LM_HORIZON_OPEN);
    const lm_horizon_q40_t end_in_two = run(&far, middle);
    for (uint32_t i = 0; i < 400; i++) {
        assert_true(whole.lit.horizon[i + 1] >= whole.lit.horizon[i]);
        const struct scene *part = i < 150 ? &near : &far;
        assert_int_equal(is_lit(&whole, i), is_lit(part, i < 150 ? i : i - 150));
    }
    assert_true(middle <= end);
    /* The two grids round 1 / s differently: to 2^-30 of the tangent. */
    assert_true(llabs(end - end_in_two) < (int64_t)1 << 12);
}

TEST(a_horizon_above_everything_leaves_all_dark)
{
    static struct scene s;
    make_flat(&s, 0);
    set_grid(&s, 90000, 1, 100, 3000, 0);
    run(&s, INT64_MAX);
    for (uint32_t i = 0; i < 100; i++) {
        assert_false(is_lit(&s, i));
    }
    run(&s, INT64_MIN + 1);
    assert_true(is_lit(&s, 0));
    assert_true(is_lit(&s, 99));
}

TEST(a_line_that_is_too_near_throughout_is_dark_and_keeps_its_horizon)
{
    static struct scene s;
    make_flat(&s, 0);
    set_grid(&s, 100, 2, 200, 20000, 0);
    assert_int_equal(s.grid.first, 200);
    assert_int_equal(run(&s, 12345), 12345);
    for (uint32_t i = 0; i < 200; i++) {
        assert_false(is_lit(&s, i));
    }
}

/* ---- edges ---- */

static const struct lm_illumination_config edges = {.edge_structure_db_q8 = 6 * 256,
                                                    .edge_trees_db_q8 = 2 * 256,
                                                    .shore_db_q8 = 5 * 256,
                                                    .shore_width_m = 60};

/* What the edges add to each cell of a line of classes, written as letters: s soil, t trees,
 * b buildings, w water, a asphalt (ground, like soil). */
static void edges_of(const char *classes, double cell_m, int32_t *added_q8)
{
    static struct scene with, without;
    static const char letters[] = "sacbtw"; /* in the order of enum tiny_class */
    const uint32_t cells = (uint32_t)strlen(classes);
    make_flat(&with, 0);
    for (uint32_t i = 0; i < cells; i++) {
        with.line.cell[i] = cell_of(-20, (uint32_t)(strchr(letters, classes[i]) - letters), 0);
    }
    without.line = with.line;
    with.config = edges;
    set_grid(&with, 20000, cell_m, cells, 3000, 0);
    set_grid(&without, 20000, cell_m, cells, 3000, 0);
    run(&with, LM_HORIZON_OPEN);
    run(&without, LM_HORIZON_OPEN);
    for (uint32_t i = 0; i < cells; i++) {
        added_q8[i] = with.lit.level_db_q8[i] - without.lit.level_db_q8[i];
    }
}

static void assert_edges(const char *classes, double cell_m, const int32_t *expected_q8)
{
    int32_t added_q8[LM_CELLS_MAX];
    edges_of(classes, cell_m, added_q8);
    for (size_t i = 0; i < strlen(classes); i++) {
        if (added_q8[i] != expected_q8[i]) {
            fail_msg("%s: cell %zu gains %d and not %d", classes, i, added_q8[i], expected_q8[i]);
        }
    }
}

TEST(entering_a_structure_or_trees_brightens_one_cell)
{
    enum { B = 6 * 256, T = 2 * 256 };
    assert_edges("sbbs", 10, (int32_t[]){0, B, 0, 0});
    assert_edges("sttsbt", 10, (int32_t[]){0, T, 0, 0, B, T});
    assert_edges("ssssssssbsssssssssssbbbbtttt", 10, (int32_t[28]){[8] = B, [20] = B, [24] = T});
    assert_edges("tbtbtb", 10, (int32_t[]){0, B, T, B, T, B});
    assert_edges("sacsacsab", 10, (int32_t[9]){[8] = B});
}

TEST(an_edge_beyond_the_range_counts_as_the_last_of_it)
{
    static struct scene s;
    make_flat(&s, 0);
    s.config.edge_structure_db_q8 = INT16_MAX;
    s.config.edge_trees_db_q8 = -1;
    s.line.cell[3] = cell_of(-20, TINY_STRUCTURE, 0);
    s.line.cell[7] = cell_of(-20, TINY_TREES, 0);
    s.line.cell[9] = 0xFF00 | cell_of(-20, TINY_STRUCTURE, 0);
    set_grid(&s, 20000, 10, 12, 3000, 0);
    run(&s, LM_HORIZON_OPEN);
    assert_true(abs(s.lit.level_db_q8[3] - (-20 * 256 + LM_EDGE_MAX_DB_Q8)) < 64);
    assert_true(abs(s.lit.level_db_q8[7] - -20 * 256) < 64);
    assert_true(abs(s.lit.level_db_q8[9] - (255 * 128 - 80 * 256 + LM_EDGE_MAX_DB_Q8)) < 64);
}

TEST(the_first_cell_enters_nothing)
{
    assert_edges("bbss", 10, (int32_t[4]){0});
    assert_edges("ttss", 10, (int32_t[4]){0});
    assert_edges("b", 10, (int32_t[1]){0});
    /* Nor does the first one that is not too near. */
    static struct scene s;
    make_flat(&s, 0);
    s.config = edges;
    for (uint32_t i = 5; i < 20; i++) {
        s.line.cell[i] = cell_of(-20, TINY_TREES, 0);
    }
    set_grid(&s, 1450, 10, 20, 3000, 0);
    assert_int_equal(s.grid.first, 5);
    run(&s, LM_HORIZON_OPEN);
    assert_true(abs(s.lit.level_db_q8[5] + 20 * 256) < 64);
    /* Water that is not shown has no far shore. */
    for (uint32_t i = 0; i < 4; i++) {
        s.line.cell[i] = cell_of(-40, TINY_WATER, 0);
    }
    run(&s, LM_HORIZON_OPEN);
    assert_true(abs(s.lit.level_db_q8[5] + 20 * 256) < 64);
}

TEST(the_far_shore_fades_over_its_width)
{
    enum { S = 5 * 256, FALL = S / 3 }; /* 60 m are 3 cells of 20 m */
    assert_edges("swwsssss", 20, (int32_t[8]){[3] = S, S - FALL, S - 2 * FALL, S - 3 * FALL});
    /* Water ends it, and the next shore begins anew. */
    assert_edges("wswsssss", 20, (int32_t[8]){[1] = S, 0, S, S - FALL, S - 2 * FALL, S - 3 * FALL});
    /* It goes on under other classes, and adds to their edges. */
    assert_edges("wwbstas", 20,
                 (int32_t[7]){[2] = S + 6 * 256, S - FALL, S - 2 * FALL + 2 * 256, S - 3 * FALL});
    /* The near shore is none, nor is the end of the line reached. */
    assert_edges("ssssww", 20, (int32_t[6]){0});
    assert_edges("sssssssssw", 20, (int32_t[10]){0});
    assert_edges("ssssssssws", 20, (int32_t[10]){[9] = S});
    /* Cells longer than the width: one. */
    assert_edges("wsss", 500, (int32_t[4]){[1] = S});
}

/* One class in each of eight cells, in every order of three: the search in words misses no place.
 */
TEST(edges_are_found_wherever_they_lie)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 77);
    for (int n = 0; n < 3000; n++) {
        char classes[41];
        int32_t expected[40] = {0}, shore = 0;
        const uint32_t cells = 1 + (uint32_t)hs_rng_below(&rng, 40);
        const uint32_t change = 1 + (uint32_t)hs_rng_below(&rng, 12);
        for (uint32_t i = 0; i < cells; i++) {
            const int is_new = i == 0 || hs_rng_below(&rng, change) == 0;
            classes[i] = is_new ? "sabtw"[hs_rng_below(&rng, 5)] : classes[i - 1];
        }
        classes[cells] = '\0';
        for (uint32_t i = 1; i < cells; i++) {
            shore = classes[i] == 'w' ? 0 : classes[i - 1] == 'w' ? 5 * 256 : shore - 5 * 256 / 3;
            shore = shore < 0 ? 0 : shore;
            expected[i] = shore;
            if (classes[i] != classes[i - 1]) {
                expected[i] += classes[i] == 'b' ? 6 * 256 : classes[i] == 't' ? 2 * 256 : 0;
            }
        }
        assert_edges(classes, 20, expected);
    }
}

TEST(edges_run_on_in_shadow_and_show_where_it_ends)
{
    static struct scene s, without;
    make_flat(&s, 0);
    s.line.cell[10] = cell_of(0, TINY_STRUCTURE, 9); /* 25 m: some 167 m of shadow */
    for (uint32_t i = 20; i < 24; i++) {
        s.line.cell[i] = cell_of(-40, TINY_WATER, 0);
    }
    s.config = edges;
    s.config.shore_width_m = 600;
    without.line = s.line;
    set_grid(&s, 20000, 10, 100, 3000, 0);
    set_grid(&without, 20000, 10, 100, 3000, 0);
    run(&s, LM_HORIZON_OPEN);
    run(&without, LM_HORIZON_OPEN);
    assert_false(is_lit(&s, 24)); /* the shore itself */
    const uint32_t lit = 40;
    assert_true(is_lit(&s, lit));
    assert_int_equal(s.lit.level_db_q8[lit] - without.lit.level_db_q8[lit],
                     5 * 256 - (int32_t)(lit - 24) * (5 * 256 / 60));
}

TEST(no_data_is_darker_than_any_noise_floor)
{
    static struct scene s;
    make_flat(&s, 0);
    for (uint32_t i = 50; i < 100; i++) {
        s.line.cell[i] = LM_CELL_NONE;
        s.line.elevation_m_q14[i] = 0;
    }
    set_grid(&s, 20000, 10, 150, 3000, 0);
    run(&s, LM_HORIZON_OPEN);
    for (uint32_t i = 50; i < 100; i++) {
        assert_true(abs(s.lit.level_db_q8[i] + 80 * 256) < 64);
    }
    assert_true(abs(s.lit.level_db_q8[100] + 20 * 256) < 64);
}

/* A radar table and a map of numbers that their checks let pass: ground 16 km below the sea, cells
 * of 4 km, and a beam that looks nearly straight down. */
TEST(a_rise_beyond_the_format_lights_the_first_cell)
{
    static struct scene s;
    make_flat(&s, -16000);
    set_grid(&s, 256, 4095, 20, 500, -16000);
    assert_int_equal(s.grid.flat_rise, INT32_MAX);
    run(&s, LM_HORIZON_OPEN);
    assert_true(is_lit(&s, 0));
}
