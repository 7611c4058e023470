/* Parked targets from their models to the glass: baked, listed, built into the image, flown, and
 * looked at from four sides. Where a target and its shadow should lie follows from its place in the
 * list, its size and the depression alone. */
#include "check.h"
#include "real_scene.h"

#include <geodesic.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* host-sim/gallery/airfield.script. */
static const double range_m = 12000, height_m = 3000, cell_m = 0.5;
static const struct real_place centre = {42.0021055, -27};
static struct real_scene scene;

static const double pi = 3.14159265358979323846;

/* Shadow is black; an apron of -28 dB seldom is. */
enum { LOOKS = 4, TARGETS_MAX = 32 };

struct parked {
    char kind[17];
    double heading_deg;
    struct real_place place;
};

static struct parked parked[TARGETS_MAX];
static int parked_count;
static struct real_picture pictures[LOOKS];

static int read_list(void)
{
    char line[256], kind[17];
    FILE *in = fopen("host-sim/gallery/airfield.targets", "r");
    if (!in) {
        return -1;
    }
    while (fgets(line, sizeof line, in) && parked_count < TARGETS_MAX) {
        struct parked *p = &parked[parked_count];
        if (sscanf(line, "target %*s %lf %lf ground %lf signature %16s", &p->place.latitude,
                   &p->place.longitude, &p->heading_deg, kind) == 4) {
            strcpy(p->kind, kind);
            parked_count++;
        }
    }
    fclose(in);
    return parked_count == 13 ? 0 : -1;
}

static int make_scene(void **state)
{
    (void)state;
    if (read_list() != 0 || real_scene_make(&scene, "airfield", NULL) != 0) {
        return -1;
    }
    for (int i = 0; i < LOOKS; i++) {
        char name[32];
        snprintf(name, sizeof name, "patch-look-%03d", 90 * i);
        if (real_patch_read(&pictures[i], &scene, name) != 0) {
            return -1;
        }
    }
    return 0;
}

/* Where a target lies in a patch: its line and cell, fractions included. */
static void find(const struct parked *p, int look, double *line, double *cell)
{
    struct geod_geodesic earth;
    double metres, azimuth;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    geod_inverse(&earth, centre.latitude, centre.longitude, p->place.latitude, p->place.longitude,
                 &metres, &azimuth, NULL);
    const double off = (azimuth - 90.0 * look) * pi / 180;
    *line = REAL_CELLS / 2 + metres * sin(off) / cell_m;
    *cell = REAL_CELLS / 2 + metres * cos(off) / cell_m;
}

/* A rectangle about a target, metres to the right and away from the radar. */
struct area {
    double left, right, near, far;
};

struct measure {
    double mean;
    int brightest, cells;
};

static struct measure measure(const struct parked *p, int look, struct area a)
{
    double line, cell, sum = 0;
    struct measure m = {0};
    find(p, look, &line, &cell);
    for (int x = (int)ceil(line + a.left / cell_m - 0.5); x + 0.5 <= line + a.right / cell_m; x++) {
        for (int y = (int)ceil(cell + a.near / cell_m - 0.5); y + 0.5 <= cell + a.far / cell_m;
             y++) {
            const bool is_in = x >= 0 && x < REAL_CELLS && y >= 0 && y < REAL_CELLS;
            const int grey = is_in ? pictures[look].grey[x][y] : REAL_NO_PIXEL;
            if (grey != REAL_NO_PIXEL) {
                sum += grey;
                m.brightest = grey > m.brightest ? grey : m.brightest;
                m.cells++;
            }
        }
    }
    m.mean = m.cells > 0 ? sum / m.cells : 0;
    return m;
}

static bool is_a(const struct parked *p, const char *kind)
{
    return strcmp(p->kind, kind) == 0;
}

/* The open apron between aircraft and vehicles, about the third aircraft: nothing stands there. */
static struct measure apron(int look)
{
    static const struct area south_of_it[LOOKS] = {
        {-8, 8, -22, -14}, {14, 22, -8, 8}, {-8, 8, 14, 22}, {-22, -14, -8, 8}};
    return measure(&parked[2], look, south_of_it[look]);
}

