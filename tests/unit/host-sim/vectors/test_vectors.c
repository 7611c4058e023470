/* `landmass-db vectors`: small files made here become classes, heights and detail, and each of
 * their elements is accounted for. */
#include "check.h"
#include "scene.h"
#include "support.h"

#include <gdal.h>
#include <math.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TABLES "host-sim/programs/db/classes/"

/* Indices of landcover.classes. */
enum { SOIL, ASPHALT, CONCRETE, STRUCTURE, VEGETATION, WATER, FOREST, NONE = 255 };

/* A degree is some 111 km north and 76 km east here. */
static const double south_deg = 47, west_deg = 8, metre_north = 1 / 111177.0,
                    metre_east = 1 / 76060.0;

/* ---- files of OpenStreetMap, written in metres from a corner ---- */

static char text[1 << 16];
static int next_node;

static void begin_osm(void)
{
    scene_folder();
    next_node = 1;
    strcpy(text,
           "<osm version=\"0.6\"><bounds minlat=\"47\" minlon=\"8\" maxlat=\"47.004\" "
           "maxlon=\"8.006\"/>\n");
}

static void add(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void add(const char *format, ...)
{
    const size_t used = strlen(text);
    va_list list;
    va_start(list, format);
    vsnprintf(text + used, sizeof text - used, format, list);
    va_end(list);
    assert_true(strlen(text) + 1 < sizeof text);
}

/* A node at metres east and north; its number. */
static int node(double east, double north)
{
    add("<node id=\"%d\" lat=\"%.7f\" lon=\"%.7f\"/>\n", next_node, south_deg + north * metre_north,
        west_deg + east * metre_east);
    return next_node++;
}

/* The four nodes of a rectangle, counter-clockwise from the south-west; the first one's number. */
static int corners(double east, double north, double width, double depth)
{
    const int first = node(east, north);
    node(east + width, north);
    node(east + width, north + depth);
    node(east, north + depth);
    return first;
}

static void way_of(int id, int first, int count, int closes, const char *tags)
{
    add("<way id=\"%d\">", id);
    for (int i = 0; i < count; i++) {
        add("<nd ref=\"%d\"/>", first + i);
    }
    if (closes) {
        add("<nd ref=\"%d\"/>", first);
    }
    add("%s</way>\n", tags);
}

#define TAG(k, v) "<tag k=\"" k "\" v=\"" v "\"/>"

static void rectangle(int id, double east, double north, double width, double depth,
                      const char *tags)
{
    way_of(id, corners(east, north, width, depth), 4, 1, tags);
}

static void line(int id, double east, double north, double to_east, double to_north,
                 const char *tags)
{
    const int first = node(east, north);
    node(to_east, to_north);
    way_of(id, first, 2, 0, tags);
}

static int run_on(const char *file, const char *options)
{
    return scene_run("vectors --vectors %s --rules " TABLES "osm.rules --classes " TABLES
                     "landcover.classes --out %s --heights %s --detail %s %s",
                     scene_path(file), scene_path("c.tif"), scene_path("h.tif"),
                     scene_path("d.txt"), options);
}

static int run_osm(const char *options)
{
    add("</osm>\n");
    scene_text("v.osm", text);
    return run_on("v.osm", options);
}

/* The pixel of a raster at metres from the corner. */
static double pixel(const char *name, double east, double north)
{
    GDALDatasetH file = GDALOpen(scene_path(name), GA_ReadOnly);
    assert_non_null(file);
    OGRSpatialReferenceH crs = OSRClone(GDALGetSpatialRef(file)),
                         wgs = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(wgs, 4326);
    OSRSetAxisMappingStrategy(wgs, OAMS_TRADITIONAL_GIS_ORDER);
    OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
    OGRCoordinateTransformationH way = OCTNewCoordinateTransformation(wgs, crs);
    double x = west_deg + east * metre_east, y = south_deg + north * metre_north, t[6], value;
    assert_true(OCTTransform(way, 1, &x, &y, NULL));
    GDALGetGeoTransform(file, t);
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(file, 1), GF_Read, (int)((x - t[0]) / t[1]),
                                  (int)((y - t[3]) / t[5]), 1, 1, &value, 1, 1, GDT_Float64, 0, 0),
                     CE_None);
    OCTDestroyCoordinateTransformation(way);
    OSRDestroySpatialReference(crs);
    OSRDestroySpatialReference(wgs);
    GDALClose(file);
    return value;
}

static int class_at(double east, double north)
{
    return (int)pixel("c.tif", east, north);
}

static double height_at(double east, double north)
{
    return pixel("h.tif", east, north);
}

