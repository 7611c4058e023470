/* `landmass-db build` from end to end: known functions of a place go in as rasters, and every cell
 * of the image is held against them, wherever on Earth and in whatever CRS. */
#include "image/codes.h"
#include "image/grid.h"
#include "image/reader.h"
#include "image/verify.h"
#include "lm/images.h"

#include "check.h"
#include "memory_flash.h"
#include "scene.h"
#include "support.h"

#include <gdal_alg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { CELLS = LM_TILE_CELLS };

/* ---- looking into an image ---- */

static void open_sound_image(struct image *image, const char *name)
{
    struct image_findings findings = {stdout, 0, 10, false, NULL};
    struct image_verify_counts counts;
    assert_int_equal(image_map(image, scene_path(name)), 0);
    assert_int_equal(image_verify(image, &findings, &counts), 0);
    assert_int_equal(findings.count, 0);
    assert_int_equal(counts.tiles, image->header.record_count);
}

/* Class of a cell in the class table: structures of every facing are class 3. */
static int table_class(uint16_t cell)
{
    const int k = image_cell_class(cell);
    return k >= 6 && k < 6 + LM_FACINGS ? 3 : k;
}

static void centre_of(const struct image *image, const struct lm_tile *t, int r, int c,
                      double *latitude, double *longitude)
{
    const uint8_t shift = (uint8_t)(image->header.shift0 + t->lod);
    const struct image_frame f = image_frame_of(shift, t->zone, t->row, t->column);
    *latitude = image_degrees(f.south) + (r + 0.5) * image_degrees(f.latitude_step);
    *longitude = image_longitude_degrees(f.west) + (c + 0.5) * image_degrees(f.longitude_step);
}

/* Elevation at a post in metres. */
static double post_m(const struct lm_tile *t, int r, int c)
{
    return (double)image_post_q6(t, r, c) / 64.0;
}

static double step_m(const struct lm_tile *t)
{
    return ldexp(1.0 / 64.0, t->post_shift);
}

/* The cell under a place, at a level; IMAGE_CELL_NONE where there is no tile. */
static uint16_t cell_at(const struct image *image, uint8_t level, double latitude, double longitude)
{
    const uint8_t shift = (uint8_t)(image->header.shift0 + level);
    const int64_t up = image_bam(latitude) + IMAGE_BAM_QUARTER;
    const uint32_t east = (uint32_t)image_bam(longitude), row = (uint32_t)(up >> (shift + 6));
    const int east_shift = shift + image_row_zone(shift, row);
    const struct lm_tile *t = image_find_tile(image, level, row, east >> (east_shift + 6));
    return t == NULL ? IMAGE_CELL_NONE
                     : image_tile_cell(t, up >> shift & 63, (int)(east >> east_shift & 63));
}

/* ---- known rasters ---- */

/* A pattern that changes with every pixel: classes 0..5 and all reflectivities of -60 .. 19.5 dB.
 */
static int class_of(long column, long row)
{
    return (int)((column * 7 + row * 3 + (column / 5) * (row / 7)) % 6);
}
static double gamma_of(long column, long row)
{
    return -60.0 + (double)((column * 13 + row * 5) % 160) / 2.0;
}

/* The raster at hand, for the value functions. */
static struct {
    double geotransform[6];
    int epsg, width, height;
} grid;

static double class_value(double x, double y)
{
    return class_of(lround((x - grid.geotransform[0]) / grid.geotransform[1] - 0.5),
                    lround((y - grid.geotransform[3]) / grid.geotransform[5] - 0.5));
}
static double gamma_value(double x, double y)
{
    return gamma_of(lround((x - grid.geotransform[0]) / grid.geotransform[1] - 0.5),
                    lround((y - grid.geotransform[3]) / grid.geotransform[5] - 0.5));
}

static void write_cover(int epsg, const double geotransform[6], int width, int height)
{
    memcpy(grid.geotransform, geotransform, sizeof grid.geotransform);
    grid.epsg = epsg;
    grid.width = width;
    grid.height = height;
    struct scene_raster r = {.width = width,
                             .height = height,
                             .epsg = epsg,
                             .type = GDT_Byte,
                             .has_nodata = true,
                             .nodata = 255,
                             .value = class_value};
    memcpy(r.geotransform, geotransform, sizeof r.geotransform);
    scene_write("classes.tif", &r);
    r.type = GDT_Float32;
    r.nodata = -9999;
    r.value = gamma_value;
    scene_write("gamma.tif", &r);
}

static double waves_m(double x, double y)
{
    return 200.0 + 100.0 * sin(x * 60.0) * cos(y * 60.0);
}

/* Elevations over degrees, `spacing` apart, whole degrees as DTED has them. */
static void write_terrain(const char *name, double west, double south, double width, double height,
                          double spacing, double (*value)(double, double))
{
    const struct scene_raster r = {.width = (int)lround(width / spacing),
                                   .height = (int)lround(height / spacing),
                                   .geotransform = {west, spacing, 0, south + height, 0, -spacing},
                                   .epsg = 4326,
                                   .type = GDT_Float32,
                                   .value = value};
    scene_write(name, &r);
}

/* ---- the comparison ---- */

/* Every finest cell of the image against the pattern, the pixel under its centre found by GDAL's
 * own transformer. Returns how many cells were compared; cells within a hundredth of a pixel of a
 * border between two are not. */
static long compare_cover(const struct image *image)
{
    GDALDatasetH raster = GDALOpen(scene_path("classes.tif"), GA_ReadOnly);
    char *options[] = {"DST_SRS=EPSG:4326", NULL};
    void *transformer = GDALCreateGenImgProjTransformer2(raster, NULL, options);
    assert_non_null(transformer);
    long compared = 0;
    for (uint32_t i = 0; i < image->header.entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(image, i);
        for (int k = 0; t && t->lod == 0 && k < CELLS * CELLS; k++) {
            double x, y, z = 0;
            int ok = 0;
            centre_of(image, t, k / CELLS, k % CELLS, &y, &x);
            GDALGenImgProjTransform(transformer, TRUE, 1, &x, &y, &z, &ok);
            const double edge_x = fabs(x - round(x)), edge_y = fabs(y - round(y));
            const bool is_inside = ok && x > 0 && x < grid.width && y > 0 && y < grid.height;
            if (!is_inside || edge_x < 0.01 || edge_y < 0.01) {
                continue;
            }
            const uint16_t cell = image_tile_cell(t, k / CELLS, k % CELLS);
            const long column = (long)floor(x), row = (long)floor(y);
            assert_int_equal(table_class(cell), class_of(column, row));
            assert_true(image_gamma_db(image_cell_gamma(cell)) == gamma_of(column, row));
            /* Structures have 8 m, trees 12 m, 0.4 to 1.6 times; water has none whatever the table
             * says. */
            const int k_class = class_of(column, row);
            const uint16_t height_dm = image->db.classes.height_dm[image_cell_height(cell)];
            if (k_class == 4) {
                assert_in_range(height_dm, 40, 220);
            } else {
                assert_int_equal(height_dm, k_class == 3 ? 80 : 0);
            }
            compared++;
        }
    }
    GDALDestroyGenImgProjTransformer(transformer);
    GDALClose(raster);
    print_message("# %ld cells compared\n", compared);
    return compared;
}

