/* Reflectivity: each texture against its theory, limits, independence of order, and both methods on
 * a raster. */
#include "check.h"
#include "fixture.h"
#include "gis/raster.h"
#include "reflectivity/reflect.h"

#include "hs/error.h"
#include "hs/rng.h"

#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 400 };

struct moments {
    double mean, deviation, skewness, low, high;
};

static struct moments measure(const double *v, size_t count)
{
    struct moments m = {.low = INFINITY, .high = -INFINITY};
    double second = 0, third = 0;
    for (size_t i = 0; i < count; i++) {
        m.mean += v[i] / (double)count;
        m.low = fmin(m.low, v[i]);
        m.high = fmax(m.high, v[i]);
    }
    for (size_t i = 0; i < count; i++) {
        const double d = v[i] - m.mean;
        second += d * d / (double)count;
        third += d * d * d / (double)count;
    }
    m.deviation = sqrt(second);
    m.skewness = third / (second * m.deviation);
    return m;
}

static struct moments draw(const struct db_class *c)
{
    static double values[SIDE * SIDE];
    struct db_reflect_law law;
    db_reflect_law_init(&law, c);
    for (int i = 0; i < SIDE * SIDE; i++) {
        values[i] = db_reflect_assign(&law, 1, i % SIDE, i / SIDE);
    }
    return measure(values, SIDE * SIDE);
}

/* With limits far away mean and spread are the table's, and the skewness is that of the logarithm
 * of a Gamma variate, polygamma(2, order) / polygamma(1, order)^1.5: -1.1395 for order 1 (the
 * Gumbel distribution's, of opposite sign), -0.7803 for order 2 (polygamma(2, 2) = 2 - 2 zeta(3) =
 * -0.40411, polygamma(1, 2) = pi^2 / 6 - 1 = 0.64493). */
TEST(each_texture_has_the_mean_the_spread_and_the_skewness_of_its_theory)
{
    static const struct {
        enum db_texture texture;
        double shape, skewness;
    } laws[] = {{DB_TEXTURE_GAUSSIAN, 1, 0},
                {DB_TEXTURE_RAYLEIGH, 1, -1.1395},
                {DB_TEXTURE_K, 1, -1.1395},
                {DB_TEXTURE_K, 2, -0.7803},
                {DB_TEXTURE_K, 0.5, -1.5351}};
    for (size_t i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        const struct db_class c = {.gamma_db = -17,
                                   .spread_db = 4,
                                   .low_db = -300,
                                   .high_db = 300,
                                   .texture = laws[i].texture,
                                   .texture_shape = laws[i].shape};
        const struct moments m = draw(&c);
        print_message("# texture %d order %g: mean %.3f spread %.3f skewness %.3f\n",
                      laws[i].texture, laws[i].shape, m.mean, m.deviation, m.skewness);
        /* Four standard errors of 160,000 draws: 4 * 4 / 400 for the mean. */
        assert_true(fabs(m.mean + 17) < 0.04);
        assert_true(fabs(m.deviation - 4) < 0.05);
        assert_true(fabs(m.skewness - laws[i].skewness) < 0.06);
    }
}

/* A coarse cell beside the mean of the pixels in it. */
TEST(a_coarse_cell_has_the_mean_and_the_spread_of_the_pixels_that_it_stands_for)
{
    static const struct db_class classes[] = {
        {.gamma_db = -15, .spread_db = 3, .low_db = -24, .high_db = -6},
        {.gamma_db = -2,
         .spread_db = 5.57,
         .low_db = -30,
         .high_db = 30,
         .texture = DB_TEXTURE_RAYLEIGH}};
    for (size_t k = 0; k < sizeof classes / sizeof classes[0]; k++) {
        static double means[SIDE * SIDE], coarse[SIDE * SIDE];
        struct db_reflect_law law;
        db_reflect_law_init(&law, &classes[k]);
        for (int halvings = 0; halvings <= 3; halvings++) {
            const int pixels = 1 << halvings, side = SIDE / pixels, count = side * side;
            for (int i = 0; i < count; i++) {
                double sum = 0;
                for (int p = 0; p < pixels * pixels; p++) {
                    const int x = i % side * pixels + p % pixels,
                              y = i / side * pixels + p / pixels;
                    sum += pow(10, db_reflect_assign(&law, 1, x, y) / 10);
                }
                means[i] = 10 * log10(sum / (pixels * pixels));
                coarse[i] = db_reflect_assign_coarse(&law, 2, i % side, i / side, halvings);
            }
            const struct moments wanted = measure(means, (size_t)count);
            const struct moments found = measure(coarse, (size_t)count);
            print_message("# %d x %d pixels: mean %.2f spread %.2f; wanted %.2f and %.2f\n", pixels,
                          pixels, found.mean, found.deviation, wanted.mean, wanted.deviation);
            assert_true(fabs(found.mean - wanted.mean) < (pixels == 2 ? 0.7 : 0.3));
            assert_true(fabs(found.deviation / wanted.deviation - 1) < 0.3);
        }
    }
}

