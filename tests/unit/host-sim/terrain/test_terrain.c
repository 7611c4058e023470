/* Elevation models as one surface: every post against GDAL's own resampling, voids, seas, edges and
 * seams. */
#include "fill.h"
#include "terrain/surface.h"

#include "check.h"
#include "scene.h"
#include "support.h"

#include <cpl_string.h>
#include <gdal_utils.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { N = LM_TILE_POSTS };

static void open_terrain(struct terrain *t, uint8_t shift0, int count, ...)
{
    struct hs_list list = {.count = count};
    va_list names;
    va_start(names, count);
    for (int i = 0; i < count; i++) {
        list.items[i] = (char *)va_arg(names, const char *);
    }
    va_end(names);
    const struct terrain_options options = {.sea_level_m = 0.0};
    assert_int_equal(terrain_open(t, &list, &options), 0);
    terrain_set_cell(t, shift0);
}

static struct image_frame frame_at(uint8_t shift, double latitude, double longitude)
{
    const uint32_t row = image_row_of(shift, image_bam(latitude));
    const uint8_t zone = image_row_zone(shift, row);
    const uint32_t column = (uint32_t)image_bam(longitude) >> (shift + zone + LM_TILE_CELLS_LOG2);
    return image_frame_of(shift, zone, row, column);
}

/* GDAL's bilinear warp with an exact transformation to a grid whose pixel centres are the tile's
 * posts. */
static void gdal_posts(GDALDatasetH source, const struct image_frame *f, float posts[N][N])
{
    char number[6][40], *arguments[32];
    const double north_step = image_degrees(f->latitude_step);
    const double east_step = image_degrees(f->longitude_step);
    const double west = image_longitude_degrees(f->west) - east_step / 2;
    const double south = image_degrees(f->south) - north_step / 2;
    snprintf(number[0], sizeof number[0], "%.17g", west);
    snprintf(number[1], sizeof number[1], "%.17g", south);
    snprintf(number[2], sizeof number[2], "%.17g", west + N * east_step);
    snprintf(number[3], sizeof number[3], "%.17g", south + N * north_step);
    const char *const list[] = {"-of",        "MEM",     "-r",        "bilinear", "-et",
                                "0",          "-t_srs",  "EPSG:4326", "-ot",      "Float32",
                                "-dstnodata", "-9999",   "-ts",       "65",       "65",
                                "-te",        number[0], number[1],   number[2],  number[3]};
    int count = 0;
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        arguments[count++] = (char *)list[i];
    }
    arguments[count] = NULL;
    GDALWarpAppOptions *options = GDALWarpAppOptionsNew(arguments, NULL);
    int failed = 0;
    GDALDatasetH warped = GDALWarp("", NULL, 1, &source, options, &failed);
    GDALWarpAppOptionsFree(options);
    assert_non_null(warped);
    float top_down[N][N];
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(warped, 1), GF_Read, 0, 0, N, N, top_down, N, N,
                                  GDT_Float32, 0, 0),
                     CE_None);
    for (int r = 0; r < N; r++) {
        memcpy(posts[r], top_down[N - 1 - r], sizeof posts[r]);
    }
    GDALClose(warped);
}

/* Largest difference in metres between our posts and GDAL's over a square of tiles. */
static double worst_against_gdal(struct terrain *t, GDALDatasetH source, uint8_t shift,
                                 double latitude, double longitude, int tiles)
{
    static struct terrain_posts ours;
    static float theirs[N][N];
    const struct image_frame first = frame_at(shift, latitude, longitude);
    double worst = 0.0;
    long compared = 0;
    for (int i = 0; i < tiles * tiles; i++) {
        const struct image_frame f =
            image_frame_of(shift, first.zone, first.row + (uint32_t)(i / tiles),
                           first.column + (uint32_t)(i % tiles));
        assert_true(terrain_posts(t, &f, &ours) >= 0);
        gdal_posts(source, &f, theirs);
        for (int k = 0; k < N * N; k++) {
            const float z = theirs[k / N][k % N];
            if (z > -9000.0f) {
                worst = fmax(worst, fabs(ours.q6[k / N][k % N] / 64.0 - (double)z));
                compared++;
            }
        }
    }
    assert_true(compared > 1000);
    print_message("# worst of %ld posts: %.4f m\n", compared, worst);
    return worst;
}