/* Bilinear between samples `spacing` degrees apart misses the waves by at most h^2/8 of both second
 * derivatives. */
static double waves_error_m(double spacing)
{
    return spacing * spacing / 8 * 2 * 100.0 * 60 * 60 + 0.01;
}

/* Posts of a coarser level are means. Each of them weighs 1, 2, 1 both ways, which adds h^2/4 of
 * both second derivatives for the finer posts' distance h: all levels together a third of that for
 * their own. */
static double smoothing_error_m(const struct image_frame *f)
{
    const double degrees = image_degrees(f->longitude_step);
    return degrees * degrees / 12 * 2 * 100.0 * 60 * 60;
}

/* Every post of the image that lies between two samples of the terrain raster against the function
 * that these were taken of. `area` is the raster's: west, south, width, height. */
static void compare_waves(const struct image *image, const double area[4], double spacing)
{
    long compared = 0;
    for (uint32_t i = 0; i < image->header.entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(image, i);
        if (!t) {
            continue;
        }
        const uint8_t shift = (uint8_t)(image->header.shift0 + t->lod);
        const struct image_frame f = image_frame_of(shift, t->zone, t->row, t->column);
        for (int k = 0; k < CELLS * CELLS; k++) {
            const double y = image_degrees(f.south + k / CELLS * f.latitude_step);
            const double x = image_degrees((int64_t)f.west + k % CELLS * f.longitude_step);
            /* The means of a coarser level reach as far as its own posts lie apart. */
            const double rim = spacing + (t->lod > 0 ? image_degrees(f.longitude_step) : 0);
            if (x > area[0] + rim && x < area[0] + area[2] - rim && y > area[1] + rim &&
                y < area[1] + area[3] - rim) {
                const double apart = post_m(t, k / CELLS, k % CELLS) - waves_m(x, y);
                const double smoothed_m = t->lod > 0 ? smoothing_error_m(&f) : 0;
                assert_true(fabs(apart) < waves_error_m(spacing) + smoothed_m + step_m(t) / 2);
                compared++;
            }
        }
    }
    assert_true(compared > 10000);
}

#define BUILD_COVER                                                                                \
    "build --classes %s --class-raster %s --reflectivity %s --terrain %s --land-class trees "      \
    "--out %s"

static void build_cover(const char *terrain, const char *out)
{
    scene_classes();
    const int exit_code =
        scene_run(BUILD_COVER, scene_path(SCENE_CLASSES), scene_path("classes.tif"),
                  scene_path("gamma.tif"), scene_path(terrain), scene_path(out));
    if (exit_code != 0) {
        scene_log_holds("(what it said)");
    }
    assert_int_equal(exit_code, 0);
}

TEST(every_cell_holds_the_pixel_under_it_on_a_geographic_grid)
{
    write_cover(4326, (const double[6]){8.01, 0.0003, 0, 47.19, 0, -0.0003}, 300, 250);
    write_terrain("terrain.tif", 8.0, 47.0, 0.2, 0.25, 0.001, waves_m);
    build_cover("terrain.tif", "a.lmdb");
    struct image image;
    open_sound_image(&image, "a.lmdb");
    assert_true(compare_cover(&image) > 75000);
    compare_waves(&image, (const double[4]){8.0, 47.0, 0.2, 0.25}, 0.001);
    image_close(&image);
}

TEST(every_cell_holds_the_pixel_under_it_on_utm_grids_of_both_hemispheres)
{
    write_cover(32632, (const double[6]){430000, 30, 0, 5220000, 0, -30}, 260, 240);
    write_terrain("terrain.tif", 8.0, 46.9, 0.3, 0.35, 0.001, waves_m);
    build_cover("terrain.tif", "a.lmdb");
    struct image image;
    open_sound_image(&image, "a.lmdb");
    assert_true(compare_cover(&image) > 100000);
    compare_waves(&image, (const double[4]){8.0, 46.9, 0.3, 0.35}, 0.001);
    image_close(&image);
    /* The northern zone's CRS south of the equator: negative northings, as USGS has them. */
    write_cover(32622, (const double[6]){619395, 30, 0, -410205, 0, -30}, 287, 310);
    write_terrain("terrain.tif", -50.0, -3.9, 0.3, 0.3, 0.001, waves_m);
    build_cover("terrain.tif", "a.lmdb");
    open_sound_image(&image, "a.lmdb");
    assert_true(compare_cover(&image) > 150000);
    image_close(&image);
}

TEST(the_seam_of_a_projection_spoils_no_cell)
{
    /* Web Mercator ends at 180 degrees, 20,037,508 m. */
    write_cover(3857, (const double[6]){20037508.34 - 7600, 38, 0, 2280, 0, -38}, 200, 120);
    write_terrain("terrain.tif", 179.9, -0.1, 0.2, 0.2, 0.001, waves_m);
    build_cover("terrain.tif", "a.lmdb");
    struct image image;
    open_sound_image(&image, "a.lmdb");
    assert_true(compare_cover(&image) > 200 * 120);
    image_close(&image);
}