/* A row of the table that the last run printed. */
static void expect_row(const char *name, int count)
{
    char row[128];
    snprintf(row, sizeof row, "    %-28s %10d", name, count);
    if (!scene_log_holds(row)) {
        support_run("cat %s/log", scene_folder());
        fail_msg("no row \"%s\"", row);
    }
}

/* ---- classes and heights ---- */

TEST(features_become_classes_and_heights_one_over_the_other)
{
    begin_osm();
    rectangle(1, 20, 20, 200, 150, TAG("landuse", "forest"));
    rectangle(2, 60, 60, 80, 60, TAG("natural", "water"));
    line(3, 0, 90, 300, 90, TAG("highway", "residential") TAG("width", "10"));
    rectangle(4, 100, 80, 20, 20, TAG("building", "yes") TAG("height", "12"));
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(class_at(30, 30), FOREST);
    assert_true(height_at(30, 30) == 12);
    assert_int_equal(class_at(70, 70), WATER);
    assert_true(height_at(70, 70) < 0);
    assert_int_equal(class_at(70, 90), ASPHALT);
    assert_int_equal(class_at(110, 90), STRUCTURE);
    assert_true(height_at(110, 90) == 12);
    assert_int_equal(class_at(260, 60), NONE);
}

TEST(heights_come_from_tags_in_their_order_and_else_from_the_rule)
{
    static const struct {
        const char *tags;
        double height_m;
    } houses[] = {{TAG("height", "7.5"), 7.5},
                  {TAG("height", "40 ft"), 12.192},
                  {TAG("height", "6'6&quot;"), 1.9812},
                  {TAG("height", "9 m") TAG("building:levels", "9"), 9},
                  {TAG("building:levels", "4"), 12},
                  {TAG("height", "high") TAG("building:levels", "2"), 6},
                  {TAG("height", "99999"), 8},
                  {"", 8}};
    enum { HOUSES = sizeof houses / sizeof *houses };
    begin_osm();
    for (int i = 0; i < HOUSES; i++) {
        char tags[160];
        snprintf(tags, sizeof tags, "%s%s", TAG("building", "yes"), houses[i].tags);
        rectangle(i + 1, 20 + 40 * i, 20, 20, 20, tags);
    }
    assert_int_equal(run_osm(""), 0);
    for (int i = 0; i < HOUSES; i++) {
        assert_true(fabs(height_at(30 + 40 * i, 30) - houses[i].height_m) < 1e-4);
    }
    expect_row("height", 4);
    expect_row("building:levels", 2);
    expect_row("no height, taken as 8 m", 2);
    expect_row("with a number that is none", 2);
}

TEST(parts_stand_for_the_building_that_holds_them)
{
    begin_osm();
    rectangle(1, 20, 20, 40, 40, TAG("building", "yes") TAG("height", "100"));
    rectangle(2, 20, 20, 40, 30, TAG("building:part", "yes") TAG("height", "10"));
    rectangle(3, 20, 50, 10, 10, TAG("building:part", "yes") TAG("height", "100"));
    rectangle(4, 100, 20, 40, 40, TAG("building", "yes") TAG("height", "30"));
    rectangle(5, 100, 20, 10, 10, TAG("building:part", "yes") TAG("height", "50"));
    assert_int_equal(run_osm(""), 0);
    assert_true(height_at(40, 30) == 10);
    assert_true(height_at(25, 55) == 100);
    assert_int_equal(class_at(50, 55), NONE);
    assert_true(height_at(130, 50) == 30); /* a quarter or less of it has parts */
    assert_true(height_at(105, 25) == 50);
    expect_row("drawn as their parts", 1);
}

/* ---- the coast ---- */

static void island(int first, int count, int is_turned)
{
    add("<way id=\"9\">");
    for (int i = 0; i <= count; i++) {
        const int k = is_turned ? count - i : i;
        add("<nd ref=\"%d\"/>", first + k % count);
    }
    add(TAG("natural", "coastline") "</way>\n");
}

TEST(land_lies_on_the_left_of_a_coast)
{
    for (int is_turned = 0; is_turned < 2; is_turned++) {
        begin_osm();
        island(corners(100, 100, 200, 150), 4, is_turned);
        assert_int_equal(run_osm(""), 0);
        assert_int_equal(class_at(200, 170), is_turned ? WATER : VEGETATION);
        assert_int_equal(class_at(102, 102), is_turned ? WATER : VEGETATION);
        assert_int_equal(class_at(20, 20), is_turned ? VEGETATION : WATER);
        assert_int_equal(class_at(98, 98), is_turned ? VEGETATION : WATER);
        assert_false(scene_log_holds("it is open"));
    }
}

