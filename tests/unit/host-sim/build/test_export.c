/* Export and QGIS: the planes of an image as GDAL reads them back, against the rasters it was built
 * of, and the XML of styles and projects, parsed. That QGIS itself opens them was tried by hand
 * (docs/classifier.md): it is too large to be installed for a test. */
#include "check.h"
#include "scene.h"
#include "support.h"

#include "hs/error.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <gdal.h>
#include <geodesic.h>
#include <math.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 200 };
static const double west = 8.01, north = 47.19, step = 0.0003;

static double class_value(double x, double y)
{
    const int column = (int)floor((x - west) / step), row = (int)floor((north - y) / step);
    return (column / 7 + row / 5) % 6;
}

static double gamma_value(double x, double y)
{
    return class_value(x, y) - 20;
}

static double slope_m(double x, double y)
{
    return 300 + 1000 * (x - west) + 500 * (y - 47);
}

static void build_image(void)
{
    struct scene_raster r = scene_in_degrees(SIDE, west, north, step, GDT_Byte, class_value);
    r.has_nodata = true;
    r.nodata = 255;
    scene_write("classes.tif", &r);
    r = scene_in_degrees(SIDE, west, north, step, GDT_Float32, gamma_value);
    scene_write("gamma.tif", &r);
    r = scene_in_degrees(300, 8.0, 47.25, 0.001, GDT_Float32, slope_m);
    scene_write("terrain.tif", &r);
    scene_classes();
    assert_int_equal(scene_run("build --classes %s --class-raster %s --reflectivity %s --terrain "
                               "%s --land-class trees --out %s",
                               scene_path(SCENE_CLASSES), scene_path("classes.tif"),
                               scene_path("gamma.tif"), scene_path("terrain.tif"),
                               scene_path("a.lmdb")),
                     0);
}

/* A raster under the folder, and where its pixels lie. */
struct opened {
    GDALDatasetH file;
    GDALRasterBandH band;
    int width, height;
    double g[6];
};

static struct opened open_plane(const char *name)
{
    struct opened o = {.file = GDALOpen(scene_path(name), GA_ReadOnly)};
    assert_non_null(o.file);
    o.band = GDALGetRasterBand(o.file, 1);
    o.width = GDALGetRasterXSize(o.file);
    o.height = GDALGetRasterYSize(o.file);
    assert_int_equal(GDALGetGeoTransform(o.file, o.g), CE_None);
    assert_string_equal(OSRGetAuthorityCode(GDALGetSpatialRef(o.file), NULL), "4326");
    return o;
}

static float *read_plane(const struct opened *o)
{
    float *values = malloc((size_t)o->width * (size_t)o->height * sizeof *values);
    assert_non_null(values);
    assert_int_equal(GDALRasterIO(o->band, GF_Read, 0, 0, o->width, o->height, values, o->width,
                                  o->height, GDT_Float32, 0, 0),
                     CE_None);
    return values;
}

/* How many pixels inside the cover differ by more than `allowed` from a function of the place. */
static void compare_plane(const char *name, double (*truth)(double, double), double allowed,
                          long *inside, long *wrong)
{
    const struct opened o = open_plane(name);
    float *values = read_plane(&o);
    *inside = *wrong = 0;
    for (int i = 0; i < o.width * o.height; i++) {
        const double x = o.g[0] + o.g[1] * (i % o.width + 0.5);
        const double y = o.g[3] + o.g[5] * (i / o.width + 0.5);
        if (x > west + step && x < west + (SIDE - 1) * step && y < north - step &&
            y > north - (SIDE - 1) * step) {
            ++*inside;
            *wrong += !(fabs((double)values[i] - truth(x, y)) <= allowed);
        }
    }
    free(values);
    GDALClose(o.file);
}

TEST(gdal_reads_back_every_plane_as_it_was_built)
{
    long inside, wrong;
    build_image();
    assert_int_equal(scene_run("export %s --out %s", scene_path("a.lmdb"), scene_path("planes")),
                     0);
    compare_plane("planes/class.tif", class_value, 0, &inside, &wrong);
    assert_true(inside > 30000);
    /* A structure's facing is a class of its own that comes after the table's. */
    assert_true(wrong <= inside / 6 + inside / 50);
    compare_plane("planes/elevation.tif", slope_m, 1, &inside, &wrong);
    assert_in_range(wrong, 0, inside / 1000);
    struct opened o = open_plane("planes/reflectivity.tif");
    assert_string_equal(GDALGetRasterUnitType(o.band), "dB");
    assert_string_equal(GDALGetDescription(o.band), "reflectivity");
    const char *sensor = GDALGetMetadataItem(o.file, "LANDMASS_SENSOR", NULL);
    assert_non_null(sensor);
    assert_string_equal(sensor, "x");
    GDALClose(o.file);
    o = open_plane("planes/height.tif");
    assert_string_equal(GDALGetRasterUnitType(o.band), "m");
    GDALClose(o.file);
}