TEST(an_area_across_greenwich_the_antimeridian_or_a_zone_border_is_whole)
{
    static const struct {
        double longitude, latitude;
    } places[] = {{0, 51},      {180, -17},    {20, 61.875}, {-70, -61.875},
                  {15, 73.125}, {180, 84.375}, {-180, 0}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        const double x = places[i].longitude, y = places[i].latitude;
        write_cover(4326, (const double[6]){x - 0.05, 0.0005, 0, y + 0.04, 0, -0.0005}, 200, 160);
        write_terrain("terrain.tif", x - 0.1, y - 0.1, 0.2, 0.2, 0.002, waves_m);
        build_cover("terrain.tif", "a.lmdb");
        struct image image;
        open_sound_image(&image, "a.lmdb");
        const uint64_t expected = 200 * 160;
        /* The cell under each pixel's centre, both sides of the seam. */
        for (uint64_t k = 0; k < expected; k++) {
            const long column = (long)(k % 200), row = (long)(k / 200);
            const uint16_t cell = cell_at(&image, 0, y + 0.04 - 0.0005 * ((double)row + 0.5),
                                          x - 0.05 + 0.0005 * ((double)column + 0.5));
            /* The cell's centre may lie in the next pixel: the class is then its. */
            bool fits = false;
            for (int d = 0; d < 9; d++) {
                fits = fits || table_class(cell) == class_of(column + d % 3 - 1, row + d / 3 - 1);
            }
            assert_true(table_class(cell) < 6 && fits);
        }
        assert_true(compare_cover(&image) > (y == 84.375 ? 1000 : 20000));
        image_close(&image);
    }
}

static double east_waves(double x, double y)
{
    return waves_m(x, y);
}
static double west_waves(double x, double y)
{
    return waves_m(x + 360.0, y);
}