/* Teeth finer than a cell, at every angle: each cell beside them is on the right side. */
TEST(a_ragged_coast_keeps_its_sides)
{
    enum { TEETH = 120 };
    begin_osm();
    const int first = next_node;
    for (int i = 0; i < TEETH; i++) {
        const double angle = 2 * 3.14159265358979 * i / TEETH, r = i % 2 ? 120 : 117;
        node(220 + r * cos(angle), 220 + r * sin(angle));
    }
    island(first, TEETH, 0);
    assert_int_equal(run_osm("--cell 4"), 0);
    for (int i = 0; i < 360; i++) {
        const double c = cos(i * 3.14159265358979 / 180), s = sin(i * 3.14159265358979 / 180);
        assert_int_equal(class_at(220 + 112 * c, 220 + 112 * s), VEGETATION);
        assert_int_equal(class_at(220 + 125 * c, 220 + 125 * s), WATER);
    }
    assert_int_equal(class_at(220, 220), VEGETATION);
    assert_int_equal(class_at(5, 5), WATER);
}

/* Capes sharper than a right angle: what lies before their tips is nearest to two lines at once, of
 * which only one tells the side. */
TEST(the_sea_before_a_sharp_cape_is_sea)
{
    enum { CAPES = 24 };
    const double turn = 2 * 3.14159265358979 / CAPES, half = 0.03;
    begin_osm();
    const int first = next_node;
    for (int i = 0; i < CAPES; i++) {
        node(220 + 100 * cos(i * turn - half), 220 + 100 * sin(i * turn - half));
        node(220 + 160 * cos(i * turn), 220 + 160 * sin(i * turn));
        node(220 + 100 * cos(i * turn + half), 220 + 100 * sin(i * turn + half));
    }
    island(first, 3 * CAPES, 0);
    assert_int_equal(run_osm(""), 0);
    for (int i = 0; i < CAPES; i++) {
        const double c = cos(i * turn), s = sin(i * turn);
        for (int side = -2; side <= 2; side++) {
            assert_int_equal(class_at(220 + 162.5 * c - side * s, 220 + 162.5 * s + side * c),
                             WATER);
        }
        assert_int_equal(class_at(220 + 110 * c, 220 + 110 * s), VEGETATION);
    }
    assert_false(scene_log_holds("it is open"));
}

TEST(an_open_coast_is_warned_of_with_its_length)
{
    begin_osm();
    line(9, 100, 200, 300, 200, TAG("natural", "coastline"));
    assert_int_equal(run_osm(""), 0);
    assert_true(scene_log_holds("it is open: "));
    assert_int_equal(class_at(200, 300), VEGETATION);
    assert_int_equal(class_at(200, 100), WATER);
}

/* ---- nothing is lost without a word ---- */

TEST(every_element_has_one_fate_and_losses_are_named)
{
    begin_osm();
    add("<node id=\"900\" lat=\"47.001\" lon=\"8.001\">" TAG("power", "tower") "</node>\n");
    add("<node id=\"901\" lat=\"47.001\" lon=\"8.001\">" TAG("amenity", "bench") "</node>\n");
    add("<node id=\"902\" lat=\"48.001\" lon=\"8.001\">" TAG("power", "tower") "</node>\n");
    rectangle(1, 20, 20, 20, 20, TAG("building", "yes"));
    add("<way id=\"1\">" TAG("building", "yes") "</way>\n");
    way_of(2, 777000, 4, 1, TAG("building", "yes"));                  /* no node is there */
    way_of(3, corners(60, 20, 20, 20), 4, 0, TAG("building", "yes")); /* not closed */
    line(4, 20, 90, 120, 90, TAG("highway", "footway"));
    line(5, 20, 95, 120, 95, TAG("route", "ferry"));
    line(6, 20, 98, 120, 98, "");
    line(7, 20, 80, 120, 80, TAG("waterway", "ditch") TAG("width", "0.5"));
    rectangle(8, 20, 100, 0, 20, TAG("building", "yes")); /* no width */
    add("<relation id=\"1\"><member type=\"way\" ref=\"555\" role=\"outer\"/>" TAG(
        "type", "multipolygon") TAG("natural", "water") "</relation>\n");
    add("<relation id=\"2\"><member type=\"way\" ref=\"6\" role=\"outer\"/>" TAG(
        "type", "multipolygon") TAG("natural", "water") "</relation>\n");
    add("<relation id=\"3\"><member type=\"node\" ref=\"900\" role=\"\"/>" TAG("type", "route")
            TAG("route", "bus") "</relation>\n");
    assert_int_equal(run_osm(""), 0);
    assert_true(scene_log_holds("23 nodes"));
    expect_row("without tags", 20);
    assert_true(scene_log_holds("9 ways"));
    expect_row("repeated", 1);
    expect_row("narrower than half a cell", 1);
    expect_row("outside the area", 1);
    assert_true(scene_log_holds("3 relations"));
    expect_row("lost: parts not in the file", 1); /* way 2, relation 1 */
    expect_row("lost: ring is open", 1);          /* way 3, relation 2 */
    expect_row("lost: nothing left of it", 1);    /* way 8 */
    assert_true(scene_log_holds("5 references lead to nodes that are not in the file"));
    assert_true(scene_log_holds("5 elements that a rule fits were lost"));
}

