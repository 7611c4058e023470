/* landmass-db infrared: its files, their values, and what it refuses. */
#include "check.h"
#include "fixture.h"
#include "gis/raster.h"
#include "infrared/planck.h"
#include "infrared/weather.h"

#include "hs/error.h"

#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 96 };

static const char head[] =
    "[water]\ncolour = 1 1 9\nkind = water\ngamma_db = -40\nspread_db = 3\n"
    "limits_db = -49 -31\nemissivity = 0.985 0.002\nalbedo = 0.08 0.01\n"
    "conductivity = 400 0\nheat_capacity = 4.18\nwetness = 1\n"
    "roughness_m = 0.0001\n";
static const char ground[] =
    "[%s]\ncolour = %d 1 1\nkind = ground\ngamma_db = -20\nspread_db = 3\n"
    "limits_db = -29 -11\nemissivity = 0.95 0.01\nalbedo = %s\n"
    "conductivity = %s\nheat_capacity = 1.94\n";

/* Stripes of water, a dark road whose conductivity varies and a bright one whose albedo does, and
 * which conducts more; and a column of no data. The terrain rises towards the west by one in two:
 * it faces east. */
static void write_scene(void)
{
    static float class_of[SIDE * SIDE], height[SIDE * SIDE];
    char table[2000], one[500], other[500];
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        class_of[i] = i % SIDE == SIDE - 1 ? 255 : (float)(3 * (i % SIDE) / SIDE);
        height[i] = 0.5F * (float)(SIDE - i % SIDE);
    }
    fixture_raster("class.tif", &grid, GDT_Byte, class_of, 255);
    fixture_raster("dem.tif", &grid, GDT_Float32, height, -1);
    OSRDestroySpatialReference(grid.crs);
    snprintf(one, sizeof one, ground, "dark", 2, "0.1 0", "0.75 0.1");
    snprintf(other, sizeof other, ground, "bright", 3, "0.4 0.02", "1.5 0");
    snprintf(table, sizeof table, "%s%s%s", head, one, other);
    fixture_write("warm.classes", table);
}

#define INFRARED "infrared --class-raster %s --classes %s --out %s --air 22 --wind 2 "
#define PATHS    fixture_path("class.tif"), fixture_path("warm.classes"), fixture_path("ir")

static uint8_t valid[SIDE * SIDE];

/* Both bands of a picture. */
static void read_all(const char *name, float *values)
{
    struct db_raster r;
    assert_int_equal(db_raster_open_one(&r, fixture_path(name)), 0);
    assert_int_equal(r.band_count, 2);
    assert_int_equal(db_raster_read(&r, 0, SIDE, values, valid), 0);
    db_raster_close(&r);
}

static void read_picture(const char *name, float *values)
{
    read_all(name, values);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_int_equal(valid[i], i % SIDE != SIDE - 1);
    }
}

struct moments {
    double mean, deviation;
};

static struct moments of_stripe(const float *values, int stripe)
{
    double sum = 0, square = 0, count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (i % SIDE < SIDE - 1 && 3 * (i % SIDE) / SIDE == stripe) {
            sum += (double)values[i];
            square += (double)values[i] * (double)values[i];
            count++;
        }
    }
    return (struct moments){sum / count, sqrt(fmax(0, square / count - pow(sum / count, 2)))};
}

TEST(pictures_hold_kelvin_and_the_radiance_that_belongs_to_them)
{
    static float day[2 * SIDE * SIDE], night[2 * SIDE * SIDE];
    write_scene();
    assert_int_equal(fixture_run(NULL, 0, INFRARED, PATHS), 0);
    read_picture("ir/infrared-0400.tif", night);
    read_picture("ir/infrared-1400.tif", day);
    for (int stripe = 0; stripe < 3; stripe++) {
        print_message("# class %d: %.1f and %.1f K, deviation %.2f and %.2f K\n", stripe,
                      of_stripe(night, stripe).mean, of_stripe(day, stripe).mean,
                      of_stripe(night, stripe).deviation, of_stripe(day, stripe).deviation);
    }
    assert_true(of_stripe(day, 1).mean > of_stripe(day, 2).mean + 5);
    assert_true(of_stripe(day, 2).mean > of_stripe(day, 0).mean + 5);
    assert_true(of_stripe(night, 0).mean > of_stripe(night, 2).mean);
    assert_true(of_stripe(night, 2).mean > of_stripe(night, 1).mean);
    assert_true(of_stripe(day, 1).deviation > 0.2 && of_stripe(day, 2).deviation > 0.2);
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (i % SIDE < SIDE - 1) {
            const double black = ir_band_radiance(8, 12, (double)day[i]);
            const double share = (double)day[SIDE * SIDE + i] / black;
            assert_true(share > 0.9 && share < 1);
        }
    }
}