TEST(dted_tiles_on_both_sides_of_the_antimeridian_become_one_surface)
{
    scene_classes();
    write_terrain("east.tif", 179.8, -17.2, 0.2, 0.2, 0.001, east_waves);
    write_terrain("west.tif", -180.0, -17.2, 0.2, 0.2, 0.001, west_waves);
    assert_int_equal(
        scene_run("build --classes %s --terrain %s --terrain %s --land-class soil --out %s",
                  scene_path(SCENE_CLASSES), scene_path("east.tif"), scene_path("west.tif"),
                  scene_path("a.lmdb")),
        0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    assert_true(image.header.lod_count <= 5);
    compare_waves(&image, (const double[4]){179.8, -17.2, 0.4, 0.2}, 0.001);
    image_close(&image);
}

/* ---- detail within wide terrain ---- */

static double island_m(double x, double y)
{
    const double d = hypot(x - 8.0, y - 47.0);
    return d < 0.2 ? 1000.0 * (0.2 - d) : d < 0.25 ? -5.0 : 0.0;
}

TEST(outside_the_class_raster_the_terrain_gives_the_class_at_its_own_level)
{
    write_cover(4326, (const double[6]){7.95, 0.0002, 0, 47.05, 0, -0.0002}, 500, 500);
    write_terrain("terrain.tif", 7.5, 46.5, 1, 1, 0.002, island_m);
    build_cover("terrain.tif", "a.lmdb");
    struct image image;
    open_sound_image(&image, "a.lmdb");
    /* 0.0002 degree is 2386 BAM, so 2^11; two thirds of 0.002 are 15,907 BAM: the wide terrain
     * begins at level 2. */
    enum { WIDE = 2 };
    assert_int_equal(image.header.shift0, 11);
    assert_int_equal(cell_at(&image, 0, 47.3, 8.3), IMAGE_CELL_NONE);
    assert_int_equal(cell_at(&image, WIDE - 1, 47.3, 8.3), IMAGE_CELL_NONE);
    for (int k = 0; k < 97 * 97; k++) {
        const double y = 46.51 + 0.01 * (k / 97), x = 7.51 + 0.01 * (k % 97);
        for (uint8_t level = WIDE; level < image.header.lod_count; level++) {
            assert_int_not_equal(cell_at(&image, level, y, x), IMAGE_CELL_NONE);
        }
    }
    for (uint8_t level = WIDE; level < image.header.lod_count; level++) {
        assert_int_equal(image_cell_class(cell_at(&image, level, 47.3, 8.3)), 5);
        assert_int_equal(image_cell_class(cell_at(&image, level, 47.1, 8.12)), 4);
        assert_int_equal(image_cell_class(cell_at(&image, level, 46.78, 8.0)),
                         5); /* -5 m: still sea */
    }
    for (uint32_t i = 0; i < image.header.entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(&image, i);
        if (!t) {
            continue;
        }
        double latitude, longitude;
        centre_of(&image, t, 32, 32, &latitude, &longitude);
        if (t->lod < WIDE) {
            assert_true(fabs(latitude - 47) < 0.08 && fabs(longitude - 8) < 0.08);
        }
    }
    /* Sea stays flat and exactly at its level, right up to the coast. */
    long sea = 0;
    for (uint32_t i = 0; i < image.header.entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(&image, i);
        for (int k = 0; t && k < CELLS * CELLS; k++) {
            double latitude, longitude;
            centre_of(&image, t, k / CELLS, k % CELLS, &latitude, &longitude);
            if (t->lod < 4 && hypot(longitude - 8.0, latitude - 47.0) > 0.26) {
                assert_true(post_m(t, k / CELLS, k % CELLS) == 0.0);
                sea++;
            }
        }
    }
    assert_true(sea > 100000);
    image_close(&image);
}

static double rugged_m(double x, double y)
{
    return 500 + fmod(fabs(floor(x / 0.01) * 7 + floor(y / 0.01) * 3), 31) * 20;
}

/* Levels meet along the class raster's border, where tiles from below lie beside tiles made at
 * their level. */
TEST(detail_and_wide_terrain_meet_without_a_crack_on_the_most_rugged_ground)
{
    write_cover(32632, (const double[6]){430000, 20, 0, 6870000, 0, -20}, 500, 500);
    struct scene_raster r = {.width = 600,
                             .height = 600,
                             .geotransform = {410000, 90, 0, 6890000, 0, -90},
                             .epsg = 32632,
                             .type = GDT_Float32,
                             .value = rugged_m};
    scene_write("terrain.tif", &r);
    build_cover("terrain.tif", "a.lmdb");
    struct image image;
    open_sound_image(&image, "a.lmdb"); /* which compares all edges and levels */
    image_close(&image);
}

TEST(the_mean_elevation_is_that_of_the_land)
{
    scene_classes();
    write_terrain("terrain.tif", 7.5, 46.5, 1, 1, 0.002, island_m);
    assert_int_equal(scene_run("build --classes %s --terrain %s --land-class soil --title Island "
                               "--geoid 48.5 --out %s",
                               scene_path(SCENE_CLASSES), scene_path("terrain.tif"),
                               scene_path("a.lmdb")),
                     0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    /* A cone of 200 m: a third of its height. */
    assert_true(fabs(image.header.mean_elevation_m_q6 / 64.0 - 200.0 / 3) < 1.0);
    assert_int_equal(image.header.geoid_m_q6, lround(48.5 * 64));
    assert_string_equal(image.header.title, "Island");
    assert_true(fabs(image_degrees((int32_t)image.header.centre_latitude) - 47.0) < 1e-6);
    assert_true(fabs(image_longitude_degrees(image.header.centre_longitude) - 8.0) < 1e-6);
    image_close(&image);
}

TEST(without_terrain_all_ground_lies_at_sea_level_when_told_so)
{
    scene_classes();
    write_cover(4326, (const double[6]){8.0, 0.0005, 0, 47.1, 0, -0.0005}, 100, 100);
    assert_int_equal(scene_run("build --classes %s --class-raster %s --out %s",
                               scene_path(SCENE_CLASSES), scene_path("classes.tif"),
                               scene_path("flat.lmdb")),
                     2);
    assert_true(scene_log_holds("--flat puts all ground at sea level"));
    assert_int_equal(
        scene_run("build --classes %s --class-raster %s --flat --sea-level 12 --out %s",
                  scene_path(SCENE_CLASSES), scene_path("classes.tif"), scene_path("flat.lmdb")),
        0);
    assert_true(scene_log_holds("no terrain: all ground lies at 12 m"));
    struct image image;
    open_sound_image(&image, "flat.lmdb");
    assert_int_equal(image.header.mean_elevation_m_q6, 12 * 64);
    int tiles = 0;
    for (uint32_t i = 0; i < image.header.entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(&image, i);
        for (int k = 0; t && k < LM_TILE_POSTS * LM_TILE_POSTS; k++) {
            assert_true(post_m(t, k / LM_TILE_POSTS, k % LM_TILE_POSTS) == 12);
        }
        tiles += t != NULL;
    }
    assert_int_equal(tiles, image.header.record_count);
    assert_int_not_equal(cell_at(&image, 0, 47.075, 8.025), IMAGE_CELL_NONE);
    image_close(&image);
    assert_int_equal(scene_run("inspect %s", scene_path("flat.lmdb")), 0);
    assert_true(scene_log_holds("terrain: none, all ground lies at 12 m"));
}

/* Blocks of four pixels by four of one class, one pixel in each of another. */
static double speckled_class(double x, double y)
{
    const long column = lround((x - 8.0) / 0.0001 - 0.5), row = lround((47.1 - y) / 0.0001 - 0.5);
    return column % 4 == 1 && row % 4 == 2 ? 0 : 3;
}
static double speckled_gamma(double x, double y)
{
    return speckled_class(x, y) == 0 ? 10.0 : -50.0;
}

TEST(cells_larger_than_the_pixels_hold_their_commonest_class_and_mean_power)
{
    scene_classes();
    struct scene_raster r = scene_in_degrees(600, 8, 47.1, 0.0001, GDT_Byte, speckled_class);
    scene_write("classes.tif", &r);
    r.type = GDT_Float32;
    r.value = speckled_gamma;
    scene_write("gamma.tif", &r);
    write_terrain("terrain.tif", 7.9, 46.9, 0.4, 0.4, 0.002, waves_m);
    assert_int_equal(scene_run(BUILD_COVER " --shift0 14", scene_path(SCENE_CLASSES),
                               scene_path("classes.tif"), scene_path("gamma.tif"),
                               scene_path("terrain.tif"), scene_path("a.lmdb")),
                     0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    /* One pixel in sixteen has 10 dB: -2.04 dB. Cells are 13.7 pixels wide, and how many bright
     * ones fall into one varies; their mean does not. */
    double power = 0;
    int count = 0;
    for (double y = 47.05; y < 47.09; y += 0.0014) {
        for (double x = 8.005; x < 8.05; x += 0.0014) {
            const uint16_t cell = cell_at(&image, 0, y, x);
            assert_int_equal(table_class(cell), 3);
            power += pow(10.0, image_gamma_db(image_cell_gamma(cell)) / 10.0);
            count++;
        }
    }
    assert_true(fabs(10.0 * log10(power / count) - (10.0 - 10.0 * log10(16.0))) < 0.2);
    image_close(&image);
}

static double tower_m(double x, double y)
{
    (void)y;
    return x < 8.05 ? 36.0 : -9999.0;
}

TEST(heights_come_from_their_raster_and_else_from_the_class)
{
    write_cover(4326, (const double[6]){8.0, 0.0005, 0, 47.1, 0, -0.0005}, 200, 200);
    write_terrain("terrain.tif", 7.9, 46.9, 0.4, 0.4, 0.002, waves_m);
    const struct scene_raster r = {.width = 90,
                                   .height = 90,
                                   .geotransform = {8, 0.001, 0, 47.09, 0, -0.001},
                                   .epsg = 4326,
                                   .type = GDT_Float32,
                                   .has_nodata = true,
                                   .nodata = -9999,
                                   .value = tower_m};
    scene_write("heights.tif", &r);
    scene_classes();
    assert_int_equal(scene_run(BUILD_COVER " --heights %s", scene_path(SCENE_CLASSES),
                               scene_path("classes.tif"), scene_path("gamma.tif"),
                               scene_path("terrain.tif"), scene_path("a.lmdb"),
                               scene_path("heights.tif")),
                     0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    for (double y = 47.005; y < 47.085; y += 0.0007) {
        for (double x = 8.005; x < 8.095; x += 0.0007) {
            const uint16_t cell = cell_at(&image, 0, y, x);
            const uint8_t k = image_cell_class(cell);
            const bool has_tower = x<8.045, is_plain = x> 8.055;
            const uint16_t height_dm = image.db.classes.height_dm[image_cell_height(cell)];
            if (k == 3 && (has_tower || is_plain)) {
                assert_int_equal(height_dm, has_tower ? 360 : 80);
            }
            if (k == 4 && (has_tower || is_plain)) {
                assert_in_range(height_dm, has_tower ? 120 : 40, has_tower ? 600 : 220);
            }
        }
    }
    image_close(&image);
}

static double far_away_m(double x, double y)
{
    (void)x;
    (void)y;
    return 10;
}

/* Metres above the ground: a town of 3 to 25 m, and single towers of 30, 80 and 300 m in it. */
static double skyline_m(double x, double y)
{
    static const double towers_m[] = {30, 80, 300};
    const long column = (long)floor((x - 8) / 0.0005), row = (long)floor((y - 47) / 0.0005);
    for (int i = 0; i < 3; i++) {
        if (row == 100 && column == 40 + 20 * i) {
            return towers_m[i];
        }
    }
    return 3 + (double)((column * 7 + row * 13) % 221) / 10;
}

static double all_structure(double x, double y)
{
    (void)x;
    (void)y;
    return 3;
}

static double too_high_m(double x, double y)
{
    return fabs(x - 8.05) < 0.001 && fabs(y - 47.05) < 0.001 ? 1200 : 8;
}

/* An image of nothing but structures, with these heights above a plain. */
static int build_skyline(double (*height_m)(double x, double y), const char *more)
{
    struct scene_raster r = {.width = 200,
                             .height = 200,
                             .geotransform = {8, 0.0005, 0, 47.1, 0, -0.0005},
                             .epsg = 4326,
                             .type = GDT_Byte,
                             .value = all_structure};
    scene_write("classes.tif", &r);
    r.type = GDT_Float32;
    r.value = height_m;
    scene_write("heights.tif", &r);
    scene_classes();
    write_terrain("terrain.tif", 7.9, 46.9, 0.4, 0.4, 0.002, far_away_m);
    return scene_run(
        "build --classes %s --class-raster %s --heights %s --terrain %s --land-class "
        "soil --out %s %s",
        scene_path(SCENE_CLASSES), scene_path("classes.tif"), scene_path("heights.tif"),
        scene_path("terrain.tif"), scene_path("a.lmdb"), more);
}

TEST(the_heights_of_the_codes_are_those_that_occur)
{
    assert_int_equal(build_skyline(skyline_m, ""), 0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    const uint16_t *table_dm = image.db.classes.height_dm;
    static const double towers_m[] = {30, 80, 300};
    double worst_m = 0;
    for (int i = 0; i < 3; i++) {
        const uint16_t dm = table_dm[image_height_code(table_dm, towers_m[i] * 10)];
        print_message("# %.0f m is %.1f m\n", towers_m[i], dm / 10.0);
        assert_true(fabs(dm / 10.0 - towers_m[i]) <= 0.02 * towers_m[i]);
    }
    for (double m = 3; m <= 25; m += 0.1) {
        const double dm = table_dm[image_height_code(table_dm, m * 10)];
        worst_m = fmax(worst_m, fabs(dm / 10 - m));
    }
    print_message("# a town of 3 to 25 m: %.2f m off at most\n", worst_m);
    assert_true(worst_m < 1.5); /* 12 codes over 22 m, evenly, leave 0.9 m */
    assert_true(support_run("%s/bin/landmass-db inspect %s | grep -q '^heights:.* 300'",
                            support_build_dir(), scene_path("a.lmdb")) == 0);
    image_close(&image);
}

static double village_m(double x, double y)
{
    return fmin(skyline_m(x, y), 11);
}

/* Images that are flown together have one table of heights, and the user hears what that costs. */
TEST(an_image_beside_another_has_its_heights)
{
    struct image first, other;
    assert_int_equal(build_skyline(village_m, ""), 0);
    assert_int_equal(rename(scene_path("a.lmdb"), scene_path("village.lmdb")), 0);
    assert_int_equal(build_skyline(skyline_m, "--title Town"), 0);
    open_sound_image(&first, "village.lmdb");
    open_sound_image(&other, "a.lmdb");
    assert_int_equal(lm_images_judge(&first.db, &other.db), LM_ERR_TABLE);
    image_close(&other);
    assert_int_equal(build_skyline(skyline_m, "--beside no.lmdb"), 1);
    char beside[600];
    snprintf(beside, sizeof beside, "--beside %s", scene_path("village.lmdb"));
    assert_int_equal(build_skyline(skyline_m, beside), 0);
    assert_true(scene_log_holds("has heights of up to 12 m: what is up to 300 m high here"));
    open_sound_image(&other, "a.lmdb");
    assert_int_equal(lm_images_judge(&first.db, &other.db), LM_OK);
    assert_memory_equal(first.db.classes.height_dm, other.db.classes.height_dm,
                        sizeof other.db.classes.height_dm);
    image_close(&other);
    image_close(&first);
}

TEST(heights_above_a_kilometre_are_refused_or_cut_and_counted)
{
    unlink(scene_path("a.lmdb"));
    assert_int_equal(build_skyline(too_high_m, ""), 1);
    assert_true(scene_log_holds("are higher than 1,000 m; correct them, or give --cut-heights"));
    assert_int_equal(access(scene_path("a.lmdb"), F_OK), -1);
    assert_int_equal(build_skyline(too_high_m, "--cut-heights"), 0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    assert_int_equal(image.db.classes.height_dm[15], 10000);
    assert_false(scene_log_holds("; 0 samples cut to 1,000 m"));
    assert_true(scene_log_holds("samples cut to 1,000 m"));
    assert_int_equal(support_run("%s/bin/landmass-db inspect %s | grep -q '^heights-cut: [1-9]'",
                                 support_build_dir(), scene_path("a.lmdb")),
                     0);
    image_close(&image);
}

static double forest_class(double x, double y)
{
    (void)x;
    (void)y;
    return 4;
}

/* Mean and deviation of the heights of a level, metres. */
static double mean_height_m(const struct image *image, uint8_t level, double *deviation_m)
{
    double sum = 0, squares = 0;
    int count = 0;
    for (double y = 47.005; y < 47.055; y += 0.00037) {
        for (double x = 8.005; x < 8.055; x += 0.00037) {
            const uint16_t cell = cell_at(image, level, y, x);
            const double m = image->db.classes.height_dm[image_cell_height(cell)] / 10.0;
            assert_int_equal(image_cell_class(cell), 4);
            sum += m;
            squares += m * m;
            count++;
        }
    }
    *deviation_m = sqrt(squares / count - sum / count * (sum / count));
    return sum / count;
}

TEST(woods_have_tops_of_many_heights_and_the_mean_of_their_class)
{
    scene_classes();
    struct scene_raster r = scene_in_degrees(600, 8, 47.06, 0.0001, GDT_Byte, forest_class);
    scene_write("classes.tif", &r);
    r.type = GDT_Float32;
    r.value = speckled_gamma;
    scene_write("gamma.tif", &r);
    write_terrain("terrain.tif", 7.9, 46.9, 0.4, 0.4, 0.002, waves_m);
    assert_int_equal(scene_run(BUILD_COVER, scene_path(SCENE_CLASSES), scene_path("classes.tif"),
                               scene_path("gamma.tif"), scene_path("terrain.tif"),
                               scene_path("a.lmdb")),
                     0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    double deviation_m;
    assert_true(fabs(mean_height_m(&image, 0, &deviation_m) - 12) < 0.15);
    print_message("# tops of 12 m differ by %.1f m\n", deviation_m);
    assert_true(deviation_m > 2.0 && deviation_m < 4.0);
    for (uint8_t level = 1; level < 4; level++) {
        const double mean_m = mean_height_m(&image, level, &deviation_m);
        print_message("# level %d: mean %.2f m, deviation %.2f m\n", level, mean_m, deviation_m);
        assert_true(fabs(mean_m - 12) < 0.7); /* means are rounded to codes */
    }
    image_close(&image);
}

static double steep_m(double x, double y)
{
    (void)y;
    /* 0.001 degree is 76 m of longitude at latitude 47. */
    return x < 8.0 ? 100.0 : 100.0 + (x - 8.0) * 1000 * 76;
}

TEST(steep_ground_gets_its_own_class)
{
    scene_classes();
    write_terrain("terrain.tif", 7.95, 46.95, 0.1, 0.1, 0.001, steep_m);
    assert_int_equal(
        scene_run("build --classes %s --terrain %s --land-class soil --steep-class concrete "
                  "--steep-degrees 40 --out %s",
                  scene_path(SCENE_CLASSES), scene_path("terrain.tif"), scene_path("a.lmdb")),
        0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    assert_int_equal(image_cell_class(cell_at(&image, 0, 47, 7.98)), 0);
    assert_int_equal(image_cell_class(cell_at(&image, 0, 47, 8.02)), 2);
    image_close(&image);
}

/* The tag of the reflectivity decides, and without a raster the option. Values of X would lie 1 to
 * 5 dB below the classes' means. */
TEST(an_image_has_the_levels_of_the_sensor_it_is_for)
{
    static const char heaton6[] = "host-sim/programs/db/classes/heaton6.classes";
    static const struct {
        const char *reflect, *build;
        double soil_db;
        enum lm_sensor sensor;
    } cases[] = {{"ka", "", -17.3, LM_SENSOR_KA},
                 {"mmw", "--sensor mmw", -15.1, LM_SENSOR_MMW},
                 {NULL, "--sensor ku", -19, LM_SENSOR_KU}};
    write_cover(4326, (const double[6]){8.01, 0.0003, 0, 47.19, 0, -0.0003}, 100, 90);
    write_terrain("terrain.tif", 8.0, 47.0, 0.2, 0.25, 0.001, waves_m);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char more[600] = "";
        if (cases[i].reflect) {
            assert_int_equal(scene_run("reflect --class-raster %s --classes %s --sensor %s --out "
                                       "%s",
                                       scene_path("classes.tif"), heaton6, cases[i].reflect,
                                       scene_path("band.tif")),
                             0);
            snprintf(more, sizeof more, "--class-raster %s --reflectivity %s",
                     scene_path("classes.tif"), scene_path("band.tif"));
        }
        assert_int_equal(scene_run("build --classes %s --terrain %s --land-class soil --out %s %s "
                                   "%s",
                                   heaton6, scene_path("terrain.tif"), scene_path("b.lmdb"), more,
                                   cases[i].build),
                         0);
        struct image image;
        open_sound_image(&image, "b.lmdb");
        assert_int_equal(image.header.sensor, cases[i].sensor);
        assert_true(fabs(image.db.classes.entry[0].gamma_db_q8 / 256.0 - cases[i].soil_db) < 0.01);
        double sum = 0, count = 0;
        for (int k = 0; k < 128 * 128; k++) {
            const uint16_t cell =
                cell_at(&image, 0, 47.164 + k / 128 * 0.0002, 8.011 + k % 128 * 0.0002);
            if (cell != IMAGE_CELL_NONE) {
                sum += image_gamma_db(image_cell_gamma(cell)) -
                       image.db.classes.entry[image_cell_class(cell)].gamma_db_q8 / 256.0;
                count++;
            }
        }
        print_message("# %s: %.2f dB from the classes' means (%.0f cells)\n", cases[i].build,
                      sum / count, count);
        assert_true(count > 1000 && fabs(sum / count) < 0.5);
        image_close(&image);
    }
}

/* ---- what else must hold ---- */

TEST(the_same_inputs_give_the_same_bytes)
{
    write_cover(4326, (const double[6]){8.01, 0.0003, 0, 47.19, 0, -0.0003}, 100, 90);
    write_terrain("terrain.tif", 8.0, 47.0, 0.2, 0.25, 0.001, waves_m);
    build_cover("terrain.tif", "a.lmdb");
    assert_int_equal(support_run("mkdir -p %s/elsewhere && cp %s/*.tif %s/*.classes %s/elsewhere",
                                 scene_folder(), scene_folder(), scene_folder(), scene_folder()),
                     0);
    assert_int_equal(scene_run(BUILD_COVER, scene_path("elsewhere/" SCENE_CLASSES),
                               scene_path("elsewhere/classes.tif"),
                               scene_path("elsewhere/gamma.tif"),
                               scene_path("elsewhere/terrain.tif"), scene_path("b.lmdb")),
                     0);
    assert_int_equal(support_run("cmp %s %s", scene_path("a.lmdb"), scene_path("b.lmdb")), 0);
}

TEST(the_firmware_opens_the_image_and_accepts_every_tile)
{
    write_cover(32632, (const double[6]){430000, 30, 0, 5220000, 0, -30}, 260, 240);
    write_terrain("terrain.tif", 8.0, 46.9, 0.3, 0.35, 0.001, waves_m);
    build_cover("terrain.tif", "a.lmdb");
    struct image image;
    open_sound_image(&image, "a.lmdb");
    struct memory_flash flash;
    static struct lm_db db;
    memory_flash_open(&flash, image.bytes, image.size_bytes);
    assert_int_equal(lm_db_open(&db, &flash.port, 4), LM_OK);
    for (uint32_t i = 0; i < image.header.entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(&image, i);
        if (!t) {
            continue;
        }
        const int64_t entry = lm_db_entry(&db, t->lod, t->row, t->column);
        assert_true(entry >= 0);
        assert_int_equal(lm_db_entry_check(&db, (uint32_t)entry, &image.entries[entry]), LM_OK);
        assert_true(image_find_tile(&image, t->lod, t->row, t->column) == t);
        assert_int_equal(lm_tile_check(t, t->lod, t->row, t->column), LM_OK);
    }
    image_close(&image);
}

static double class_nine(double x, double y)
{
    (void)x;
    (void)y;
    return 9;
}

static void expect_failure(int exit_code, int expected, const char *message)
{
    assert_int_equal(exit_code, expected);
    assert_true(scene_log_holds(message));
    assert_int_equal(support_run("ls -A %s | grep -q -e out.lmdb -e unfinished", scene_folder()),
                     1);
}

TEST(every_bad_input_is_named_and_leaves_no_file)
{
    scene_classes();
    write_cover(4326, (const double[6]){8.0, 0.0005, 0, 47.1, 0, -0.0005}, 100, 100);
    write_terrain("terrain.tif", 7.9, 46.9, 0.4, 0.4, 0.002, waves_m);
    write_terrain("far.tif", 20, 20, 0.4, 0.4, 0.002, far_away_m);
    struct scene_raster r = {.width = 100,
                             .height = 100,
                             .geotransform = {8, 0.0005, 0, 47.1, 0, -0.0005},
                             .type = GDT_Byte,
                             .value = far_away_m};
    scene_write("nocrs.tif", &r);
    r.epsg = 4326;
    r.value = class_nine;
    scene_write("nine.tif", &r);
    r.width = 99;
    r.type = GDT_Float32;
    scene_write("othergrid.tif", &r);
    scene_text("empty.tif", "");
    scene_text("bad.classes", "[soil]\ncolour = 1 2\n");
    assert_int_equal(
        support_run("head -c 20000 %s > %s", scene_path("gamma.tif"), scene_path("cut.tif")), 0);
    assert_int_equal(support_run("head -c 40000 %s > %s", scene_path("terrain.tif"),
                                 scene_path("cutterrain.tif")),
                     0);
    static const struct {
        const char *classes, *class_raster, *reflectivity, *terrain, *more;
        int exit_code;
        const char *message;
    } cases[] = {
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "far.tif", "", 1, "lies outside all terrain"},
        {SCENE_CLASSES, "nocrs.tif", "gamma.tif", "terrain.tif", "", 1,
         "no coordinate reference system"},
        {SCENE_CLASSES, "nine.tif", "gamma.tif", "terrain.tif", "", 1, "holds class 9"},
        {SCENE_CLASSES, "classes.tif", "othergrid.tif", "terrain.tif", "", 1,
         "lies on another grid"},
        {SCENE_CLASSES, "classes.tif", "cut.tif", "terrain.tif", "", 1, "cut short"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "cutterrain.tif", "", 1, "cut short"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "empty.tif", "", 1,
         "cannot be opened as terrain"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "missing.tif", "", 1, "missing.tif"},
        {SCENE_CLASSES, "missing.tif", "gamma.tif", "terrain.tif", "", 1,
         "cannot be opened as a class raster"},
        {"bad.classes", "classes.tif", "gamma.tif", "terrain.tif", "", 1, "bad.classes"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "terrain.tif", "--water-class lava", 1,
         "no class \"lava\""},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "terrain.tif", "--sensor ku", 1,
         "is for X band, and --sensor asks for Ku band"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "terrain.tif", "--cell 5 --shift0 12", 2,
         "--shift0"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "terrain.tif", "--cell 0.01", 1, "--cell"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "terrain.tif", "--centre 91,0", 2, "--centre"},
        {SCENE_CLASSES, "classes.tif", "gamma.tif", "terrain.tif",
         "--title 'a title of more than thirty-two bytes'", 2, "--title"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const int exit_code =
            scene_run(BUILD_COVER " %s", scene_path(cases[i].classes),
                      scene_path(cases[i].class_raster), scene_path(cases[i].reflectivity),
                      scene_path(cases[i].terrain), scene_path("out.lmdb"), cases[i].more);
        expect_failure(exit_code, cases[i].exit_code, cases[i].message);
    }
    expect_failure(scene_run(BUILD_COVER, scene_path(SCENE_CLASSES), scene_path("classes.tif"),
                             scene_path("gamma.tif"), scene_path("terrain.tif"),
                             "/nowhere/out.lmdb"),
                   1, "check that the folder exists");
}

TEST(a_full_disk_leaves_no_file_and_the_old_image_as_it_was)
{
    write_cover(4326, (const double[6]){8.01, 0.0003, 0, 47.19, 0, -0.0003}, 100, 90);
    write_terrain("terrain.tif", 8.0, 47.0, 0.2, 0.25, 0.001, waves_m);
    scene_classes();
    scene_text("old.lmdb", "the old image");
    const int exit_code = support_run(
        "trap '' XFSZ; ulimit -f 200; %s/bin/landmass-db " BUILD_COVER " >%s/log 2>&1",
        support_build_dir(), scene_path(SCENE_CLASSES), scene_path("classes.tif"),
        scene_path("gamma.tif"), scene_path("terrain.tif"), scene_path("old.lmdb"), scene_folder());
    assert_int_equal(exit_code, 1);
    assert_true(scene_log_holds("free some space"));
    assert_int_equal(support_run("grep -q 'the old image' %s", scene_path("old.lmdb")), 0);
    assert_int_equal(support_run("ls -A %s | grep -q unfinished", scene_folder()), 1);
    unlink(scene_path("old.lmdb"));
}

TEST(inspect_verify_and_picture_say_what_is_in_the_image)
{
    write_cover(4326, (const double[6]){8.01, 0.0003, 0, 47.19, 0, -0.0003}, 100, 90);
    write_terrain("terrain.tif", 8.0, 47.0, 0.2, 0.25, 0.001, waves_m);
    build_cover("terrain.tif", "a.lmdb");
    assert_int_equal(scene_run("inspect %s", scene_path("a.lmdb")), 0);
    assert_true(scene_log_holds("input: class-raster classes.tif"));
    assert_int_equal(scene_run("verify %s", scene_path("a.lmdb")), 0);
    assert_true(scene_log_holds("no faults"));
    static const char *const planes[] = {"reflectivity", "class", "elevation", "height", "shade"};
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++) {
        assert_int_equal(scene_run("picture %s --plane %s --out %s --max-size 100",
                                   scene_path("a.lmdb"), planes[i], scene_path("p.png")),
                         0);
        assert_true(scene_log_holds("scale: "));
    }
    assert_int_equal(
        scene_run("picture %s --plane colour --out %s", scene_path("a.lmdb"), scene_path("p.png")),
        2);
    assert_int_equal(
        scene_run("convert --compress none %s %s", scene_path("a.lmdb"), scene_path("raw.lmdb")),
        0);
    static const char *const images[] = {"a.lmdb", "raw.lmdb"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(support_run("printf x | dd of=%s bs=1 seek=30000 conv=notrunc 2>/dev/null",
                                     scene_path(images[i])),
                         0);
        assert_int_equal(scene_run("verify %s", scene_path(images[i])), 1);
        assert_true(scene_log_holds("tile of entry"));
    }
    assert_true(scene_log_holds("tile of entry 13: its checksum does not fit it"));
    assert_int_equal(
        scene_run("convert --compress lz4 %s %s", scene_path("raw.lmdb"), scene_path("never.lmdb")),
        1);
    assert_true(scene_log_holds("convert a sound copy of it"));
    assert_int_equal(access(scene_path("never.lmdb"), F_OK), -1);
    assert_int_equal(scene_run("verify %s", scene_path("classes.tif")), 1);
    assert_int_equal(scene_run("inspect %s", scene_path("classes.tif")), 1);
    assert_int_equal(scene_run("verify"), 2);
}

/* A known picture: elevation white in the north-east, black in the south-west. */
static double tilted_m(double x, double y)
{
    return 1000.0 + 1000.0 * (x - 8.0) + 2000.0 * (y - 47.0);
}

TEST(a_picture_has_north_up_and_the_scale_it_says)
{
    scene_classes();
    write_terrain("terrain.tif", 7.9, 46.9, 0.4, 0.4, 0.001, tilted_m);
    assert_int_equal(scene_run("build --classes %s --terrain %s --land-class soil --out %s",
                               scene_path(SCENE_CLASSES), scene_path("terrain.tif"),
                               scene_path("a.lmdb")),
                     0);
    assert_int_equal(
        scene_run("picture %s --plane elevation --area 47.0,8.0,47.2,8.2 --black 1000 --white 1600 "
                  "--out %s",
                  scene_path("a.lmdb"), scene_path("p.png")),
        0);
    GDALDatasetH picture = GDALOpen(scene_path("p.png"), GA_ReadOnly);
    assert_non_null(picture);
    const int width = GDALGetRasterXSize(picture), height = GDALGetRasterYSize(picture);
    for (int v = 0; v < height; v += 7) {
        for (int u = 0; u < width; u += 7) {
            uint8_t grey;
            assert_int_equal(GDALRasterIO(GDALGetRasterBand(picture, 1), GF_Read, u, v, 1, 1, &grey,
                                          1, 1, GDT_Byte, 0, 0),
                             CE_None);
            const double x = 8.0 + 0.2 * (u + 0.5) / width, y = 47.2 - 0.2 * (v + 0.5) / height;
            assert_true(fabs(grey - 255.0 * (tilted_m(x, y) - 1000.0) / 600.0) < 1.5);
        }
    }
    GDALClose(picture);
}

TEST(real_dted_becomes_one_island_without_seams)
{
    char paths[3][512];
    if (!support_data_path("dted1_hawaii/n19_w155_3arc_v2.dt1", paths[0], sizeof paths[0]) ||
        !support_data_path("dted1_hawaii/n19_w156_3arc_v2.dt1", paths[1], sizeof paths[1]) ||
        !support_data_path("dted1_hawaii/n20_w156_3arc_v2.dt1", paths[2], sizeof paths[2])) {
        skip();
    }
    scene_classes();
    assert_int_equal(
        scene_run("build --classes %s --terrain %s --terrain %s --terrain %s --land-class soil "
                  "--shift0 14 --out %s",
                  scene_path(SCENE_CLASSES), paths[0], paths[1], paths[2], scene_path("a.lmdb")),
        0);
    struct image image;
    open_sound_image(&image, "a.lmdb");
    /* Mauna Kea, 4,205 m, and the sea off Hilo. */
    double highest = 0;
    for (uint32_t i = 0; i < image.header.entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(&image, i);
        for (int k = 0; t && k < CELLS * CELLS; k++) {
            highest = fmax(highest, post_m(t, k / CELLS, k % CELLS));
        }
    }
    assert_true(highest > 4150 && highest < 4210);
    assert_int_equal(image_cell_class(cell_at(&image, 0, 19.82, -155.47)), 0);
    assert_int_equal(image_cell_class(cell_at(&image, 0, 19.8, -154.9)), 5);
    assert_int_equal(cell_at(&image, 0, 20.5, -154.5), IMAGE_CELL_NONE);
    image_close(&image);
}

/* 20,000 x 20,000 pixels take minutes and 3.4 GB of disk: only when LANDMASS_BIG_TESTS is set. */
TEST(twenty_thousand_pixels_a_side_fit_into_a_gibibyte)
{
    if (!getenv("LANDMASS_BIG_TESTS")) {
        print_message("# skipped: LANDMASS_BIG_TESTS is not set (3.4 GB of disk, minutes)\n");
        skip();
    }
    scene_classes();
    write_terrain("terrain.tif", 2.0, 43.8, 2.2, 1.6, 0.001, waves_m);
    assert_int_equal(
        support_run("for k in 'classes Byte' 'gamma Float32'; do set -- $k; gdal_create -q -of "
                    "GTiff -ot $2 -outsize "
                    "20000 20000 -bands 1 -a_srs EPSG:32631 -a_ullr 450000 5000000 550000 4900000 "
                    "-co TILED=YES -co SPARSE_OK=TRUE %s/$1.tif; done",
                    scene_folder()),
        0);
    build_cover("terrain.tif", "big.lmdb");
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_CHILDREN, &usage), 0);
    print_message("# largest resident set %ld kB\n", usage.ru_maxrss);
    unlink(scene_path("big.lmdb"));
    assert_true(usage.ru_maxrss < 1024 * 1024);
}

static int tidy(void **state)
{
    (void)state;
    return support_run("rm -rf %s", scene_folder());
}

TEST_GROUP(NULL, tidy);