TEST(a_line_that_lacks_a_node_is_made_of_its_pieces)
{
    begin_osm();
    const int first = node(20, 50);
    node(60, 50);
    const int later = node(120, 50);
    node(160, 50);
    add("<way id=\"1\"><nd ref=\"%d\"/><nd ref=\"%d\"/><nd ref=\"99999\"/><nd ref=\"%d\"/>"
        "<nd ref=\"%d\"/>" TAG("highway", "primary") "</way>\n",
        first, first + 1, later, later + 1);
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(class_at(40, 50), ASPHALT);
    assert_int_equal(class_at(90, 50), NONE); /* nobody knows where it ran */
    assert_int_equal(class_at(140, 50), ASPHALT);
    assert_true(scene_log_holds("1 lines lack nodes"));
}

TEST(an_area_that_crosses_itself_is_repaired_and_counted)
{
    begin_osm();
    const int first = node(20, 20);
    node(80, 80);
    node(80, 20);
    node(20, 80);
    way_of(1, first, 4, 1, TAG("building", "yes"));
    assert_int_equal(run_osm(""), 0);
    assert_true(scene_log_holds("1 areas crossed themselves and were made valid"));
    assert_int_equal(class_at(30, 50), STRUCTURE);
    assert_int_equal(class_at(70, 50), STRUCTURE);
    assert_int_equal(class_at(50, 30), NONE);
}

TEST(elements_may_stand_in_any_order)
{
    begin_osm();
    add("<way id=\"1\"><nd ref=\"1\"/><nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"4\"/>"
        "<nd ref=\"1\"/>" TAG("natural", "water") "</way>\n");
    corners(20, 20, 50, 50);
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(class_at(40, 40), WATER);
    assert_true(scene_log_holds("1 elements stand out of order"));
}

/* ---- relations ---- */

/* A lake of two open ways with an island, then its two forms of tagging. */
static void lake(const char *tags_of_relation, const char *tags_of_way)
{
    begin_osm();
    const int first = corners(20, 20, 200, 100), hole = corners(80, 50, 40, 40);
    way_of(1, first, 3, 0, tags_of_way);
    add("<way id=\"2\"><nd ref=\"%d\"/><nd ref=\"%d\"/><nd ref=\"%d\"/></way>\n", first, first + 3,
        first + 2); /* the other way round */
    way_of(3, hole, 4, 1, "");
    add("<relation id=\"1\"><member type=\"way\" ref=\"1\" role=\"outer\"/>"
        "<member type=\"way\" ref=\"2\" role=\"outer\"/>"
        "<member type=\"way\" ref=\"3\" role=\"inner\"/>" TAG("type",
                                                              "multipolygon") "%s</relation>\n",
        tags_of_relation);
}

static void expect_lake(void)
{
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(class_at(40, 40), WATER);
    assert_int_equal(class_at(200, 100), WATER);
    assert_int_equal(class_at(100, 70), NONE);
}

TEST(rings_are_joined_of_ways_in_either_direction_and_islands_cut_out)
{
    lake(TAG("natural", "water"), "");
    expect_lake();
}

TEST(a_relation_without_tags_has_those_of_its_outer_way)
{
    lake("", TAG("natural", "water"));
    expect_lake();
    expect_row("in a relation", 1);
}

TEST(an_area_that_lacks_a_ring_is_made_of_the_others_and_counted)
{
    begin_osm();
    way_of(1, corners(20, 20, 50, 50), 4, 1, "");
    add("<relation id=\"1\"><member type=\"way\" ref=\"1\" role=\"outer\"/>"
        "<member type=\"way\" ref=\"77\" role=\"inner\"/>" TAG("type", "multipolygon")
            TAG("natural", "water") "</relation>\n");
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(class_at(40, 40), WATER);
    assert_true(scene_log_holds("1 areas lack a ring"));
}

/* ---- detail ---- */

struct item {
    char kind[16], word[16];
    double n[7];
};

/* Lines of the detail file that begin with `kind`. */
static int read_detail(const char *kind, struct item *items, int most)
{
    char row[256];
    int count = 0;
    FILE *file = fopen(scene_path("d.txt"), "r");
    assert_non_null(file);
    while (fgets(row, sizeof row, file)) {
        struct item i;
        memset(&i, 0, sizeof i);
        const int got = sscanf(row, "%15s %lf %lf %lf %lf %lf %lf %15s", i.kind, &i.n[0], &i.n[1],
                               &i.n[2], &i.n[3], &i.n[4], &i.n[5], i.word);
        if (got > 1 && strcmp(i.kind, kind) == 0) {
            assert_true(count < most);
            items[count++] = i;
        }
    }
    fclose(file);
    return count;
}