/* Single look: an exponential power has a deviation of 5.57 dB; unscaled, the texture is
 * that law itself. */
TEST(the_rayleigh_texture_at_its_own_spread_is_an_exponential_power)
{
    const struct db_class c = {.gamma_db = -2.5068,
                               .spread_db = 5.5700,
                               .low_db = -300,
                               .high_db = 300,
                               .texture = DB_TEXTURE_RAYLEIGH};
    struct db_reflect_law law;
    db_reflect_law_init(&law, &c);
    double sum = 0, square = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double power = pow(10, db_reflect_assign(&law, 9, i % SIDE, i / SIDE) / 10);
        sum += power;
        square += power * power;
    }
    const double mean = sum / (SIDE * SIDE);
    assert_true(fabs(mean - 1) < 0.011);
    assert_true(fabs(sqrt(square / (SIDE * SIDE) - mean * mean) / mean - 1) < 0.02);
}

/* A normal cut at one spread either side keeps its mean and narrows to 0.5396 of its deviation
 * (1 - 2 phi(1) / (2 Phi(1) - 1) = 0.29112). */
TEST(no_value_leaves_the_limits_and_cutting_narrows_as_theory_says)
{
    const struct db_class c = {.gamma_db = -20, .spread_db = 3, .low_db = -23, .high_db = -17};
    const struct moments m = draw(&c);
    assert_true(m.low >= -23 && m.high <= -17);
    assert_true(m.low < -22.99 && m.high > -17.01);
    assert_true(fabs(m.mean + 20) < 0.02);
    assert_true(fabs(m.deviation - 3 * 0.53956) < 0.02);
}

TEST(neighbours_are_independent_and_seeds_differ)
{
    const struct db_class c = {.spread_db = 1, .low_db = -90, .high_db = 60};
    struct db_reflect_law law;
    db_reflect_law_init(&law, &c);
    double across = 0, down = 0, seeds = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x = i % SIDE, y = i / SIDE;
        const double v = db_reflect_assign(&law, 1, x, y);
        across += v * db_reflect_assign(&law, 1, x + 1, y);
        down += v * db_reflect_assign(&law, 1, x, y + 1);
        seeds += v * db_reflect_assign(&law, 2, x, y);
    }
    /* Four standard errors of a correlation over 160,000 pairs. */
    assert_true(fabs(across) / (SIDE * SIDE) < 0.01);
    assert_true(fabs(down) / (SIDE * SIDE) < 0.01);
    assert_true(fabs(seeds) / (SIDE * SIDE) < 0.01);
}

/* ---- The command ---- */

static const char classes[] =
    "[field]\ncolour = 1 1 1\nkind = ground\ngamma_db = -20\nspread_db = 3\nlimits_db = -60 20\n"
    "[lake]\ncolour = 2 2 2\nkind = water\ngamma_db = -40\nspread_db = 3\nlimits_db = -43 -37\n"
    "[town]\ncolour = 3 3 3\nkind = structure\ngamma_db = 0\nspread_db = 5\nlimits_db = -6 6\n";

/* Three stripes of class and a column of no data; brightness of each its own. */
static void write_scene(void)
{
    static float class_of[SIDE * SIDE], brightness[SIDE * SIDE];
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x = i % SIDE;
        class_of[i] = x == SIDE - 1 ? 255 : (float)(3 * x / SIDE);
        brightness[i] = (float)(50 + 60 * (3 * x / SIDE) + 7 * hs_rng_normal(&rng));
    }
    fixture_raster("class.tif", &grid, GDT_Byte, class_of, 255);
    fixture_raster("bright.tif", &grid, GDT_Float32, brightness, -1);
    fixture_write("three.classes", classes);
    OSRDestroySpatialReference(grid.crs);
}

