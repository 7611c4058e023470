/* Tracks from files, good ones and bad ones. */
#include "check.h"
#include "hs/rng.h"
#include "read_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct result read_csv(const char *text)
{
    return read_as(NAV_FORMAT_CSV, false, text);
}

TEST(csv_columns_come_in_any_order_case_and_unit)
{
    struct result r = read_csv(
        "\xEF\xBB\xBFLongitude;LAT;callsign;altitude_m;groundspeed_ms;TIME\r\n"
        "7.5;43.5;\"A;1200;90.5;2020-06-25T08:23:06.5Z\r\n"
        "7.6;43.6;B;;91;2020-06-25 10:23:07.5+02:00\r\n");
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 2);
    assert_true(r.track.fix[0].time_us == INT64_C(1593073386500000));
    assert_true(r.track.fix[1].time_us == INT64_C(1593073387500000));
    assert_near(r.track.fix[0].height_m, 1200, 0);
    assert_true(isnan(r.track.fix[1].height_m));
    assert_near(r.track.fix[1].speed_ms, 91, 0);
    assert_int_equal(r.track.datum, NAV_DATUM_SEA_LEVEL);
    nav_track_free(&r.track);
    r = read_csv(
        "timestamp,latitude,longitude,altitude,groundspeed,vertical_rate\n"
        "1576068400000,43.5,7.2,1000,100,600\n1576068401,43.5,7.2,1000,100,600\n");
    assert_int_equal(r.track.count, 2);
    assert_true(r.track.fix[1].time_us - r.track.fix[0].time_us == 1000000);
    assert_near(r.track.fix[0].height_m, 304.8, 1e-9);
    assert_near(r.track.fix[0].speed_ms, 51.4444444, 1e-6);
    assert_near(r.track.fix[0].climb_ms, 3.048, 1e-9);
    assert_int_equal(r.track.datum, NAV_DATUM_BAROMETRIC);
    nav_track_free(&r.track);
}

TEST(csv_heights_are_taken_from_the_best_column)
{
    static const struct {
        const char *columns;
        double height_m;
        enum nav_datum datum;
    } wanted[] = {{"altitude,geoaltitude", 609.6, NAV_DATUM_ELLIPSOID},
                  {"ellipsoid_height_m,altitude", 1000, NAV_DATUM_ELLIPSOID},
                  {"alt_m,altitude", 1000, NAV_DATUM_SEA_LEVEL},
                  {"alt,altitude_m", 2000, NAV_DATUM_SEA_LEVEL},
                  {"baro_altitude_m,track", 1000, NAV_DATUM_BAROMETRIC},
                  {"altitude_m,geoid_m", 3000, NAV_DATUM_ELLIPSOID}};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        char text[200];
        const char *second = strstr(wanted[i].columns, "track") ? "20" : "2000";
        snprintf(text, sizeof text, "time,lat,lon,%s\n1,43,7,1000,%s\n", wanted[i].columns, second);
        struct result r = read_csv(text);
        assert_int_equal(r.track.count, 1);
        assert_near(r.track.fix[0].height_m, wanted[i].height_m, 1e-9);
        assert_int_equal(r.track.datum, wanted[i].datum);
        nav_track_free(&r.track);
    }
}

#define HEAD "time,lat,lon,altitude\n"
#define GOOD "1,43,7,100\n2,43.1,7,100\n3,43.2,7,100\n4,43.3,7,100\n5,43.4,7,100\n6,43.5,7,100\n"