/* Four corners of a house around a middle, its length turned from north by east. */
static int turned_house(double east, double north, double length, double width, double turn_deg)
{
    static const double signs[4][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}};
    const double s = sin(turn_deg * 3.14159265358979 / 180),
                 c = cos(turn_deg * 3.14159265358979 / 180);
    const int first = next_node;
    for (int i = 0; i < 4; i++) {
        const double along = signs[i][0] * length / 2, across = signs[i][1] * width / 2;
        node(east + along * s + across * c, north + along * c - across * s);
    }
    return first;
}

TEST(a_house_is_a_box_with_its_place_sides_and_turn)
{
    struct item items[4];
    begin_osm();
    way_of(1, turned_house(150, 120, 24, 10, 33), 4, 1,
           TAG("building", "yes") TAG("height", "6") TAG("roof:shape", "gabled"));
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(read_detail("building", items, 4), 1);
    const double *n = items[0].n;
    assert_true(fabs((n[0] - south_deg) / metre_north - 120) < 0.3);
    assert_true(fabs((n[1] - west_deg) / metre_east - 150) < 0.3);
    assert_true(fabs(n[2] - 24) < 0.2 && fabs(n[3] - 10) < 0.2 && n[5] == 6);
    assert_true(fabs(remainder(n[4] - 33, 180)) < 0.5);
    assert_string_equal(items[0].word, "gabled");
}

TEST(an_l_shaped_house_is_two_boxes_of_its_area)
{
    struct item items[8];
    begin_osm();
    const int first = node(100, 100);
    node(130, 100);
    node(130, 110);
    node(112, 110);
    node(112, 130);
    node(100, 130);
    way_of(1, first, 6, 1, TAG("building", "yes") TAG("roof:shape", "gabled"));
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(read_detail("building", items, 8), 2);
    const double area = items[0].n[2] * items[0].n[3] + items[1].n[2] * items[1].n[3];
    assert_true(fabs(area - (300 + 240)) < 8);
    assert_string_equal(items[0].word, "flat"); /* no roof runs along both */
}

TEST(courts_stay_open)
{
    struct item items[24];
    double area = 0;
    begin_osm();
    way_of(1, corners(100, 100, 40, 40), 4, 1, "");
    way_of(2, corners(110, 110, 20, 20), 4, 1, "");
    add("<relation id=\"1\"><member type=\"way\" ref=\"1\" role=\"outer\"/>"
        "<member type=\"way\" ref=\"2\" role=\"inner\"/>" TAG("type", "multipolygon")
            TAG("building", "yes") "</relation>\n");
    assert_int_equal(run_osm(""), 0);
    const int count = read_detail("building", items, 24);
    for (int i = 0; i < count; i++) {
        area += items[i].n[2] * items[i].n[3];
    }
    assert_int_equal(count, 4);
    assert_true(fabs(area - 1200) < 10);
}

TEST(lines_walls_masts_and_bridges_become_detail)
{
    struct item items[8];
    begin_osm();
    rectangle(1, 0, 80, 400, 60, TAG("natural", "water"));
    line(2, 100, 60, 100, 160, TAG("highway", "primary") TAG("bridge", "yes") TAG("width", "9"));
    line(3, 20, 20, 80, 20, TAG("railway", "rail"));
    line(4, 20, 30, 80, 30, TAG("barrier", "wall") TAG("height", "3"));
    line(5, 20, 40, 80, 40, TAG("barrier", "fence"));
    line(6, 20, 50, 80, 50, TAG("power", "line"));
    line(7, 20, 55, 80, 55, TAG("railway", "rail") TAG("tunnel", "yes"));
    add("<node id=\"900\" lat=\"47.0005\" lon=\"8.001\">" TAG("power", "tower") "</node>\n");
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(class_at(100, 110), ASPHALT); /* over the water */
    assert_int_equal(class_at(110, 110), WATER);
    assert_int_equal(read_detail("wall", items, 8), 1);
    assert_true(items[0].n[4] == 3);
    assert_int_equal(read_detail("mast", items, 8), 1);
    assert_true(items[0].n[2] == 30);
    /* Rail, fence, wire, and two railings 9 m apart; none in the tunnel. */
    assert_int_equal(read_detail("line", items, 8), 5);
    assert_true(fabs(fabs(items[0].n[1] - items[1].n[1]) / metre_east - 9) < 0.1);
}

