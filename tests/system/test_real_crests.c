/* What hides what, against the full terrain: lines of the ground map at every range scale, from
 * images that the builder made, against lines of sight over the very rasters that it was given.
 * Cells that every line of sight about them finds hidden must be dark, and cells that all of them
 * find lit must be lit. A ridge that is narrower than a cell must hide what geometry says.
 *
 * The scenes of Sentinel-2 and Landsat are not among them: they are squares of 2.5 and 9 km, of
 * which even a sector of 10 nm sees a corner, and their terrain is SRTM once more. */
#include "check.h"
#include "real_scene.h"
#include "support.h"

#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/illumination.h"
#include "lm/scan_line.h"
#include "memory_flash.h"

#include <gdal.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    BINS = 256,
    POLLS = 1000,
    POOL_TILES = 192,
    STEPS_MAX = 24000, /* of a line of sight */
    FAN = 9,           /* lines of sight to either side, half a far cell apart */
    NODE_STEPS = 128   /* a geodesic is straight between nodes */
};

static const double pi = 3.14159265358979323846, earth_m = 6371000 * 4 / 3.0;
static const int scales_nm[] = {10, 20, 40, 80};
enum { SCALES = sizeof scales_nm / sizeof *scales_nm };

/* ---- the image ---- */

struct map {
    uint8_t *bytes; /* owned */
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_scan_line line;
    struct lm_lit_line lit;
    struct lm_range_grid grid;
    struct lm_class_lut classes;
    uint8_t pool[POOL_TILES * sizeof(struct lm_tile)] __attribute__((aligned(8)));
};

static struct map map;

static void map_open(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long size = ftell(file);
    rewind(file);
    map.bytes = malloc((size_t)size);
    assert_int_equal(fread(map.bytes, 1, (size_t)size, file), size);
    fclose(file);
    memory_flash_open(&map.flash, map.bytes, (size_t)size);
    assert_int_equal(lm_db_open(&map.db, &map.flash.port, POLLS), LM_OK);
    assert_int_equal(lm_tile_cache_init(&map.tiles, &map.db, map.pool, sizeof map.pool, POLLS),
                     LM_OK);
    lm_class_lut_set(&map.classes, &lm_radar_default.illumination, &map.db.classes);
}

/* Read a line, tiles and all, and light it by map.grid. */
static void map_read(uint8_t lod, const struct lm_ground_path *path)
{
    for (int again = 0; again < 2; again++) {
        lm_scan_line_run(&map.line, &map.tiles, lod, NULL, path, BINS);
        for (int i = 0; i < 100000 && !lm_tile_cache_is_idle(&map.tiles); i++) {
            lm_tile_cache_service(&map.tiles, 0, 8);
        }
    }
    lm_illuminate(&map.grid, &map.classes, NULL, &map.line, LM_HORIZON_OPEN, &map.lit);
}

/* The levels of a line as the radar draws it before anything random: map.lit. */
static void map_trace(struct lm_position from, fx_bam_t azimuth, double range_m, double height_m)
{
    const uint32_t length_m_q8 = (uint32_t)lround(range_m * 256);
    struct lm_geo_origin origin;
    struct lm_geo_ray ray;
    struct lm_ground_path path;
    lm_geo_set_origin(&origin, from);
    lm_geo_set_ray(&ray, &origin, azimuth);
    const struct lm_position points[3] = {from, lm_geo_along(&ray, length_m_q8 / 2),
                                          lm_geo_along(&ray, length_m_q8)};
    lm_ground_path_fit(&path, points, BINS);
    const uint32_t cell_m_q8 = length_m_q8 / BINS;
    const uint8_t lod = lm_scan_lod(&map.db, (uint32_t)((uint64_t)cell_m_q8 * 1000 / 256));
    lm_range_grid_set(&map.grid, &lm_radar_default.illumination, cell_m_q8 / 2, cell_m_q8, BINS,
                      (int32_t)lround(height_m * 1024), 0);
    map_read(lod, &path);
}

/* ---- the terrain ---- */

struct terrain {
    struct real_raster rasters[3];
    int count;
};

static double elevation_m(const struct terrain *t, double latitude, double longitude)
{
    for (int i = 0; i < t->count; i++) {
        const double z = real_raster_bilinear(&t->rasters[i], longitude, latitude);
        if (!isnan(z) && z > -1000) {
            return z;
        }
    }
    return (double)NAN;
}