TEST(what_is_parked_shines_where_it_stands)
{
    for (int look = 0; look < LOOKS; look++) {
        for (int i = 0; i < parked_count; i++) {
            const struct area body = {-3, 3, -3, 3};
            assert_true(measure(&parked[i], look, body).brightest > apron(look).brightest);
        }
    }
}

/* 5 to 9 m behind the middle of a vehicle lies shadow, and none so far in front, where the two
 * sides along the row have nobody else's. */
TEST(vehicles_throw_their_shadow_away_from_the_radar)
{
    for (int look = 0; look < LOOKS; look++) {
        const double open = apron(look).mean;
        for (int i = 0; i < parked_count; i++) {
            const struct area behind = {-1, 1, 5, 9}, before = {-1, 1, -9, -5};
            if (is_a(&parked[i], "tank") || is_a(&parked[i], "lorry")) {
                assert_true(measure(&parked[i], look, behind).mean < 0.6 * open);
                assert_true(look % 2 == 1 || measure(&parked[i], look, before).mean > 0.4 * open);
            }
        }
    }
}

/* Metres from a target's middle to the end of the shadow behind `from_m`. */
static double shadow_end_m(const struct parked *p, int look, double from_m)
{
    double end = from_m;
    while (measure(p, look, (struct area){-4, 4, end, end + 1}).mean < 0.7 * apron(look).mean) {
        end += 0.5;
    }
    return end + 0.5;
}

/* Seen from behind, a shelter 30 m long and 8 m high; its chip is that of 15 degrees. */
TEST(a_shelters_shadow_is_as_long_as_its_height_says)
{
    const double depression = atan(height_m / range_m) * 180 / pi;
    int shelters = 0;
    assert_true(fabs(depression - 15) < 3.5);
    for (int i = 0; i < parked_count; i++) {
        if (is_a(&parked[i], "shelter")) {
            const double end = shadow_end_m(&parked[i], 2, 20);
            assert_true(fabs(end - 15 - 8 / tan(15 * pi / 180)) < 1.5);
            shelters++;
        }
    }
    assert_int_equal(shelters, 3);
}

TEST(what_stands_square_to_the_radar_flashes)
{
    for (int look = 0; look < LOOKS; look++) {
        double square = 0, aslant = 0;
        for (int i = 0; i < parked_count; i++) {
            const struct area body = {-4, 4, -4, 4};
            if (is_a(&parked[i], "lorry")) {
                const bool is_square = fmod(parked[i].heading_deg, 90) == 0;
                double *most = is_square ? &square : &aslant;
                *most = fmax(*most, measure(&parked[i], look, body).brightest);
            }
        }
        print_message("# look %d: square %.0f, aslant %.0f\n", look, square, aslant);
        assert_true(square > 1.2 * aslant); /* the flash is cut off at white, 255 */
    }
}

/* Four aircraft with the same heading are the same from each side, and another picture from the
 * next: their flanks brighter than their noses. */
TEST(an_aircraft_changes_with_the_side_alone)
{
    const struct area body = {-3, 3, -3, 3};
    double mean[LOOKS];
    for (int look = 0; look < LOOKS; look++) {
        mean[look] = measure(&parked[0], look, body).mean;
        for (int i = 1; i < 4; i++) {
            assert_true(is_a(&parked[i], "aircraft") && parked[i].heading_deg == 180);
            assert_true(fabs(measure(&parked[i], look, body).mean / mean[look] - 1) < 0.08);
        }
    }
    assert_true(mean[1] > 1.2 * mean[0] && mean[3] > 1.2 * mean[0]);
    assert_true(fabs(mean[1] / mean[3] - 1) < 0.05); /* it is symmetric */
    assert_true(fabs(mean[2] / mean[0] - 1) > 0.1);
}

TEST_GROUP(make_scene, NULL);