TEST(colours_and_names_of_the_classes_are_in_the_raster_and_its_style)
{
    static const char *const names[] = {"soil",      "asphalt", "concrete",
                                        "structure", "trees",   "water"};
    build_image();
    assert_int_equal(scene_run("export %s --out %s", scene_path("a.lmdb"), scene_path("planes")),
                     0);
    const struct opened o = open_plane("planes/class.tif");
    char **categories = GDALGetRasterCategoryNames(o.band);
    const GDALColorTableH colours = GDALGetRasterColorTable(o.band);
    CPLXMLNode *style = CPLParseXMLFile(scene_path("planes/class.qml"));
    assert_non_null(categories);
    assert_non_null(colours);
    assert_non_null(style);
    const CPLXMLNode *entry = CPLGetXMLNode(style, "=qgis.pipe.rasterrenderer.colorPalette");
    assert_non_null(entry);
    entry = entry->psChild;
    for (int i = 0; i < 6; i++, entry = entry->psNext) {
        const GDALColorEntry *c = GDALGetColorEntry(colours, i);
        char text[16];
        snprintf(text, sizeof text, "#%02x%02x%02x", c->c1, c->c2, c->c3);
        assert_string_equal(categories[i], names[i]);
        assert_non_null(entry);
        assert_string_equal(CPLGetXMLValue(entry, "label", ""), names[i]);
        assert_string_equal(CPLGetXMLValue(entry, "color", ""), text);
        assert_int_equal(atoi(CPLGetXMLValue(entry, "value", "")), i);
    }
    CPLDestroyXMLNode(style);
    GDALClose(o.file);
}

/* Every value of an overview of the classes is one that the full raster has there or beside. */
static void check_overview(const struct opened *o)
{
    const GDALRasterBandH overview = GDALGetOverview(o->band, 0);
    const int width = GDALGetRasterBandXSize(overview), height = GDALGetRasterBandYSize(overview);
    uint8_t *small = malloc((size_t)width * (size_t)height);
    float *whole = read_plane(o);
    assert_non_null(small);
    assert_int_equal(
        GDALRasterIO(overview, GF_Read, 0, 0, width, height, small, width, height, GDT_Byte, 0, 0),
        CE_None);
    const double across = (double)o->width / width, down = (double)o->height / height;
    long odd = 0;
    for (int i = 0; i < width * height; i++) {
        const int x = (int)(across * (i % width)), y = (int)(down * (i / width));
        bool is_there = false;
        for (int k = 0; k < 9; k++) {
            const int c = x + k % 3, r = y + k / 3;
            is_there =
                is_there || (c < o->width && r < o->height &&
                             (int)whole[(size_t)r * (size_t)o->width + (size_t)c] == small[i]);
        }
        odd += !is_there;
    }
    assert_int_equal(odd, 0);
    free(small);
    free(whole);
}

TEST(planes_are_cloud_optimised_with_overviews)
{
    static const char *const names[] = {"class", "reflectivity", "elevation", "height"};
    build_image();
    assert_int_equal(scene_run("export %s --out %s", scene_path("a.lmdb"), scene_path("planes")),
                     0);
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "planes/%s.tif", names[i]);
        const struct opened o = open_plane(name);
        const char *layout = GDALGetMetadataItem(o.file, "LAYOUT", "IMAGE_STRUCTURE");
        assert_true(layout && strcmp(layout, "COG") == 0);
        assert_true(o.width > 256 && GDALGetOverviewCount(o.band) > 0);
        if (i == 0) {
            check_overview(&o);
        }
        GDALClose(o.file);
    }
    assert_int_equal(
        support_run("ls %s | grep -E 'cog|tmp|~' && exit 1; exit 0", scene_path("planes")), 0);
}

/* Area between two parallels and two meridians by PROJ's geodesics; meridians are geodesics, and
 * the parallels are cut into many short ones. */