/* A line of sight in equal steps: which of them see the ground. Returns how many lie on the
 * terrain; the first beyond it ends the line. */
static int see(const struct terrain *t, struct real_place from, double azimuth_deg, double step_m,
               int steps, double height_m, uint8_t *sees)
{
    double horizon = -HUGE_VAL;
    struct real_place a = from, b = from;
    for (int i = 0; i < steps; i++) {
        if (i % NODE_STEPS == 0) {
            a = i == 0 ? from : b;
            b = real_geodesic(from, azimuth_deg, (i + NODE_STEPS) * step_m);
        }
        const double share = (i % NODE_STEPS + 0.5) / NODE_STEPS, s = (i + 0.5) * step_m;
        const double z = elevation_m(t, a.latitude + share * (b.latitude - a.latitude),
                                     a.longitude + share * (b.longitude - a.longitude));
        if (isnan(z)) {
            return i;
        }
        const double tangent = (z - height_m - s * s / (2 * earth_m)) / s;
        sees[i] = tangent > horizon;
        horizon = fmax(horizon, tangent);
    }
    return steps;
}

/* ---- the comparison ---- */

struct score {
    long hidden, hidden_bright, hidden_shining, lit, lit_dark;
};

static uint8_t fan[2 * FAN + 1][STEPS_MAX];

struct look {
    struct real_place from;
    double azimuth_deg, range_m, height_m;
    double pixel_m; /* of the terrain */
};

static void compare_line(const struct terrain *t, const struct look *l, struct score *score)
{
    const double cell_m = l->range_m / BINS;
    int a_cell = (int)ceil(cell_m / fmin(cell_m / 6, l->pixel_m / 2));
    a_cell = a_cell * BINS <= STEPS_MAX ? a_cell : STEPS_MAX / BINS;
    int steps = a_cell * BINS;
    for (int k = -FAN; k <= FAN; k++) {
        const double azimuth_deg = l->azimuth_deg + k * 0.5 * cell_m / l->range_m * 180 / pi;
        steps = see(t, l->from, azimuth_deg, cell_m / a_cell, steps, l->height_m, fan[k + FAN]);
    }
    map_trace((struct lm_position){hs_bam(l->from.latitude), hs_bam(l->from.longitude)},
              hs_bam(l->azimuth_deg), l->range_m, l->height_m);
    const uint32_t nearest = map.grid.first + 2;
    for (uint32_t i = nearest > BINS / 9 ? nearest : BINS / 9; (int)(i + 2) * a_cell < steps; i++) {
        /* One cell about it: a cell to either side, and before and behind. */
        const int side = (int)fmin(FAN, 2.0 * BINS / (i + 0.5));
        bool is_hidden = true, is_lit = true;
        for (int k = -side; k <= side; k++) {
            for (uint32_t n = (i - 1) * (uint32_t)a_cell; n < (i + 2) * (uint32_t)a_cell; n++) {
                is_hidden = is_hidden && !fan[k + FAN][n];
                is_lit = is_lit && fan[k + FAN][n];
            }
        }
        const int32_t level = map.lit.level_db_q8[i];
        const int32_t gamma = (int32_t)(map.line.cell[i] >> 8) * 128 - 80 * 256;
        score->hidden += is_hidden;
        score->hidden_bright += is_hidden && level != LM_LEVEL_SHADOW;
        score->hidden_shining += is_hidden && level > gamma - 10 * 256;
        score->lit += is_lit;
        score->lit_dark += is_lit && level == LM_LEVEL_SHADOW;
    }
}

struct scene {
    const char *name;
    const char *files[3];
    const char *options; /* of the builder */
    double south, north, west, east, pixel_m;
};

static double percent(long part, long of)
{
    return of > 0 ? 100.0 * (double)part / (double)of : 0;
}

/* Half a per cent may be wrong; of fewer than 400 cells one or two are no measure. */
static void check_score(const struct scene *s, int nm, double height_m, const struct score *score)
{
    print_message(
        "# %-22s %2d nm %5.0f m: %6ld hidden, bright %.2f %% (above -10 dB %.2f %%); "
        "%6ld lit, dark %.2f %%\n",
        s->name, nm, height_m, score->hidden, percent(score->hidden_bright, score->hidden),
        percent(score->hidden_shining, score->hidden), score->lit,
        percent(score->lit_dark, score->lit));
    assert_true(score->hidden < 400 || percent(score->hidden_bright, score->hidden) <= 0.5);
    assert_true(score->lit < 400 || percent(score->lit_dark, score->lit) <= 0.5);
}

