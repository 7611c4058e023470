/* landmass-nav: a recorded or invented flight as traffic of the avionics bus. */
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "nav/make_track.h"
#include "nav/parse.h"
#include "nav/read_track.h"
#include "nav/send.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help_text[] =
    "usage: landmass-nav [OPTIONS] TRACK\n"
    "       landmass-nav [OPTIONS] --circle LAT,LON,RADIUS_M,HEIGHT_M,SPEED_MS[,START_DEG]\n"
    "       landmass-nav [OPTIONS] --straight LAT,LON,HEADING_DEG,HEIGHT_M,SPEED_MS\n"
    "Turn a flight into a log of CANaerospace 1.7 frames, as candump -L writes it.\n"
    "\n"
    "Where the flight comes from:\n"
    "  TRACK             a .csv, .gpx or .igc file, plain or .gz; - is standard input\n"
    "  --format NAME     csv, gpx or igc, when the name of the file does not tell\n"
    "  --strict          stop at the first line that cannot be used (otherwise such lines\n"
    "                    are left out, counted and reported)\n"
    "  --circle ...      fly a banked circle round LAT,LON (degrees), clockwise, or to the\n"
    "                    left for a negative radius, beginning START_DEG from north\n"
    "  --straight ...    fly the geodesic that leaves LAT,LON in the direction HEADING_DEG\n"
    "\n"
    "What is sent:\n"
    "  --out FILE        where the log goes; without it, standard output\n"
    "  --iface NAME      interface named in the log (can0)\n"
    "  --position KIND   latitude and longitude as double (pairs of DOUBLEH and DOUBLEL, the\n"
    "                    default), float (FLOAT) or long (LONG of 1e-7 degree)\n"
    "  --rate-scale X    multiply every rate by X, 0.0125..4 (1: attitude 80 Hz, positions\n"
    "                    and speeds 10 Hz, time and date 1 Hz)\n"
    "  --start S         begin S seconds after the first fix\n"
    "  --seconds N       send N seconds; with --circle and --straight, fly N seconds (60)\n"
    "  --begin TIME      move the flight so that its first fix is at TIME (ISO 8601, or\n"
    "                    seconds since 1970); --circle and --straight otherwise begin at\n"
    "                    2000-01-01T12:00:00Z\n"
    "  --rain LAT,LON,RADIUS_M,MM_H[,FROM_S[,UNTIL_S]]\n"
    "                    tell of a circle of rain, 100..100000 m, 1..150 mm/h, once a second,\n"
    "                    in a part of the log; up to four\n"
    "  --jammer LAT,LON,DB[,FROM_S[,UNTIL_S]]\n"
    "                    likewise a jammer of -20..80 dB above the radar's noise, on the axis\n"
    "                    of its antenna at ten nautical miles\n"
    "  --weather-clear S take all of it away S seconds after the log's beginning; what is only\n"
    "                    not told any more is removed by the display after 10 s\n"
    "  --height-offset M add M metres to every height, for example the height of the geoid\n"
    "\n"
    "What counts as broken:\n"
    "  --max-gap S       a longer pause between fixes is a gap, in which the bus is silent;\n"
    "                    default the larger of 30 s and 3 median intervals\n"
    "  --max-speed MS    a faster step between fixes is a jump and is sent as one: the\n"
    "                    position stays, then jumps when the next fix is due (411 m/s)\n"
    "\n"
    "  --quiet           no summary on standard error\n"
    "  -h, --help        print this\n"
    "\n"
    "Columns of a CSV, named in its first line, in any order and case: timestamp or time\n"
    "(ISO 8601, or seconds, milliseconds or microseconds since 1970), latitude (lat),\n"
    "longitude (lon), altitude (feet) or altitude_m, groundspeed (knots) or groundspeed_ms,\n"
    "track, heading, roll, pitch (degrees), vertical_rate (feet a minute) or\n"
    "vertical_rate_ms. Others are passed over; an empty field is a value not known.\n"
    "Between fixes the position follows the geodesic. What the track does not have is\n"
    "derived: bank from turn rate and speed, pitch from the angle of climb, heading = track.\n"
    "Exit status: 0 done, 1 the work failed, 2 the command line makes no sense.\n";

struct command {
    const char *track_path;
    const char *out_path; /* NULL: standard output */
    enum nav_format format;
    bool is_strict, is_quiet, has_circle, has_straight, has_begin;
    struct nav_circle circle;
    struct nav_straight straight;
    struct nav_limits limits;
    struct nav_send_options send;
    double start_s, seconds; /* seconds: 0 when not given */
    double height_offset_m;
    int64_t begin_us;
};