static double area_of_km2(const struct opened *o)
{
    struct geod_geodesic earth;
    struct geod_polygon outline;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    geod_polygon_init(&outline, 0);
    const double east = o->g[0] + o->width * o->g[1], south = o->g[3] + o->height * o->g[5];
    for (int i = 0; i <= 1000; i++) {
        geod_polygon_addpoint(&earth, &outline, south, o->g[0] + (east - o->g[0]) * i / 1000);
    }
    for (int i = 1000; i >= 0; i--) {
        geod_polygon_addpoint(&earth, &outline, o->g[3], o->g[0] + (east - o->g[0]) * i / 1000);
    }
    double area_m2;
    geod_polygon_compute(&earth, &outline, 0, 1, &area_m2, NULL);
    return area_m2 / 1e6;
}

TEST(the_attribute_table_has_names_colours_counts_and_areas)
{
    build_image();
    assert_int_equal(scene_run("export %s --out %s", scene_path("a.lmdb"), scene_path("planes")),
                     0);
    const struct opened o = open_plane("planes/class.tif");
    const GDALRasterAttributeTableH t = GDALGetDefaultRAT(o.band);
    char **categories = GDALGetRasterCategoryNames(o.band);
    assert_non_null(t);
    const int name = GDALRATGetColOfUsage(t, GFU_Name),
              count = GDALRATGetColOfUsage(t, GFU_PixelCount);
    const int red = GDALRATGetColOfUsage(t, GFU_Red);
    assert_true(name >= 0 && count >= 0 && red >= 0);
    assert_string_equal(GDALRATGetNameOfCol(t, count + 1), "Area_km2");
    float *values = read_plane(&o);
    double seen = 0, area_km2 = 0;
    for (int row = 0; row < GDALRATGetRowCount(t); row++) {
        long pixels = 0;
        for (int i = 0; i < o.width * o.height; i++) {
            pixels += (int)values[i] == row;
        }
        const GDALColorEntry *c = GDALGetColorEntry(GDALGetRasterColorTable(o.band), row);
        assert_string_equal(GDALRATGetValueAsString(t, row, name), categories[row]);
        assert_int_equal((long)GDALRATGetValueAsDouble(t, row, count), pixels);
        assert_int_equal(GDALRATGetValueAsInt(t, row, red), c->c1);
        seen += (double)pixels;
        area_km2 += GDALRATGetValueAsDouble(t, row, count + 1);
    }
    const double share = seen / ((double)o.width * o.height);
    assert_true(share > 0.3);
    /* Classes lie evenly enough that their share of the area is that of the pixels. */
    assert_true(fabs(area_km2 / (share * area_of_km2(&o)) - 1) < 1e-3);
    free(values);
    GDALClose(o.file);
}

/* Every layer of a project opens from the folder of the project. */
static int count_layers(const char *project, const char *folder)
{
    int count = 0;
    CPLXMLNode *xml = CPLParseXMLFile(project);
    assert_non_null(xml);
    assert_string_equal(
        CPLGetXMLValue(xml, "=qgis.properties.SpatialRefSys.ProjectionsEnabled", ""), "1");
    const CPLXMLNode *layers = CPLGetXMLNode(xml, "=qgis.projectlayers");
    assert_non_null(layers);
    for (const CPLXMLNode *l = layers->psChild; l; l = l->psNext, count++) {
        char path[1024];
        const char *source = CPLGetXMLValue(l, "datasource", "");
        snprintf(path, sizeof path, "%s%s%.*s", source[0] == '/' ? "" : folder,
                 source[0] == '/' ? "" : "/", (int)strcspn(source, "|"), source);
        GDALDatasetH file = GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_VECTOR, NULL, NULL, NULL);
        assert_non_null(file);
        GDALClose(file);
        assert_true(strlen(CPLGetXMLValue(l, "srs.spatialrefsys.wkt", "")) > 100);
    }
    CPLDestroyXMLNode(xml);
    return count;
}

TEST(a_project_of_the_planes_names_four_layers_that_open)
{
    build_image();
    assert_int_equal(scene_run("export %s --out %s", scene_path("a.lmdb"), scene_path("planes")),
                     0);
    assert_int_equal(count_layers(scene_path("planes/planes.qgs"), scene_path("planes")), 4);
}

TEST(an_export_that_cannot_be_says_why)
{
    build_image();
    assert_int_equal(
        scene_run("export %s --out %s --level 14", scene_path("a.lmdb"), scene_path("never")),
        HS_EXIT_FAILED);
    assert_true(scene_log_holds("the image ends at level"));
    assert_int_not_equal(access(scene_path("never/class.tif"), F_OK), 0);
}