static void compare_scene(const struct scene *s, const struct terrain *t)
{
    enum { LINES = 480 };
    static const double heights_m[] = {300, 1500};
    struct hs_rng rng;
    hs_rng_seed(&rng, 14);
    for (int k = 0; k < SCALES; k++) {
        for (int h = 0; h < 2; h++) {
            struct score score = {0};
            for (int n = 0; n < LINES; n++) {
                struct look l = {.azimuth_deg = 360 * hs_rng_uniform(&rng),
                                 .range_m = scales_nm[k] * 1852.0,
                                 .pixel_m = s->pixel_m};
                l.from.latitude = s->south + (s->north - s->south) * hs_rng_uniform(&rng);
                l.from.longitude = s->west + (s->east - s->west) * hs_rng_uniform(&rng);
                const double z = elevation_m(t, l.from.latitude, l.from.longitude);
                if (!isnan(z)) {
                    l.height_m = z + heights_m[h];
                    compare_line(t, &l, &score);
                }
            }
            check_score(s, scales_nm[k], heights_m[h], &score);
        }
    }
}

static void build(const char *options, const char *terrain, const char *out)
{
    assert_int_equal(
        support_run("mkdir -p %s/tmp && %s/bin/landmass-db build --classes "
                    "host-sim/programs/db/classes/heaton6.classes %s %s --out %s >/dev/null 2>&1",
                    support_build_dir(), support_build_dir(), options, terrain, out),
        0);
}

static void run_scene(const struct scene *s)
{
    char out[512], arguments[4096] = "";
    struct terrain t = {.count = 0};
    for (int i = 0; i < 3 && s->files[i]; i++) {
        char path[1024], opened[2100];
        if (!support_data_path(s->files[i], path, sizeof path)) {
            skip();
        }
        const char *name = strrchr(path, '/') + 1;
        if (strstr(name, ".zip")) {
            snprintf(opened, sizeof opened, "/vsizip/%s/%.*s", path, (int)strlen(name) - 4, name);
        } else {
            snprintf(opened, sizeof opened, "%s", path);
        }
        snprintf(arguments + strlen(arguments), sizeof arguments - strlen(arguments),
                 " --terrain %s", path);
        assert_int_equal(real_raster_read(&t.rasters[t.count++], opened), 0);
    }
    snprintf(out, sizeof out, "%s/tmp/crests-%d.lmdb", support_build_dir(), (int)s->pixel_m);
    build(s->options, arguments, out);
    map_open(out);
    compare_scene(s, &t);
    for (int i = 0; i < t.count; i++) {
        real_raster_free(&t.rasters[i]);
    }
    free(map.bytes);
    remove(out);
}

TEST(srtm_of_90_m_hides_and_shows_what_it_should)
{
    static const struct scene riviera = {
        "Riviera, 90 m", {"srtm_hgt/N43E007.hgt.zip"}, "", 43.1, 43.9, 7.1, 7.9, 90};
    run_scene(&riviera);
}

TEST(srtm_of_90_m_on_rolling_ground_hides_and_shows_what_it_should)
{
    static const struct scene borders = {
        "Scottish Borders, 90 m", {"srtm_hgt/N55W003.hgt.zip"}, "", 55.1, 55.9, -2.9, -2.1, 90};
    run_scene(&borders);
}

TEST(srtm_of_30_m_hides_and_shows_what_it_should)
{
    static const struct scene olympic = {"Juan de Fuca, 30 m",
                                         {"srtm_hgt/N48W125.hgt.zip"},
                                         "--shift0 12",
                                         48.1,
                                         48.9,
                                         -124.9,
                                         -124.1,
                                         30};
    run_scene(&olympic);
}

TEST(srtm_of_a_canyon_hides_and_shows_what_it_should)
{
    static const struct scene zion = {
        "Zion, 90 m", {"zion_nlcd_srtm/srtm.tif"}, "", 37.17, 37.48, -113.2, -112.88, 90};
    run_scene(&zion);
}