/* Half a step of 1/64 m, and float against double. */
static const double rounding_m = 0.5 / 64 + 0.002;

TEST(posts_over_dted_are_gdals_bilinear_samples_across_the_files_edges)
{
    char a[512], b[512], c[512];
    if (!support_data_path("dted1_hawaii/n19_w155_3arc_v2.dt1", a, sizeof a) ||
        !support_data_path("dted1_hawaii/n19_w156_3arc_v2.dt1", b, sizeof b) ||
        !support_data_path("dted1_hawaii/n20_w156_3arc_v2.dt1", c, sizeof c)) {
        skip();
    }
    scene_folder();
    const char *names[] = {a, b, c, NULL};
    int failed = 0;
    GDALDatasetH vrt = GDALBuildVRT("", 3, NULL, names, NULL, &failed);
    assert_non_null(vrt);
    struct terrain t;
    open_terrain(&t, 11, 3, a, b, c);
    assert_int_equal(t.layer_count, 1);
    assert_true(worst_against_gdal(&t, vrt, 11, 19.94, -155.3, 10) < rounding_m); /* across 20 N */
    assert_true(worst_against_gdal(&t, vrt, 11, 19.3, -155.06, 10) < rounding_m); /* across 155 W */
    terrain_close(&t);
    GDALClose(vrt);
}

TEST(posts_over_utm_with_negative_northings_are_gdals_bilinear_samples)
{
    char path[512];
    if (!support_data_path("landsat5_amazon_tucurui_srtm_labels/derived/srtm.bsq", path,
                           sizeof path)) {
        skip();
    }
    scene_folder();
    GDALDatasetH source = GDALOpen(path, GA_ReadOnly);
    assert_non_null(source);
    struct terrain t;
    open_terrain(&t, 9, 1, path);
    assert_true(worst_against_gdal(&t, source, 9, -3.78, -49.92, 10) < rounding_m);
    terrain_close(&t);
    GDALClose(source);
}

/* Root of the mean square of what the image's bilinear surface misses of the model's, over a tile,
 * at quarters of its cells. */
static double missed_m(const struct image_frame *f, float posts[N][N],
                       double (*model)(double, double))
{
    double sum = 0;
    for (int k = 0; k < 256 * 256; k++) {
        const double v = k / 256 / 4.0, u = k % 256 / 4.0;
        const int r = (int)v, c = (int)u;
        const double south = posts[r][c] + (posts[r][c + 1] - posts[r][c]) * (u - c);
        const double north = posts[r + 1][c] + (posts[r + 1][c + 1] - posts[r + 1][c]) * (u - c);
        const double off_m =
            south + (north - south) * (v - r) -
            model(image_longitude_degrees(f->west) + image_degrees(f->longitude_step) * u,
                  image_degrees(f->south) + image_degrees(f->latitude_step) * v);
        sum += off_m * off_m;
    }
    return sqrt(sum / (256 * 256));
}

/* Pixels of 0.001 degrees of pyramids on which hardly a post of the image lies, and their bilinear
 * surface. */
static double pyramid(double x, double y)
{
    const long column = (long)floor(x / 0.001), row = (long)floor(y / 0.001);
    return 40.0 * (double)((column * 7 + row * 3) % 5) + 25.0 * (double)((column + 2 * row) % 3);
}

static double between_pyramids(double x, double y)
{
    const double u = x / 0.001 - 0.5, v = y / 0.001 - 0.5, fu = u - floor(u), fv = v - floor(v);
    const double west = (floor(u) + 0.5) * 0.001, south = (floor(v) + 0.5) * 0.001;
    return (pyramid(west, south) * (1 - fu) + pyramid(west + 0.001, south) * fu) * (1 - fv) +
           (pyramid(west, south + 0.001) * (1 - fu) + pyramid(west + 0.001, south + 0.001) * fu) *
               fv;
}