enum option_code {
    OPT_FORMAT = 256,
    OPT_STRICT,
    OPT_CIRCLE,
    OPT_STRAIGHT,
    OPT_OUT,
    OPT_IFACE,
    OPT_POSITION,
    OPT_RATE_SCALE,
    OPT_START,
    OPT_SECONDS,
    OPT_BEGIN,
    OPT_HEIGHT_OFFSET,
    OPT_MAX_GAP,
    OPT_MAX_SPEED,
    OPT_RAIN,
    OPT_JAMMER,
    OPT_WEATHER_CLEAR,
    OPT_QUIET
};

static const struct option long_options[] = {
    {"format", required_argument, NULL, OPT_FORMAT},
    {"strict", no_argument, NULL, OPT_STRICT},
    {"circle", required_argument, NULL, OPT_CIRCLE},
    {"straight", required_argument, NULL, OPT_STRAIGHT},
    {"out", required_argument, NULL, OPT_OUT},
    {"iface", required_argument, NULL, OPT_IFACE},
    {"position", required_argument, NULL, OPT_POSITION},
    {"rate-scale", required_argument, NULL, OPT_RATE_SCALE},
    {"start", required_argument, NULL, OPT_START},
    {"seconds", required_argument, NULL, OPT_SECONDS},
    {"begin", required_argument, NULL, OPT_BEGIN},
    {"height-offset", required_argument, NULL, OPT_HEIGHT_OFFSET},
    {"max-gap", required_argument, NULL, OPT_MAX_GAP},
    {"max-speed", required_argument, NULL, OPT_MAX_SPEED},
    {"rain", required_argument, NULL, OPT_RAIN},
    {"jammer", required_argument, NULL, OPT_JAMMER},
    {"weather-clear", required_argument, NULL, OPT_WEATHER_CLEAR},
    {"quiet", no_argument, NULL, OPT_QUIET},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

static int usage_error(const char *option, const char *wanted)
{
    return hs_error(option, "see landmass-nav --help", "takes %s", wanted);
}

static int take_number(const char *option, const char *text, double low, double high, double *value)
{
    if (nav_parse_number(text, value) && *value >= low && *value <= high) {
        return 0;
    }
    return hs_error(option, "see landmass-nav --help", "takes a number from %g to %g, not '%s'",
                    low, high, text);
}

/* The place of `text` in a list of names ended by NULL, or -1. */
static int take_name(const char *text, const char *const *names)
{
    for (int i = 0; names[i]; i++) {
        if (strcmp(text, names[i]) == 0) {
            return i;
        }
    }
    return -1;
}

/* Numbers between commas; returns how many, or -1 for anything else or more than `most`. */
static int take_list(const char *text, double *value, int most)
{
    char copy[256];
    if (strlen(text) >= sizeof copy) {
        return -1;
    }
    strcpy(copy, text);
    int n = 0;
    for (char *p = copy, *next; p; p = next, n++) {
        next = strchr(p, ',');
        if (next) {
            *next++ = '\0';
        }
        if (n == most || !nav_parse_number(p, &value[n])) {
            return -1;
        }
    }
    return n;
}

static bool is_place(double latitude_deg, double longitude_deg)
{
    return fabs(latitude_deg) <= 90 && fabs(longitude_deg) <= 180;
}

static int take_circle(struct command *c, const char *text)
{
    double v[6] = {0};
    const int n = take_list(text, v, 6);
    if (n < 5 || !is_place(v[0], v[1]) || fabs(v[2]) < 1 || fabs(v[2]) > 1e6 || v[4] <= 0 ||
        v[4] > 10000) {
        return usage_error("--circle",
                           "LAT,LON,RADIUS_M,HEIGHT_M,SPEED_MS[,START_DEG] with a "
                           "radius of 1..1000000 m and a speed of up to 10000 m/s");
    }
    c->circle = (struct nav_circle){v[0], v[1], v[2], v[3], v[4], v[5]};
    c->has_circle = true;
    return 0;
}

static int take_straight(struct command *c, const char *text)
{
    double v[5];
    if (take_list(text, v, 5) != 5 || !is_place(v[0], v[1]) || v[4] < 0 || v[4] > 10000) {
        return usage_error("--straight",
                           "LAT,LON,HEADING_DEG,HEIGHT_M,SPEED_MS with a speed of "
                           "0..10000 m/s");
    }
    c->straight = (struct nav_straight){v[0], v[1], v[2], v[3], v[4]};
    c->has_straight = true;
    return 0;
}

static int take_weather(struct command *c, int option, const char *text)
{
    double v[6];
    const bool is_jammer = option == OPT_JAMMER;
    if (nav_weather_add(&c->send.weather, is_jammer, v, take_list(text, v, 6))) {
        return 0;
    }
    return is_jammer ? usage_error("--jammer",
                                   "LAT,LON,DB[,FROM_S[,UNTIL_S]] with -20..80 dB, and up to "
                                   "four times")
                     : usage_error("--rain",
                                   "LAT,LON,RADIUS_M,MM_H[,FROM_S[,UNTIL_S]] with a radius of "
                                   "100..100000 m and 1..150 mm/h, and up to four times");
}

static int take_interface(struct command *c, const char *text)
{
    const size_t length = strlen(text);
    if (length < 1 || length > 15 || strpbrk(text, " \t\n/")) {
        return usage_error("--iface", "a name of 1 to 15 characters without blanks");
    }
    c->send.interface = text;
    return 0;
}

static int take_names(struct command *c, int option, const char *text)
{
    static const char *const formats[] = {"csv", "gpx", "igc", NULL};
    static const char *const positions[] = {"double", "float", "long", NULL};
    const int i = take_name(text, option == OPT_FORMAT ? formats : positions);
    if (i < 0) {
        return option == OPT_FORMAT ? usage_error("--format", "csv, gpx or igc")
                                    : usage_error("--position", "double, float or long");
    }
    if (option == OPT_FORMAT) {
        c->format = (enum nav_format)(i + NAV_FORMAT_CSV);
    } else {
        c->send.position = (enum nav_position)i;
    }
    return 0;
}

static int take_option(struct command *c, int option, const char *text)
{
    switch (option) {
    case OPT_FORMAT:
    case OPT_POSITION:
        return take_names(c, option, text);
    case OPT_STRICT:
        c->is_strict = true;
        return 0;
    case OPT_QUIET:
        c->is_quiet = true;
        return 0;
    case OPT_CIRCLE:
        return take_circle(c, text);
    case OPT_STRAIGHT:
        return take_straight(c, text);
    case OPT_RAIN:
    case OPT_JAMMER:
        return take_weather(c, option, text);
    case OPT_WEATHER_CLEAR:
        c->send.weather.has_clear = true;
        return take_number("--weather-clear", text, 0, 1e9, &c->send.weather.clear_s);
    case OPT_OUT:
        c->out_path = text;
        return 0;
    case OPT_IFACE:
        return take_interface(c, text);
    case OPT_RATE_SCALE:
        return take_number("--rate-scale", text, NAV_RATE_SCALE_MIN, NAV_RATE_SCALE_MAX,
                           &c->send.rate_scale);
    case OPT_START:
        return take_number("--start", text, 0, 1e9, &c->start_s);
    case OPT_SECONDS:
        return take_number("--seconds", text, 0.0125, 1e9, &c->seconds);
    case OPT_HEIGHT_OFFSET:
        return take_number("--height-offset", text, -10000, 10000, &c->height_offset_m);
    case OPT_MAX_GAP:
        return take_number("--max-gap", text, 0.001, 1e9, &c->limits.max_gap_s);
    case OPT_MAX_SPEED:
        return take_number("--max-speed", text, 1, 1e9, &c->limits.max_speed_ms);
    case OPT_BEGIN:
        c->has_begin = nav_parse_time(text, &c->begin_us);
        return c->has_begin ? 0 : usage_error("--begin", "a time such as 2020-06-25T08:23:06Z");
    default:
        return hs_error("command line", "see landmass-nav --help",
                        "has an unknown option, or one without its value");
    }
}

/* Returns 0, or -1 when the command line makes no sense (reported), or 1 after --help. */
static int parse_command(struct command *c, int argc, char **argv)
{
    *c = (struct command){.limits = {.max_gap_s = 0, .max_speed_ms = 800 * 1852.0 / 3600.0},
                          .send = {.interface = "can0", .rate_scale = 1}};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "h", long_options, NULL)) != -1;) {
        if (option == 'h') {
            fputs(help_text, stdout);
            return 1;
        }
        if (take_option(c, option, optarg) != 0) {
            return -1;
        }
    }
    if (argc - optind + c->has_circle + c->has_straight != 1) {
        return hs_error("command line", "see landmass-nav --help",
                        "must name exactly one of a track, --circle and --straight");
    }
    c->track_path = argv[optind];
    return 0;
}

