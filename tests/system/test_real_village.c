/* Sentinel-2 image, polygons and SRTM of a mining village in the Amazon forest, from the data to
 * patches from four sides. What a patch should show where is asked of the class raster, by GDAL and
 * PROJ's geodesics. */
#include "check.h"
#include "real_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* As in host-sim/gallery/village.classes; NONE lies outside the raster. */
enum { FOREST, VILLAGE, WATER, MUD, NONE };

/* What lies in shadow has the floor of the patch alone, mostly below this. */
enum { DARK = 24, CELL_M = 10 };

static const struct real_place centre = {-1.46935, -56.3626};
static struct real_scene scene;

struct patch {
    double look_deg, cell_m;
    struct real_picture picture;
    int class_of[REAL_CELLS][REAL_CELLS];
};

static void patch_read(struct patch *p, const char *name, double look_deg, double cell_m)
{
    char path[2048];
    struct real_raster classes;
    p->look_deg = look_deg;
    p->cell_m = cell_m;
    snprintf(path, sizeof path, "%s/classes.tif", scene.folder);
    assert_int_equal(real_raster_read(&classes, path), 0);
    assert_int_equal(real_patch_read(&p->picture, &scene, name), 0);
    for (int line = 0; line < REAL_CELLS; line++) {
        for (int cell = 0; cell < REAL_CELLS; cell++) {
            const struct real_place place = real_patch_place(centre, look_deg, cell_m, line, cell);
            const double value = real_raster_nearest(&classes, place.longitude, place.latitude);
            p->class_of[line][cell] = isnan(value) ? NONE : (int)value;
        }
    }
    real_raster_free(&classes);
}

static int class_at(const struct patch *p, int line, int cell)
{
    const int is_inside = line >= 0 && line < REAL_CELLS && cell >= 0 && cell < REAL_CELLS;
    return is_inside ? p->class_of[line][cell] : NONE;
}

/* The four patches from the commanded place, and three from passes 8 km off. */
static struct patch *patch_number(int n)
{
    static const struct {
        const char *name;
        double look_deg, cell_m;
    } table[] = {
        {"patch-look-000", 0, CELL_M},   {"patch-look-090", 90, CELL_M},
        {"patch-look-180", 180, CELL_M}, {"patch-look-270", 270, CELL_M},
        {"flight-from-west", 90.24, 8},  {"flight-from-north", 180.48, 8},
        {"flight-from-east", 269.29, 8},
    };
    static struct patch patch;
    patch_read(&patch, table[n].name, table[n].look_deg, table[n].cell_m);
    return &patch;
}

enum { PATCHES = 7, COMMANDED = 4 };

/* Of the class's cells that are not in shadow; of all of the water's. */
static double mean_grey(const struct patch *p, int class_index)
{
    double sum = 0, count = 0;
    for (int line = 0; line < REAL_CELLS; line++) {
        for (int cell = 0; cell < REAL_CELLS; cell++) {
            const int is_lit = p->picture.grey[line][cell] > DARK || class_index == WATER;
            if (p->class_of[line][cell] == class_index && is_lit) {
                sum += p->picture.grey[line][cell];
                count++;
            }
        }
    }
    return count > 0 ? sum / count : 0;
}

/* The village by a fifth of the forest's grey, nearly 4 dB: seen off the way that its houses
 * face, it returns by its roofs and corners alone. Water has at most a quarter of it (0.250 was
 * seen), and a hundredth by which another training of the network may move that. */
TEST(water_is_dark_forest_grey_and_the_village_bright_from_every_side)
{
    if (!scene.is_here) {
        skip();
    }
    for (int n = 0; n < PATCHES; n++) {
        const struct patch *p = patch_number(n);
        const double water = mean_grey(p, WATER), forest = mean_grey(p, FOREST),
                     village = mean_grey(p, VILLAGE);
        print_message("# patch %d: grey of water %.1f, forest %.1f, village %.1f\n", n, water,
                      forest, village);
        assert_true(water < forest * 0.26);
        assert_true(forest * 1.2 < village);
    }
}

/* Of the dark cells on low ground, those that have forest within `reach` cells in the direction
 * (across, along). */
static double with_forest(const struct patch *p, int across, int along, int reach)
{
    double dark = 0, found = 0;
    for (int line = reach; line < REAL_CELLS - reach; line++) {
        for (int cell = reach; cell < REAL_CELLS - reach; cell++) {
            const int is_low = p->class_of[line][cell] == VILLAGE || p->class_of[line][cell] == MUD;
            if (!is_low || p->picture.grey[line][cell] > DARK) {
                continue;
            }
            int is_found = 0;
            for (int i = 1; i <= reach && !is_found; i++) {
                is_found = class_at(p, line + across * i, cell + along * i) == FOREST;
            }
            dark++;
            found += is_found;
        }
    }
    return dark > 0 ? found / dark : 0;
}

