/* What the reference says a radar sees, against geometry on paper. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>

enum { CELLS = 4000 };
static const double a = REF_EFFECTIVE_EARTH_M, nautical_mile_m = 1852, foot_m = 0.3048;

static double tan_deg(double deg)
{
    return tan(deg * acos(-1.0) / 180);
}

static void assert_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance)) {
        print_error("found %.9g, expected %.9g within %.3g\n", found, expected, tolerance);
        fail();
    }
}

/* A line of flat soil at 0 m whose first cell begins at `near_m`. */
static struct ref_bin *flat_line(size_t count, double near_m, double cell_m)
{
    struct ref_bin *bins = calloc(count, sizeof *bins);
    assert_non_null(bins);
    for (size_t i = 0; i < count; i++) {
        bins[i] = (struct ref_bin){.range_m = near_m + ((double)i + 0.5) * cell_m,
                                   .has_data = true,
                                   .kind = LM_KIND_GROUND,
                                   .gamma_db = -20};
    }
    return bins;
}

static struct ref_params no_edges(void)
{
    struct ref_params params = ref_params_default();
    params.edge_structure_db = params.edge_trees_db = params.shore_db = 0;
    params.noise_floor_db = -200;
    return params;
}

/* Aspect of a line whose ground before the first cell is flat, whatever its range. */
static void look(struct ref_bin *bins, size_t count, double antenna_m, double cell_m,
                 const struct ref_params *params)
{
    const struct ref_view view = {antenna_m, 0, cell_m};
    ref_illuminate(bins, count, &view, params, ref_tangent(antenna_m, bins[0].range_m - cell_m, 0));
}

static size_t dark_run(const struct ref_bin *bins, size_t count, size_t first)
{
    size_t end = first;
    while (end < count && !bins[end].is_lit) {
        end++;
    }
    return end - first;
}

/* Where the ray that leaves the antenna with tangent T meets ground at 0 m: the nearer root of
 * -H/s - s/(2a) = T. */
static double ray_ground_m(double antenna_m, double tangent)
{
    return a * (-tangent - sqrt(tangent * tangent - 2 * antenna_m / a));
}

/* RADAR tables: a 10 m building at 2, 5, 10, 15, 30 degrees throws 286, 114, 57, 37, 17 m. The
 * grazing angle is that of the ray over the roof, on the Earth curved by 4/3, 20 km away: curvature
 * is 0.13 degree there, 7 % of the shadow at 2 degrees. */
TEST(the_shadow_of_a_wall_is_its_height_over_the_tangent_of_grazing)
{
    const double grazing_deg[] = {2, 5, 10, 15, 30}, table_m[] = {286, 114, 57, 37, 17};
    const double wall_m = 10, cell_m = 1, wall_range_m = 20000;
    const struct ref_params params = no_edges();
    for (int i = 0; i < 5; i++) {
        const double slope = tan_deg(grazing_deg[i]);
        const double antenna_m = wall_m + wall_range_m * (slope + wall_range_m / (2 * a));
        struct ref_bin *bins = flat_line(CELLS, wall_range_m - 100 * cell_m - 0.5, cell_m);
        bins[100].kind = LM_KIND_STRUCTURE;
        bins[100].height_m = wall_m;
        look(bins, CELLS, antenna_m, cell_m, &params);
        assert_true(bins[100].is_lit);
        const double shadow_m = (double)dark_run(bins, CELLS, 101) * cell_m;
        assert_near(shadow_m, wall_m / slope, cell_m);
        assert_near(shadow_m, table_m[i], cell_m);
        free(bins);
    }
}

TEST(shadows_on_the_curved_earth_end_where_the_ray_meets_the_ground)
{
    const double cell_m = 30, antenna_m = 3000;
    const struct ref_params params = no_edges();
    for (int range_nm = 10; range_nm <= 80; range_nm += 10) {
        const double wall_range_m = range_nm * nautical_mile_m, wall_m = 40;
        struct ref_bin *bins = flat_line(CELLS, wall_range_m - 10.5 * cell_m, cell_m);
        bins[10].height_m = wall_m;
        look(bins, CELLS, antenna_m, cell_m, &params);
        const double tangent = (wall_m - antenna_m) / wall_range_m - wall_range_m / (2 * a);
        const double end_m = ray_ground_m(antenna_m, tangent);
        const double shadow_m = (double)dark_run(bins, CELLS, 11) * cell_m;
        assert_near(shadow_m, end_m - wall_range_m, cell_m);
        free(bins);
    }
}

