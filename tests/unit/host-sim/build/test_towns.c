/* Towns in an image: the budget of their power against closed forms, and the facing of walls
 * against towns turned by known angles. */
#include "build/facing.h"
#include "build/towns.h"
#include "image/codes.h"
#include "image/grid.h"
#include "image/reader.h"

#include "check.h"
#include "scene.h"
#include "support.h"

#include <math.h>
#include <string.h>

enum { CELLS = LM_TILE_CELLS, FIELD = 0, TOWN = 1 };

static const double pi = 3.14159265358979323846;

/* ---- budget ---- */

struct ground {
    uint16_t cells[CELLS][CELLS];
    int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS];
    float built[CELLS][CELLS];
};

static struct lm_classes two_classes(void)
{
    struct lm_classes classes = {.height_dm = {0, 100, 400}};
    memcpy(classes.entry[FIELD].name, "field", 5);
    classes.entry[FIELD].gamma_db_q8 = -20 * 256;
    memcpy(classes.entry[TOWN].name, "town", 4);
    classes.entry[TOWN].kind = LM_KIND_STRUCTURE;
    classes.entry[TOWN].gamma_db_q8 = -3 * 256;
    return classes;
}

/* Every `period`-th row is a terrace of houses; the rest is field. */
static void make_terraces(struct ground *g, int period, uint8_t height)
{
    memset(g, 0, sizeof *g);
    for (int i = 0; i < CELLS * CELLS; i++) {
        const bool is_house = i / CELLS % period == period / 2;
        g->cells[i / CELLS][i % CELLS] = is_house ? image_cell(image_gamma_code(2), TOWN, height)
                                                  : image_cell(image_gamma_code(-80), FIELD, 0);
        g->built[i / CELLS][i % CELLS] = 1;
    }
}

static double gain_of(const struct ground *g, double north_m, double east_m)
{
    const struct lm_classes classes = two_classes();
    const struct build_towns_tile tile = {g->cells, g->posts_q6, g->built};
    struct build_towns towns = {.table_count = {0}};
    build_towns_add(&towns, 0, &tile, &classes, north_m, east_m);
    return build_towns_gain_db(&towns, 0);
}

/* Flat roofs everywhere: no walls, no edges. What is missing is what the reflectivity is off. */
TEST(a_town_without_heights_gains_what_its_cells_lack)
{
    struct ground g;
    make_terraces(&g, 1, 0);
    assert_true(fabs(gain_of(&g, 5, 5) + 3 + 2) < 1e-9);
}

/* Terraces 40 m high, 160 m apart, hide all between them: at a tangent of 0.15 shadows are 267 m
 * long. Looked at from south and north all rises are walls, at edges of 6 dB; from east and west
 * the houses' roofs are flat ground, and the line of sight runs along them. */
TEST(walls_that_hide_all_else_carry_all_of_the_power)
{
    struct ground g;
    make_terraces(&g, 16, 2);
    const double edge = pow(10, 0.6), gamma = pow(10, 0.2), roofs = 1.0 / 16;
    const double mean = (gamma * edge + gamma * roofs) / 2;
    assert_true(fabs(gain_of(&g, 10, 10) - (-3 - 10 * log10(mean))) < 0.1);
}

TEST(what_is_not_built_up_does_not_count)
{
    struct ground g;
    make_terraces(&g, 1, 0);
    for (int i = 0; i < CELLS * CELLS / 2; i++) {
        g.built[i / CELLS][i % CELLS] = 0;
        g.cells[i / CELLS][i % CELLS] = image_cell(image_gamma_code(30), TOWN, 0);
    }
    assert_true(fabs(gain_of(&g, 5, 5) + 5) < 1e-9);
    memset(g.built, 0, sizeof g.built);
    assert_true(gain_of(&g, 5, 5) == 0);
}

TEST(built_up_is_the_share_of_roofs_from_15_per_cent_on)
{
    const struct lm_classes classes = two_classes();
    struct ground g;
    make_terraces(&g, 4, 1);
    build_towns_mark((const uint16_t(*)[CELLS])g.cells, &classes, 5, g.built);
    assert_true(fabs((double)g.built[32][32] - 0.25) < 0.03 && (double)g.built[0][0] == 0.25);
    make_terraces(&g, 8, 1);
    build_towns_mark((const uint16_t(*)[CELLS])g.cells, &classes, 5, g.built);
    assert_true(g.built[32][32] == 0);
}

/* ---- facing ---- */

static struct lm_classes some_classes(int grounds, int structures)
{
    struct lm_classes classes = {.height_dm = {0}};
    for (int i = 0; i < grounds + structures; i++) {
        classes.entry[i].name[0] = (char)('a' + i);
        classes.entry[i].kind = i < grounds ? LM_KIND_GROUND : LM_KIND_STRUCTURE;
    }
    return classes;
}

