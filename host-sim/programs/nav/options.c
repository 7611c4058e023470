#include "options.h"

#include "hs/error.h"
#include "hs/network_options.h"
#include "hs/number.h"
#include "hs/options.h"
#include "nav/parse.h"

#include <math.h>
#include <string.h>

static bool is_place(double latitude_deg, double longitude_deg)
{
    return fabs(latitude_deg) <= 90 && fabs(longitude_deg) <= 180;
}

static const char *take_circle(void *context, const char *text)
{
    struct command *c = context;
    double v[6] = {0};
    const int n = hs_numbers(text, ',', v, 6);
    if (n < 5 || !is_place(v[0], v[1]) || fabs(v[2]) < 1 || fabs(v[2]) > 1e6 || v[4] <= 0 ||
        v[4] > 10000) {
        return "needs LAT,LON,RADIUS_M,HEIGHT_M,SPEED_MS[,START_DEG] with a radius of 1..1000000 m "
               "and a speed of up to 10000 m/s";
    }
    c->circle = (struct nav_circle){v[0], v[1], v[2], v[3], v[4], v[5]};
    c->has_circle = true;
    return NULL;
}

static const char *take_straight(void *context, const char *text)
{
    struct command *c = context;
    double v[5];
    if (hs_numbers(text, ',', v, 5) != 5 || !is_place(v[0], v[1]) || v[4] < 0 || v[4] > 10000) {
        return "needs LAT,LON,HEADING_DEG,HEIGHT_M,SPEED_MS with a speed of 0..10000 m/s";
    }
    c->straight = (struct nav_straight){v[0], v[1], v[2], v[3], v[4]};
    c->has_straight = true;
    return NULL;
}

static bool add_weather(struct command *c, bool is_jammer, const char *text)
{
    double v[6];
    return nav_weather_add(&c->send.weather, is_jammer, v, hs_numbers(text, ',', v, 6));
}

static const char *take_rain(void *context, const char *text)
{
    return add_weather(context, false, text)
               ? NULL
               : "needs LAT,LON,RADIUS_M,MM_H[,FROM_S[,UNTIL_S]] with a radius of 100..100000 m "
                 "and 1..150 mm/h, up to four times";
}

static const char *take_jammer(void *context, const char *text)
{
    return add_weather(context, true, text)
               ? NULL
               : "needs LAT,LON,DB[,FROM_S[,UNTIL_S]] with -20..80 dB, up to four times";
}

static const char *take_beacon(void *context, const char *text)
{
    struct command *c = context;
    double v[6];
    return nav_live_add_beacon(&c->send.live, v, hs_numbers(text, ',', v, 6))
               ? NULL
               : "needs NUMBER,CODE,LAT,LON[,HEIGHT_M[,LATE_US]] with a number of 0..255 that is "
                 "not taken, a code of 0..15, up to 16000 m and whole microseconds of 0..15";
}

static const char *take_live(void *context, const char *text)
{
    struct command *c = context;
    double v[10];
    return nav_live_add(&c->send.live, v, hs_numbers(text, ',', v, 10))
               ? NULL
               : "needs NUMBER,KIND,LAT,LON,COURSE_DEG,SPEED_MS[,HEIGHT_M[,TURN_DEG_S[,FROM_S"
                 "[,UNTIL_S]]]] with a number of 0..255 that is not taken, a kind of 0..17, up to "
                 "1000 m/s, 16000 m and 60 deg/s";
}

static const char *take_exercise_rate(void *context, const char *text)
{
    struct command *c = context;
    double v[2];
    return nav_exercise_add_rate(&c->send.exercise, v, hs_numbers(text, ',', v, 2))
               ? NULL
               : "needs RATE[,FROM_S] with a rate of 0..16, up to eight times, in ascending FROM_S";
}

static const char *take_malfunction(void *context, const char *text)
{
    struct command *c = context;
    return nav_exercise_add_malfunction(&c->send.exercise, text);
}

static const char *take_begin(void *context, const char *text)
{
    struct command *c = context;
    c->has_begin = nav_parse_time(text, &c->begin_us);
    return c->has_begin ? NULL : "needs a time such as 2020-06-25T08:23:06Z";
}

static const struct hs_usage usage = {
    "", "turn a flight into traffic of the avionics bus",
    "Write a log of CANaerospace 1.7 frames, as candump -L writes it. The flight is a TRACK, a "
    "--circle, a --straight line, or what a simulator flies (--flightgear, --xplane): exactly one "
    "of "
    "them.\n"
    "\n"
    "Between fixes the position follows the geodesic. What the track does not have is derived: "
    "bank from turn rate and speed, pitch from the angle of climb, heading = track."};

