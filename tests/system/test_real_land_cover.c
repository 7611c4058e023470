/* Land cover of three makers, from their rasters to the glass: NLCD (Zion), CORINE (Guadeloupe) and
 * the Cropland Data Layer (Kansas). What each code should be is written down here again, and pixels
 * are read by GDAL and PROJ alone. */
#include "check.h"
#include "real_scene.h"
#include "support.h"

#include <gdal.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct expected {
    int code;
    const char *name;
};

static const struct expected nlcd[] = {{11, "water"},  {22, "suburb"},     {31, "rock"},
                                       {42, "forest"}, {52, "vegetation"}, {0, NULL}};
static const struct expected corine[] = {{2, "suburb"}, {3, "structure"}, {6, "asphalt"},
                                         {12, "crops"}, {23, "forest"},   {44, "water"},
                                         {0, NULL}};
static const struct expected cdl[] = {{5, "crops"},    {24, "soil"},        {111, "water"},
                                      {141, "forest"}, {176, "vegetation"}, {0, NULL}};

static struct cover {
    const char *scene, *file;
    const struct expected *codes;
    struct real_scene made;
    struct real_raster raster;
    double geotransform[6];
    OGRCoordinateTransformationH to_degrees, to_raster;
} covers[] = {
    {.scene = "zion", .file = "zion_nlcd_srtm/nlcd2011.tif", .codes = nlcd},
    {.scene = "guadeloupe",
     .file = "corine_guadeloupe/U2018_CLC2018_V2020_20u1_FR_GLP.tif",
     .codes = corine},
    {.scene = "kansas", .file = "cropland_kansas_cdl/2021_30m_cdls.tif", .codes = cdl},
};

enum { COVERS = sizeof covers / sizeof *covers };

static void read_cover(struct cover *c)
{
    char path[2048];
    snprintf(path, sizeof path, "%s%s", c->made.data, c->file);
    assert_int_equal(real_raster_read(&c->raster, path), 0);
    GDALDatasetH file = GDALOpen(path, GA_ReadOnly);
    OGRSpatialReferenceH crs = OSRClone(GDALGetSpatialRef(file)),
                         degrees = OSRNewSpatialReference(NULL);
    OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
    assert_int_equal(OSRImportFromEPSG(degrees, 4326), OGRERR_NONE);
    OSRSetAxisMappingStrategy(degrees, OAMS_TRADITIONAL_GIS_ORDER);
    GDALGetGeoTransform(file, c->geotransform);
    c->to_degrees = OCTNewCoordinateTransformation(crs, degrees);
    c->to_raster = OCTNewCoordinateTransformation(degrees, crs);
    assert_non_null(c->to_degrees);
    assert_non_null(c->to_raster);
    OSRDestroySpatialReference(crs);
    OSRDestroySpatialReference(degrees);
    GDALClose(file);
}

static int make_all(void **state)
{
    (void)state;
    GDALAllRegister();
    for (int i = 0; i < COVERS; i++) {
        struct cover *c = &covers[i];
        if (real_scene_make(&c->made, c->scene, c->file) != 0) {
            return -1;
        }
        if (c->made.is_here) {
            read_cover(c);
        }
    }
    return 0;
}

static int free_all(void **state)
{
    (void)state;
    for (int i = 0; i < COVERS; i++) {
        if (covers[i].made.is_here) {
            real_raster_free(&covers[i].raster);
            OCTDestroyCoordinateTransformation(covers[i].to_degrees);
            OCTDestroyCoordinateTransformation(covers[i].to_raster);
        }
    }
    return 0;
}

TEST_GROUP(make_all, free_all);

static double code_at(const struct cover *c, int x, int y)
{
    return x >= 0 && y >= 0 && x < c->raster.width && y < c->raster.height
               ? c->raster.values[(size_t)y * (size_t)c->raster.width + (size_t)x]
               : NAN;
}

/* Whether all pixels as far as `reach` have the same code: then it does not matter which of them is
 * the nearest to a cell. */
static bool is_even(const struct cover *c, int x, int y, int reach)
{
    for (int k = -reach; k <= reach; k++) {
        for (int i = -reach; i <= reach; i++) {
            if (!(code_at(c, x + i, y + k) == code_at(c, x, y))) {
                return false;
            }
        }
    }
    return true;
}

