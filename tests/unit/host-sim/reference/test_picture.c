/* The reference's view of an image file, and its whole pictures, on scenes made for the purpose. */
#include "check.h"
#include "reference/reference.h"
#include "support.h"
#include "tiny_image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double bam_deg = 360 / 4294967296.0;

static void open_image(struct ref_db *db, const struct tiny_spec *spec)
{
    struct tiny_image image;
    assert_int_equal(tiny_image_build(&image, spec), 0);
    assert_int_equal(ref_db_open_memory(db, image.bytes, image.size, "tiny"), 0);
    tiny_image_free(&image);
}

/* Cells that differ from each neighbour, so that a wrong one shows. */
static struct tiny_cell checkered(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    const long row = lround(floor(place->latitude_deg / bam_deg / 512));
    const long column = lround(floor(place->longitude_deg / bam_deg / 512));
    const long index = (row * 5 + column * 3) & 127;
    return (struct tiny_cell){-60 + (double)index * 0.5, (uint8_t)(index % 6),
                              (uint8_t)(index % 16)};
}

/* A plane in degrees, steep enough that a wrong post is metres off. */
static double plane_m(void *ctx, const struct tiny_place *place)
{
    const double *corner = ctx;
    const double north = place->latitude_deg - corner[0];
    return 200 + 9000 * north + 7000 * remainder(place->longitude_deg - corner[1], 360);
}

static const double corners[][2] = {{46, 11},     {-33.5, -179.999}, {61.875, 0.0005},
                                    {-73.125, 0}, {84.4, 180},       {0, 100}};
enum { CORNERS = sizeof corners / sizeof corners[0] };

static struct tiny_spec checkered_spec(const double *corner)
{
    struct tiny_spec spec = tiny_spec_at(corner[0], corner[1]);
    spec.rows = spec.columns = 2;
    spec.cell = checkered;
    spec.elevation_m = plane_m;
    spec.ctx = (void *)corner;
    return spec;
}

/* Places spread over the 2 x 2 tiles around a corner, none on a border. */
static struct ref_place scattered(const double *corner, int i)
{
    return (struct ref_place){corner[0] + ((i * 37 % 101) / 101.0 - 0.499) * 0.0027,
                              corner[1] + ((i * 61 % 103) / 103.0 - 0.499) * 0.0027};
}

TEST(a_place_finds_its_cell_also_across_borders_of_zones_and_longitude)
{
    for (int k = 0; k < CORNERS; k++) {
        const struct tiny_spec spec = checkered_spec(corners[k]);
        struct ref_db db;
        open_image(&db, &spec);
        for (int i = 0; i < 400; i++) {
            const struct ref_place place = scattered(corners[k], i);
            const int zone = fabs(place.latitude_deg) > 84.375   ? 3
                             : fabs(place.latitude_deg) > 73.125 ? 2
                             : fabs(place.latitude_deg) > 61.875 ? 1
                                                                 : 0;
            const double wide = ldexp(512, zone) * bam_deg;
            const double longitude = remainder(place.longitude_deg, 360);
            const struct tiny_place centre = {
                .latitude_deg = (floor(place.latitude_deg / bam_deg / 512) + 0.5) * 512 * bam_deg,
                .longitude_deg = (floor(longitude / wide) + 0.5) * wide};
            const struct tiny_cell expected = checkered(NULL, &centre);
            struct ref_bin bin;
            ref_db_cell(&db, 0, place, &bin);
            assert_true(bin.has_data);
            assert_int_equal(bin.class_index, expected.class_index);
            assert_int_equal(bin.kind, tiny_classes()->entry[expected.class_index].kind);
            assert_true(bin.gamma_db == expected.gamma_db);
            assert_true(bin.height_m == tiny_classes()->height_dm[expected.height_code] / 10.0);
        }
        ref_db_close(&db);
    }
}

TEST(a_plane_comes_back_from_its_posts)
{
    for (int k = 0; k < CORNERS; k++) {
        const struct tiny_spec spec = checkered_spec(corners[k]);
        struct ref_db db;
        open_image(&db, &spec);
        for (int i = 0; i < 400; i++) {
            const struct ref_place place = scattered(corners[k], i);
            const struct tiny_place asked = {place.latitude_deg, place.longitude_deg, 0, 0};
            const double expected_m = plane_m((void *)corners[k], &asked);
            double exact_m, cut_m;
            assert_true(ref_db_elevation(&db, 0, place, true, &exact_m));
            assert_true(ref_db_elevation(&db, 0, place, false, &cut_m));
            /* Posts are stored to the nearest 1/64 m; the cut weights lose less than 1/256 of the
             * rise over a cell in either direction, and always downhill here. */
            assert_true(fabs(exact_m - expected_m) <= 0.5 / 64 + 1e-6);
            const double rise_m = 512 * bam_deg * (9000 + 8 * 7000);
            assert_true(cut_m <= exact_m + 1.0 / 64 && cut_m > exact_m - rise_m / 256 - 1.0 / 64);
        }
        ref_db_close(&db);
    }
}

