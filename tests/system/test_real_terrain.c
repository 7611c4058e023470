/* Real terrain, DTED level 1 of Hawaii and SRTM of Nice, from the files to ground maps. Where sea,
 * coast and radar shadow should be is worked out here in double precision from the same files:
 * elevations by GDAL, geodesics by PROJ, lines of sight over an Earth of 4/3 its radius. */
#include "check.h"
#include "real_scene.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { TILES_MAX = 3, STEPS_A_CELL = 6 };

/* Greys that tell echoes apart: sea -40 dB comes out at 0..30, land at -17 dB and a slope's share
 * at 60 and more. */
enum { LAND_GREY = 45, NOISE_GREY = 20 };

struct terrain {
    struct real_raster tiles[TILES_MAX];
    int count;
};

/* What a double-precision radar finds in a range cell. */
enum truth { SEA, LAND, HIDDEN, MIXED, UNKNOWN };

struct view {
    struct real_place place;
    double heading_deg, height_m, range_m;
};

static struct real_scene island, riviera;

static double elevation(const struct terrain *t, struct real_place p)
{
    for (int i = 0; i < t->count; i++) {
        const double z = real_raster_bilinear(&t->tiles[i], p.longitude, p.latitude);
        if (!isnan(z)) {
            return z;
        }
    }
    return NAN;
}

static void terrain_read(struct terrain *t, const struct real_scene *scene,
                         const char *const *names, int count)
{
    t->count = count;
    for (int i = 0; i < count; i++) {
        char path[2048];
        snprintf(path, sizeof path, "%s%s", scene->data, names[i]);
        assert_int_equal(real_raster_read(&t->tiles[i], path), 0);
    }
}

static void terrain_free(struct terrain *t)
{
    for (int i = 0; i < t->count; i++) {
        real_raster_free(&t->tiles[i]);
    }
}

static double height_cells(const struct view *v)
{
    return v->height_m / v->range_m * REAL_CELLS;
}

static double line_azimuth(const struct view *v, int line)
{
    return v->heading_deg + (line + 0.5) * 120 / REAL_CELLS - 60;
}

/* One line: the truth of each cell, from samples every sixth of a cell. */
static void look_along(const struct terrain *t, const struct view *v, int line,
                       enum truth truth[REAL_CELLS])
{
    const double earth_m = 6371000 * 4 / 3.0, cell_m = v->range_m / REAL_CELLS;
    double horizon = -1e9;
    for (int cell = 0; cell < REAL_CELLS; cell++) {
        int hidden = 0, sea = 0, unknown = 0;
        for (int step = 0; step < STEPS_A_CELL; step++) {
            const double range = (cell + (step + 0.5) / STEPS_A_CELL) * cell_m;
            const double z = elevation(t, real_geodesic(v->place, line_azimuth(v, line), range));
            if (isnan(z)) {
                unknown++;
                continue;
            }
            const double tangent = (z - v->height_m - range * range / (2 * earth_m)) / range;
            hidden += tangent <= horizon;
            horizon = fmax(horizon, tangent);
            sea += z <= 0;
        }
        truth[cell] = unknown                                         ? UNKNOWN
                      : hidden == STEPS_A_CELL                        ? HIDDEN
                      : hidden > 0 || (sea > 0 && sea < STEPS_A_CELL) ? MIXED
                      : sea                                           ? SEA
                                                                      : LAND;
    }
}

/* How often the picture shows what the truth says. */
struct agreement {
    double sea, sea_dark, land, land_bright, hidden, hidden_black;
};

/* What the beam and the pulse mix: lines and cells to either side. Two-way, the beam falls by 20 dB
 * in 6.4 lines. */
enum { BEAM_LINES = 8, PULSE_CELLS = 2 };

static bool is_all_one(enum truth truth[REAL_CELLS][REAL_CELLS], int line, int cell)
{
    for (int k = line - BEAM_LINES; k <= line + BEAM_LINES; k++) {
        for (int i = cell - PULSE_CELLS; i <= cell + PULSE_CELLS; i++) {
            if (truth[k][i] != truth[line][cell]) {
                return false;
            }
        }
    }
    return true;
}

/* Only cells count whose whole surroundings, as far as the beam and the pulse reach, say the same.
 */
