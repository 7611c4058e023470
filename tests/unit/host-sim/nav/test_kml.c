/* KML and KMZ: tracks with times, lines without, and what their altitudes are measured from. */
#include "check.h"
#include "read_text.h"
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

#define KML(body)                                                                                  \
    "<?xml version='1.0'?><kml xmlns='http://www.opengis.net/kml/2.2' "                            \
    "xmlns:gx='http://www.google.com/kml/ext/2.2'><Document><Placemark>" body                      \
    "</Placemark></Document></kml>"
#define ABSOLUTE "<altitudeMode>absolute</altitudeMode>"
#define LINE(mode, places)                                                                         \
    "<LineString>" mode "<coordinates>\n " places "\n</coordinates></LineString>"
#define WHEN(second)  "<when>\n 2020-01-01T00:00:" second "Z\n</when>"
#define COORD(places) "<gx:coord>" places "</gx:coord>"

static struct result read_kml(const char *text)
{
    return read_as(NAV_FORMAT_KML, false, text);
}

/* All times first and times and places in turn are both in use. */
TEST(a_track_pairs_its_times_places_and_angles_by_their_order)
{
    static const char *const texts[] = {
        KML("<gx:Track>" ABSOLUTE WHEN("00") WHEN("01") WHEN("02.5") COORD("7.1 43.1 500")
                COORD("7.2 43.2 600") COORD("-7.3 -43.3 700") "<gx:angles>350 2 -15</gx:angles>"
                                                              "<gx:angles/></gx:Track>"),
        KML("<Track>" WHEN("00") COORD("7.1 43.1 500") "<angles>350 2 -15</angles>" WHEN("01")
                COORD(" 7.2  43.2 600 ") WHEN("02.5") COORD("-7.3 -43.3 700") ABSOLUTE "</Track>")};
    for (int i = 0; i < 2; i++) {
        struct result r = read_kml(texts[i]);
        const struct nav_fix *f = r.track.fix;
        assert_int_equal(r.status, 0);
        assert_int_equal(r.track.count, 3);
        assert_true(f[0].time_us == INT64_C(1577836800000000));
        assert_true(f[2].time_us - f[0].time_us == 2500000);
        assert_near(f[1].latitude_deg, 43.2, 1e-12);
        assert_near(f[2].longitude_deg, -7.3, 1e-12);
        assert_near(f[2].height_m, 700, 0);
        assert_near(f[0].heading_deg, -10, 1e-12);
        assert_near(f[0].pitch_deg, 2, 0);
        assert_near(f[0].roll_deg, -15, 0);
        assert_true(isnan(f[1].roll_deg) && f[0].starts_leg && !f[1].starts_leg);
        assert_int_equal(r.track.datum, NAV_DATUM_SEA_LEVEL);
        nav_track_free(&r.track);
    }
}

TEST(each_track_begins_a_leg_and_an_empty_place_is_no_fix)
{
    struct result r = read_kml(
        KML("<gx:MultiTrack><gx:Track>" WHEN("00") WHEN("01") WHEN("02")
                COORD("7 43 0") "<gx:coord/>" COORD("7 43.1 0") "</gx:Track><gx:Track>" WHEN("03")
                    WHEN("04") COORD("7 43.2 0") COORD("7 43.3 0") "</gx:Track></gx:MultiTrack>"));
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 4);
    assert_int_equal(r.reading.missing, 1);
    assert_true(r.track.fix[0].starts_leg && !r.track.fix[1].starts_leg);
    assert_true(r.track.fix[2].starts_leg && !r.track.fix[3].starts_leg);
    nav_track_free(&r.track);
}

/* The mode of a model inside a track is the model's own. */
TEST(only_absolute_altitudes_are_above_sea_level)
{
    static const struct {
        const char *mode;
        bool is_kept;
    } modes[] = {{ABSOLUTE, true},
                 {"", false},
                 {"<altitudeMode>clampToGround</altitudeMode>", false},
                 {"<altitudeMode>relativeToGround</altitudeMode>", false},
                 {"<gx:altitudeMode>relativeToSeaFloor</gx:altitudeMode>", false},
                 {"<Model>" ABSOLUTE "</Model>", false}};
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        char text[1024];
        snprintf(text, sizeof text, KML("<gx:Track>%s" WHEN("00") COORD("7 43 500") "</gx:Track>"),
                 modes[i].mode);
        struct result r = read_kml(text);
        assert_int_equal(r.track.count, 1);
        assert_true(isnan(r.track.fix[0].height_m) != modes[i].is_kept);
        nav_track_free(&r.track);
        r = read_with((struct nav_reading){.name = "test", .is_datum_given = true}, NAV_FORMAT_KML,
                      text);
        assert_near(r.track.fix[0].height_m, 500, 0);
        nav_track_free(&r.track);
    }
}