/* 0.001 degrees are 1.46 cells of 2^13 BAM. */
TEST(posts_nearly_as_far_apart_as_the_models_are_fitted_to_its_surface)
{
    const struct scene_raster r = scene_in_degrees(400, 10.0, 50.4, 0.001, GDT_Float32, pyramid);
    scene_write("pyramids.tif", &r);
    GDALDatasetH source = GDALOpen(scene_path("pyramids.tif"), GA_ReadOnly);
    struct terrain t;
    open_terrain(&t, 13, 1, scene_path("pyramids.tif"));
    const struct image_frame f = frame_at(13, 50.2, 10.2);
    static struct terrain_posts posts;
    static float fitted[N][N], sampled[N][N];
    assert_int_equal(terrain_posts(&t, &f, &posts), N * N);
    gdal_posts(source, &f, sampled);
    for (int k = 0; k < N * N; k++) {
        fitted[k / N][k % N] = (float)(posts.q6[k / N][k % N] / 64.0);
        assert_true(fitted[k / N][k % N] >= 0 && fitted[k / N][k % N] <= 210);
    }
    const double ours_m = missed_m(&f, fitted, between_pyramids);
    const double samples_m = missed_m(&f, sampled, between_pyramids);
    print_message("# fitted posts miss %.1f m of the surface, samples %.1f m\n", ours_m, samples_m);
    assert_true(ours_m < 0.75 * samples_m);
    terrain_close(&t);
    GDALClose(source);
}

/* A model whose pixels are the image's cells: the fit has nothing to do. */
static double of_cells(double x, double y)
{
    const double cell = image_degrees(8192);
    return 50.0 * (double)((long)floor(x / cell) * 7 % 11) +
           30.0 * (double)((long)floor(y / cell) % 7);
}

TEST(posts_that_lie_on_the_models_are_the_models)
{
    const double cell = image_degrees(8192);
    const double west = (floor(10.0 / cell) - 0.5) * cell,
                 north = (floor(50.4 / cell) + 0.5) * cell;
    const struct scene_raster r = scene_in_degrees(500, west, north, cell, GDT_Float32, of_cells);
    scene_write("cells.tif", &r);
    struct terrain t;
    open_terrain(&t, 13, 1, scene_path("cells.tif"));
    assert_true(t.layers[0].fit.is_on);
    const struct image_frame f = frame_at(13, 50.2, 10.2);
    static struct terrain_posts posts;
    assert_int_equal(terrain_posts(&t, &f, &posts), N * N);
    for (int k = 0; k < N * N; k++) {
        const double y = image_degrees(f.south + k / N * f.latitude_step);
        const double x = image_degrees((int64_t)f.west + k % N * f.longitude_step);
        const double z = of_cells(x + cell / 4, y + cell / 4);
        /* What the dual loses at its ends: a thousandth of jumps of 700 m. */
        assert_true(fabs(posts.q6[k / N][k % N] / 64.0 - z) < 1.0);
    }
    terrain_close(&t);
}

static double cliff(double x, double y)
{
    (void)y;
    return x < 10.2 ? 0.0 : 400.0;
}

TEST(water_beside_a_cliff_stays_flat_in_fitted_posts)
{
    const struct scene_raster r = scene_in_degrees(400, 10.0, 50.4, 0.001, GDT_Float32, cliff);
    scene_write("cliff.tif", &r);
    struct terrain t;
    open_terrain(&t, 13, 1, scene_path("cliff.tif"));
    const struct image_frame f = frame_at(13, 50.2, 10.2);
    static struct terrain_posts posts;
    assert_int_equal(terrain_posts(&t, &f, &posts), N * N);
    int flat = 0;
    for (int k = 0; k < N * N; k++) {
        const double x = image_degrees((int64_t)f.west + k % N * f.longitude_step);
        const int32_t z_q6 = posts.q6[k / N][k % N];
        assert_in_range(z_q6, 0, 400 * 64);
        if (x < 10.1995 - 1e-9) { /* the middle of the last pixel before the cliff */
            assert_int_equal(z_q6, 0);
            flat++;
        }
    }
    assert_true(flat > N);
    terrain_close(&t);
}

/* A tilted plane over degrees. */
static double plane(double x, double y)
{
    return 100.0 + 300.0 * (x - 10.0) - 200.0 * (y - 50.0);
}