TEST(a_line_that_cannot_be_used_is_counted_and_left_out)
{
    static const char *const bad[] = {
        "7,43x,7,100\n",  "7,91,7,100\n",   "7,43,400,100\n",
        "7,43,7\n",       "7,43,7,100,5\n", "seven,43,7,100\n",
        "7,nan,7,100\n",  "7,0x2B,7,100\n", "7,43,7,1e300\n",
        "7,43,7,1e999\n", "-7,43,7,100\n",  "2020-06-31T00:00:00Z,43,7,1\n",
        "7,43,7,inf\n",   "7,4 3,7,100\n",  "2020-06-25T25:00:00Z,43,7,1\n"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s%s8,43.6,7,100\n", HEAD, GOOD, bad[i]);
        struct result r = read_csv(text);
        assert_int_equal(r.status, 0);
        assert_int_equal(r.reading.malformed, 1);
        assert_int_equal(r.track.count, 7);
        nav_track_free(&r.track);
        r = read_as(NAV_FORMAT_CSV, true, text);
        assert_int_equal(r.status, -1);
        nav_track_free(&r.track);
    }
}

TEST(repeated_and_backward_times_are_counted_and_left_out)
{
    struct result r =
        read_csv(HEAD GOOD "6,44,7,100\n3,44,7,100\n\n7,43.6,7,100\n,43,7,1\n8,,7,1\n");
    assert_int_equal(r.status, 0);
    assert_int_equal(r.reading.disordered, 2);
    assert_int_equal(r.reading.missing, 2);
    assert_int_equal(r.track.count, 7);
    for (size_t i = 1; i < r.track.count; i++) {
        assert_true(r.track.fix[i].time_us > r.track.fix[i - 1].time_us);
    }
    nav_track_free(&r.track);
}

TEST(what_is_no_track_is_an_error)
{
    static const char *const texts[] = {"",
                                        "\n",
                                        "a,b,c\n1,2,3\n",
                                        "time,lat\n1,2\n",
                                        HEAD,
                                        "time,lat,lon,altitude\nx\ny\nz\n1,43,7,1\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct result r = read_csv(texts[i]);
        assert_int_equal(r.status, -1);
        nav_track_free(&r.track);
    }
    static const char *const files[] = {"/nowhere/a.csv", "/dev/null", "/"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        assert_int_equal(read_file((struct nav_reading){0}, files[i]).status, -1);
    }
}

#define GPX_POINT(lat, time)                                                                       \
    "<trkpt lat='" lat "' lon='7.1'><ele>500</ele><time>" time "</time></trkpt>"
#define GPX(body) "<?xml version='1.0'?><gpx version='1.1'><trk>" body "</trk></gpx>"

TEST(gpx_segments_begin_legs)
{
    struct result r = read_as(
        NAV_FORMAT_GPX, false,
        GPX("<trkseg>" GPX_POINT("43", "2020-01-01T00:00:00Z")
                GPX_POINT("43.001", "2020-01-01T00:00:01Z") "</trkseg><trkseg>" GPX_POINT(
                    "43.002",
                    "2020-01-01T00:00:02Z") "<trkpt lat='43.003' "
                                            "lon='7.1'><time>2020-01-01T00:00:03Z</time><speed> "
                                            "88.5 </speed><course>12</course></trkpt></trkseg>"));
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 4);
    assert_near(r.track.fix[0].height_m, 500, 0);
    assert_true(r.track.fix[0].starts_leg && !r.track.fix[1].starts_leg);
    assert_true(r.track.fix[2].starts_leg && !r.track.fix[3].starts_leg);
    assert_near(r.track.fix[3].speed_ms, 88.5, 0);
    assert_near(r.track.fix[3].track_deg, 12, 0);
    assert_true(r.track.fix[0].time_us == INT64_C(1577836800000000));
    nav_track_free(&r.track);
}