/* A cone of slope m crossed beside its top at x is the hyperbola h - m hypot(x, y). A ray of slope
 * p grazes it at y = p x / sqrt(m^2 - p^2), and comes down at p to the ground. */
TEST(the_shadow_of_a_cone_starts_and_ends_where_its_tangent_does)
{
    const double top_m = 300, m = 0.5, cone_range_m = 60000, cell_m = 10;
    const double antenna_m = cone_range_m * (tan_deg(10) + cone_range_m / (2 * a));
    const struct ref_params params = no_edges();
    for (int x = 0; x < 500; x += 120) {
        double y = 0, z = 0, p = tan_deg(10);
        for (int i = 0; i < 5; i++) {
            y = p * x / sqrt(m * m - p * p);
            z = top_m - m * hypot(x, y);
            p = (antenna_m - z) / (cone_range_m + y) - (cone_range_m + y) / (2 * a);
        }
        struct ref_bin *bins = flat_line(CELLS, cone_range_m - 1000.5 * cell_m, cell_m);
        for (int i = 0; i < CELLS; i++) {
            bins[i].elevation_m = fmax(0, top_m - m * hypot(x, bins[i].range_m - cone_range_m));
        }
        look(bins, CELLS, antenna_m, cell_m, &params);
        size_t start = 0;
        while (bins[start].is_lit) {
            start++;
        }
        assert_near(bins[start].range_m - cone_range_m, y, 1.5 * cell_m);
        const size_t end = start + dark_run(bins, CELLS, start);
        assert_near(bins[end].range_m - cone_range_m, y + z / p, cell_m);
        free(bins);
    }
}

TEST(a_cone_flatter_than_the_ray_throws_no_shadow)
{
    const double top_m = 100, m = 0.1, cone_range_m = 60000, cell_m = 10;
    const double antenna_m = cone_range_m * (tan_deg(10) + cone_range_m / (2 * a));
    const struct ref_params params = no_edges();
    struct ref_bin *bins = flat_line(CELLS, cone_range_m - 2000.5 * cell_m, cell_m);
    for (int i = 0; i < CELLS; i++) {
        bins[i].elevation_m = fmax(0, top_m - m * fabs(bins[i].range_m - cone_range_m));
    }
    look(bins, CELLS, antenna_m, cell_m, &params);
    for (int i = 0; i < CELLS; i++) {
        assert_true(bins[i].is_lit);
    }
    free(bins);
}

TEST(a_step_down_throws_the_shadow_of_a_wall_and_a_step_up_shows_its_face)
{
    const double step_m = 50, range_m = 40000, cell_m = 5;
    const double slope = tan_deg(8), antenna_m = step_m + range_m * (slope + range_m / (2 * a));
    const struct ref_params params = no_edges();
    struct ref_bin *bins = flat_line(CELLS, range_m - 1000.5 * cell_m, cell_m);
    for (int i = 300; i <= 1000; i++) {
        bins[i].elevation_m = step_m;
    }
    look(bins, CELLS, antenna_m, cell_m, &params);
    assert_near((double)dark_run(bins, CELLS, 1001) * cell_m, step_m / slope, cell_m);
    /* The face is 50 m of projected height where flat ground shows ds tan psi. */
    const double at = bins[300].range_m, flat = antenna_m / at - at / (2 * a);
    assert_near(bins[300].rise * at, step_m + flat * cell_m, 0.02 * flat * cell_m);
    assert_near(bins[300].level_db, -20 + 10 * log10(1 + step_m / (flat * cell_m)), 0.05);
    free(bins);
}

/* The K law is exact for flat ground: the horizon's rise over a cell is what the gain undoes. */
TEST(flat_ground_shows_its_gamma_at_all_ranges)
{
    const struct ref_params params = no_edges();
    const double scales_nm[] = {10, 20, 40, 80};
    for (int scale = 0; scale < 4; scale++) {
        const double cell_m = scales_nm[scale] * nautical_mile_m / 256, antenna_m = 6000;
        const struct ref_view view = {antenna_m, 0, cell_m};
        struct ref_bin *bins = flat_line(256, 0, cell_m);
        const size_t first = ref_first_shown(bins, 256, &view);
        assert_true(bins[first].range_m >= 3000 && bins[first].range_m < 3000 + cell_m);
        ref_illuminate(bins, 256, &view, &params, ref_gm_horizon(&bins[first], &view));
        for (size_t i = 0; i < 256; i++) {
            assert_near(bins[i].level_db, i < first ? params.noise_floor_db : -20, 1e-6);
        }
        free(bins);
    }
}