TEST(a_plane_stays_a_plane_whether_cells_are_finer_or_coarser_than_the_model)
{
    const struct scene_raster r = scene_in_degrees(1200, 10.0, 51.2, 0.001, GDT_Float32, plane);
    scene_write("plane.tif", &r);
    /* 0.001 degree is 11,930 BAM: cells of 2^10 to 2^18. */
    for (uint8_t shift = 10; shift <= 18; shift++) {
        struct terrain t;
        open_terrain(&t, shift, 1, scene_path("plane.tif"));
        const struct image_frame f = frame_at(shift, 50.6, 10.6);
        static struct terrain_posts posts;
        assert_true(terrain_posts(&t, &f, &posts) > 0);
        const double margin = 0.002 + image_degrees((int64_t)1 << shift);
        for (int k = 0; k < N * N; k++) {
            const double y = image_degrees(f.south + k / N * f.latitude_step);
            const double x = image_degrees((int64_t)f.west + k % N * f.longitude_step);
            /* Nearer than the kernel to the raster's edge there is less than a plane to see. */
            if (x > 10 + margin && x < 11.2 - margin && y > 50 + margin && y < 51.2 - margin) {
                assert_true(fabs(posts.q6[k / N][k % N] / 64.0 - plane(x, y)) < rounding_m);
            }
        }
        terrain_close(&t);
    }
}

/* Columns of 0 and 100 m in turn, each a pixel wide. */
static double comb(double x, double y)
{
    (void)y;
    return (long)floor(x / 0.001) & 1 ? 100.0 : 0.0;
}

TEST(a_model_much_finer_than_the_cells_is_averaged)
{
    const struct scene_raster r = scene_in_degrees(1000, 10.0, 51.0, 0.001, GDT_Int16, comb);
    scene_write("comb.tif", &r);
    struct terrain t;
    open_terrain(&t, 17, 1, scene_path("comb.tif"));
    const struct image_frame f = frame_at(17, 50.5, 10.5);
    static struct terrain_posts posts;
    assert_true(terrain_posts(&t, &f, &posts) > 0);
    for (int k = 0; k < N * N; k++) {
        const double y = image_degrees(f.south + k / N * f.latitude_step);
        const double x = image_degrees((int64_t)f.west + k % N * f.longitude_step);
        if (x > 10.03 && x < 10.97 && y > 50.03 && y < 50.97) {
            assert_true(fabs(posts.q6[k / N][k % N] / 64.0 - 50.0) < 2.0);
        }
    }
    terrain_close(&t);
}

/* A square hole in a slope of a metre a pixel, in rectangles on both sides of the coarse picture's
 * size. */
TEST(a_hole_in_a_slope_is_filled_with_the_slope)
{
    scene_folder();
    static const int sides[] = {5, 40, 256, 257, 700, 1500};
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        const int side = sides[i], rim = side / 5;
        float *metres = malloc((size_t)side * (size_t)side * sizeof *metres);
        uint8_t *is_known = malloc((size_t)side * (size_t)side);
        for (int k = 0; k < side * side; k++) {
            const int x = k % side, y = k / side;
            is_known[k] = x < rim || y < rim || x >= side - rim || y >= side - rim;
            metres[k] = is_known[k] ? (float)(x + y) : -1e9f;
        }
        assert_int_equal(terrain_fill(side, side, metres, is_known), 0);
        double worst = 0, worst_step = 0;
        for (int k = 0; k < side * side; k++) {
            const int x = k % side, y = k / side;
            worst = fmax(worst, fabs((double)metres[k] - x - y));
            worst_step =
                x > 0 ? fmax(worst_step, fabs((double)(metres[k] - metres[k - 1]))) : worst_step;
            const bool was_known = x < rim || y < rim || x >= side - rim || y >= side - rim;
            assert_true(!was_known || metres[k] == (float)(x + y));
        }
        print_message("# %d pixels: %.1f m off at most, steps up to %.1f m\n", side, worst,
                      worst_step);
        /* Of a slope of 2 x side metres. */
        assert_true(worst < 0.05 * side && worst_step < 2.0);
        free(metres);
        free(is_known);
    }
}

/* Ground on a slope with a square hole; hills around a hole in the sea; a hole with nothing known
 * around it. */