TEST(bad_gpx_is_refused_or_its_points_left_out)
{
    struct result r = read_as(
        NAV_FORMAT_GPX, false,
        GPX("<trkseg>" GPX_POINT("43", "2020-01-01T00:00:00Z")
                GPX_POINT("x", "2020-01-01T00:00:01Z")
                    GPX_POINT("43.002", "yesterday") "<trkpt lat='43.003' lon='7.1'/>" GPX_POINT(
                        "43.004", "2020-01-01T00:00:04Z")
                        GPX_POINT("43.005", "2020-01-01T00:00:05Z") "</trkseg>"));
    assert_int_equal(r.status, 0);
    assert_int_equal(r.reading.malformed, 3);
    assert_int_equal(r.track.count, 3);
    nav_track_free(&r.track);
    static const char *const refused[] = {"<gpx><trk><trkseg>", "no xml", "",
                                          "<!DOCTYPE gpx><gpx><trk><trkseg>" GPX_POINT(
                                              "43", "2020-01-01T00:00:00Z") "</trkseg></trk></gpx>",
                                          GPX("<trkseg></trkseg>")};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        r = read_as(NAV_FORMAT_GPX, false, refused[i]);
        assert_int_equal(r.status, -1);
        nav_track_free(&r.track);
    }
}

/* The B record of the specification's example: 16:02:40, 54 07.121 N, 002 49.342 W, 280 m by
 * pressure, 421 m by satellite. */
TEST(igc_records_are_read_as_the_specification_says)
{
    struct result r = read_as(NAV_FORMAT_IGC, false,
                              "AXXX001\r\nHFDTE150709\r\nB1602405407121N00249342WA0028000421\r\n"
                              "LXXX remark\r\nB1602455107126S00149300EV002880042900309020\r\n"
                              "B160250510712\r\nB1602555107126N00149300EA-012000429\r\n");
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 3);
    assert_int_equal(r.reading.malformed, 1);
    const struct nav_fix *f = r.track.fix;
    assert_true(f[0].time_us == INT64_C(1247673760000000));
    assert_near(f[0].latitude_deg, 54 + 7.121 / 60, 1e-9);
    assert_near(f[0].longitude_deg, -(2 + 49.342 / 60), 1e-9);
    assert_near(f[0].height_m, 421, 0);
    assert_near(f[1].latitude_deg, -(51 + 7.126 / 60), 1e-9);
    assert_true(isnan(f[1].height_m)); /* barometric among others */
    assert_int_equal(r.reading.heights_left_out, 1);
    assert_int_equal(r.track.datum, NAV_DATUM_ELLIPSOID);
    nav_track_free(&r.track);
}

TEST(igc_says_what_its_heights_are_measured_from)
{
    struct result r = read_as(NAV_FORMAT_IGC, false,
                              "HFDTE150709\nHFALGALTGPS:GEO\n"
                              "B1602405407121N00249342WA0028000421\n");
    assert_int_equal(r.track.datum, NAV_DATUM_SEA_LEVEL);
    nav_track_free(&r.track);
    r = read_as(NAV_FORMAT_IGC, false, "HFDTE150709\nB1602405407121N00249342WV0028000000\n");
    assert_int_equal(r.track.datum, NAV_DATUM_BAROMETRIC);
    assert_near(r.track.fix[0].height_m, 280, 0);
    nav_track_free(&r.track);
}

TEST(gpx_heights_are_above_the_ellipsoid_where_every_point_has_a_geoid)
{
#define POINT_WITH(time, more)                                                                     \
    "<trkpt lat='43' lon='7'><ele>500</ele>" more "<time>2020-01-01T00:00:" time                   \
    "Z</time></"                                                                                   \
    "trkpt>"
    struct result r =
        read_as(NAV_FORMAT_GPX, false,
                GPX("<trkseg>" POINT_WITH("00", "<geoidheight>47.5</geoidheight>")
                        POINT_WITH("01", "<geoidheight>48</geoidheight>") "</trkseg>"));
    assert_int_equal(r.track.datum, NAV_DATUM_ELLIPSOID);
    assert_near(r.track.fix[0].height_m, 547.5, 0);
    assert_near(r.track.fix[1].height_m, 548, 0);
    nav_track_free(&r.track);
    r = read_as(NAV_FORMAT_GPX, false,
                GPX("<trkseg>" POINT_WITH("00", "<geoidheight>47.5</geoidheight>")
                        POINT_WITH("01", "") "</trkseg>"));
    assert_int_equal(r.track.datum, NAV_DATUM_SEA_LEVEL);
    assert_near(r.track.fix[0].height_m, 500, 0);
    nav_track_free(&r.track);
}