TEST(flat_ground_of_a_patch_shows_its_gamma)
{
    const struct ref_params params = no_edges();
    const double cells_m[] = {0.5, 1, 3, 10}, ranges_m[] = {8000, 37040, 74080};
    for (int i = 0; i < 12; i++) {
        const double cell_m = cells_m[i % 4], range_m = ranges_m[i / 4], antenna_m = 5000;
        struct ref_bin *bins = flat_line(256, range_m - 128 * cell_m, cell_m);
        look(bins, 256, antenna_m, cell_m, &params);
        for (int k = 0; k < 256; k++) {
            assert_near(bins[k].level_db, -20, 0.01);
        }
        free(bins);
    }
}

/* A strip of slope angle theta shows ds / cos theta x sin(psi + theta) across the beam, flat ground
 * ds sin psi: a ratio of 1 + tan theta / tan psi. The slopes are one metre high so that range and
 * grazing angle change little on them. */
TEST(slopes_show_their_projected_area)
{
    const double range_m = 50000, cell_m = 1;
    const struct ref_params params = no_edges();
    const double theta_deg[] = {-4, -2, 0, 2, 5, 15, 30, 45}, psi_deg[] = {5, 10, 20, 30};
    for (int i = 0; i < 32; i++) {
        const double m = tan_deg(theta_deg[i % 8]), psi = tan_deg(psi_deg[i / 8]);
        const double antenna_m = range_m * (psi + range_m / (2 * a));
        struct ref_bin *bins = flat_line(64, range_m - 20 * cell_m, cell_m);
        for (int k = 20; k < 64; k++) {
            bins[k].elevation_m = m * (k - 20) * cell_m;
        }
        look(bins, 64, antenna_m, cell_m, &params);
        const double expected_db = -20 + 10 * log10(1 + m / psi);
        assert_near(bins[21].level_db, expected_db, 0.05);
        assert_near(bins[19].level_db, -20, 0.01);
        free(bins);
    }
}

/* Horizons of the 4/3 Earth in nautical miles, the root of twice radius times height, by hand. */
TEST(the_sea_ends_at_the_radar_horizon)
{
    const double feet[] = {500, 5000, 20000, 40000}, horizon_nm[] = {27.5, 86.9, 173.8, 245.7};
    const struct ref_params params = no_edges();
    for (int i = 0; i < 4; i++) {
        const double cell_m = horizon_nm[i] * nautical_mile_m / 2000;
        struct ref_bin *bins = flat_line(CELLS, 0, cell_m);
        const struct ref_view view = {feet[i] * foot_m, 0, cell_m};
        ref_illuminate(bins, CELLS, &view, &params, ref_gm_horizon(&bins[0], &view));
        int last = 0;
        for (int k = 0; k < CELLS; k++) {
            last = bins[k].is_lit ? k : last;
        }
        assert_near(bins[last].range_m / nautical_mile_m, horizon_nm[i],
                    0.06 + cell_m / nautical_mile_m);
        assert_near(bins[last].range_m, sqrt(2 * a * feet[i] * foot_m), cell_m);
        free(bins);
    }
}

/* Kinds of a line by letters: g ground, w water, s structure, t trees. */
static struct ref_bin *line_of_kinds(const char *kinds, size_t count)
{
    static const char letters[] = "gwst";
    struct ref_bin *bins = flat_line(count, 20000, 10);
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 4; k++) {
            bins[i].kind = kinds[i] == letters[k] ? k : bins[i].kind;
        }
    }
    return bins;
}

static void assert_edges(const char *kinds, const struct ref_params *params, const double *edge_q8)
{
    size_t count = 0;
    while (kinds[count] != '\0') {
        count++;
    }
    struct ref_bin *bins = line_of_kinds(kinds, count);
    look(bins, count, 4000, 10, params);
    for (size_t i = 0; i < count; i++) {
        assert_near(bins[i].edge_db * 256, edge_q8[i], 1e-9);
        assert_near(bins[i].level_db, -20 + edge_q8[i] / 256, 0.01);
    }
    free(bins);
}

