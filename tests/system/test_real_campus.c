/* Aerial colours and 48 bands of a university, segmented. What the classifier reaches is measured
 * in tests/bench; here: the hole of the mosaic stays a hole, and both pictures show the same place.
 */
#include "check.h"
#include "real_scene.h"

#include <stdio.h>
#include <stdlib.h>

#include <gdal.h>

/* As in host-sim/programs/db/classes/heaton6.classes. */
enum { SOIL, ASPHALT, CONCRETE, STRUCTURE, VEGETATION, WATER };

enum { SIDE = 512, COARSE = 4, COARSE_SIDE = SIDE / COARSE };

static struct real_scene scene;

static void read_band(const char *folder, const char *name, int band, int side, uint8_t *values)
{
    char path[2048];
    snprintf(path, sizeof path, "%s%s", folder, name);
    GDALAllRegister();
    GDALDatasetH file = GDALOpen(path, GA_ReadOnly);
    assert_non_null(file);
    assert_int_equal(GDALGetRasterXSize(file), side);
    assert_int_equal(GDALGetRasterYSize(file), side);
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(file, band), GF_Read, 0, 0, side, side, values,
                                  side, side, GDT_Byte, 0, 0),
                     CE_None);
    GDALClose(file);
}

static void read_classes(const char *name, int side, uint8_t *values)
{
    char folder[1100];
    snprintf(folder, sizeof folder, "%s/", scene.folder);
    read_band(folder, name, 1, side, values);
}

TEST(the_hole_of_the_mosaic_has_no_class_and_all_else_has_one)
{
    if (!scene.is_here) {
        skip();
    }
    static uint8_t colour[3][SIDE * SIDE], classes[SIDE * SIDE];
    for (int band = 0; band < 3; band++) {
        read_band(scene.data, "houston2018_rgb_hs_labels/derived/rgb_512.ppm", band + 1, SIDE,
                  colour[band]);
    }
    read_classes("rgb-classes.tif", SIDE, classes);
    int holes = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int is_black = !colour[0][i] && !colour[1][i] && !colour[2][i];
        assert_int_equal(is_black, classes[i] == 255);
        assert_true(is_black || classes[i] <= WATER);
        holes += is_black;
    }
    assert_int_equal(holes, 5065);
}

/* The class that the labels' numbers stand for, as in host-sim/gallery/campus.map; -1 where it
 * names none. */
static int class_of_label(int label)
{
    static const int classes[] = {-1,       VEGETATION, VEGETATION, -1,      -1, STRUCTURE, ASPHALT,
                                  CONCRETE, -1,         ASPHALT,    ASPHALT, -1, STRUCTURE};
    return label < 13 ? classes[label] : -1;
}

/* Part of the labelled pixels of a class that a class raster gives to it; one pixel of it is `step`
 * labels wide. */
static double part_right(const uint8_t *classes, const uint8_t *labels, int step, int wanted)
{
    double right = 0, count = 0;
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const int found = classes[(y / step) * (SIDE / step) + x / step];
            if (class_of_label(labels[y * SIDE + x]) == wanted && found != 255) {
                right += found == wanted;
                count++;
            }
        }
    }
    return right / count;
}

/* Far below what the classifier reaches, far above what a shifted, turned or mislabelled raster
 * could. */
TEST(in_colours_and_in_48_bands_each_class_lies_on_its_labels)
{
    if (!scene.is_here) {
        skip();
    }
    static uint8_t labels[SIDE * SIDE], fine[SIDE * SIDE], coarse[COARSE_SIDE * COARSE_SIDE];
    static const int wanted[] = {ASPHALT, CONCRETE, STRUCTURE, VEGETATION};
    read_band(scene.data, "houston2018_rgb_hs_labels/derived/labels_512.pgm", 1, SIDE, labels);
    read_classes("rgb-classes.tif", SIDE, fine);
    read_classes("hs48-classes.tif", COARSE_SIDE, coarse);
    for (int i = 0; i < 4; i++) {
        const double colours = part_right(fine, labels, 1, wanted[i]),
                     bands = part_right(coarse, labels, COARSE, wanted[i]);
        print_message("# class %d: %.2f of its labels in colours, %.2f in 48 bands\n", wanted[i],
                      colours, bands);
        assert_true(colours > 0.5);
        assert_true(bands > 0.5);
    }
}

static int make_scene(void **state)
{
    (void)state;
    return real_scene_make(&scene, "campus", "houston2018_rgb_hs_labels/derived/rgb_512.ppm");
}

TEST_GROUP(make_scene, NULL);