TEST(the_level_is_the_largest_cell_not_longer_than_nine_eighths_of_a_range_cell)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.level_count = 6;
    struct ref_db db;
    open_image(&db, &spec);
    assert_true(fabs(ref_db_cell_m(&db, 0) - 4.7693) < 0.001);
    assert_true(fabs(ref_db_cell_m(&db, 5) - 152.62) < 0.01);
    const double cells_m[] = {1, 4.7, 8.4, 8.5, 9.6, 100, 136, 5000};
    const unsigned levels[] = {0, 0, 0, 1, 1, 4, 5, 5};
    for (int i = 0; i < 8; i++) {
        assert_int_equal(ref_db_level_for(&db, cells_m[i]), levels[i]);
    }
    ref_db_close(&db);
}

static bool leave_out_level_0(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    (void)ctx;
    (void)column;
    return level == 0 && row % 2 == 1;
}

TEST(a_missing_tile_is_answered_by_its_parent_and_nothing_by_no_data)
{
    struct tiny_spec spec = checkered_spec(corners[0]);
    spec.leave_out = leave_out_level_0;
    spec.level_count = 3;
    struct ref_db db;
    open_image(&db, &spec);
    int coarse = 0;
    for (int i = 0; i < 200; i++) {
        struct ref_bin fine, parent;
        double fine_m, parent_m;
        const struct ref_place place = scattered(corners[0], i);
        const double y = (place.latitude_deg + 90) / bam_deg;
        ref_db_cell(&db, 0, place, &fine);
        ref_db_cell(&db, 1, place, &parent);
        assert_true(ref_db_elevation(&db, 0, place, false, &fine_m));
        assert_true(ref_db_elevation(&db, 1, place, false, &parent_m));
        if ((uint64_t)y >> 15 & 1) {
            coarse++;
            assert_true(fine.gamma_db == parent.gamma_db && fine.class_index == parent.class_index);
            assert_true(fine_m == parent_m);
        }
    }
    assert_in_range(coarse, 50, 150);
    struct ref_bin none;
    double nothing_m;
    ref_db_cell(&db, 0, (struct ref_place){-10, 50}, &none);
    assert_false(none.has_data);
    assert_int_equal(none.class_index, 15);
    assert_true(none.height_m == 0);
    assert_false(ref_db_elevation(&db, 0, (struct ref_place){-10, 50}, false, &nothing_m));
    assert_true(nothing_m == 0);
    ref_db_close(&db);
}

TEST(a_damaged_record_counts_as_missing_and_a_damaged_header_is_refused)
{
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    struct ref_db db;
    struct ref_bin bin;
    image.bytes[image.tiles_offset + 5000] ^= 4;
    assert_int_equal(ref_db_open_memory(&db, image.bytes, image.size, "damaged"), 0);
    ref_db_cell(&db, 0, (struct ref_place){46, 11}, &bin);
    assert_false(bin.has_data);
    ref_db_close(&db);
    const size_t places[] = {0, 8, 16, 24, 25, 300, image.classes_offset, image.bands_offset};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        image.bytes[places[i]] ^= 0x40;
        assert_int_equal(ref_db_open_memory(&db, image.bytes, image.size, "damaged"), -1);
        image.bytes[places[i]] ^= 0x40;
    }
    assert_int_equal(ref_db_open_memory(&db, image.bytes, image.size / 2, "cut off"), -1);
    assert_int_equal(ref_db_open_memory(&db, image.bytes, 100, "cut off"), -1);
    tiny_image_free(&image);
}

/* A block of structures 20 m high, 60 m to the east and 30 m to the north of the centre, 40 m
 * square. */
static struct tiny_cell one_block(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    const bool is_block = fabs(place->east_m - 60) < 20 && fabs(place->north_m - 30) < 20;
    return is_block ? (struct tiny_cell){0, TINY_STRUCTURE, 8}
                    : (struct tiny_cell){-20, TINY_SOIL, 0};
}