TEST(a_line_is_a_route_and_has_no_times)
{
    static const char line[] = KML(LINE(ABSOLUTE, "7.1,46,2000 7.2,46.1 \t7.3,46.2,1e3") LINE(
        "", "1,1 2,2") "<Polygon><outerBoundaryIs><LinearRing><coordinates>5,5 6,6 7,7 "
                       "5,5</coordinates></LinearRing></outerBoundaryIs></Polygon>");
    struct result r = read_route(NAV_FORMAT_KML, line);
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 3); /* of the first line alone */
    assert_near(r.track.fix[1].latitude_deg, 46.1, 1e-12);
    assert_near(r.track.fix[2].longitude_deg, 7.3, 1e-12);
    assert_near(r.track.fix[2].height_m, 1000, 0);
    assert_true(isnan(r.track.fix[1].height_m));
    assert_int_equal(r.track.datum, NAV_DATUM_SEA_LEVEL);
    nav_track_free(&r.track);
    r = read_kml(line);
    assert_int_equal(r.status, -1);
    r = read_route(NAV_FORMAT_KML, KML("<gx:Track>" COORD("7 46 0") COORD("7 47 0")
                                           WHEN("00") "</gx:Track>" LINE("", "1,1 2,2")));
    assert_int_equal(r.track.count, 2);
    assert_near(r.track.fix[1].latitude_deg, 47, 1e-12);
    nav_track_free(&r.track);
}

TEST(bad_points_are_counted_and_bad_files_refused)
{
    static const char *const bad[] = {"7.1,x",      "7.1",    "7.1,91,0", "7.1,,43",
                                      "7.1,43,5,6", "7.1;43", "400,43,0", "7.1,43,1e9"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[1024];
        snprintf(text, sizeof text, KML(LINE(ABSOLUTE, "7,43,0 %s 7,44,0")), bad[i]);
        struct result r = read_route(NAV_FORMAT_KML, text);
        assert_int_equal(r.status, 0);
        assert_int_equal(r.reading.malformed, 1);
        assert_int_equal(r.track.count, 2);
        nav_track_free(&r.track);
    }
    static const char *const refused[] = {
        KML(""),
        KML("<gx:Track/>"),
        "<kml><Document>",
        KML("<gx:Track>" WHEN("00") WHEN("01") COORD("7 43 0") "</gx:Track>"),
        KML("<gx:Track><when>2020</when>" COORD("7 43 0") "</gx:Track>"),
        "<!DOCTYPE kml [<!ENTITY a '7 43 0'>]>" KML("<gx:Track>" WHEN("00")
                                                        COORD("&a;") "</gx:Track>"),
        "PK\3\4 and nothing more"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        struct result r = read_kml(refused[i]);
        assert_int_equal(r.status, -1);
        assert_int_equal(r.track.count, 0);
        nav_track_free(&r.track);
    }
}

static const char *path_of(const char *name)
{
    static char path[300];
    snprintf(path, sizeof path, "%s/tmp/%s", support_build_dir(), name);
    return path;
}

static void add_file(zip_t *archive, const char *name, const char *bytes, size_t size)
{
    zip_source_t *source = zip_source_buffer(archive, bytes, size, 0);
    assert_non_null(source);
    assert_true(zip_file_add(archive, name, source, 0) >= 0);
}

/* An archive of two files, of which the one called `name` is the KML. */
static struct result read_archive(const char *name, const char *kml, size_t size)
{
    remove(path_of("track.kmz"));
    zip_t *archive = zip_open(path_of("track.kmz"), ZIP_CREATE, NULL);
    assert_non_null(archive);
    add_file(archive, "images/a.png", "no picture", 10);
    add_file(archive, name, kml, size);
    assert_int_equal(zip_close(archive), 0);
    return read_file((struct nav_reading){0}, path_of("track.kmz"));
}

TEST(a_kmz_is_its_kml_and_a_bomb_is_refused)
{
    static const char kml[] = KML("<gx:Track>" WHEN("00") COORD("7 43 0") "</gx:Track>");
    struct result r = read_archive("doc.kml", kml, sizeof kml - 1);
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 1);
    nav_track_free(&r.track);
    r = read_archive("files/Flight.KML", kml, sizeof kml - 1);
    assert_int_equal(r.track.count, 1);
    nav_track_free(&r.track);
    assert_int_equal(read_archive("doc.txt", kml, sizeof kml - 1).status, -1);
    const size_t size = (size_t)300 << 20;
    char *blanks = calloc(1, size);
    assert_non_null(blanks);
    memset(blanks, ' ', size);
    assert_int_equal(read_archive("doc.kml", blanks, size).status, -1);
    free(blanks);
}