/* A runway of 300 m in a meadow: its strip, and ten pieces of verge on either side of it. */
TEST(runways_become_strips_with_verges)
{
    struct item items[24];
    begin_osm();
    rectangle(1, 0, 0, 400, 150, TAG("landuse", "meadow"));
    line(2, 50, 80, 350, 80, TAG("aeroway", "runway") TAG("width", "30"));
    line(3, 50, 20, 350, 20, TAG("highway", "service"));
    assert_int_equal(run_osm(""), 0);
    assert_int_equal(read_detail("surface", items, 24), 1);
    const double middle = (items[0].n[0] + items[0].n[2]) / 2;
    assert_true(items[0].n[4] == 30);
    assert_true(fabs(fabs(items[0].n[3] - items[0].n[1]) / metre_east - 300) < 0.5);
    assert_int_equal(read_detail("verge", items, 24), 20);
    for (int i = 0; i < 20; i++) {
        const double off = fabs((items[i].n[0] + items[i].n[2]) / 2 - middle) / metre_north;
        assert_true(fabs(off - (15 + items[i].n[4] / 2)) < 0.3);
        assert_true(fabs(fabs(items[i].n[3] - items[i].n[1]) / metre_east - 30) < 0.1);
    }
    assert_true(scene_log_holds("21 strips"));
}

static double level_value(double x, double y)
{
    (void)x, (void)y;
    return 100;
}

TEST(the_geopackage_holds_what_was_made)
{
    char options[512];
    begin_osm();
    rectangle(1, 100, 100, 30, 20, TAG("building", "yes") TAG("height", "14"));
    line(2, 20, 20, 200, 20, TAG("railway", "rail"));
    line(3, 20, 30, 200, 30, TAG("highway", "footway"));
    snprintf(options, sizeof options, "--package %s", scene_path("look.gpkg"));
    assert_int_equal(run_osm(options), 0);
    GDALDatasetH file = GDALOpenEx(scene_path("look.gpkg"), GDAL_OF_VECTOR, NULL, NULL, NULL);
    assert_non_null(file);
    assert_int_equal(GDALDatasetGetLayerCount(file), 3);
    OGRLayerH areas = GDALDatasetGetLayerByName(file, "areas");
    assert_int_equal(OGR_L_GetFeatureCount(areas, TRUE), 1);
    assert_int_equal(OGR_L_GetFeatureCount(GDALDatasetGetLayerByName(file, "lines"), TRUE), 1);
    OGRFeatureH house = OGR_L_GetNextFeature(areas);
    const OGRFeatureDefnH fields = OGR_L_GetLayerDefn(areas);
    assert_string_equal(OGR_F_GetFieldAsString(house, OGR_FD_GetFieldIndex(fields, "origin")),
                        "way 1");
    assert_string_equal(OGR_F_GetFieldAsString(house, OGR_FD_GetFieldIndex(fields, "class")),
                        "structure");
    assert_true(OGR_F_GetFieldAsDouble(house, OGR_FD_GetFieldIndex(fields, "height_m")) == 14);
    OGR_F_Destroy(house);
    GDALClose(file);
}

TEST(build_takes_what_vectors_makes)
{
    begin_osm();
    rectangle(1, 100, 100, 30, 20, TAG("building", "yes") TAG("height", "14"));
    line(2, 20, 20, 200, 20, TAG("railway", "rail"));
    assert_int_equal(run_osm(""), 0);
    const struct scene_raster terrain = {.width = 40,
                                         .height = 40,
                                         .geotransform = {7.99, 0.001, 0, 47.02, 0, -0.001},
                                         .epsg = 4326,
                                         .type = GDT_Float32,
                                         .value = level_value};
    scene_write("t.tif", &terrain);
    assert_int_equal(scene_run("build --classes " TABLES "landcover.classes --class-raster %s "
                               "--heights %s --detail %s --terrain %s --out %s",
                               scene_path("c.tif"), scene_path("h.tif"), scene_path("d.txt"),
                               scene_path("t.tif"), scene_path("v.lmdb")),
                     0);
    assert_true(scene_log_holds("detail 4 items"));
    assert_int_equal(scene_run("verify %s", scene_path("v.lmdb")), 0);
}

/* ---- ground under the vectors ---- */

static double ground_value(double x, double y)
{
    (void)y;
    return x < 8.003 ? 41 : 11;
}

TEST(vectors_are_burnt_over_a_land_cover)
{
    const struct scene_raster ground = {.width = 100,
                                        .height = 60,
                                        .geotransform = {7.999, 0.0001, 0, 47.005, 0, -0.0001},
                                        .epsg = 4326,
                                        .type = GDT_Byte,
                                        .value = ground_value};
    char options[512];
    begin_osm();
    scene_write("g.tif", &ground);
    rectangle(1, 50, 50, 30, 30, TAG("building", "yes"));
    snprintf(options, sizeof options, "--ground %s --map " TABLES "nlcd.map", scene_path("g.tif"));
    assert_int_equal(run_osm(options), 0);
    assert_int_equal(class_at(60, 60), STRUCTURE);
    assert_int_equal(class_at(100, 200), FOREST);
    assert_int_equal(class_at(400, 200), WATER);
}