static struct agreement compare(const struct terrain *t, const struct view *v,
                                const struct real_picture *p, int noise_grey, int end)
{
    struct agreement a = {0};
    static enum truth truth[REAL_CELLS][REAL_CELLS];
    for (int line = 0; line < REAL_CELLS; line++) {
        look_along(t, v, line, truth[line]);
    }
    for (int line = BEAM_LINES; line < REAL_CELLS - BEAM_LINES; line++) {
        for (int cell = 16; cell < end - PULSE_CELLS; cell++) {
            const int grey = p->grey[line][cell];
            const enum truth here = truth[line][cell];
            if (grey == REAL_NO_PIXEL || !is_all_one(truth, line, cell)) {
                continue;
            }
            a.sea += here == SEA;
            a.sea_dark += here == SEA && grey < LAND_GREY;
            a.land += here == LAND;
            a.land_bright += here == LAND && grey >= LAND_GREY;
            a.hidden += here == HIDDEN;
            a.hidden_black += here == HIDDEN && grey <= noise_grey;
        }
    }
    print_message(
        "# sea %.0f cells, %.1f %% dark; land %.0f, %.1f %% bright; hidden %.0f, %.1f %% black\n",
        a.sea, 100 * a.sea_dark / a.sea, a.land, 100 * a.land_bright / a.land, a.hidden,
        100 * a.hidden_black / a.hidden);
    return a;
}

/* Flies straight at 200 m/s; a sweep takes a second and ends when the picture is taken. */
static struct view island_view(double height_m, double range_m, double picture_s)
{
    const struct real_place start = {19.75, -154.75};
    const double flown_m = 200 * (picture_s - 0.5);
    return (struct view){real_geodesic(start, 270, flown_m), 270, height_m, range_m};
}

static void island_terrain(struct terrain *t)
{
    static const char *const names[] = {"dted1_hawaii/n19_w155_3arc_v2.dt1",
                                        "dted1_hawaii/n19_w156_3arc_v2.dt1",
                                        "dted1_hawaii/n20_w156_3arc_v2.dt1"};
    terrain_read(t, &island, names, 3);
}

TEST(what_a_line_of_sight_over_the_dted_hides_shows_noise_and_the_sea_is_darker_than_the_land)
{
    if (!island.is_here) {
        skip();
    }
    static const struct {
        const char *name;
        double height_m, range_m, picture_s;
        int noise_grey; /* what noise reaches: it grows with range, and the lower the aircraft */
        int end;        /* cells behind it are left out: noise is as bright as land there */
    } table[] = {
        {"high-ground-map-80nm", 3000, 148160, 4, LAND_GREY - 1, REAL_CELLS},
        {"high-ground-map-40nm", 3000, 74080, 8, NOISE_GREY, REAL_CELLS},
        {"low-ground-map-80nm", 1500, 148160, 4, LAND_GREY - 1, REAL_CELLS * 2 / 3},
        {"low-ground-map-40nm", 1500, 74080, 8, LAND_GREY - 1, REAL_CELLS},
    };
    struct terrain t;
    double hidden = 0;
    island_terrain(&t);
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        static struct real_picture p;
        const struct view v = island_view(table[i].height_m, table[i].range_m, table[i].picture_s);
        assert_int_equal(real_ground_map_read(&p, &island, table[i].name, height_cells(&v)), 0);
        print_message("# %s\n", table[i].name);
        const struct agreement a = compare(&t, &v, &p, table[i].noise_grey, table[i].end);
        hidden += a.hidden; /* 40 miles have few on the glass, whose wings are clipped */
        assert_true(a.hidden_black >= 0.95 * a.hidden);
        assert_true(a.sea > 5000 && a.sea_dark >= 0.99 * a.sea);
        assert_true(a.land > 300 && a.land_bright >= 0.95 * a.land);
    }
    assert_true(hidden > 5000);
    terrain_free(&t);
}

/* First cell that is land to the eye: it and one of the next two are bright. -1 when there is none.
 */
static int drawn_coast(const int grey[REAL_CELLS])
{
    for (int cell = 8; cell < REAL_CELLS - 2; cell++) {
        if (grey[cell] >= LAND_GREY &&
            (grey[cell + 1] >= LAND_GREY || grey[cell + 2] >= LAND_GREY)) {
            return cell;
        }
    }
    return -1;
}

