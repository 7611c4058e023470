/* Reflectivity from an image of several patches and from radar imagery. */
#include "check.h"
#include "fixture.h"
#include "gis/raster.h"
#include "support.h"

#include "hs/rng.h"

#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 256 };

static const char classes[] =
    "[field]\ncolour = 1 1 1\nkind = ground\ngamma_db = -20\nspread_db = 3\nlimits_db = -60 20\n"
    "[lake]\ncolour = 2 2 2\nkind = water\ngamma_db = -40\nspread_db = 3\nlimits_db = -43 -37\n"
    "[wood]\ncolour = 3 3 3\nkind = trees\ngamma_db = -15\nspread_db = 4\nlimits_db = -60 6\n";

static double speckle(struct hs_rng *rng)
{
    return -log(1 - hs_rng_uniform(rng));
}

static void read_values(const char *name, float *values)
{
    struct db_raster r;
    assert_int_equal(db_raster_open_one(&r, fixture_path(name)), 0);
    assert_int_equal(GDALRasterIO(r.bands[0].handle, GF_Read, 0, 0, SIDE, SIDE, values, SIDE, SIDE,
                                  GDT_Float32, 0, 0),
                     CE_None);
    db_raster_close(&r);
}

/* One field over two pictures: the right one is brighter by 60 and has half the contrast. Ground
 * of 16 pixels is alike, as it is between real pixels. */
static void write_patches(void)
{
    static float bright[SIDE * SIDE], mask[SIDE * SIDE], class_of[SIDE * SIDE];
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    struct hs_rng rng;
    hs_rng_seed(&rng, 7);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const bool is_right = i % SIDE >= SIDE / 2;
        const double value = 50 + 20 * (hs_rng_uniform(&rng) - 0.5);
        bright[i] = (float)(is_right ? 60 + value / 2 + 25 : value);
        mask[i] = is_right ? 2 : 1;
        class_of[i] = 0;
    }
    fixture_raster("bright.tif", &grid, GDT_Float32, bright, -1);
    fixture_raster("mask.tif", &grid, GDT_UInt16, mask, 0);
    fixture_raster("class.tif", &grid, GDT_Byte, class_of, 255);
    OSRDestroySpatialReference(grid.crs);
    fixture_write("three.classes", classes);
}

/* Mean power of four. */
static void halve(double *db, int side)
{
    for (int y = 0; y < side / 2; y++) {
        for (int x = 0; x < side / 2; x++) {
            double sum = 0;
            for (int i = 0; i < 4; i++) {
                sum += pow(10, db[(2 * y + i / 2) * side + 2 * x + i % 2] / 10);
            }
            db[y * (side / 2) + x] = 10 * log10(sum / 4);
        }
    }
}

/* The step of the mean across the edge between the pictures, dB, at each level. */
static double largest_step(const float *values)
{
    static double level[SIDE * SIDE];
    double most = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        level[i] = (double)values[i];
    }
    for (int side = SIDE; side >= 8; side /= 2) {
        double sum = 0;
        for (int i = 0; i < side * side; i++) {
            sum += i % side < side / 2 ? -level[i] : level[i];
        }
        const double step = 2 * sum / side / side;
        most = fabs(step) > fabs(most) ? step : most;
        halve(level, side);
    }
    return most;
}

#define REFLECT "reflect --class-raster %s --classes %s --out %s "
#define REFLECT_PATHS                                                                              \
    fixture_path("class.tif"), fixture_path("three.classes"), fixture_path("gamma.tif")

TEST(a_class_is_even_over_the_edge_of_two_pictures_at_every_level)
{
    static float values[SIDE * SIDE];
    char said[4096];
    write_patches();
    assert_int_equal(fixture_run(NULL, 0, REFLECT "--method adjust --image %s", REFLECT_PATHS,
                                 fixture_path("bright.tif")),
                     0);
    read_values("gamma.tif", values);
    const double without = largest_step(values);
    assert_int_equal(fixture_run(said, sizeof said,
                                 REFLECT "--method adjust --image %s --patches %s", REFLECT_PATHS,
                                 fixture_path("bright.tif"), fixture_path("mask.tif")),
                     0);
    read_values("gamma.tif", values);
    const double with = largest_step(values);
    print_message("# step over the edge: %.2f dB without the mask, %.3f dB with it\n", without,
                  with);
    assert_true(without > 3);
    assert_true(fabs(with) < 0.01);
    assert_non_null(strstr(said, "patches: 2; 0 pixels"));
}