static double holed(double x, double y)
{
    const bool is_land_hole = x > 10.3 && x < 10.33 && y > 50.3 && y < 50.33;
    const bool is_sea_hole = x > 10.6 && x < 10.7 && y > 50.6 && y < 50.7;
    const bool is_sea = x > 10.55 && x < 10.75 && y > 50.55;
    return is_land_hole || is_sea_hole ? -32768 : is_sea ? 0 : 500 + 1000 * (x - 10);
}

TEST(voids_on_land_are_filled_from_their_rim_and_voids_at_sea_are_sea)
{
    const struct scene_raster r = {.width = 800,
                                   .height = 800,
                                   .geotransform = {10.0, 0.001, 0, 50.8, 0, -0.001},
                                   .epsg = 4326,
                                   .type = GDT_Int16,
                                   .has_nodata = true,
                                   .nodata = -32768,
                                   .value = holed};
    scene_write("holed.tif", &r);
    struct terrain t;
    open_terrain(&t, 12, 1, scene_path("holed.tif"));
    const struct terrain_voids *v = &t.layers[0].voids;
    assert_int_equal(v->region_count, 2);
    assert_int_equal(v->regions[0].filling, TERRAIN_SEA);
    assert_int_equal(v->regions[0].pixels, 100 * 100);
    assert_int_equal(v->regions[1].filling, TERRAIN_INTERPOLATED);
    assert_int_equal(v->regions[1].pixels, 30 * 30);
    static struct terrain_posts posts;
    for (int hole = 0; hole < 2; hole++) {
        const struct image_frame f = frame_at(12, hole ? 50.315 : 50.65, hole ? 10.315 : 10.65);
        assert_int_equal(terrain_posts(&t, &f, &posts), N * N);
        for (int k = 0; k < N * N; k++) {
            const double x = image_degrees((int64_t)f.west + k % N * f.longitude_step);
            const double z = posts.q6[k / N][k % N] / 64.0;
            /* The slope is a metre a pixel. */
            assert_true(hole ? fabs(z - (500 + 1000 * (x - 10))) < 1 : z == 0.0);
        }
    }
    terrain_close(&t);
}

/* A sea void larger than "small", in open sea, and one that is half on land. */
static double large_holes(double x, double y)
{
    const bool is_at_sea = x > 10.1 && x < 10.4 && y > 50.1 && y < 50.4;
    const bool is_on_coast = x > 10.5 && x < 10.9 && y > 50.1 && y < 50.4;
    return is_at_sea || is_on_coast ? -9999 : x > 10.7 ? 300 : 0;
}

TEST(a_large_void_on_a_coast_is_left_unless_voids_are_said_to_be_sea)
{
    const struct scene_raster r = {.width = 1000,
                                   .height = 500,
                                   .geotransform = {10.0, 0.001, 0, 50.5, 0, -0.001},
                                   .epsg = 4326,
                                   .type = GDT_Float32,
                                   .has_nodata = true,
                                   .nodata = -9999,
                                   .value = large_holes};
    scene_write("large.tif", &r);
    for (int sea = 0; sea < 2; sea++) {
        const struct hs_list list = {.items = {(char *)scene_path("large.tif")}, .count = 1};
        const struct terrain_options options = {.voids_are_sea = sea};
        struct terrain t;
        assert_int_equal(terrain_open(&t, &list, &options), 0);
        terrain_set_cell(&t, 12);
        static struct terrain_posts posts;
        struct image_frame f = frame_at(12, 50.25, 10.25);
        assert_int_equal(terrain_posts(&t, &f, &posts), N * N);
        assert_int_equal(posts.q6[9][9], 0);
        f = frame_at(12, 50.25, 10.8);
        assert_int_equal(terrain_posts(&t, &f, &posts), sea ? N * N : 0);
        assert_true(sea ? posts.q6[9][9] == 0 : posts.q6[9][9] > 100 * 64);
        terrain_close(&t);
    }
}

static double all_void(double x, double y)
{
    (void)x;
    (void)y;
    return (double)NAN;
}