/* The six classes of scene_classes() stand in another order than those of landcover.classes. */
TEST(a_class_raster_under_the_vectors_is_matched_by_its_names)
{
    char options[512];
    scene_classes();
    begin_osm();
    rectangle(1, 0, 0, 450, 440, TAG("natural", "water"));
    scene_text("g.rules", "[lake]\nfrom = area\nwhere = natural=water\nclass = water\n");
    add("</osm>\n");
    scene_text("v.osm", text);
    scene_text("turned.classes",
               "[water]\ncolour = 0 0 9\nkind = water\ngamma_db = -40\nspread_db = 3\n"
               "limits_db = -49 -31\n");
    assert_int_equal(scene_run("vectors --vectors %s --rules %s --classes %s --out %s",
                               scene_path("v.osm"), scene_path("g.rules"),
                               scene_path("turned.classes"), scene_path("g.tif")),
                     0); /* water is class 0 here, and soil in landcover.classes */
    begin_osm();
    rectangle(1, 50, 50, 30, 30, TAG("building", "yes"));
    snprintf(options, sizeof options, "--ground %s", scene_path("g.tif"));
    assert_int_equal(run_osm(options), 0);
    assert_int_equal(class_at(60, 60), STRUCTURE);
    assert_int_equal(class_at(200, 200), WATER);
}

/* ---- other formats ---- */

/* One town in four files: XML, and protocol buffers plain, packed, and with nodes one by one. */
TEST(protocol_buffers_hold_what_the_xml_does)
{
    static const char *const files[] = {"osm_xml/town.osm", "osm_pbf/plain.osm.pbf",
                                        "osm_pbf/packed.osm.pbf", "osm_pbf/nodes.osm.pbf"};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(scene_run("vectors --vectors tests/fuzz/corpus/%s --rules " TABLES
                                   "osm.rules --classes " TABLES "landcover.classes --out %s "
                                   "--heights %s --detail %s",
                                   files[i], scene_path("c.tif"), scene_path("h.tif"),
                                   scene_path("d.txt")),
                         0);
        struct item mast;
        assert_true(scene_log_holds("5 nodes"));
        assert_true(scene_log_holds("2 ways"));
        assert_true(scene_log_holds("1 relations"));
        assert_true(scene_log_holds("1 references lead to nodes that are not in the file"));
        assert_int_equal(class_at(100, 150), STRUCTURE);
        assert_true(height_at(100, 150) == 9);
        assert_int_equal(read_detail("mast", &mast, 1), 1);
        assert_true(fabs(mast.n[0] - 47.003) < 1e-6 && fabs(mast.n[1] - 8.004) < 1e-6);
        assert_true(mast.n[2] == 25);
    }
}

TEST(geojson_geopackage_and_shapefile_give_the_same_classes)
{
    static const char *const files[] = {"v.geojson", "v.gpkg", "v.shp"};
    scene_folder();
    begin_osm();
    scene_text("v.geojson",
               "{\"type\":\"FeatureCollection\",\"features\":["
               "{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\",\"height\":\"20\"},"
               "\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[8.001,47.001],[8.002,47.001],"
               "[8.002,47.002],[8.001,47.002],[8.001,47.001]]]}},"
               "{\"type\":\"Feature\",\"properties\":{\"building\":null,\"height\":null},"
               "\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[8.003,47.001],[8.004,47.001],"
               "[8.004,47.002],[8.003,47.001]]]}}]}");
    for (int i = 1; i < 3; i++) {
        assert_int_equal(
            support_run("ogr2ogr -overwrite %s %s", scene_path(files[i]), scene_path(files[0])), 0);
    }
    for (int i = 0; i < 3; i++) {
        assert_int_equal(run_on(files[i], "--area 47,8,47.004,8.006"), 0);
        assert_int_equal(class_at(100, 150), STRUCTURE);
        assert_true(height_at(100, 150) == 20);
        assert_int_equal(class_at(250, 130), NONE);
        assert_true(scene_log_holds("2 features"));
        expect_row("made", 1);
        expect_row("no rule fits", 1);
    }
}