TEST(dted_hides_and_shows_what_it_should)
{
    static const struct scene island = {"Hawaii, DTED 1",
                                        {"dted1_hawaii/n19_w155_3arc_v2.dt1",
                                         "dted1_hawaii/n19_w156_3arc_v2.dt1",
                                         "dted1_hawaii/n20_w156_3arc_v2.dt1"},
                                        "",
                                        19.2,
                                        20.6,
                                        -155.9,
                                        -155.0,
                                        90};
    run_scene(&island);
}

/* ---- a ridge that is thinner than a cell ---- */

enum { RIDGE_SIDE = 1400 };
static const double ridge_px_deg = 1.0 / 3600, ridge_north = 0.36, ridge_west = 10.0 - 0.02;
static const double ridge_m = 27000, ridge_high_m = 300;

/* The north-eastern quarter of a ring of 27 km radius about 0 N 10 E: the ridge has every turn to
 * the grid. 120 m wide at its foot and 60 m on its top. */
static double ring_m(double latitude, double longitude)
{
    const double metres = 111319.49; /* of a degree, near enough both ways at the equator */
    const double off =
        fabs(hypot((latitude + 0) * metres * 0.99331, (longitude - 10) * metres) - ridge_m);
    return off <= 30 ? ridge_high_m : off >= 60 ? 0 : ridge_high_m * (60 - off) / 30;
}

static void write_ring(const char *path)
{
    GDALAllRegister();
    GDALDatasetH file = GDALCreate(GDALGetDriverByName("GTiff"), path, RIDGE_SIDE, RIDGE_SIDE, 1,
                                   GDT_Float32, NULL);
    double geo[6] = {ridge_west, ridge_px_deg, 0, ridge_north, 0, -ridge_px_deg};
    float *row = malloc(RIDGE_SIDE * sizeof *row);
    assert_non_null(file);
    GDALSetGeoTransform(file, geo);
    GDALSetProjection(file, "EPSG:4326");
    for (int y = 0; y < RIDGE_SIDE; y++) {
        for (int x = 0; x < RIDGE_SIDE; x++) {
            row[x] = (float)ring_m(ridge_north - (y + 0.5) * ridge_px_deg,
                                   ridge_west + (x + 0.5) * ridge_px_deg);
        }
        assert_int_equal(GDALRasterIO(GDALGetRasterBand(file, 1), GF_Write, 0, y, RIDGE_SIDE, 1,
                                      row, RIDGE_SIDE, 1, GDT_Float32, 0, 0),
                         CE_None);
    }
    free(row);
    GDALClose(file);
}

/* Length of the shadow behind the ridge, from cells or steps that are lit or not. */
static double shadow_behind_m(const uint8_t *sees, int count, double step_m)
{
    int last = 0, first = -1;
    for (int i = 0; i < count; i++) {
        const double s = (i + 0.5) * step_m;
        if (!sees[i] && s > ridge_m - 1500 && s < ridge_m + 9500) {
            first = first < 0 ? i : first;
            last = i;
        }
    }
    return first < 0 ? 0 : (last - first + 1) * step_m;
}