static struct ref_sar block_sar(void)
{
    return (struct ref_sar){.centre = {46, 11},
                            .azimuth_deg = 0,
                            .range_m = 20000,
                            .antenna_m =
                                20000 * 0.1763 + 20000 * 20000 / (2 * REF_EFFECTIVE_EARTH_M),
                            .cell_m = 2,
                            .cell_count = 128};
}

static void open_block(struct ref_db *db)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 7;
    spec.rows = spec.columns = 8;
    spec.cell = one_block;
    open_image(db, &spec);
}

/* In the patch the block lies right of the middle and beyond it; its front is bright and its
 * shadow, 20 m / tan 10 degrees = 113 m, falls away from the radar. */
TEST(a_patch_shows_a_block_and_its_shadow_where_they_are)
{
    struct ref_db db;
    open_block(&db);
    const struct ref_sar sar = block_sar();
    const struct ref_params params = ref_params_default();
    struct ref_picture picture;
    assert_int_equal(ref_sar_patch(&picture, &db, &sar, &params), 0);
    int structures = 0, dark = 0;
    assert_int_equal(picture.line_count, 130); /* 128 x 20000 / 19872, even */
    for (unsigned line = 0; line < 130; line++) {
        for (int cell = 0; cell < 128; cell++) {
            const struct ref_bin *bin = ref_picture_bin(&picture, line, cell);
            const double y = (cell + 0.5 - 64) * 2, x = (line + 0.5 - 65) * 2 * (1 + y / 20000);
            if (bin->class_index == TINY_STRUCTURE) {
                structures++;
                assert_true(fabs(x - 60) < 22 && fabs(y - 30) < 22);
            }
            if (!bin->is_lit) {
                dark++;
                assert_true(fabs(x - 60) < 22 && y > 45 && y < 50 + 20 / 0.1763 + 4);
            }
        }
    }
    assert_in_range(structures, 380, 420);
    assert_in_range(dark, 20 * 36, 20 * 40); /* the patch ends before the shadow does */
    const struct ref_bin *front = ref_picture_bin(&picture, 95, 69);
    while (front->class_index != TINY_STRUCTURE) {
        front++;
    }
    const double front_db = 10 * log10(1 + 20 / (0.1763 * 2)) + params.edge_structure_db;
    assert_true(fabs(front->level_db - front_db) < 0.2);
    uint8_t *pixels = malloc((size_t)256 * 256);
    assert_non_null(pixels);
    ref_glass_sar(&picture, sar.range_m, 256, pixels);
    const uint8_t *at = pixels + (size_t)256 * (255 - 2 * 90);
    const uint8_t *lit = pixels + (size_t)256 * (255 - 2 * 37);
    assert_true(2 * at[2 * 94] < lit[2 * 94] && lit[2 * 94] > 30);
    assert_false(ref_picture_bin(&picture, 95, 90)->is_lit);
    assert_true(ref_picture_bin(&picture, 95, 37)->is_lit);
    free(pixels);
    ref_picture_free(&picture);
    ref_db_close(&db);
}

/* A ridge across the line of sight, 3 km before the centre of the patch, rising a little eastward.
 */
static double ridge_m(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    return fmax(0, 900 - 0.6 * fabs(place->north_m + 3000) + 0.01 * place->east_m);
}

TEST(a_ridge_before_the_patch_throws_its_shadow_into_it)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 11;
    spec.rows = spec.columns = 10;
    spec.elevation_m = ridge_m;
    struct ref_db db;
    open_image(&db, &spec);
    const struct ref_params params = ref_params_default();
    const struct ref_sar sar = {
        .centre = {46, 11}, .range_m = 8000, .antenna_m = 2300, .cell_m = 20, .cell_count = 128};
    struct ref_picture picture;
    assert_int_equal(ref_sar_patch(&picture, &db, &sar, &params), 0);
    /* The crest, 5 km from the antenna, hides the ground as far as the ray over it. */
    const double tangent = (900 - 2300) / 5000.0 - 5000 / (2 * REF_EFFECTIVE_EARTH_M);
    const double end_m = REF_EFFECTIVE_EARTH_M *
                         (-tangent - sqrt(tangent * tangent - 2 * 2300 / REF_EFFECTIVE_EARTH_M));
    for (unsigned line = 0; line < picture.line_count; line += 9) {
        for (int cell = 0; cell < 128; cell++) {
            const struct ref_bin *bin = ref_picture_bin(&picture, line, cell);
            /* Coarse cells are 50 m long: the highest of them lies up to 15 m under the crest,
             * which itself changes by 12 m to either side of the middle. */
            assert_true(bin->is_lit || bin->range_m < end_m + 100);
            assert_true(!bin->is_lit || bin->range_m > end_m - 150);
        }
        assert_true(line == 0 || picture.start_horizons[line] > picture.start_horizons[line - 1]);
    }
    ref_picture_free(&picture);
    ref_db_close(&db);
}