TEST(points_without_times_are_read_as_a_route)
{
    static const char rte[] =
        "<gpx><wpt lat='1' lon='1'/><rte><rtept lat='46' lon='7'><ele>2000</ele></rtept>"
        "<rtept lat='46.1' lon='7'/></rte><trk><trkseg><trkpt lat='3' "
        "lon='3'/></trkseg></trk></gpx>";
    struct result r = read_route(NAV_FORMAT_GPX, rte);
    assert_int_equal(r.track.count, 2);
    assert_near(r.track.fix[1].latitude_deg, 46.1, 0);
    assert_int_equal(r.track.datum, NAV_DATUM_SEA_LEVEL);
    nav_track_free(&r.track);
    r = read_as(NAV_FORMAT_GPX, false, rte);
    assert_int_equal(r.status, -1);
    nav_track_free(&r.track);
    r = read_route(NAV_FORMAT_CSV, "lat,lon\n46,7\n46.1,7\n46,7\n");
    assert_int_equal(r.track.count, 3);
    nav_track_free(&r.track);
    r = read_csv("lat,lon\n46,7\n46.1,7\n");
    assert_int_equal(r.status, -1);
    nav_track_free(&r.track);
}

TEST(igc_goes_on_after_midnight_and_needs_a_date)
{
    struct result r =
        read_as(NAV_FORMAT_IGC, false,
                "HFDTEDATE:311219,01\nB2359585407121N00249342WA0028000421\n"
                "B0000035407121N00249342WA0028000421\nB0000025407121N00249342WA0028000421\n");
    assert_int_equal(r.status, 0);
    assert_int_equal(r.track.count, 2);
    assert_int_equal(r.reading.disordered, 1);
    assert_true(r.track.fix[1].time_us - r.track.fix[0].time_us == 5000000);
    assert_true(r.track.fix[1].time_us == INT64_C(1577836803000000));
    nav_track_free(&r.track);
    r = read_as(NAV_FORMAT_IGC, false, "B2359585407121N00249342WA0028000421\n");
    assert_int_equal(r.status, -1);
    nav_track_free(&r.track);
}

/* Whatever becomes of a file, the reader returns, and what it returns is in order and in range. */
TEST(torn_files_give_an_error_or_a_proper_track)
{
    static const char *const whole[] = {
        HEAD GOOD,
        GPX("<trkseg>" GPX_POINT("43", "2020-01-01T00:00:00Z")
                GPX_POINT("43.1", "2020-01-01T00:00:09Z") "</trkseg>"),
        "HFDTE150709\nB1602405407121N00249342WA0028000421\nB1602455407121N00249342WA0028000421\n"};
    struct hs_rng random;
    hs_rng_seed(&random, 20);
    for (int i = 0; i < 9000; i++) {
        char text[1024];
        const int kind = i % 3;
        strcpy(text, whole[kind]);
        const size_t n = strlen(text);
        for (uint32_t k = 0; k <= hs_rng_below(&random, 4); k++) {
            const uint32_t place = hs_rng_below(&random, (uint32_t)n);
            text[place] = hs_rng_below(&random, 2)
                              ? (char)(1 + hs_rng_below(&random, 255))
                              : ",;\n-+.e90N<>&\"T:Z"[hs_rng_below(&random, 18)];
        }
        text[hs_rng_below(&random, 3) ? n : hs_rng_below(&random, (uint32_t)n)] = '\0';
        struct result r = read_as((enum nav_format)(NAV_FORMAT_CSV + kind), false, text);
        for (size_t k = 0; k < r.track.count; k++) {
            const struct nav_fix *f = &r.track.fix[k];
            assert_true(fabs(f->latitude_deg) <= 90 && fabs(f->longitude_deg) <= 180);
            assert_true(f->time_us >= 0 && (k == 0 || f->time_us > f[-1].time_us));
        }
        nav_track_free(&r.track);
    }
}