static int get_track(const struct command *c, struct nav_track *t, struct nav_reading *r)
{
    if (!c->has_circle && !c->has_straight) {
        r->is_strict = c->is_strict;
        return nav_read_track(c->track_path, c->format, t, r);
    }
    const int64_t noon_us = INT64_C(946728000000000); /* 2000-01-01T12:00:00Z */
    const int64_t begin_us = c->has_begin ? c->begin_us : noon_us;
    const double seconds = c->start_s + (c->seconds > 0 ? c->seconds : 60);
    return c->has_circle ? nav_make_circle(&c->circle, begin_us, seconds, t)
                         : nav_make_straight(&c->straight, begin_us, seconds, t);
}

static void shift_track(const struct command *c, struct nav_track *t)
{
    const int64_t shift_us = c->has_begin ? c->begin_us - t->fix[0].time_us : 0;
    for (size_t i = 0; i < t->count; i++) {
        t->fix[i].time_us += shift_us;
        t->fix[i].height_m += c->height_offset_m;
    }
}

static void set_cut(struct command *c, const struct nav_track *t)
{
    c->send.from_us = t->fix[0].time_us + llround(c->start_s * 1e6);
    c->send.until_us = c->seconds > 0 ? c->send.from_us + llround(c->seconds * 1e6) : INT64_MAX;
}