/* Water has the season's mean, the air's unless it is given. */
TEST(water_has_the_mean_that_is_asked_for)
{
    static float values[2 * SIDE * SIDE];
    write_scene();
    static const char *const more[] = {"--hours 0,6,12,18", "--hours 0,6,12,18 --water 10"};
    for (int k = 0; k < 2; k++) {
        double mean = 0;
        assert_int_equal(fixture_run(NULL, 0, INFRARED "%s", PATHS, more[k]), 0);
        for (int hour = 0; hour < 24; hour += 6) {
            char name[40];
            snprintf(name, sizeof name, "ir/infrared-%02d00.tif", hour);
            read_picture(name, values);
            mean += of_stripe(values, 0).mean / 4;
        }
        assert_true(fabs(mean - (k ? 283.15 : 295.15)) < 0.3);
    }
}

TEST(ground_that_faces_east_is_warmer_in_the_morning_and_colder_in_the_evening)
{
    static float flat[2 * SIDE * SIDE], slope[2 * SIDE * SIDE];
    static const char *const names[] = {"ir/infrared-0800.tif", "ir/infrared-1730.tif"};
    write_scene();
    for (int k = 0; k < 2; k++) {
        assert_int_equal(fixture_run(NULL, 0, INFRARED "--hours 8,17.5", PATHS), 0);
        read_picture(names[k], flat);
        assert_int_equal(fixture_run(NULL, 0, INFRARED "--hours 8,17.5 --terrain %s", PATHS,
                                     fixture_path("dem.tif")),
                         0);
        read_picture(names[k], slope);
        const double more = of_stripe(slope, 1).mean - of_stripe(flat, 1).mean;
        print_message("# %s: %+.1f K\n", names[k], more);
        assert_true(k == 0 ? more > 4 : more < -2);
    }
}

/* A raster of one value, but for some of it. */
static void write_level(const char *name, int side, float value)
{
    static float values[SIDE * SIDE];
    struct db_grid grid = fixture_grid(side, side);
    for (int i = 0; i < side * side; i++) {
        values[i] = value + (float)(i % 7);
    }
    fixture_raster(name, &grid, GDT_Float32, values, -9999);
    OSRDestroySpatialReference(grid.crs);
}

TEST(what_does_not_look_like_terrain_or_heights_is_refused_unless_it_is_trusted)
{
    static const struct {
        const char *options, *file;
        int side;
        float value;
        int status; /* without --trust-inputs */
        const char *words;
    } cases[] = {
        {"--terrain", "far.tif", SIDE, 30000, 1, "nowhere on Earth"},
        {"--terrain", "part.tif", SIDE / 2, 100, 0, "75.0 % of the pixels have no elevation"},
        {"--shadows --heights", "gamma.tif", SIDE, -20, 1, "below"},
        {"--shadows --heights", "sea.tif", SIDE, 400, 1, "above"},
        {"--shadows --heights", "small.tif", SIDE / 2, 5, 1, "another grid"},
        {"--heights", "five.tif", SIDE, 5, 2, "needs --shadows"},
    };
    write_scene();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char said[4000];
        write_level(cases[i].file, cases[i].side, cases[i].value);
        const int status = fixture_run(said, sizeof said, INFRARED "--hours 9 %s %s", PATHS,
                                       cases[i].options, fixture_path(cases[i].file));
        if (status != cases[i].status || !strstr(said, cases[i].words)) {
            fail_msg("%s %s: %d, %s", cases[i].options, cases[i].file, status, said);
        }
    }
    char said[4000];
    assert_int_equal(fixture_run(said, sizeof said,
                                 INFRARED "--hours 9 --trust-inputs --terrain %s", PATHS,
                                 fixture_path("far.tif")),
                     0);
    assert_non_null(strstr(said, "warning"));
}

/* A wall of 10 m from south to north. At 8 h the sun is in the north-east, and the shadow reaches
 * 10 m times its eastward part over its height to the west; at 16 h to the east. */
TEST(a_wall_casts_a_shadow_as_long_as_the_sun_is_low)
{
    static float class_of[SIDE * SIDE], wall[SIDE * SIDE], values[2 * SIDE * SIDE];
    static const int middle = SIDE / 2, row = SIDE / 2;
    write_scene();
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        class_of[i] = 2;
        wall[i] = i % SIDE == middle ? 10 : 0;
    }
    fixture_raster("class.tif", &grid, GDT_Byte, class_of, 255);
    fixture_raster("wall.tif", &grid, GDT_Float32, wall, -1);
    OSRDestroySpatialReference(grid.crs);
    const struct ir_weather w = {.latitude = -3.62 * 3.14159265358979 / 180, .day_of_year = 172};
    for (int k = 0; k < 2; k++) {
        const double hour = k == 0 ? 8 : 16;
        double sun[3];
        ir_sun(&w, hour - 0.5, sun); /* the sun of the last hour */
        const int reach = (int)(10 * fabs(sun[0]) / sun[2]), way = k == 0 ? -1 : 1;
        assert_int_equal(fixture_run(NULL, 0, INFRARED "--hours %g --shadows --heights %s --seed 2",
                                     PATHS, hour, fixture_path("wall.tif")),
                         0);
        read_all(k == 0 ? "ir/infrared-0800.tif" : "ir/infrared-1600.tif", values);
        const float *line = values + row * SIDE;
        const float near = line[middle + way * 2], edge = line[middle + way * (reach - 2)],
                    beyond = line[middle + way * (reach + 12)], sunny = line[middle - way * 8];
        print_message("# %g h: shadow of %d m: %.1f %.1f, beyond %.1f, in the sun %.1f K\n", hour,
                      reach, (double)near, (double)edge, (double)beyond, (double)sunny);
        assert_true(near < beyond - 3 && edge < beyond - 3);
        assert_true(near < sunny - 3 && edge < sunny - 3);
    }
}