TEST(a_model_of_voids_only_reaches_nothing_and_the_next_one_shows_through)
{
    struct scene_raster r = scene_in_degrees(100, 10.0, 51.0, 0.01, GDT_Float32, all_void);
    scene_write("void.tif", &r);
    r.value = plane;
    scene_write("under.tif", &r);
    static struct terrain_posts posts;
    const struct image_frame f = frame_at(13, 50.5, 10.5);
    struct terrain t;
    open_terrain(&t, 13, 1, scene_path("void.tif"));
    assert_int_equal(terrain_posts(&t, &f, &posts), 0);
    terrain_close(&t);
    open_terrain(&t, 13, 2, scene_path("void.tif"), scene_path("under.tif"));
    assert_int_equal(terrain_posts(&t, &f, &posts), N * N);
    const double x = image_degrees((int64_t)f.west), y = image_degrees(f.south);
    assert_true(fabs(posts.q6[0][0] / 64.0 - plane(x, y)) < 0.05);
    terrain_close(&t);
}

TEST(beyond_the_model_posts_keep_the_height_of_its_edge)
{
    const struct scene_raster r = scene_in_degrees(100, 10.0, 51.0, 0.01, GDT_Float32, plane);
    scene_write("edge.tif", &r);
    struct terrain t;
    open_terrain(&t, 13, 1, scene_path("edge.tif"));
    const struct image_frame f = frame_at(13, 50.5, 11.0);
    static struct terrain_posts posts;
    const int reached = terrain_posts(&t, &f, &posts);
    assert_in_range(reached, 1, N * N - 1);
    for (int r0 = 0; r0 < N; r0++) {
        for (int c = 0; c < N; c++) {
            const double y = image_degrees(f.south + r0 * f.latitude_step);
            const double x = image_degrees((int64_t)f.west + c * f.longitude_step);
            assert_int_equal(posts.has[r0][c], x < 11.0);
            /* One pixel is 3 m eastward and 2 m northward. */
            assert_true(fabs(posts.q6[r0][c] / 64.0 - plane(fmin(x, 10.995), y)) < 3.1);
        }
    }
    terrain_close(&t);
}

static double feet(double x, double y)
{
    (void)x;
    (void)y;
    return 1000;
}

TEST(of_two_models_the_nearer_one_lends_its_edge)
{
    scene_folder();
    struct scene_raster r = scene_in_degrees(100, 12.0, 51.0, 0.01, GDT_Float32, feet);
    scene_write("far.tif", &r);
    r.geotransform[0] = 10.0;
    r.value = plane;
    scene_write("near.tif", &r);
    for (int order = 0; order < 2; order++) {
        struct terrain t;
        open_terrain(&t, 13, 2, scene_path(order ? "far.tif" : "near.tif"),
                     scene_path(order ? "near.tif" : "far.tif"));
        static struct terrain_posts posts;
        struct image_frame f = frame_at(13, 50.5, 11.2);
        assert_int_equal(terrain_posts(&t, &f, &posts), 0);
        assert_true(fabs(posts.q6[0][0] / 64.0 - plane(10.995, image_degrees(f.south))) < 3.1);
        f = frame_at(13, 50.5, 11.8);
        assert_int_equal(terrain_posts(&t, &f, &posts), 0);
        assert_int_equal(posts.q6[0][0], 1000 * 64);
        terrain_close(&t);
    }
}

/* A tile against its neighbours to the east and north. */
static void assert_edges_shared(struct terrain *t, const struct image_frame *f)
{
    static struct terrain_posts home, east, north;
    const uint32_t mask = image_columns_round(f->shift, f->zone) - 1;
    const struct image_frame e = image_frame_of(f->shift, f->zone, f->row, (f->column + 1) & mask);
    const struct image_frame n = image_frame_of(f->shift, f->zone, f->row + 1, f->column);
    assert_true(terrain_posts(t, f, &home) >= 0);
    assert_true(terrain_posts(t, &e, &east) >= 0 && terrain_posts(t, &n, &north) >= 0);
    for (int k = 0; k < N; k++) {
        assert_int_equal(home.q6[k][N - 1], east.q6[k][0]);
        assert_int_equal(home.q6[N - 1][k], north.q6[0][k]);
        assert_int_equal(home.has[k][N - 1], east.has[k][0]);
        assert_int_equal(home.has[N - 1][k], north.has[0][k]);
    }
}

static double jumps(double x, double y)
{
    return fmod(fabs(floor(x / 0.001) * 7 + floor(y / 0.001) * 3), 11) * 10;
}