TEST(a_ridge_120_m_wide_hides_nine_tenths_of_what_geometry_says_or_more)
{
    enum { LOOKS = 180 };
    const double height_m = 1450;
    char raster[512], out[512], arguments[600];
    struct terrain t = {.count = 1};
    struct hs_rng rng;
    snprintf(raster, sizeof raster, "%s/tmp/ring.tif", support_build_dir());
    snprintf(out, sizeof out, "%s/tmp/ring.lmdb", support_build_dir());
    snprintf(arguments, sizeof arguments, "--terrain %s", raster);
    assert_int_equal(support_run("mkdir -p %s/tmp", support_build_dir()), 0);
    write_ring(raster);
    build("--sea-level -10", arguments, out);
    assert_int_equal(real_raster_read(&t.rasters[0], raster), 0);
    map_open(out);
    for (int k = 1; k < SCALES; k++) {
        const double range_m = scales_nm[k] * 1852.0, cell_m = range_m / BINS;
        double mean_m = 0, least_m = HUGE_VAL, most_m = 0, says_m = 0;
        hs_rng_seed(&rng, 3);
        for (int n = 0; n < LOOKS; n++) {
            const struct real_place from = {(hs_rng_uniform(&rng) - 0.5) * 0.01,
                                            10 + (hs_rng_uniform(&rng) - 0.5) * 0.01};
            const double azimuth_deg = 3 + 84.0 * n / LOOKS + hs_rng_uniform(&rng);
            uint8_t drawn[BINS];
            const int steps = see(&t, from, azimuth_deg, 15, 37000 / 15, height_m, fan[0]);
            const double true_m = shadow_behind_m(fan[0], steps, 15);
            map_trace((struct lm_position){hs_bam(from.latitude), hs_bam(from.longitude)},
                      hs_bam(azimuth_deg), range_m, height_m);
            for (int i = 0; i < BINS; i++) {
                drawn[i] = map.lit.level_db_q8[i] != LM_LEVEL_SHADOW;
            }
            const double drawn_m = shadow_behind_m(drawn, BINS, cell_m);
            mean_m += drawn_m / LOOKS;
            says_m += true_m / LOOKS;
            least_m = fmin(least_m, drawn_m - true_m);
            most_m = fmax(most_m, drawn_m - true_m);
        }
        print_message("# %2d nm: hides %.2f km of %.2f; a line differs by %.2f to %.2f km\n",
                      scales_nm[k], mean_m / 1000, says_m / 1000, least_m / 1000, most_m / 1000);
        assert_true(says_m > 6500 && says_m < 8000);
        /* Posts that are decimated hit the ridge or miss it: alone they hid 0 to 2.7 km, with
         * crests 5.8. A line differs by less than a third. */
        assert_true(mean_m > 0.9 * says_m && mean_m < 1.1 * says_m);
        assert_true(least_m > -0.35 * says_m && most_m < 0.35 * says_m);
    }
    real_raster_free(&t.rasters[0]);
    free(map.bytes);
    remove(raster);
    remove(out);
}

/* ---- towers ---- */

enum { FIELD_SIDE = 640, TOWERS = 3, TOWER_SIDE = 6 };
static const double field_px_deg = 0.00005, field_north = 0.016, field_west = 10; /* 5.6 m */
static const double towers_m[TOWERS] = {30, 80, 300};

/* Towers stand side by side, 200 pixels from the southern edge, in a town of 3 to 25 m that lies
 * apart from them. */
static double field_m(int y, int x, bool is_height)
{
    for (int i = 0; i < TOWERS; i++) {
        const int west = 100 + 200 * i;
        if (y >= 440 - TOWER_SIDE && y < 440 && x >= west && x < west + 2 * TOWER_SIDE) {
            return is_height ? towers_m[i] : 3;
        }
    }
    const bool is_town = y >= 560;
    return is_height ? (is_town ? 3 + (x * 7 + y * 13) % 221 / 10.0 : 0) : is_town ? 3 : 0;
}

static void write_field(const char *name, bool is_height, double flat)
{
    char path[600];
    snprintf(path, sizeof path, "%s/tmp/%s", support_build_dir(), name);
    GDALAllRegister();
    GDALDatasetH file = GDALCreate(GDALGetDriverByName("GTiff"), path, FIELD_SIDE, FIELD_SIDE, 1,
                                   is_height ? GDT_Float32 : GDT_Byte, NULL);
    double geo[6] = {field_west, field_px_deg, 0, field_north, 0, -field_px_deg};
    double row[FIELD_SIDE];
    assert_non_null(file);
    GDALSetGeoTransform(file, geo);
    GDALSetProjection(file, "EPSG:4326");
    for (int y = 0; y < FIELD_SIDE; y++) {
        for (int x = 0; x < FIELD_SIDE; x++) {
            row[x] = flat >= 0 ? flat : field_m(y, x, is_height);
        }
        assert_int_equal(GDALRasterIO(GDALGetRasterBand(file, 1), GF_Write, 0, y, FIELD_SIDE, 1,
                                      row, FIELD_SIDE, 1, GDT_Float64, 0, 0),
                         CE_None);
    }
    GDALClose(file);
}