static const char heights_help[] =
    "GPX: above mean sea level; with a geoidheight in every point, above the ellipsoid. IGC: above "
    "the ellipsoid, or above mean sea level where a record HFALG says GEO; barometric where no fix "
    "has a GNSS altitude. KML: above mean sea level where altitudeMode is absolute; others are "
    "above "
    "the ground and are left out, unless --datum says what they are. CSV: the column says it. "
    "--circle and --straight: above the ellipsoid. Simulators: above mean sea level.\n";

static const char columns_help[] =
    "They are named in the first line, in any order and case: timestamp or time (ISO 8601, or "
    "seconds, milliseconds or microseconds since 1970), latitude (lat), longitude (lon), altitude "
    "(feet, barometric) or baro_altitude_m, altitude_m (mean sea level), geoaltitude (feet) or "
    "ellipsoid_height_m, geoid_m (of the geoid above the ellipsoid), groundspeed (knots) or "
    "groundspeed_ms, track, heading, roll, pitch (degrees), vertical_rate (feet a minute) or "
    "vertical_rate_ms. Others are passed over; an empty field is a value not known.\n";

/* What options give that is not a number or a name of its own in struct command. */
struct raw {
    int format, position; /* -1: by name; enum nav_position */
    int datum;            /* -1: by record */
    double clear_s;       /* NAN: never */
    double seconds, max_gap_s;
    double clock_s; /* NAN: none */
    long seed;      /* -1: none */
};