TEST(leading_edges_brighten_the_first_cell_of_structures_and_trees)
{
    struct ref_params params = no_edges();
    params.edge_structure_db = 6;
    params.edge_trees_db = 3;
    const double expected[] = {0, 1536, 0, 0, 768, 0, 1536, 768, 0, 0, 0, 768};
    assert_edges("gssgttstggwt", &params, expected);
    const double none_before_the_first[] = {0, 0, 0};
    assert_edges("ssg", &params, none_before_the_first);
}

/* Shore 1 dB over 58 m of 10 m cells: round(5.8) = 6 cells, steps of floor(256 / 6) = 42, so 256,
 * 214, .. 46, 4, 0; water ends the ramp and the next shore begins another. */
TEST(the_far_shore_is_a_ramp_that_water_ends)
{
    struct ref_params params = no_edges();
    params.shore_db = 1;
    params.shore_width_m = 58;
    const double expected[] = {0, 0, 256, 214, 172, 130, 88, 46, 4, 0, 0, 256, 214, 0, 256, 214};
    assert_edges("gwggggggggwggwgg", &params, expected);
    params.edge_structure_db = 6;
    const double both[] = {0, 256 + 1536, 214, 172, 130, 88};
    assert_edges("wsssgg", &params, both);
}

TEST(a_shore_narrower_than_a_cell_is_one_cell)
{
    struct ref_params params = no_edges();
    params.shore_db = 8;
    params.shore_width_m = 1;
    const double expected[] = {0, 2048, 0, 0};
    assert_edges("wggg", &params, expected);
}

/* The shore lies in the shadow of a wall: its ramp runs on in the dark, and what comes out of the
 * shadow has the rest of it. */
TEST(edges_count_in_shadow_and_show_only_when_lit)
{
    struct ref_params params = no_edges();
    params.shore_db = 10;
    params.shore_width_m = 100;
    params.noise_floor_db = -60;
    struct ref_bin *bins = line_of_kinds("gwwwwggggggggggg", 16);
    bins[1].height_m = 14; /* at a grazing angle of 11 degrees: 70 m, 7 cells */
    look(bins, 16, 4000, 10, &params);
    size_t first_lit = 2;
    while (!bins[first_lit].is_lit) {
        assert_near(bins[first_lit].level_db, -60, 0);
        first_lit++;
    }
    assert_in_range(first_lit, 8, 10);
    assert_near(bins[first_lit].edge_db, 10 - (double)(first_lit - 5), 1e-9);
    free(bins);
}

TEST(no_data_is_ground_of_minus_80_db_that_hides)
{
    const struct ref_params params = no_edges();
    struct ref_bin *bins = flat_line(32, 20000, 10);
    bins[8].has_data = false;
    bins[8].gamma_db = -80;
    bins[8].elevation_m = 10;
    look(bins, 32, 4000, 10, &params);
    assert_true(bins[8].level_db < -55);
    assert_false(bins[9].is_lit);
    free(bins);
}

/* Partly in shadow: the cell where the shadow of a wall ends shows the part of it that is lit. */
TEST(a_cell_partly_in_shadow_is_partly_lit)
{
    const struct ref_params params = no_edges();
    struct ref_bin *bins = flat_line(200, 20000, 10);
    bins[50].height_m = 20;
    look(bins, 200, 4000, 10, &params);
    const size_t first_lit = 51 + dark_run(bins, 200, 51);
    const double end_m = ray_ground_m(4000, bins[50].tangent);
    const double lit_share = (bins[first_lit].range_m - end_m) / 10;
    assert_in_range(lit_share * 1000, 0, 1000);
    assert_near(bins[first_lit].level_db, -20 + 10 * log10(lit_share), 0.05);
    free(bins);
}

TEST(the_receiver_gain_is_held_where_flat_ground_is_too_flat)
{
    const struct ref_view view = {1000, 0, 100};
    const double beyond_m = sqrt(2 * a * 1000) * 2;
    assert_near(ref_grazing(&view, beyond_m, beyond_m), 1.0 / 256, 0);
    assert_near(ref_gain_db(&view, beyond_m, beyond_m), 10 * log10(beyond_m * 256 / 100), 1e-9);
    assert_near(ref_grazing(&view, 10000, 9900), 0.1 - 9900 / (2 * a), 1e-12);
}