/* At levels and places where the mapping is bent, cut or wrapped, on ground that jumps by 100 m a
 * pixel. */
TEST(tiles_share_their_edges_bit_for_bit)
{
    static const struct {
        int epsg;
        double geotransform[6];
        uint8_t shift;
        double latitude, longitude;
    } cases[] = {
        {4326, {10.0, 0.001, 0, 51.0, 0, -0.001}, 12, 50.5, 10.5},
        {32632, {400000, 100, 0, 5700000, 0, -100}, 13, 51.0, 8.2},
        {32632, {450000, 100, 0, 6820000, 0, -100}, 15, 60.6, 8.4}, /* bent here, straight there */
        {32632, {400000, 100, 0, 5700000, 0, -100}, 17, 51.0, 8.2}, /* bent over 300 km tiles */
        {32660, {750000, 1000, 0, 400000, 0, -1000}, 15, 2.0, 179.7}, /* over the antimeridian */
        {3857,
         {19000000, 1000, 0, 500000, 0, -1000},
         16,
         3.0,
         179.5}, /* the seam of the projection */
        {3413, {-600000, 1000, 0, 600000, 0, -1000}, 17, 87.0, 90.0}, /* near the pole */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct scene_raster r = {.width = 1200,
                                 .height = 1200,
                                 .epsg = cases[i].epsg,
                                 .type = GDT_Float32,
                                 .value = jumps};
        memcpy(r.geotransform, cases[i].geotransform, sizeof r.geotransform);
        scene_write("shared.tif", &r);
        struct terrain t;
        open_terrain(&t, cases[i].shift, 1, scene_path("shared.tif"));
        const struct image_frame first =
            frame_at(cases[i].shift, cases[i].latitude, cases[i].longitude);
        static struct terrain_posts posts;
        assert_true(terrain_posts(&t, &first, &posts) > 0);
        for (uint32_t k = 0; k < 25; k++) {
            const uint32_t mask = image_columns_round(first.shift, first.zone) - 1;
            const struct image_frame f = image_frame_of(first.shift, first.zone, first.row + k / 5,
                                                        (first.column + k % 5) & mask);
            if (f.south + 2 * LM_TILE_CELLS * f.latitude_step <= IMAGE_BAM_QUARTER &&
                image_row_zone(f.shift, f.row + 1) == f.zone) {
                assert_edges_shared(&t, &f);
            }
        }
        terrain_close(&t);
    }
}

TEST(elevations_in_feet_become_metres)
{
    const struct scene_raster r = scene_in_degrees(100, 10.0, 51.0, 0.01, GDT_Int16, feet);
    scene_write("feet.tif", &r);
    GDALDatasetH d = GDALOpen(scene_path("feet.tif"), GA_Update);
    GDALSetRasterUnitType(GDALGetRasterBand(d, 1), "ft");
    GDALClose(d);
    struct terrain t;
    open_terrain(&t, 13, 1, scene_path("feet.tif"));
    const struct image_frame f = frame_at(13, 50.5, 10.5);
    static struct terrain_posts posts;
    assert_int_equal(terrain_posts(&t, &f, &posts), N * N);
    assert_int_equal(posts.q6[0][0], lround(304.8 * 64));
    terrain_close(&t);
}