/* A slope to the north with hills on it: both ends of a patch that looks there lose ground. */
static double hilly_slope_m(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    return 800 + 0.3 * place->north_m + 15 * sin(place->east_m / 60) * cos(place->north_m / 80);
}

/* What layover brings into a patch is what a patch twice as large shows there, whose ends are
 * elsewhere. */
TEST(overscan_fills_the_ends_with_what_a_larger_patch_shows_there)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 9;
    spec.rows = spec.columns = 6;
    spec.elevation_m = hilly_slope_m;
    struct ref_db db;
    open_image(&db, &spec);
    const struct ref_params params = ref_params_default();
    struct ref_sar sar = {
        .centre = {46, 11}, .range_m = 20000, .antenna_m = 9000, .cell_m = 5, .cell_count = 128};
    struct ref_picture small, large;
    assert_int_equal(ref_sar_patch(&small, &db, &sar, &params), 0);
    sar.cell_count = 256;
    assert_int_equal(ref_sar_patch(&large, &db, &sar, &params), 0);
    print_message("# overscan: %u cells before, %u behind\n", small.overscan.before,
                  small.overscan.behind);
    /* 80 cells beyond the centre the slope is 120 m above it: 0.44 of 5 m each make 10.6 cells less
     * the Earth's drop, and two more. The hills add or take 1.3. */
    assert_in_range(small.overscan.before, 10, 14);
    assert_in_range(small.overscan.behind, 10, 14);
    unsigned beside = 0;
    for (unsigned line = 0; line < small.line_count; line++) {
        const unsigned twin = line + (large.line_count - small.line_count) / 2;
        for (int cell = 0; cell < 128; cell++) {
            const double here = ref_picture_bin(&small, line, cell)->ground;
            const double there = ref_picture_bin(&large, twin, cell + 64)->ground;
            beside += fabs(10 * log10(here / there)) > 0.1;
        }
    }
    print_message("# %u of %u pixels are not those of the larger patch\n", beside,
                  128 * small.line_count);
    assert_true(beside * 1000 < 128 * small.line_count);
    sar.is_plan = true;
    ref_picture_free(&small);
    assert_int_equal(ref_sar_patch(&small, &db, &sar, &params), 0);
    assert_int_equal(small.overscan.before + small.overscan.behind, 0);
    ref_picture_free(&small);
    ref_picture_free(&large);
    ref_db_close(&db);
}

static double plateau_m(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    (void)place;
    return 800;
}

/* Land east of the antenna, water west of it, nothing north of 10 km. */
static struct tiny_cell coast(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    if (place->north_m > 10000) {
        return (struct tiny_cell){-80, TINY_NONE, 0};
    }
    return place->east_m < 0 ? (struct tiny_cell){-40, TINY_WATER, 0}
                             : (struct tiny_cell){-20, TINY_SOIL, 0};
}

TEST(a_sweep_has_its_coast_where_it_is_and_its_brightness)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 13;
    spec.rows = spec.columns = 8;
    spec.cell = coast;
    spec.elevation_m = plateau_m;
    struct ref_db db;
    open_image(&db, &spec);
    const struct ref_params params = ref_params_default();
    const struct ref_gm gm = {.antenna = {46, 11},
                              .antenna_m = 3800,
                              .cell_m = 100,
                              .half_angle_deg = 60,
                              .cell_count = 128,
                              .line_count = 60};
    struct ref_picture picture;
    assert_int_equal(ref_gm_sweep(&picture, &db, &gm, &params), 0);
    for (unsigned line = 0; line < 60; line++) {
        const double azimuth = ref_gm_azimuth_deg(&gm, line) * acos(-1.0) / 180;
        assert_true(fabs(azimuth * 180 / acos(-1.0) - (2.0 * line - 59)) < 1e-9);
        for (int cell = 20; cell < 128;
             cell++) { /* from 2,050 m, beyond half the antenna's height */
            const struct ref_bin *bin = ref_picture_bin(&picture, line, cell);
            const double north = bin->range_m * cos(azimuth), east = bin->range_m * sin(azimuth);
            if (fabs(north - 10000) < 200 || fabs(east) < 200) {
                continue;
            }
            assert_int_equal(bin->has_data, north < 10000);
            if (north > 10000) {
                assert_true(bin->level_db < params.noise_floor_db);
                continue;
            }
            const double expected = east < 0 ? -40 : -20;
            assert_true(fabs(bin->level_db - expected) < 0.25);
        }
    }
    uint8_t *pixels = calloc(444, 256);
    assert_non_null(pixels);
    ref_glass_gm(&picture, &gm, 444, 256, pixels);
    assert_int_equal(pixels[255 * 444 + 10], 0); /* outside the sector */
    assert_int_equal(pixels[100 * 444 + 222 + 80], ref_picture_bin(&picture, 30 + 13, 87)->grey);
    free(pixels);
    ref_picture_free(&picture);
    ref_db_close(&db);
}