static bool read_table(struct command *c, struct raw *raw, int argc, char **argv, int *exit_code)
{
    struct hs_taker circle = {take_circle, c}, straight = {take_straight, c},
                    interface = {hs_take_interface, &c->send.interface}, begin = {take_begin, c},
                    rain = {take_rain, c}, jammer = {take_jammer, c},
                    bind = {hs_take_address, &c->bind}, can = {hs_take_interface, &c->can},
                    from = {hs_take_address, &c->from}, ask = {hs_take_address, &c->ask},
                    live = {take_live, c}, beacon = {take_beacon, c},
                    exercise_rate = {take_exercise_rate, c}, malfunction = {take_malfunction, c};
    const struct hs_option options[] = {
        {"TRACK", HS_INPUT_ARGUMENT, &c->track_path, 0, 0, NULL,
         "a .csv, .gpx, .igc, .kml or .kmz file, plain or .gz; - is standard input", false},
        {"format", HS_CHOICE, &raw->format, 0, 0, "csv|gpx|igc|kml",
         "of the track, when the name of the file does not tell", false},
        {"strict", HS_FLAG, &c->is_strict, 0, 0, NULL,
         "stop at the first line that cannot be used; otherwise such lines are left out, counted "
         "and reported",
         false},
        {"speed", HS_REAL, &c->speed_ms, 1, 10000, "MS",
         "fly the points of a route or a track at this speed, with banked turns; times in the file "
         "are not used",
         false},
        {"circle", HS_TAKER, &circle, 0, 0, "LAT,LON,RADIUS_M,HEIGHT_M,SPEED_MS[,START_DEG]",
         "fly a banked circle round LAT,LON (degrees), clockwise, or to the left for a negative "
         "radius, beginning START_DEG from north",
         false},
        {"straight", HS_TAKER, &straight, 0, 0, "LAT,LON,HEADING_DEG,HEIGHT_M,SPEED_MS",
         "fly the geodesic that leaves LAT,LON in the direction HEADING_DEG", false},
        {"A simulator", HS_HEADING, NULL, 0, 0, NULL, "", false},
        {"flightgear", HS_INTEGER, &c->flightgear_port, 1, 65535, "PORT",
         "take what FlightGear flies from this port of UDP, in real time, until a signal or "
         "--seconds; "
         "docs/nav.md says how to start it",
         false},
        {"xplane", HS_INTEGER, &c->xplane_port, 1, 65535, "PORT",
         "likewise X-Plane: its data output with the rows 17, 20 and 21, or what --ask asks for",
         false},
        {"ask", HS_TAKER, &ask, 0, 0, "ADDRESS",
         "ask the X-Plane at this address, port 49000, for its position instead, in full precision",
         false},
        {"bind", HS_TAKER, &bind, 0, 0, "ADDRESS",
         "listen at this address of the machine; 0.0.0.0: at all. Left out: 127.0.0.1, or 0.0.0.0 "
         "with "
         "--ask",
         false},
        {"from", HS_TAKER, &from, 0, 0, "ADDRESS",
         "hear this address alone; left out: the first that is heard, until it was silent for 3 s",
         false},
        {"can", HS_TAKER, &can, 0, 0, "NAME", "send to an interface of SocketCAN instead of a log",
         false},
        {"What is sent", HS_HEADING, NULL, 0, 0, NULL, "", false},
        {"out", HS_OUTPUT, &c->out_path, 0, 0, "FILE",
         "where the log goes; left out: standard output", false},
        {"iface", HS_TAKER, &interface, 0, 0, "NAME", "interface named in the log (can0)", false},
        {"position", HS_CHOICE, &raw->position, 0, 0, "double|float|long",
         "latitude and longitude as pairs of DOUBLEH and DOUBLEL, as FLOAT, or as LONG of 1e-7 "
         "degree",
         false},
        {"rate-scale", HS_REAL, &c->send.rate_scale, NAV_RATE_SCALE_MIN, NAV_RATE_SCALE_MAX, "X",
         "multiply every rate; 1: attitude 80 Hz, positions and speeds 10 Hz, time and date 1 Hz",
         false},
        {"start", HS_REAL, &c->start_s, 0, 1e9, "S", "begin S seconds after the first fix", false},
        {"seconds", HS_REAL, &raw->seconds, 0.0125, 1e9, "S",
         "send S seconds; left out: the whole track, 60 s of a --circle or --straight line, or "
         "what the "
         "simulator flies without end",
         false},
        {"begin", HS_TAKER, &begin, 0, 0, "TIME",
         "move the flight so that its first fix is at TIME (ISO 8601, or seconds since 1970); "
         "--circle and --straight otherwise begin at 2000-01-01T12:00:00Z",
         false},
        {"rain", HS_TAKER, &rain, 0, 0, "LAT,LON,RADIUS_M,MM_H[,FROM_S[,UNTIL_S]]",
         "tell of a circle of rain, 100..100000 m, 1..150 mm/h, once a second, in a part of the "
         "log; up to four",
         false},
        {"jammer", HS_TAKER, &jammer, 0, 0, "LAT,LON,DB[,FROM_S[,UNTIL_S]]",
         "likewise a jammer of -20..80 dB above the radar's noise, on the axis of its antenna at "
         "ten nautical miles",
         false},
        {"weather-clear", HS_REAL, &raw->clear_s, 0, 1e9, "S",
         "take all of it away S seconds after the log's beginning; what is only not told any more "
         "is removed by the display after 10 s",
         false},
        {"live", HS_TAKER, &live, 0, 0,
         "NUMBER,KIND,LAT,LON,COURSE_DEG,SPEED_MS[,HEIGHT_M[,TURN_DEG_S[,FROM_S[,UNTIL_S]]]]",
         "tell of a live target once a second: it begins there, goes straight on or turns, at a "
         "height above mean sea level, or on the ground where that is left out or below -1000, "
         "and is removed at UNTIL_S; kinds are those of docs/bus.md; up to 256",
         false},
        {"beacon", HS_TAKER, &beacon, 0, 0, "NUMBER,CODE,LAT,LON[,HEIGHT_M[,LATE_US]]",
         "tell of a radar beacon that stands there, likewise, with a number that no other target "
         "has: it answers the beacon mode with a code of 0..15, and perhaps 0..15 microseconds "
         "late",
         false},
        {"live-routes", HS_INPUT, &c->live_path, 0, 0, "FILE",
         "tell of the live targets of a file, each with places on its way and when it is there or "
         "how fast it goes",
         false},
        {"exercise-clock", HS_REAL, &raw->clock_s, 0, 2147483, "S",
         "tell the clock of an exercise that began S seconds before the log, once a second: what "
         "moves or fluctuates in the display follows it",
         false},
        {"exercise-rate", HS_TAKER, &exercise_rate, 0, 0, "RATE[,FROM_S]",
         "from FROM_S seconds after the log's beginning on this clock runs RATE times as fast, "
         "0..16; 0: the exercise stands; up to eight",
         false},
        {"exercise-seed", HS_INTEGER, &raw->seed, 0, 2147483647, "N",
         "tell the seed of speckle and noise, too", false},
        {"malfunction", HS_TAKER, &malfunction, 0, 0, "NAME[=VALUE][@FROM_S[,UNTIL_S]]",
         "break the radar, for an exercise: no-transmit, weak-transmit=DB, noise=DB, "
         "stuck-antenna=DEG, antenna-drift=DEG_A_MINUTE, lost-sector=FROM,TO, frozen-video, "
         "tilt=DEG, dead-key=N; up to twelve",
         false},
        {"datum", HS_CHOICE, &raw->datum, 0, 0, "ellipsoid|msl|barometric",
         "what heights are measured from, if the file says it wrong or not at all; they are sent "
         "as 1038, 332 or 320. Left out: as below",
         false},
        {"qnh", HS_REAL, &c->qnh_hpa, 900, 1100, "HPA",
         "correct barometric heights for this pressure at sea level; left out: 1013.25 hPa", false},
        {"height-offset", HS_REAL, &c->height_offset_m, -10000, 10000, "M",
         "add M metres to every height", false},
        {"quiet", HS_FLAG, &c->is_quiet, 0, 0, NULL, "no summary on standard error", false},
        {"What counts as broken", HS_HEADING, NULL, 0, 0, NULL, "", false},
        {"max-gap", HS_REAL, &raw->max_gap_s, 0.001, 1e9, "S",
         "a longer pause between fixes is a gap, in which the bus is silent; left out: the larger "
         "of 30 s and 3 median intervals",
         false},
        {"max-speed", HS_REAL, &c->limits.max_speed_ms, 1, 1e9, "MS",
         "a faster step between fixes is a jump and is sent as one: the position stays, then jumps "
         "when the next fix is due",
         false},
        {"keep-repeats", HS_FLAG, &c->keeps_repeats, 0, 0, NULL,
         "send fixes that repeat the position of the one before although the aircraft moves; "
         "otherwise they are left out and counted",
         false},
        HS_CLASHES_ROW("circle", "TRACK|straight|flightgear|xplane"),
        HS_CLASHES_ROW("straight", "TRACK|flightgear|xplane"),
        HS_CLASHES_ROW("flightgear", "TRACK|xplane"),
        HS_CLASHES_ROW("xplane", "TRACK"),
        HS_NEEDS_ROW("ask", "xplane"),
        HS_NEEDS_ROW("bind", "flightgear|xplane"),
        HS_NEEDS_ROW("from", "flightgear|xplane"),
        HS_NEEDS_ROW("can", "flightgear|xplane"),
        HS_CLASHES_ROW("can", "out"),
        HS_CLASHES_ROW("start", "flightgear|xplane"),
        HS_CLASHES_ROW("begin", "flightgear|xplane"),
        HS_CLASHES_ROW("exercise-rate", "flightgear|xplane"),
        HS_NEEDS_ROW("format", "TRACK"),
        HS_NEEDS_ROW("strict", "TRACK"),
        HS_NEEDS_ROW("speed", "TRACK"),
        HS_NEEDS_ROW("datum", "TRACK|flightgear|xplane"),
        HS_NEEDS_ROW("qnh", "TRACK"),
        HS_NEEDS_ROW("max-gap", "TRACK"),
        HS_NEEDS_ROW("max-speed", "TRACK"),
        HS_NEEDS_ROW("keep-repeats", "TRACK"),
        HS_NEEDS_ROW("weather-clear", "rain|jammer"),
        {"Heights", HS_HEADING, NULL, 0, 0, NULL, heights_help, false},
        {"Columns of a CSV", HS_HEADING, NULL, 0, 0, NULL, columns_help, false},
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

bool nav_options_read(struct command *c, int argc, char **argv, int *exit_code)
{
    *c = (struct command){.limits = {.max_speed_ms = 800 * 1852.0 / 3600.0},
                          .send = {.interface = "can0", .rate_scale = 1},
                          .speed_ms = NAN,
                          .qnh_hpa = NAN};
    struct raw raw = {-1, NAV_POSITION_DOUBLE, -1, NAN, NAN, NAN, NAN, -1};
    if (!read_table(c, &raw, argc, argv, exit_code)) {
        return false;
    }
    if ((c->track_path != NULL) + c->has_circle + c->has_straight + (c->flightgear_port > 0) +
            (c->xplane_port > 0) !=
        1) {
        *exit_code =
            hs_options_wrong(&usage, "TRACK",
                             "or --circle, --straight, --flightgear or --xplane must be given, "
                             "and only one of them");
        return false;
    }
    if (isnan(raw.clock_s) && (raw.seed >= 0 || c->send.exercise.rate_count > 0)) {
        *exit_code = hs_options_wrong(&usage, "--exercise-clock",
                                      "is missing: rate and seed belong to a clock");
        return false;
    }
    c->format =
        raw.format < 0 ? NAV_FORMAT_BY_NAME : (enum nav_format)(raw.format + NAV_FORMAT_CSV);
    c->datum = raw.datum < 0 ? NAV_DATUM_BY_RECORD : (enum nav_datum)raw.datum;
    c->send.position = (enum nav_position)raw.position;
    c->send.weather.has_clear = !isnan(raw.clear_s);
    c->send.weather.clear_s = raw.clear_s;
    c->send.exercise.has_clock = !isnan(raw.clock_s);
    c->send.exercise.start_s = raw.clock_s;
    c->send.exercise.has_seed = raw.seed >= 0;
    c->send.exercise.seed = (int32_t)raw.seed;
    c->seconds = isnan(raw.seconds) ? 0 : raw.seconds;
    c->limits.max_gap_s = isnan(raw.max_gap_s) ? 0 : raw.max_gap_s;
    return true;
}