/* South of the equator the sun of June stands in the north: a wall from west to east has its shadow
 * on its southern side. */
TEST(shadows_lie_away_from_the_sun_at_noon)
{
    static float class_of[SIDE * SIDE], wall[SIDE * SIDE], values[2 * SIDE * SIDE];
    write_scene();
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        class_of[i] = 2;
        wall[i] = i / SIDE == SIDE / 2 ? 10 : 0;
    }
    fixture_raster("class.tif", &grid, GDT_Byte, class_of, 255);
    fixture_raster("wall.tif", &grid, GDT_Float32, wall, -1);
    OSRDestroySpatialReference(grid.crs);
    assert_int_equal(fixture_run(NULL, 0, INFRARED "--hours 12 --shadows --heights %s", PATHS,
                                 fixture_path("wall.tif")),
                     0);
    read_all("ir/infrared-1200.tif", values);
    const float *column = values + SIDE / 2;
    const float north = column[(SIDE / 2 - 2) * SIDE], south = column[(SIDE / 2 + 2) * SIDE];
    print_message("# north of the wall %.1f K, south %.1f K\n", (double)north, (double)south);
    assert_true(south < north - 3);
}

TEST(curves_and_pictures_lie_beside_the_rasters)
{
    static const char *const names[] = {"ir/infrared.csv", "ir/infrared.png",
                                        "ir/infrared-1330.png", "ir/infrared-1330.tif"};
    write_scene();
    assert_int_equal(fixture_run(NULL, 0, INFRARED "--hours 13.5", PATHS), 0);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(access(fixture_path(names[i]), R_OK), 0);
    }
    FILE *f = fopen(fixture_path("ir/infrared.csv"), "r");
    char line[200];
    int lines = 0;
    assert_non_null(f);
    while (fgets(line, sizeof line, f)) {
        double hour, water, dark, bright;
        if (lines++ == 0) {
            assert_string_equal(line, "hour,water,dark,bright\n");
        } else {
            assert_int_equal(sscanf(line, "%lf,%lf,%lf,%lf", &hour, &water, &dark, &bright), 4);
            assert_true(hour == (lines - 2) / 2.0 && fabs(water - 22) < 3);
        }
    }
    fclose(f);
    assert_int_equal(lines, 49);
}

TEST(the_command_says_what_is_wrong)
{
    static const struct {
        int code;
        const char *more, *says;
    } wrong[] = {
        {HS_EXIT_USAGE, "--hours 4,25", "`25` is no hour"},
        {HS_EXIT_USAGE, "--hours noon", "`noon` is no hour"},
        {HS_EXIT_USAGE, "--date 02-30", "names a day that its month has not"},
        {HS_EXIT_USAGE, "--date 13-01", "needs a month and a day"},
        {HS_EXIT_USAGE, "--cloud 2", "needs a number from 0 to 1"},
        {HS_EXIT_USAGE, "--latitude 91", "needs a number from -90 to 90"},
        {HS_EXIT_FAILED, "--terrain nosuch.tif", "cannot be opened"},
        {HS_EXIT_USAGE, "--shadows", "needs --terrain or --heights"},
        {HS_EXIT_FAILED, "--shadows --heights nosuch.tif", "cannot be opened"},
    };
    write_scene();
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        if (!fixture_fails(wrong[i].code, wrong[i].says, INFRARED "%s", PATHS, wrong[i].more)) {
            fail_msg("%s", wrong[i].more);
        }
    }
    fixture_write("x.classes",
                  "[soil]\ncolour = 1 1 1\nkind = ground\ngamma_db = -20\n"
                  "spread_db = 3\nlimits_db = -29 -11\nemissivity = 0.9 0.01\n");
    assert_true(fixture_fails(HS_EXIT_FAILED, ":1: class [soil] has no `albedo`",
                              "infrared --class-raster %s --classes %s --out %s",
                              fixture_path("class.tif"), fixture_path("x.classes"),
                              fixture_path("ir")));
}

TEST_GROUP(fixture_open, fixture_close);