/* Speckle of a whole patch of one class: the spread of four looks. */
TEST(the_speckle_of_a_flat_patch_has_the_spread_of_its_looks)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.rows = spec.columns = 3;
    struct ref_db db;
    open_image(&db, &spec);
    struct ref_params params = ref_params_default();
    params.leak_db = -100;
    const struct ref_sar sar = {.centre = {46, 11},
                                .azimuth_deg = 33,
                                .range_m = 20000,
                                .antenna_m = 5000,
                                .cell_m = 1,
                                .cell_count = 160};
    struct ref_picture picture;
    assert_int_equal(ref_sar_patch(&picture, &db, &sar, &params), 0);
    double sum = 0, squares = 0, pairs = 0;
    const int n = 160 * 159;
    for (int i = 0; i < n; i++) {
        const struct ref_bin *bin = ref_picture_bin(&picture, (unsigned)(i / 159), i % 159);
        const double power = pow(10, (bin->echo_db + 20) / 10);
        sum += power / n;
        squares += power * power / n;
        pairs += power * pow(10, (bin[1].echo_db + 20) / 10) / n;
    }
    const double variance = squares - sum * sum;
    assert_true(fabs(sum - 1) < 0.02);
    print_message("# mean %.4f, CV %.4f, neighbours %.3f\n", sum, sqrt(variance),
                  (pairs - sum * sum) / variance);
    assert_true(fabs(sqrt(variance) - 0.5) < 0.02);
    assert_true(fabs((pairs - sum * sum) / variance - 0.30) < 0.05); /* as the weighting says */
    ref_picture_free(&picture);
    ref_db_close(&db);
}

TEST(the_program_renders_dumps_and_explains_itself)
{
    char image_path[] = "/tmp/landmass-tiny-XXXXXX", dump_path[64], raw_path[64], png_path[64];
    close(mkstemp(image_path));
    snprintf(dump_path, sizeof dump_path, "%s.csv", image_path);
    snprintf(raw_path, sizeof raw_path, "%s.f64", image_path);
    snprintf(png_path, sizeof png_path, "%s.png", image_path);
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    assert_int_equal(tiny_image_write(&image, image_path), 0);
    tiny_image_free(&image);
    char program[256];
    snprintf(program, sizeof program, "%s/bin/landmass-reference", support_build_dir());
    assert_int_equal(support_run("%s sar %s --cells 16 --out %s --dump %s", program, image_path,
                                 png_path, dump_path),
                     0);
    assert_int_equal(support_run("test $(wc -l <%s) = %d", dump_path, 1 + 18 * 16), 0);
    assert_int_equal(support_run("%s gm %s --cells 16 --lines 8 --out %s --dump %s", program,
                                 image_path, png_path, raw_path),
                     0);
    assert_int_equal(support_run("test $(wc -c <%s) = %d", raw_path, 23 * 8 * 16 * 8), 0);
    assert_int_equal(support_run("%s sector %s --cells 32 --lines 8 --rain 20 --jam 30 --out %s",
                                 program, image_path, png_path),
                     0);
    assert_int_equal(
        support_run("%s --help >/dev/null && %s sector --help >/dev/null", program, program), 0);
    assert_int_equal(support_run("%s sar %s --lines 8 2>&1 | sed 's/^/# /'; "
                                 "%s sar %s --lines 8 2>/dev/null",
                                 program, image_path, program, image_path),
                     2);
    assert_int_equal(support_run("%s sar %s --range 100 --cells 64 --out %s 2>/dev/null", program,
                                 image_path, png_path),
                     1);
    assert_int_equal(support_run("%s sar /nonexistent 2>/dev/null", program), 1);
    assert_int_equal(support_run("rm -f %s*", image_path), 0);
}