/* Canopy of 18 m throws 90 m of shadow at 11 degrees and 100 m in flight. */
TEST(shadow_lies_behind_the_forest_that_casts_it_whichever_way_the_radar_looks)
{
    if (!scene.is_here) {
        skip();
    }
    for (int n = 0; n < PATCHES; n++) {
        const struct patch *p = patch_number(n);
        const int reach = (int)(100 / p->cell_m);
        const double before = with_forest(p, 0, -1, reach), behind = with_forest(p, 0, 1, reach);
        const double left = with_forest(p, -1, 0, reach), right = with_forest(p, 1, 0, reach);
        print_message("# patch %d: forest before %.2f, behind %.2f, left %.2f, right %.2f\n", n,
                      before, behind, left, right);
        assert_true(before > 0.8);
        assert_true(behind < before - 0.15 && left < before - 0.15 && right < before - 0.15);
    }
}

/* The brightest of a cell and its two neighbours on the line: the image's cells are not the
 * raster's pixels, and an edge may lie one cell off. */
static int brightest(const struct patch *p, int line, int cell)
{
    int grey = 0;
    for (int c = cell - 1; c <= cell + 1; c++) {
        if (c >= 0 && c < REAL_CELLS && p->picture.grey[line][c] > grey) {
            grey = p->picture.grey[line][c];
        }
    }
    return grey;
}

/* Mean of that over the forest cells that have for 100 m nearer (along = -1) or farther (1) only
 * open ground, or only forest: wide enough that no other forest's shadow lies on them. */
static double edge_grey(const struct patch *p, int along, int is_open_wanted)
{
    const int reach = (int)(100 / p->cell_m);
    double sum = 0, count = 0;
    for (int line = 0; line < REAL_CELLS; line++) {
        for (int cell = 0; cell < REAL_CELLS; cell++) {
            int is_edge = p->class_of[line][cell] == FOREST;
            for (int i = 1; i <= reach && is_edge; i++) {
                const int next = class_at(p, line, cell + along * i);
                is_edge = is_open_wanted ? next == WATER || next == MUD : next == FOREST;
            }
            sum += is_edge ? brightest(p, line, cell) : 0;
            count += is_edge;
        }
    }
    assert_true(count > 10);
    return sum / count;
}

TEST(forest_edges_that_face_the_radar_are_bright_and_those_behind_are_not)
{
    if (!scene.is_here) {
        skip();
    }
    for (int n = 0; n < PATCHES; n++) {
        const struct patch *p = patch_number(n);
        const double inside = edge_grey(p, -1, 0), front = edge_grey(p, -1, 1),
                     back = edge_grey(p, 1, 1);
        print_message("# patch %d: grey of forest %.1f, its front %.1f, its back %.1f\n", n, inside,
                      front, back);
        assert_true(front > inside * 1.15);
        assert_true(back < inside);
    }
}

/* The cell of a patch that looks in a multiple of 90 degrees which covers the cell (east, north) of
 * a patch that looks north. */
static int grey_north_up(const struct patch *p, int quarter, int east, int north)
{
    const int last = REAL_CELLS - 1;
    const int line[] = {east, last - north, last - east, north};
    const int cell[] = {north, east, last - north, last - east};
    return p->picture.grey[line[quarter]][cell[quarter]];
}

/* Turned to north and added, the four patches lie on the class raster: their shadows cancel.
 * Correlation with a mask of what is bright, at shifts of up to three cells. */
TEST(turned_to_north_the_four_patches_lie_on_each_other_and_on_the_image)
{
    if (!scene.is_here) {
        skip();
    }
    static double sum[REAL_CELLS][REAL_CELLS];
    static int mask[REAL_CELLS][REAL_CELLS];
    for (int quarter = 0; quarter < COMMANDED; quarter++) {
        const struct patch *p = patch_number(quarter);
        for (int east = 0; east < REAL_CELLS; east++) {
            for (int north = 0; north < REAL_CELLS; north++) {
                sum[east][north] =
                    (quarter ? sum[east][north] : 0) + grey_north_up(p, quarter, east, north);
                if (quarter == 0) {
                    mask[east][north] = p->class_of[east][north];
                }
            }
        }
    }
    double best = -1;
    int best_east = 99, best_north = 99;
    for (int de = -3; de <= 3; de++) {
        for (int dn = -3; dn <= 3; dn++) {
            double bright = 0, dark = 0, brights = 0, darks = 0;
            for (int east = 8; east < REAL_CELLS - 8; east++) {
                for (int north = 8; north < REAL_CELLS - 8; north++) {
                    const int class_index = mask[east + de][north + dn];
                    const int is_bright = class_index == FOREST || class_index == VILLAGE;
                    const int is_dark = class_index == WATER || class_index == MUD;
                    bright += is_bright ? sum[east][north] : 0;
                    brights += is_bright;
                    dark += is_dark ? sum[east][north] : 0;
                    darks += is_dark;
                }
            }
            const double contrast = bright / brights - dark / darks;
            if (contrast > best) {
                best = contrast;
                best_east = de;
                best_north = dn;
            }
        }
    }
    print_message("# best contrast %.1f at a shift of %d east, %d north\n", best, best_east,
                  best_north);
    assert_in_range(best_east + 3, 2, 4);
    assert_in_range(best_north + 3, 2, 4);
}

static int make_scene(void **state)
{
    (void)state;
    return real_scene_make(
        &scene, "village",
        "sentinel2_amazon_village_srtm_labels/derived/sen2_12band_refl_x10000.bsq");
}

TEST_GROUP(make_scene, NULL);