/* Six classes by number: soil, asphalt, concrete, structure, trees, water. */
static void write_field_classes(void)
{
    char path[600];
    snprintf(path, sizeof path, "%s/tmp/field.classes", support_build_dir());
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(
        "[soil]\ncolour = 176 140 90\nkind = ground\ngamma_db = -20\nspread_db = 3\n"
        "limits_db = -29 -11\n"
        "[asphalt]\ncolour = 96 96 104\nkind = ground\ngamma_db = -30\nspread_db = 3\n"
        "limits_db = -39 -21\n"
        "[concrete]\ncolour = 208 208 200\nkind = ground\ngamma_db = -28\nspread_db = 3\n"
        "limits_db = -37 -19\n"
        "[structure]\ncolour = 216 48 40\nkind = structure\ngamma_db = 0\nspread_db = 5\n"
        "limits_db = -15 15\nheight_m = 8\n"
        "[trees]\ncolour = 48 136 48\nkind = trees\ngamma_db = -15\nspread_db = 3\n"
        "limits_db = -24 -6\nheight_m = 12\n"
        "[water]\ncolour = 32 64 160\nkind = water\ngamma_db = -40\nspread_db = 3\n"
        "limits_db = -49 -31\n",
        file);
    fclose(file);
}

/* Cells of 5 m, as in a patch, from 8.7 km on: what lies behind the tower. */
TEST(a_tower_of_30_80_or_300_m_casts_the_shadow_of_its_height)
{
    char out[600];
    const char *b = support_build_dir();
    const double height_m = 3000, cell_m = 5, start_m = 8700;
    assert_int_equal(support_run("mkdir -p %s/tmp", b), 0);
    write_field("field.tif", false, -1);
    write_field("field_heights.tif", true, -1);
    write_field("field_terrain.tif", true, 0);
    write_field_classes();
    snprintf(out, sizeof out, "%s/tmp/field.lmdb", b);
    assert_int_equal(
        support_run("%s/bin/landmass-db build --classes %s/tmp/field.classes --class-raster "
                    "%s/tmp/field.tif --heights %s/tmp/field_heights.tif --terrain "
                    "%s/tmp/field_terrain.tif --land-class soil --sea-level -10 --out %s "
                    ">/dev/null 2>&1",
                    b, b, b, b, b, out),
        0);
    map_open(out);
    for (int i = 0; i < TOWERS; i++) {
        /* From the south along a meridian through the tower; its southern face is 100 m behind the
         * first cell. */
        const double longitude = field_west + (100 + 200 * i + TOWER_SIDE) * field_px_deg;
        const double face = field_north - 440 * field_px_deg;
        const double metres = 110574; /* of a degree of latitude at the equator */
        const struct lm_position from = {hs_bam(face - (start_m + 100) / metres),
                                         hs_bam(longitude)};
        struct lm_geo_origin origin;
        struct lm_geo_ray ray;
        struct lm_ground_path path;
        lm_geo_set_origin(&origin, from);
        lm_geo_set_ray(&ray, &origin, 0);
        const uint32_t start_m_q8 = (uint32_t)(start_m * 256), long_m_q8 = BINS * 5 * 256;
        const struct lm_position points[3] = {lm_geo_along(&ray, start_m_q8),
                                              lm_geo_along(&ray, start_m_q8 + long_m_q8 / 2),
                                              lm_geo_along(&ray, start_m_q8 + long_m_q8)};
        lm_ground_path_fit(&path, points, BINS);
        lm_range_grid_set(&map.grid, &lm_radar_default.illumination, start_m_q8 + 640, 1280, BINS,
                          (int32_t)height_m * 1024, 0);
        map_read(lm_scan_lod(&map.db, 5000), &path);
        int dark = 0, tower = 0;
        double highest_m = 0;
        for (int k = 0; k < BINS; k++) {
            const double h = map.db.classes.height_dm[map.line.cell[k] & 15] / 10.0;
            highest_m = fmax(highest_m, h);
            dark += map.lit.level_db_q8[k] == LM_LEVEL_SHADOW && h == 0;
            tower += h > 0;
        }
        /* From the tower's rear edge to where the ray over it meets the ground. */
        const double rear_m = start_m + 100 + tower * cell_m;
        const double tangent = (height_m - highest_m) / rear_m;
        const double true_m = towers_m[i] / tangent;
        print_message("# %3.0f m: %.1f m in the image; its shadow %d m of %.0f\n", towers_m[i],
                      highest_m, dark * (int)cell_m, true_m);
        assert_true(fabs(highest_m - towers_m[i]) <= 0.02 * towers_m[i]);
        assert_true(fabs(dark * cell_m - true_m) <= fmax(2 * cell_m, 0.02 * true_m));
    }
    free(map.bytes);
    remove(out);
}