/* Distance to the first land along the line in cells, or -1 when there is none or the map ends
 * before. */
static double true_coast(const struct terrain *t, const struct view *v, int line)
{
    const double step_m = 20;
    for (double range = 2000; range < v->range_m - 1000; range += step_m) {
        const double z = elevation(t, real_geodesic(v->place, line_azimuth(v, line), range));
        if (isnan(z)) {
            return -1;
        }
        if (z > 0.5) {
            return range / v->range_m * REAL_CELLS;
        }
    }
    return -1;
}

/* The nearest coast within the half-power width of the two-way beam: five lines. -1 when one of
 * them has none. */
static double coast_in_beam(const struct terrain *t, const struct view *v, int line)
{
    double nearest = 1e9;
    for (int k = line - 2; k <= line + 2; k++) {
        const double coast = true_coast(t, v, k);
        if (coast < 0) {
            return -1;
        }
        nearest = fmin(nearest, coast);
    }
    return nearest;
}

/* Whether a symbol, the cursor's line for one, lies over the picture around that cell. */
static bool is_covered(const int grey[REAL_CELLS], double cell)
{
    for (int near = (int)cell - 2; near <= (int)cell + 2; near++) {
        if (near >= 0 && near < REAL_CELLS && grey[near] == REAL_NO_PIXEL) {
            return true;
        }
    }
    return false;
}

TEST(the_coast_is_drawn_at_the_distance_that_the_dted_says)
{
    if (!island.is_here) {
        skip();
    }
    static struct real_picture p;
    struct terrain t;
    island_terrain(&t);
    const struct view v = island_view(3000, 74080, 8);
    assert_int_equal(real_ground_map_read(&p, &island, "high-ground-map-40nm", height_cells(&v)),
                     0);
    int lines = 0, within = 0;
    double sum = 0;
    for (int line = 0; line < REAL_CELLS; line += 4) {
        const double truth = coast_in_beam(&t, &v, line);
        const int drawn = drawn_coast(p.grey[line]);
        if (truth >= 0 && drawn >= 0 && !is_covered(p.grey[line], truth)) {
            lines++;
            within += fabs(drawn + 0.5 - truth) <= 3;
            sum += drawn + 0.5 - truth;
        }
    }
    print_message("# coast within three cells on %d of %d lines, mean difference %.2f cells\n",
                  within, lines, sum / lines);
    assert_true(lines >= 40);
    assert_true(within >= 0.9 * lines);
    /* Half of the pulse is 0.85 cells, and the beam has skirts that meet nearer land than the five
     * lines of its truth: 1.04 cells with symbols on the lines that they cover now. */
    assert_true(fabs(sum / lines) <= 1.25);
    terrain_free(&t);
}

/* The recorded track 110 s after the beginning of the piece that is flown: fixes of 9,600 and 9,620
 * s (nav_tracks/nice.csv.gz). */
TEST(a_real_flight_along_the_riviera_sees_coast_and_ridges_where_srtm_has_them)
{
    if (!riviera.is_here) {
        skip();
    }
    static const char *const name = "srtm_hgt/N43E007.hgt.zip";
    static struct real_picture p;
    struct terrain t;
    terrain_read(&t, &riviera, &name, 1);
    const struct view v = {{43.47396, 6.98116}, 43.0, 4025 * 0.3048, 37040};
    assert_int_equal(real_ground_map_read(&p, &riviera, "ground-map-20nm-110", height_cells(&v)),
                     0);
    const struct agreement a = compare(&t, &v, &p, NOISE_GREY, REAL_CELLS);
    assert_true(a.sea > 5000 && a.sea_dark >= 0.99 * a.sea);
    assert_true(a.land > 300 && a.land_bright >= 0.9 * a.land);
    terrain_free(&t);
}

static int make_scenes(void **state)
{
    (void)state;
    return real_scene_make(&island, "island", "dted1_hawaii/n20_w156_3arc_v2.dt1") ||
           real_scene_make(&riviera, "riviera", "srtm_hgt/N43E007.hgt.zip");
}

TEST_GROUP(make_scenes, NULL);