static const char *expected_name(const struct cover *c, double code)
{
    const struct expected *e = c->codes;
    while (e->name && e->code != code) {
        e++;
    }
    return e->name;
}

static struct real_place place_of(const struct cover *c, int x, int y)
{
    const double *t = c->geotransform;
    double east = t[0] + (x + 0.5) * t[1], north = t[3] + (y + 0.5) * t[5];
    assert_true(OCTTransform(c->to_degrees, 1, &east, &north, NULL));
    return (struct real_place){.latitude = north, .longitude = east};
}

TEST(the_image_has_the_class_of_each_code_where_the_land_cover_has_it)
{
    int covers_here = 0;
    for (int i = 0; i < COVERS; i++) {
        const struct cover *c = &covers[i];
        int compared = 0;
        for (int y = 3; c->made.is_here && y < c->raster.height; y += 23) {
            for (int x = 3; x < c->raster.width; x += 29) {
                char name[17];
                const char *expected = expected_name(c, code_at(c, x, y));
                if (expected && is_even(c, x, y, 1)) {
                    assert_string_equal(real_image_class(&c->made, place_of(c, x, y), name),
                                        expected);
                    compared++;
                }
            }
        }
        if (c->made.is_here) {
            printf("# %s: %d places have their class\n", c->scene, compared);
            assert_true(compared > 300);
            covers_here++;
        }
    }
    if (covers_here == 0) {
        skip();
    }
}

static bool log_holds(const struct cover *c, const char *text)
{
    return support_run("grep -q '%s' %s/log", text, c->made.folder) == 0;
}

/* Counts of gdalinfo -hist, which the notes beside the data give. */
TEST(what_is_counted_is_what_the_rasters_hold)
{
    if (covers[1].made.is_here) {
        assert_true(log_holds(&covers[1], "^code 0 *397856 pixels .* none "));
        assert_true(log_holds(&covers[1], "^code 23 *62482 pixels .* forest "));
        assert_true(log_holds(&covers[1], "^code 44 *455878 pixels .* water "));
    }
    if (covers[2].made.is_here) {
        assert_true(log_holds(&covers[2], "^code 5 *203274 pixels .* crops "));
        assert_true(log_holds(&covers[2], "^code 121 *28308 pixels .* asphalt "));
    }
    if (!covers[1].made.is_here && !covers[2].made.is_here) {
        skip();
    }
}

/* Milford Lake from the south: its water is dark, the fields around it are not. */
TEST(a_lake_is_dark_among_fields)
{
    const struct cover *c = &covers[2];
    static struct real_picture p;
    int water = 0, dark = 0, fields = 0, bright = 0;
    if (!c->made.is_here) {
        skip();
    }
    assert_int_equal(real_patch_read(&p, &c->made, "lake-look-000"), 0);
    const struct real_place centre = {39.21, -96.93};
    for (int line = 0; line < REAL_CELLS; line += 3) {
        for (int cell = 0; cell < REAL_CELLS; cell += 3) {
            struct real_place at = real_patch_place(centre, 0, 30, line, cell);
            double pixel[2] = {at.longitude, at.latitude};
            assert_true(OCTTransform(c->to_raster, 1, &pixel[0], &pixel[1], NULL));
            const int x = (int)floor((pixel[0] - c->geotransform[0]) / c->geotransform[1]),
                      y = (int)floor((pixel[1] - c->geotransform[3]) / c->geotransform[5]);
            const double code = code_at(c, x, y);
            const int grey = p.grey[line][cell];
            if (grey == REAL_NO_PIXEL || !is_even(c, x, y, 2)) {
                continue;
            }
            water += code == 111;
            dark += code == 111 && grey < 30;
            fields += code == 5 || code == 176;
            bright += (code == 5 || code == 176) && grey > 30;
        }
    }
    printf("# water %d, dark %d; fields %d, bright %d\n", water, dark, fields, bright);
    assert_true(water > 300 && fields > 300);
    assert_true(dark > 0.98 * water && bright > 0.98 * fields);
}