static void read_values(const char *name, float *values, uint8_t *valid)
{
    struct db_raster r;
    assert_int_equal(db_raster_open_one(&r, fixture_path(name)), 0);
    assert_int_equal(db_raster_read(&r, 0, SIDE, values, valid), 0);
    db_raster_close(&r);
}

static struct moments measure_stripe(const float *values, int stripe)
{
    static double picked[SIDE * SIDE];
    size_t count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (i % SIDE != SIDE - 1 && 3 * (i % SIDE) / SIDE == stripe) {
            picked[count++] = (double)values[i];
        }
    }
    return measure(picked, count);
}

TEST(assigned_rasters_have_each_classes_mean_spread_and_limits)
{
    static float values[SIDE * SIDE], again[SIDE * SIDE];
    static uint8_t valid[SIDE * SIDE];
    write_scene();
    assert_int_equal(fixture_run(NULL, 0,
                                 "reflect --class-raster %s --classes %s --out %s --seed 4",
                                 fixture_path("class.tif"), fixture_path("three.classes"),
                                 fixture_path("g.tif")),
                     0);
    read_values("g.tif", values, valid);
    assert_int_equal(valid[SIDE - 1], 0);
    const struct moments field = measure_stripe(values, 0), lake = measure_stripe(values, 1);
    assert_true(fabs(field.mean + 20) < 0.06 && fabs(field.deviation - 3) < 0.05);
    assert_true(lake.low >= -43 && lake.high <= -37 && fabs(lake.mean + 40) < 0.05);
    assert_int_equal(fixture_run(NULL, 0,
                                 "reflect --class-raster %s --classes %s --out %s --seed 4",
                                 fixture_path("class.tif"), fixture_path("three.classes"),
                                 fixture_path("g2.tif")),
                     0);
    read_values("g2.tif", again, valid);
    assert_memory_equal(values, again, sizeof values);
}

TEST(adjusted_rasters_keep_the_detail_and_make_water_uniform)
{
    static float values[SIDE * SIDE], bright[SIDE * SIDE];
    static uint8_t valid[SIDE * SIDE];
    write_scene();
    assert_int_equal(
        fixture_run(NULL, 0,
                    "reflect --method adjust --class-raster %s --image %s --classes %s --out %s",
                    fixture_path("class.tif"), fixture_path("bright.tif"),
                    fixture_path("three.classes"), fixture_path("a.tif")),
        0);
    read_values("bright.tif", bright, valid);
    read_values("a.tif", values, valid);
    const struct moments field = measure_stripe(values, 0), lake = measure_stripe(values, 1);
    const struct moments town = measure_stripe(values, 2);
    assert_true(fabs(field.mean + 20) < 1e-3 && fabs(field.deviation - 3) < 1e-3);
    assert_true(lake.low == -40 && lake.high == -40);
    assert_true(town.low == -6 && town.high == 6);
    for (int i = 1; i < SIDE / 3; i++) {
        assert_int_equal(values[i] > values[i - 1], bright[i] > bright[i - 1]);
    }
}

TEST(the_command_says_what_is_wrong)
{
    write_scene();
    const char *raster = fixture_path("class.tif"), *table = fixture_path("three.classes");
    const char *out = fixture_path("never.tif");
    assert_true(fixture_fails(HS_EXIT_USAGE, "needs the image",
                              "reflect --method adjust --class-raster %s --classes %s --out %s",
                              raster, table, out));
    assert_true(fixture_fails(HS_EXIT_USAGE, "neither assign nor adjust",
                              "reflect --method guess --class-raster %s --classes %s --out %s",
                              raster, table, out));
    assert_true(fixture_fails(HS_EXIT_FAILED, "the class table ends at 2",
                              "reflect --class-raster %s --classes %s --out %s",
                              fixture_path("bright.tif"), table, out));
    assert_true(fixture_fails(HS_EXIT_FAILED, "cannot be created",
                              "reflect --class-raster %s --classes %s --out /nowhere/g.tif", raster,
                              table));
    assert_true(fixture_fails(HS_EXIT_USAGE, "needs a whole number within its range",
                              "reflect --seed -4 --class-raster %s --classes %s --out %s", raster,
                              table, out));
}

TEST_GROUP(fixture_open, fixture_close);