/* GDAL's writer of KML is not ours: a line from it comes back as it went in. */
#define MARK(second, point)                                                                        \
    "<Placemark><TimeStamp>" WHEN(second) "</TimeStamp><Point>" point "</Point></Placemark>"
#define AT(place) "<coordinates> " place " </coordinates>"

TEST(placemarks_with_a_time_and_a_point_are_flown_in_the_order_of_their_times)
{
    static const char text[] =
        "<kml><Document>" MARK("02", ABSOLUTE AT("7.2,43.2,600")) MARK(
            "00", AT("7,43,500") ABSOLUTE) "<Placemark><Point>" AT("9,9,9") "</Point></Placemark>"
        "<Placemark><TimeStamp>" WHEN("09") "</TimeStamp></Placemark>"
        MARK("01", AT("7.1,43.1,0")) MARK("02", AT("8,44")) MARK("03", AT("x"))
        "<Placemark><TimeStamp><when>2020</when></TimeStamp><Point>" AT("1,1")
        "</Point></Placemark></Document></kml>";
    struct result r = read_kml(text);
    const struct nav_fix *f = r.track.fix;
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 3);
    assert_true(f[0].time_us == INT64_C(1577836800000000) && f[0].starts_leg && !f[2].starts_leg);
    assert_near(f[0].height_m, 500, 0);
    assert_true(isnan(f[1].height_m));
    assert_near(f[1].longitude_deg, 7.1, 1e-12);
    assert_near(f[2].latitude_deg, 43.2, 1e-12);
    assert_int_equal(r.reading.malformed, 2);
    assert_int_equal(r.reading.disordered, 1);
    nav_track_free(&r.track);
}

TEST(beside_a_track_placemarks_are_its_places_of_interest)
{
    struct result r = read_kml("<kml><Document>" MARK(
        "02", AT("7.2,43.2,600")) "<Placemark>"
                                  "<gx:Track xmlns:gx='x'>" WHEN("00")
                                      COORD("7 43 0") "</gx:Track></Placemark></Document></kml>");
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 1);
    assert_near(r.track.fix[0].longitude_deg, 7, 1e-12);
    nav_track_free(&r.track);
}

TEST(points_that_gdal_wrote_with_their_times_are_read_back)
{
    static const char csv[] =
        "WKT,timestamp,altitudeMode\n"
        "\"POINT Z (7.25 43.75 1500)\",2020/01/01 00:00:05,absolute\n"
        "\"POINT Z (7.125 43.5 1000)\",2020/01/01 00:00:02,absolute\n";
    FILE *out = fopen(path_of("marks.csv"), "w");
    assert_non_null(out);
    fputs(csv, out);
    fclose(out);
    assert_int_equal(support_run("cd %s/tmp && rm -f marks.kml && ogr2ogr -f LIBKML -a_srs "
                                 "EPSG:4326 -oo AUTODETECT_TYPE=YES marks.kml marks.csv",
                                 support_build_dir()),
                     0);
    struct result r = read_file((struct nav_reading){.is_route = false}, path_of("marks.kml"));
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 2);
    assert_near(r.track.fix[0].latitude_deg, 43.5, 1e-9);
    assert_near(r.track.fix[1].height_m, 1500, 1e-9);
    assert_true(r.track.fix[1].time_us - r.track.fix[0].time_us == 3000000);
    nav_track_free(&r.track);
}

TEST(a_line_that_gdal_wrote_is_read_back)
{
    static const char csv[] =
        "WKT,altitudeMode\n\"LINESTRING Z (7.125 43.5 1000,7.25 43.75 1500,6.5 44 "
        "2000.5)\",absolute\n";
    FILE *out = fopen(path_of("line.csv"), "w");
    assert_non_null(out);
    fputs(csv, out);
    fclose(out);
    assert_int_equal(support_run("cd %s/tmp && rm -f line.kml && "
                                 "ogr2ogr -f LIBKML -a_srs EPSG:4326 line.kml line.csv",
                                 support_build_dir()),
                     0);
    struct result r = read_file((struct nav_reading){.is_route = true}, path_of("line.kml"));
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 3);
    assert_near(r.track.fix[1].latitude_deg, 43.75, 1e-9);
    assert_near(r.track.fix[2].longitude_deg, 6.5, 1e-9);
    assert_near(r.track.fix[2].height_m, 2000.5, 1e-9);
    nav_track_free(&r.track);
}