TEST(the_unknown_half_of_an_srtm_tile_is_left_and_the_hills_are_filled)
{
    char path[512];
    if (!support_data_path("srtm_hgt/N48W125.hgt.zip", path, sizeof path)) {
        skip();
    }
    scene_folder();
    struct terrain t;
    open_terrain(&t, 11, 1, path);
    uint64_t pixels[3] = {0};
    const struct terrain_voids *v = &t.layers[0].voids;
    for (size_t i = 0; i < v->region_count; i++) {
        pixels[v->regions[i].filling] += v->regions[i].pixels;
    }
    /* Counted apart from this program: 34 regions, 6,483,876 posts, the northern half of which is
     * one; 69 % of its rim is at sea level, and the rest the mountains of Vancouver Island. */
    assert_int_equal(v->region_count, 34);
    assert_int_equal(pixels[TERRAIN_LEFT_VOID], 6482170);
    assert_int_equal(pixels[TERRAIN_INTERPOLATED], 6483876 - 6482170);
    static struct terrain_posts posts;
    struct image_frame f = frame_at(11, 48.7, -124.6);
    assert_int_equal(terrain_posts(&t, &f, &posts), 0);
    /* Over the border of the void, in the mountains: no cliff. */
    f = frame_at(11, 48.502, -124.05);
    assert_in_range(terrain_posts(&t, &f, &posts), 1, N * N - 1);
    int steepest = 0;
    for (int k = N; k < N * N; k++) {
        const int rise = abs(posts.q6[k / N][k % N] - posts.q6[k / N - 1][k % N]);
        steepest = rise > steepest ? rise : steepest;
    }
    print_message("# steepest rise %.1f m in 19 m\n", steepest / 64.0);
    assert_true(steepest < 64 * 40);
    terrain_close(&t);
}

/* The same places asked for at all levels, and from both sides of a zone border, on ground that
 * jumps by up to 100 m a pixel: not a bit of difference. */
TEST(a_place_has_one_height_whichever_level_or_zone_asks)
{
    static const struct {
        int epsg;
        double geotransform[6];
        uint8_t shift0;
        double latitude, longitude;
    } cases[] = {
        {32632, {350000, 90, 0, 5700000, 0, -90}, 9, 51.0, 8.2},
        {32632, {400000, 90, 0, 6910000, 0, -90}, 10, 61.87, 9.1}, /* zone border at 61.875 */
        {32732, {400000, 90, 0, 3150000, 0, -90}, 10, -61.88, 9.1},
        {3857, {19990000, 100, 0, 60000, 0, -100}, 10, 0.2, 179.99},
    };
    static struct terrain_posts fine, coarse;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct scene_raster r = {.width = 1200,
                                 .height = 1200,
                                 .epsg = cases[i].epsg,
                                 .type = GDT_Float32,
                                 .value = jumps};
        memcpy(r.geotransform, cases[i].geotransform, sizeof r.geotransform);
        scene_write("levels.tif", &r);
        struct terrain t;
        open_terrain(&t, cases[i].shift0, 1, scene_path("levels.tif"));
        for (uint8_t level = 1; level <= 5; level++) {
            const uint8_t shift = (uint8_t)(cases[i].shift0 + level);
            const struct image_frame f = frame_at(shift, cases[i].latitude, cases[i].longitude);
            assert_true(terrain_posts(&t, &f, &coarse) > 0);
            for (uint32_t k = 0; k < 4; k++) {
                const struct image_frame child = image_frame_of(
                    (uint8_t)(shift - 1), f.zone, 2 * f.row + k / 2, 2 * f.column + k % 2);
                assert_true(terrain_posts(&t, &child, &fine) >= 0);
                for (uint32_t p = 0; p < 33 * 33; p++) {
                    assert_int_equal(fine.q6[2 * (p / 33)][2 * (p % 33)],
                                     coarse.q6[k / 2 * 32 + p / 33][k % 2 * 32 + p % 33]);
                }
            }
        }
        /* The tile north of the one that ends at the border begins with the same posts, every
         * second one. */
        const struct image_frame f =
            frame_at(cases[i].shift0, cases[i].latitude, cases[i].longitude);
        uint32_t row = f.row;
        while (image_row_zone(f.shift, row + 1) == f.zone && row < f.row + 40) {
            row++;
        }
        const uint8_t zone = image_row_zone(f.shift, row + 1);
        if (zone == f.zone + 1) {
            const struct image_frame south = image_frame_of(f.shift, f.zone, row, f.column & ~1u);
            const struct image_frame north = image_frame_of(f.shift, zone, row + 1, f.column >> 1);
            assert_true(terrain_posts(&t, &south, &fine) > 0 &&
                        terrain_posts(&t, &north, &coarse) > 0);
            for (int c = 0; c <= 32; c++) {
                assert_int_equal(fine.q6[N - 1][2 * c], coarse.q6[0][c]);
            }
        }
        terrain_close(&t);
    }
}

static int tidy(void **state)
{
    (void)state;
    return support_run("rm -rf %s", scene_folder());
}

TEST_GROUP(NULL, tidy);
