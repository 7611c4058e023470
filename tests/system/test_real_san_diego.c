/* A visual database from its tiles and models to the glass: the pieces of the San Diego CDB. */
#include "check.h"
#include "real_scene.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct real_scene scene;

static int make(void **state)
{
    (void)state;
    return real_scene_make(&scene, "san_diego", "cdb_san_diego/GTModels");
}

TEST_GROUP(make, NULL);

static void need_scene(void)
{
    if (!scene.is_here) {
        skip();
    }
}

static void check_class(double latitude, double longitude, const char *wanted)
{
    char name[17];
    const char *found = real_image_class(&scene, (struct real_place){latitude, longitude}, name);
    if (strcmp(found, wanted) != 0) {
        fail_msg("%.4f %.4f is `%s`, not `%s`", latitude, longitude, found, wanted);
    }
}

/* The sea is put together from pictures with the sun's glint and without. */
TEST(the_sea_is_water_on_both_sides_of_the_edges_of_its_pictures)
{
    need_scene();
    for (int i = 0; i < 12; i++) {
        check_class(32.662, -117.213 + 0.004 * i, "water"); /* glint, dark, glint */
    }
    check_class(32.675, -117.138, "water"); /* the bay, glint and dark */
    check_class(32.682, -117.148, "water");
    check_class(32.716, -117.200, "water");
}

/* Points of the tables of N32W118_D100_S001_T001_L01_U1_R1, as ogrinfo prints them. */
TEST(buildings_stand_where_the_tables_have_them)
{
    need_scene();
    check_class(32.6760300311219, -117.17229073465, "structure");
    check_class(32.6719806430062, -117.163323414127, "structure");
    check_class(32.7181562653256, -117.172470413821, "structure");
}

TEST(airfields_are_concrete_and_the_town_is_suburb)
{
    need_scene();
    check_class(32.700, -117.207, "concrete");
    check_class(32.688, -117.180, "suburb");
}

/* The bridge crosses the patch: one bright place in each range, on a curve without gaps. */
TEST(the_bridge_is_a_bright_curve_over_black_water)
{
    static struct real_picture p;
    need_scene();
    assert_int_equal(real_patch_read(&p, &scene, "flight-bridge"), 0);
    int last = -1, rows = 0, jumps = 0;
    double bridge = 0, water = 0;
    for (int cell = 20; cell < 236; cell++) {
        int at = 0, cells = 0;
        double sum = 0;
        for (int line = 0; line < REAL_CELLS; line++) {
            at = p.grey[line][cell] > p.grey[at][cell] ? line : at;
            sum += p.grey[line][cell] == REAL_NO_PIXEL ? 0 : p.grey[line][cell];
            cells += p.grey[line][cell] != REAL_NO_PIXEL;
        }
        jumps += last >= 0 && abs(at - last) > 8;
        last = at;
        bridge += p.grey[at][cell];
        water += sum / cells;
        rows++;
    }
    print_message("# bridge %.0f, all %.0f of 255; %d jumps in %d ranges\n", bridge / rows,
                  water / rows, jumps, rows);
    assert_true(jumps < 6);
    assert_true(bridge / rows > 100 && water / rows < 25);
}
