/* Landsat 5 bands in seven files, polygons and SRTM of a drowned valley in the Amazon forest, in
 * UTM 22 north with negative northings, from the data to pictures. The polygons are read by OGR and
 * brought to the pictures by PROJ. */
#include "check.h"
#include "real_scene.h"

#include <gdal.h>
#include <math.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POLYGONS_MAX = 64, QUARTERS = 4 };

static const struct real_place centre = {-3.7525, -49.886};

/* The aircraft while the ground map's last sweep was drawn: 3.5 s at 150 m/s from where it started.
 */

struct polygon {
    char name[32];
    OGRGeometryH shape; /* in UTM 22 north */
    OGREnvelope box;
    double grey_sum[QUARTERS], grey_count[QUARTERS]; /* by look */
};

static struct real_scene scene;
static struct polygon polygons[POLYGONS_MAX];
static int polygon_count;
static OGRCoordinateTransformationH to_utm, from_utm;

/* Coordinate systems with longitude and easting first. */
static OGRSpatialReferenceH reference(int epsg)
{
    OGRSpatialReferenceH r = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(r, epsg);
    OSRSetAxisMappingStrategy(r, OAMS_TRADITIONAL_GIS_ORDER);
    return r;
}

static void read_polygons(void)
{
    char path[2048], line[16384], *wkt;
    snprintf(path, sizeof path,
             "%slandsat5_amazon_tucurui_srtm_labels/derived/trainingPolygons_lsat.tsv", scene.data);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) && polygon_count < POLYGONS_MAX) {
        struct polygon *p = &polygons[polygon_count];
        memset(p, 0, sizeof *p);
        wkt = strstr(line, "POLYGON");
        if (wkt && sscanf(line, "%*d %31s", p->name) == 1 &&
            OGR_G_CreateFromWkt(&wkt, NULL, &p->shape) == OGRERR_NONE) {
            OGR_G_GetEnvelope(p->shape, &p->box);
            polygon_count++;
        }
    }
    fclose(file);
    assert_true(polygon_count == 36);
}

/* The polygon that holds the place, or NULL. */
static struct polygon *polygon_at(struct real_place place)
{
    double x = place.longitude, y = place.latitude;
    struct polygon *found = NULL;
    OCTTransform(to_utm, 1, &x, &y, NULL);
    OGRGeometryH point = OGR_G_CreateGeometry(wkbPoint);
    OGR_G_SetPoint_2D(point, 0, x, y);
    for (int i = 0; i < polygon_count && !found; i++) {
        const OGREnvelope *b = &polygons[i].box;
        if (x > b->MinX && x < b->MaxX && y > b->MinY && y < b->MaxY &&
            OGR_G_Contains(polygons[i].shape, point)) {
            found = &polygons[i];
        }
    }
    OGR_G_DestroyGeometry(point);
    return found;
}

static void look_at_patch(int quarter)
{
    static const char *const names[QUARTERS] = {"patch-look-000", "patch-look-090",
                                                "patch-look-180", "patch-look-270"};
    static struct real_picture picture;
    assert_int_equal(real_patch_read(&picture, &scene, names[quarter]), 0);
    for (int line = 0; line < REAL_CELLS; line++) {
        for (int cell = 0; cell < REAL_CELLS; cell++) {
            struct polygon *p = polygon_at(real_patch_place(centre, 90 * quarter, 30, line, cell));
            if (p) {
                p->grey_sum[quarter] += picture.grey[line][cell];
                p->grey_count[quarter]++;
            }
        }
    }
}

static int is_water(const struct polygon *p)
{
    return strcmp(p->name, "water") == 0;
}

static int is_forest(const struct polygon *p)
{
    return strcmp(p->name, "forest") == 0;
}

/* A forest may lie behind a ridge from one side: it is judged by all four together. */
TEST(each_water_polygon_is_dark_from_four_sides_and_each_forest_polygon_bright)
{
    if (!scene.is_here) {
        skip();
    }
    int waters = 0, forests = 0;
    for (int i = 0; i < polygon_count; i++) {
        const struct polygon *p = &polygons[i];
        double sum = 0, count = 0, brightest = 0;
        for (int quarter = 0; quarter < QUARTERS; quarter++) {
            sum += p->grey_sum[quarter];
            count += p->grey_count[quarter];
            brightest = fmax(brightest, p->grey_sum[quarter] / fmax(1, p->grey_count[quarter]));
        }
        if (count < 4 * 10) {
            continue;
        }
        print_message("# polygon %d, %s: grey %.1f, at most %.1f\n", i + 1, p->name, sum / count,
                      brightest);
        waters += is_water(p);
        forests += is_forest(p);
        assert_true(!is_water(p) || brightest < 20);
        assert_true(!is_forest(p) || sum / count > 60);
    }
    assert_true(waters >= 5 && forests >= 5);
}

/* Northings below zero, a projection's position: the firmware's own look-up of the polygon's middle
 * finds its class. */
TEST(the_middle_of_each_polygon_has_its_class_in_the_flash_image)
{
    if (!scene.is_here) {
        skip();
    }
    static const struct {
        const char *label, *name;
    } names[] = {{"forest", "forest"},
                 {"water", "water"},
                 {"cleared", "cleared"},
                 {"fallen_dry", "dry-bank"}};
    int right = 0, water_right = 0, waters = 0;
    for (int i = 0; i < polygon_count; i++) {
        char name[17];
        OGRGeometryH middle = OGR_G_PointOnSurface(polygons[i].shape);
        double x = OGR_G_GetX(middle, 0), y = OGR_G_GetY(middle, 0);
        assert_true(y < 0);
        OCTTransform(from_utm, 1, &x, &y, NULL);
        OGR_G_DestroyGeometry(middle);
        real_image_class(&scene, (struct real_place){y, x}, name);
        int is_right = 0;
        for (int n = 0; n < 4; n++) {
            is_right |=
                strcmp(polygons[i].name, names[n].label) == 0 && strcmp(name, names[n].name) == 0;
        }
        right += is_right;
        waters += is_water(&polygons[i]);
        water_right += is_water(&polygons[i]) && is_right;
    }
    print_message("# right in %d of %d polygons\n", right, polygon_count);
    assert_int_equal(water_right, waters);
    assert_true(right >= polygon_count - 1);
}

static int make_scene(void **state)
{
    (void)state;
    if (real_scene_make(&scene, "reservoir",
                        "landsat5_amazon_tucurui_srtm_labels/derived/lsat_7band.bsq") != 0) {
        return -1;
    }
    if (!scene.is_here) {
        return 0;
    }
    GDALAllRegister();
    OGRSpatialReferenceH degrees = reference(4326), utm = reference(32622);
    to_utm = OCTNewCoordinateTransformation(degrees, utm);
    from_utm = OCTNewCoordinateTransformation(utm, degrees);
    OSRDestroySpatialReference(degrees);
    OSRDestroySpatialReference(utm);
    read_polygons();
    for (int quarter = 0; quarter < QUARTERS; quarter++) {
        look_at_patch(quarter);
    }
    return 0;
}

static int forget_scene(void **state)
{
    (void)state;
    for (int i = 0; i < polygon_count; i++) {
        OGR_G_DestroyGeometry(polygons[i].shape);
    }
    OCTDestroyCoordinateTransformation(to_utm);
    OCTDestroyCoordinateTransformation(from_utm);
    return 0;
}

TEST_GROUP(make_scene, forget_scene);