TEST(masks_that_are_none_are_refused)
{
    write_patches();
    assert_true(fixture_fails(2, "--patches: needs --method fields", REFLECT "--patches %s",
                              REFLECT_PATHS, fixture_path("mask.tif")));
    assert_true(fixture_fails(1, "numbers of patches are whole",
                              REFLECT "--method adjust --image %s --patches %s", REFLECT_PATHS,
                              fixture_path("bright.tif"), fixture_path("bright.tif")));
}

/* Radar imagery of `finer` times smaller pixels over the same ground: field at -12 dB, a lake at
 * -22 dB in the middle third of the rows, wood at -8 dB below. Speckle of one look. In the first
 * four rows of the field there is no data. */
static void write_radar(int finer, bool is_linear, double floor_db)
{
    const int side = SIDE * finer;
    float *radar = malloc((size_t)side * (size_t)side * sizeof *radar);
    static float class_of[SIDE * SIDE];
    static const double means[3] = {-12, -22, -8};
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    struct hs_rng rng;
    hs_rng_seed(&rng, 11);
    for (int i = 0; i < SIDE * SIDE; i++) {
        class_of[i] = (float)(3 * (i / SIDE) / SIDE);
    }
    fixture_raster("class.tif", &grid, GDT_Byte, class_of, 255);
    for (int i = 0; i < side * side; i++) {
        const int y = i / side / finer;
        const double power = pow(10, (means[3 * y / SIDE] + floor_db) / 10) * speckle(&rng);
        radar[i] = (float)(y < 4 ? -9999 : is_linear ? power : 10 * log10(power));
    }
    grid.width = grid.height = side;
    grid.geotransform[1] /= finer;
    grid.geotransform[5] /= finer;
    fixture_raster("radar.tif", &grid, GDT_Float32, radar, -9999);
    OSRDestroySpatialReference(grid.crs);
    fixture_write("three.classes", classes);
    free(radar);
}

/* Mean and deviation in dB, and mean power in dB, of a third of the rows without its borders. */
static void measure(const float *values, int third, double out[3])
{
    double sum = 0, square = 0, power = 0;
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int y = i / SIDE;
        if (3 * (y - 8) / SIDE == third && 3 * (y + 4) / SIDE == third && y >= 8) {
            sum += (double)values[i];
            square += (double)values[i] * (double)values[i];
            power += pow(10, (double)values[i] / 10);
            count++;
        }
    }
    out[0] = sum / count;
    out[1] = sqrt(square / count - out[0] * out[0]);
    out[2] = 10 * log10(power / count);
}

#define RADAR REFLECT "--method radar --radar %s "

TEST(mean_powers_come_through_and_speckle_falls_with_the_looks)
{
    static float values[SIDE * SIDE];
    double one[3], nine[3], fine[3];
    write_radar(1, false, 0);
    for (int looks = 1; looks <= 3; looks += 2) {
        assert_int_equal(fixture_run(NULL, 0,
                                     RADAR "--radar-unit db --calibrate none --multilook %d",
                                     REFLECT_PATHS, fixture_path("radar.tif"), looks),
                         0);
        read_values("gamma.tif", values);
        measure(values, 0, looks == 1 ? one : nine);
    }
    write_radar(4, true, 0);
    assert_int_equal(fixture_run(NULL, 0,
                                 RADAR "--radar-unit linear --calibrate none --multilook 1",
                                 REFLECT_PATHS, fixture_path("radar.tif")),
                     0);
    read_values("gamma.tif", values);
    measure(values, 0, fine);
    print_message("# power %.2f, %.2f, %.2f dB; spread %.2f, %.2f, %.2f dB of 1, 9 and 16 looks\n",
                  one[2], nine[2], fine[2], one[1], nine[1], fine[1]);
    assert_true(fabs(one[2] + 12) < 0.1 && fabs(nine[2] + 12) < 0.1 && fabs(fine[2] + 12) < 0.1);
    /* 4.34 sqrt(trigamma(looks)) dB. */
    assert_true(fabs(one[1] - 5.57) < 0.1);
    assert_true(fabs(nine[1] - 1.49) < 0.1);
    assert_true(fabs(fine[1] - 1.10) < 0.1);
}