TEST(there_are_as_many_facings_as_free_class_numbers)
{
    static const struct {
        int grounds, structures, facings;
    } cases[] = {{5, 1, 8},  {6, 1, 8}, {7, 1, 4}, {10, 1, 4}, {11, 1, 2},
                 {13, 1, 0}, {5, 2, 4}, {3, 0, 0}, {1, 4, 2}};
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        const int count = cases[n].grounds + cases[n].structures;
        struct lm_classes classes = some_classes(cases[n].grounds, cases[n].structures);
        struct build_facing f;
        const int used = build_facing_classes(&f, &classes, count);
        assert_int_equal(f.facings, cases[n].facings);
        assert_int_equal(used, count + cases[n].structures * cases[n].facings);
        for (int i = count; i < used; i++) {
            assert_int_equal(classes.entry[i].kind, LM_KIND_STRUCTURE);
            assert_in_range(classes.entry[i].facing, 1, LM_FACINGS);
        }
    }
}

static const double west = 8.0, north = 47.05, step_deg = 0.00005;
static double turned_deg; /* of the town */

/* Houses of 25 m by 20 m in streets 45 m and 40 m apart, turned clockwise from north. */
static double grid_town(double x, double y)
{
    const double east_m = (x - west) * 111320 * cos(47.0 * pi / 180);
    const double north_m = (y - north) * 111200;
    const double s = sin(turned_deg * pi / 180), c = cos(turned_deg * pi / 180);
    const double u = fabs(remainder(east_m * c - north_m * s, 45));
    const double v = fabs(remainder(east_m * s + north_m * c, 40));
    return u < 12.5 && v < 10 ? 3 : 0;
}

static double level_ground(double x, double y)
{
    (void)x;
    (void)y;
    return 100;
}

static void build_town(double degrees)
{
    turned_deg = degrees;
    const struct scene_raster classes =
        scene_in_degrees(320, west, north, step_deg, GDT_Byte, grid_town);
    const struct scene_raster terrain =
        scene_in_degrees(40, west - 0.005, north + 0.005, 0.001, GDT_Float32, level_ground);
    scene_write("town.tif", &classes);
    scene_write("flat.tif", &terrain);
    scene_classes();
    assert_int_equal(
        scene_run("build --classes %s --class-raster %s --terrain %s --land-class trees "
                  "--out %s",
                  scene_path(SCENE_CLASSES), scene_path("town.tif"), scene_path("flat.tif"),
                  scene_path("town.lmdb")),
        0);
}

/* Of the structures at the finest level: how many face a way, and the share of them within a step
 * of the town's. */
static void count_facings(double *faced, double *right)
{
    struct image image;
    int structures = 0, with = 0, near = 0;
    assert_int_equal(image_open(&image, scene_path("town.lmdb")), 0);
    const struct lm_band *band = &image.db.bands[0];
    assert_int_equal(band->lod, 0);
    for (uint32_t i = 0; i < band->rows * band->columns; i++) {
        const struct lm_tile *t = image_find_tile(&image, 0, band->row0 + i / band->columns,
                                                  band->column0 + i % band->columns);
        for (int k = 0; t && k < CELLS * CELLS; k++) {
            const uint8_t number = image_cell_class(image_tile_cell(t, k / CELLS, k % CELLS));
            const struct lm_class *c = &image.db.classes.entry[number];
            if (number != LM_DB_CLASS_NONE && c->kind == LM_KIND_STRUCTURE) {
                structures++;
                with += c->facing > 0;
                near += c->facing > 0 &&
                        fabs(remainder(11.25 * (c->facing - 1) - turned_deg, 90)) < 11.25;
            }
        }
    }
    image_close(&image);
    assert_true(structures > 1000);
    *faced = (double)with / structures;
    *right = (double)near / structures;
}

TEST(a_grid_town_faces_the_way_it_is_turned)
{
    static const double turned[] = {0, 7, 20, 33, 45, 58, 81};
    for (size_t i = 0; i < sizeof turned / sizeof turned[0]; i++) {
        double faced, right;
        build_town(turned[i]);
        count_facings(&faced, &right);
        print_message(
            "# turned by %2.0f degrees: %.0f %% of the structures face a way, %.0f %% the "
            "right one\n",
            turned[i], 100 * faced, 100 * right);
        assert_true(right > 0.9);
    }
}

static int tidy(void **state)
{
    (void)state;
    return support_run("rm -rf %s", scene_folder());
}

TEST_GROUP(NULL, tidy);