static void report(const struct command *c, const struct nav_track *t, const struct nav_reading *r,
                   const struct nav_findings *found, const struct nav_sent *sent)
{
    const double per_second = sent->active_s > 0 ? (double)sent->frames / sent->active_s : 0;
    fprintf(stderr, "track: %zu fixes over %.1f s, median interval %.3g s\n", t->count,
            found->span_s, found->median_interval_s);
    fprintf(stderr, "left out: %zu malformed, %zu out of order, %zu without a position\n",
            r->malformed, r->disordered, r->missing);
    fprintf(stderr,
            "kept as they are: %zu gaps (over %g s), %zu jumps (over %.0f m/s), %zu repeated "
            "positions, %zu fixes alone between gaps\n",
            found->gaps, found->max_gap_s, found->jumps, c->limits.max_speed_ms, found->holds,
            found->isolated);
    if (!t->has_height) {
        fputs("height: the track has none; 1038 carries the offset alone\n", stderr);
    } else if (r->is_barometric) {
        fputs(
            "height: barometric altitude, sent as 1038 (GPS height) without correction but "
            "--height-offset\n",
            stderr);
    }
    fprintf(stderr, "sent: %llu frames in %.1f s, %.0f frames/s, bus load %.1f %% at 1 Mbit/s\n",
            (unsigned long long)sent->frames, sent->active_s, per_second, per_second / 8000 * 100);
}

static int write_log(const struct command *c, const struct nav_track *t, struct nav_sent *sent)
{
    if (!c->out_path) {
        if (nav_send(t, &c->send, stdout, sent) != 0 || fflush(stdout) != 0) {
            return hs_error("standard output", "free some space, or read to the end",
                            "cannot be written: %s", strerror(errno));
        }
        return 0;
    }
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, c->out_path) != 0) {
        return -1;
    }
    /* A failed write leaves the stream's error mark, which commit reports. */
    (void)nav_send(t, &c->send, file.stream, sent);
    if (sent->frames == 0) {
        hs_atomic_abort(&file);
        return 0;
    }
    return hs_atomic_commit(&file);
}

static int run(struct command *c, struct nav_track *t)
{
    struct nav_reading reading = {0};
    struct nav_findings found;
    struct nav_sent sent;
    if (c->track_path) {
        hs_input_note(c->track_path);
    }
    if ((c->out_path && hs_output_claim(c->out_path) != 0) || get_track(c, t, &reading) != 0) {
        return -1;
    }
    shift_track(c, t);
    nav_track_complete(t, &c->limits, &found);
    set_cut(c, t);
    if (write_log(c, t, &sent) != 0) {
        return -1;
    }
    if (!c->is_quiet) {
        report(c, t, &reading, &found, &sent);
    }
    if (sent.frames == 0) {
        return hs_error(c->out_path ? c->out_path : "standard output",
                        "choose another --start, --seconds or --max-gap",
                        "not written: no two fixes to send lie in the part asked for");
    }
    return 0;
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-nav");
    struct command c;
    const int parsed = parse_command(&c, argc, argv);
    if (parsed != 0) {
        return parsed > 0 ? HS_EXIT_OK : HS_EXIT_USAGE;
    }
    struct nav_track track = {0};
    const int failed = run(&c, &track);
    nav_track_free(&track);
    return failed ? HS_EXIT_FAILED : HS_EXIT_OK;
}