TEST(each_class_gets_its_mean_and_what_is_missing_is_drawn_and_counted)
{
    static float values[SIDE * SIDE];
    char said[8192];
    double field[3], wood[3];
    write_radar(1, false, 0);
    assert_int_equal(fixture_run(said, sizeof said, RADAR "--radar-unit db --multilook 1",
                                 REFLECT_PATHS, fixture_path("radar.tif")),
                     0);
    read_values("gamma.tif", values);
    measure(values, 0, field);
    measure(values, 2, wood);
    assert_true(fabs(field[0] + 20) < 0.1 && fabs(wood[0] + 15) < 0.1);
    assert_true(values[SIDE * SIDE / 2] == -40);
    assert_non_null(strstr(said, "assumed: X band differs"));
    assert_non_null(strstr(said, "1024 pixels have no radar data and are drawn from their class"));
    for (int i = 0; i < 4 * SIDE; i++) {
        assert_true(values[i] > -60 && values[i] < 20);
    }
}

TEST(one_number_for_the_scene_keeps_the_steps_between_classes)
{
    static float values[SIDE * SIDE];
    double field[3], wood[3];
    write_radar(1, false, 0);
    assert_int_equal(fixture_run(NULL, 0, RADAR "--radar-unit db --calibrate scene", REFLECT_PATHS,
                                 fixture_path("radar.tif")),
                     0);
    read_values("gamma.tif", values);
    measure(values, 0, field);
    measure(values, 2, wood);
    assert_true(fabs(wood[2] - field[2] - 4) < 0.2);
}

TEST(sigma_of_an_angle_is_gamma_over_its_cosine)
{
    static float values[SIDE * SIDE];
    double field[3];
    write_radar(1, false, 0);
    assert_int_equal(fixture_run(NULL, 0, RADAR "--radar-unit db --calibrate none --incidence 60",
                                 REFLECT_PATHS, fixture_path("radar.tif")),
                     0);
    read_values("gamma.tif", values);
    measure(values, 0, field);
    assert_true(fabs(field[2] + 12 - 3.01) < 0.1);
}

TEST(radar_of_the_wrong_unit_or_place_is_refused)
{
    const char *radar = fixture_path("radar.tif");
    write_radar(1, false, 0);
    assert_true(
        fixture_fails(1, "no power is below 0", RADAR "--radar-unit linear", REFLECT_PATHS, radar));
    assert_true(fixture_fails(2, "must say whether", RADAR, REFLECT_PATHS, radar));
    assert_true(fixture_fails(2, "--radar: needs --method radar", REFLECT "--radar %s",
                              REFLECT_PATHS, radar));
    write_radar(1, true, 30);
    assert_true(fixture_fails(1, "is it --radar-unit linear?", RADAR "--radar-unit db",
                              REFLECT_PATHS, radar));
    assert_true(fixture_fails(1, "has 1 bands", RADAR "--radar-unit linear --radar-band 2",
                              REFLECT_PATHS, radar));
    assert_int_not_equal(access(fixture_path("never.tif"), F_OK), 0);
}

TEST(a_flood_of_sentinel_1_becomes_reflectivity)
{
    char radar[512], label[512], said[8192];
    if (!support_data_path("sen1floods11_spain_s1_s2/Spain_7370579_S1Hand.tif", radar,
                           sizeof radar) ||
        !support_data_path("sen1floods11_spain_s1_s2/Spain_7370579_LabelHand.tif", label,
                           sizeof label)) {
        skip();
    }
    /* Label 1 is water, class 1; 0 is land, class 0; -1 is nothing. */
    fixture_write("three.classes", classes);
    assert_int_equal(support_run("gdal_translate -q -ot Byte -a_nodata 255 %s %s", label,
                                 fixture_path("class.tif")),
                     0);
    assert_int_equal(fixture_run(said, sizeof said, RADAR "--radar-unit db", REFLECT_PATHS, radar),
                     0);
    const char *land = strstr(said, "field ");
    land = strstr(land, "pixels of radar") ? strstr(land, "pixels of radar") : land;
    double mean = 0;
    assert_int_equal(sscanf(land, "pixels of radar mean %lf", &mean), 1);
    print_message("# land at %.2f dB in VV\n", mean);
    assert_true(mean > -10.5 && mean < -8); /* medians of its parts: -10.0, -8.9, -7.0 */
}

TEST_GROUP(fixture_open, fixture_close);