/* ---- The project in which polygons are drawn ---- */

static int make_project(const char *image)
{
    return scene_run("qgis --image %s --class-raster %s --classes %s --out %s", scene_path(image),
                     scene_path("classes.tif"), scene_path(SCENE_CLASSES), scene_path("drawing"));
}

/* As QGIS would, when somebody draws a square. */
static void draw_square(const char *label)
{
    GDALDatasetH file = GDALOpenEx(scene_path("drawing/exemplars.gpkg"),
                                   GDAL_OF_VECTOR | GDAL_OF_UPDATE, NULL, NULL, NULL);
    assert_non_null(file);
    OGRLayerH layer = GDALDatasetGetLayerByName(file, "polygons");
    assert_non_null(layer);
    OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    char wkt[256], *text = wkt;
    snprintf(wkt, sizeof wkt, "POLYGON((%g %g,%g %g,%g %g,%g %g))", west, north, west + 0.01, north,
             west + 0.01, north - 0.01, west, north);
    OGRGeometryH g;
    assert_int_equal(OGR_G_CreateFromWkt(&text, NULL, &g), OGRERR_NONE);
    OGR_F_SetGeometryDirectly(feature, g);
    OGR_F_SetFieldString(feature, OGR_F_GetFieldIndex(feature, "class"), label);
    assert_int_equal(OGR_L_CreateFeature(layer, feature), OGRERR_NONE);
    OGR_F_Destroy(feature);
    GDALClose(file);
}

TEST(polygons_drawn_in_the_project_are_taken_as_exemplars_and_kept)
{
    build_image();
    assert_int_equal(make_project("gamma.tif"), 0);
    assert_int_equal(count_layers(scene_path("drawing/landmass.qgs"), scene_path("drawing")), 4);
    draw_square("soil");
    draw_square("ignore");
    draw_square("water");
    assert_int_equal(make_project("gamma.tif"), 0); /* Made again, it keeps what was drawn. */
    assert_int_equal(scene_run("correct --class-raster %s --classes %s --corrections %s --out %s",
                               scene_path("classes.tif"), scene_path(SCENE_CLASSES),
                               scene_path("drawing/exemplars.gpkg"), scene_path("fixed.tif")),
                     HS_EXIT_FAILED);
    assert_true(scene_log_holds("polygon 2 has the unknown class `ignore`"));
}

TEST(the_form_of_a_polygon_offers_each_class_and_ignore_and_nodata)
{
    static const char *const labels[] = {"soil",  "asphalt", "concrete", "structure",
                                         "trees", "water",   "nodata",   "ignore"};
    build_image();
    assert_int_equal(make_project("gamma.tif"), 0);
    CPLXMLNode *xml = CPLParseXMLFile(scene_path("drawing/landmass.qgs"));
    const CPLXMLNode *layer = CPLGetXMLNode(xml, "=qgis.projectlayers.maplayer");
    assert_non_null(layer);
    const CPLXMLNode *option =
        CPLGetXMLNode((CPLXMLNode *)layer, "fieldConfiguration.field.editWidget.config.Option");
    assert_non_null(option);
    option = CPLGetXMLNode((CPLXMLNode *)option, "Option");
    assert_non_null(option);
    int met = 0;
    for (const CPLXMLNode *o = option->psChild; o; o = o->psNext) {
        if (o->eType == CXT_Element) {
            assert_in_range(met, 0, 7);
            assert_string_equal(CPLGetXMLValue((CPLXMLNode *)o, "Option.value", ""), labels[met]);
            met++;
        }
    }
    assert_int_equal(met, 8);
    CPLDestroyXMLNode(xml);
}

TEST(an_image_without_a_place_is_refused)
{
    build_image();
    struct scene_raster r = scene_in_degrees(SIDE, 0, 0, 1, GDT_Byte, class_value);
    r.epsg = 0;
    scene_write("nowhere.tif", &r);
    assert_int_equal(support_run("gdal_translate -q -of PNM %s %s", scene_path("nowhere.tif"),
                                 scene_path("nowhere.pgm")),
                     0);
    assert_int_equal(support_run("rm -f %s.aux.xml", scene_path("nowhere.pgm")), 0);
    assert_int_equal(make_project("nowhere.pgm"), HS_EXIT_FAILED);
    assert_true(scene_log_holds("has no georeferencing"));
}

static int tidy(void **state)
{
    (void)state;
    return support_run("rm -rf %s", scene_folder());
}

TEST_GROUP(NULL, tidy);