/* Bytes of each format are damaged in turn: the program ends by itself, within its limits. */
TEST(damaged_files_of_libraries_end_in_an_error_or_a_map)
{
    static const char *const files[] = {"v.geojson", "v.gpkg", "v.shp"};
    for (int i = 0; i < 3; i++) {
        for (unsigned seed = 1; seed <= 12; seed++) {
            FILE *file = fopen(scene_path(files[i]), "rb");
            assert_non_null(file);
            static uint8_t bytes[1 << 20];
            const size_t size = fread(bytes, 1, sizeof bytes, file);
            fclose(file);
            unsigned random = seed * 2654435761u;
            for (int k = 0; k < 12; k++) {
                random = random * 1664525u + 1013904223u;
                bytes[(random >> 8) % size] = (uint8_t)random;
            }
            char name[32];
            snprintf(name, sizeof name, "damaged%s", strrchr(files[i], '.'));
            file = fopen(scene_path(name), "wb");
            assert_int_equal(fwrite(bytes, 1, size, file), size);
            fclose(file);
            const int status = support_run(
                "(ulimit -v 4000000; timeout -k 1 20 %s/bin/landmass-db vectors --vectors %s "
                "--rules " TABLES "osm.rules --classes " TABLES
                "landcover.classes --area "
                "47,8,47.004,8.006 --out %s) >%s/log 2>&1",
                support_build_dir(), scene_path(name), scene_path("damaged.tif"), scene_folder());
            assert_true(status == 0 || status == 1);
        }
    }
}

/* ---- refusals ---- */

TEST(what_cannot_be_imported_is_refused_with_a_reason)
{
    begin_osm();
    rectangle(1, 20, 20, 20, 20, TAG("building", "yes"));
    assert_int_equal(run_osm("--area 47,8"), 1);
    assert_true(scene_log_holds("is no area"));
    assert_int_equal(run_on("v.osm", "--area 48,8,47,9"), 1);
    assert_true(scene_log_holds("is no area between 84 S and 84 N"));
    assert_int_equal(run_on("v.osm", "--area 50,8,50.01,8.01"), 1);
    assert_true(scene_log_holds("no feature of the area fits a rule"));
    assert_int_equal(run_on("v.osm", "--area 40,8,49,16 --cell 0.5"), 1);
    assert_true(scene_log_holds("choose a smaller one with --area, or larger cells"));
    scene_text("v.osm", "<osm><node id=\"1\" lat=\"x\" lon=\"8\"/></osm>");
    assert_int_equal(run_on("v.osm", ""), 1);
    assert_true(scene_log_holds("v.osm:1: an element whose id or place is no number"));
    scene_text("v.osm", "<osm><node id=\"1\" lat=\"47\" lon=\"8\">");
    assert_int_equal(run_on("v.osm", ""), 1);
    assert_true(scene_log_holds("v.osm:1: no element found"));
    assert_int_equal(run_on("nosuch.osm.pbf", ""), 1);
    assert_true(scene_log_holds("cannot be read: No such file"));
}

TEST(rules_that_are_none_are_refused_with_their_line)
{
    static const struct {
        const char *rules, *said;
    } wrong[] = {
        {"from = area\n", "1: `from` stands before any rule"},
        {"[a]\nfrom = circle\n", "2: `circle` is none of the words"},
        {"[a]\nfrom = area\nfrom = line\n", "3: `from` is given twice"},
        {"[a]\nfrom = area\nwhere = x=\n", "3: a condition without a key or a value"},
        {"[a]\nfrom = area\nwhere = x\n", "rule [a] ends without `class`, `detail` or"},
        {"[a]\nfrom = line\nwhere = x\nclass = water\n", "without `width`"},
        {"[a]\nfrom = area\nwhere = x\nclass = lava\n", "4: there is no class `lava`"},
        {"[a]\nfrom = area\nwhere = x\nclass = water\nheight = tall\n", "one number, the last"},
        {"[a]\nfrom = area\nwhere = x\nclass = water\nheight = a y 3, 4\n", "none of a measure"},
        {"[a]\nfrom = area\nwhere = x\nclass = water\norder = 100\n", "`100` is no order"},
        {"[a]\nfrom = area\nwhere = x\nclass = structure\ndetail = building\n", "without `height`"},
        {"[a]\nfrom = line\nwhere = x\ndetail = coast\nclass = water\n", "which a coast needs"},
        {"[a]\nfrom = area\nwhere = x\nclass = water\n[a]\n", "5: rule [a] is here a second time"},
        {"# none\n", "holds no rule"},
    };
    begin_osm();
    rectangle(1, 20, 20, 20, 20, TAG("building", "yes"));
    assert_int_equal(run_osm(""), 0);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        scene_text("r.rules", wrong[i].rules);
        assert_int_equal(scene_run("vectors --vectors %s --rules %s --classes " TABLES
                                   "landcover.classes --out %s",
                                   scene_path("v.osm"), scene_path("r.rules"), scene_path("c.tif")),
                         1);
        if (!scene_log_holds(wrong[i].said)) {
            support_run("cat %s/log", scene_folder());
            fail_msg("not said: %s", wrong[i].said);
        }
    }
}
