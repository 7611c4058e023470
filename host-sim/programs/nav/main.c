/* landmass-nav: a recorded or invented flight as traffic of the avionics bus. */
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/report.h"
#include "nav/route.h"
#include "options.h"
#include "simulator.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a run finds out about its track. */
struct findings {
    struct nav_reading reading;
    struct nav_findings track;
    size_t repeats;
};

static int64_t begin_us(const struct command *c)
{
    const int64_t noon_us = INT64_C(946728000000000); /* 2000-01-01T12:00:00Z */
    return c->has_begin ? c->begin_us : noon_us;
}

static void set_datum(const struct command *c, struct nav_track *t)
{
    t->datum = c->datum == NAV_DATUM_BY_RECORD ? t->datum : c->datum;
}

static int read_route(const struct command *c, struct nav_track *t, struct nav_reading *r)
{
    struct nav_track route = {0};
    r->is_route = true;
    int result = nav_read_track(c->track_path, c->format, &route, r);
    if (result == 0) {
        result = nav_fly_route(&route, c->speed_ms, begin_us(c), t);
    }
    nav_track_free(&route);
    return result;
}

static int get_track(const struct command *c, struct nav_track *t, struct findings *f)
{
    if (!c->has_circle && !c->has_straight) {
        f->reading.is_strict = c->is_strict;
        f->reading.is_datum_given = c->datum != NAV_DATUM_BY_RECORD;
        if (!isnan(c->speed_ms)) {
            return read_route(c, t, &f->reading);
        }
        const int result = nav_read_track(c->track_path, c->format, t, &f->reading);
        f->repeats = result == 0 && !c->keeps_repeats ? nav_track_drop_repeats(t) : 0;
        return result;
    }
    const double seconds = c->start_s + (c->seconds > 0 ? c->seconds : 60);
    return c->has_circle ? nav_make_circle(&c->circle, begin_us(c), seconds, t)
                         : nav_make_straight(&c->straight, begin_us(c), seconds, t);
}

/* Height of the pressure `qnh_hpa` in the standard atmosphere (ICAO Doc 7488, below 11 km): as much
 * lies an altimeter set to 1013.25 hPa too low. */
static double standard_height_m(double qnh_hpa)
{
    return 288.15 / 0.0065 * (1 - pow(qnh_hpa / 1013.25, 0.0065 * 287.05287 / 9.80665));
}

static void shift_track(const struct command *c, struct nav_track *t)
{
    const int64_t shift_us = c->has_begin ? c->begin_us - t->fix[0].time_us : 0;
    const bool is_corrected = t->datum == NAV_DATUM_BAROMETRIC && !isnan(c->qnh_hpa);
    const double raise_m = is_corrected ? -standard_height_m(c->qnh_hpa) : 0;
    for (size_t i = 0; i < t->count; i++) {
        t->fix[i].time_us += shift_us;
        t->fix[i].height_m += c->height_offset_m + raise_m;
    }
}

static void set_cut(struct command *c, const struct nav_track *t)
{
    c->send.from_us = t->fix[0].time_us + llround(c->start_s * 1e6);
    c->send.until_us = c->seconds > 0 ? c->send.from_us + llround(c->seconds * 1e6) : INT64_MAX;
}

static void report_heights(const struct command *c, const struct nav_track *t)
{
    if (!t->has_height) {
        fputs("height: the track has none; 0 and the offset are sent\n", stderr);
    } else if (t->datum == NAV_DATUM_BAROMETRIC && isnan(c->qnh_hpa)) {
        fputs(
            "height: barometric, sent as 320 for a pressure of 1013.25 hPa at sea level; --qnh "
            "corrects it\n",
            stderr);
    } else if (t->datum == NAV_DATUM_BAROMETRIC) {
        fprintf(stderr, "height: barometric, sent as 320, corrected for %g hPa\n", c->qnh_hpa);
    } else {
        fputs(t->datum == NAV_DATUM_SEA_LEVEL ? "height: above mean sea level, sent as 332\n"
                                              : "height: above the ellipsoid, sent as 1038\n",
              stderr);
    }
}

static void report(const struct command *c, const struct nav_track *t, const struct findings *f,
                   const struct nav_sent *sent)
{
    const struct nav_findings *found = &f->track;
    const double per_second = sent->active_s > 0 ? (double)sent->frames / sent->active_s : 0;
    fprintf(stderr, "track: %zu fixes over %.1f s, median interval %.3g s\n", t->count,
            found->span_s, found->median_interval_s);
    fprintf(stderr,
            "left out: %zu malformed, %zu out of order, %zu without a position, %zu repeated in "
            "motion, %zu barometric heights among others\n",
            f->reading.malformed, f->reading.disordered, f->reading.missing, f->repeats,
            f->reading.heights_left_out);
    fprintf(stderr,
            "kept as they are: %zu gaps (over %g s), %zu jumps (over %.0f m/s), %zu repeated "
            "positions, %zu fixes alone between gaps\n",
            found->gaps, found->max_gap_s, found->jumps, c->limits.max_speed_ms, found->holds,
            found->isolated);
    report_heights(c, t);
    fprintf(stderr, "sent: %llu frames in %.1f s, %.0f frames/s, bus load %.1f %% at 1 Mbit/s\n",
            (unsigned long long)sent->frames, sent->active_s, per_second, per_second / 8000 * 100);
}

static const char *datum_name(const struct nav_track *t)
{
    return !t->has_height                     ? NULL
           : t->datum == NAV_DATUM_BAROMETRIC ? "barometric"
           : t->datum == NAV_DATUM_SEA_LEVEL  ? "sea level"
                                              : "ellipsoid";
}

static void report_json(const struct nav_track *t, const struct findings *f,
                        const struct nav_sent *sent)
{
    const struct nav_findings *found = &f->track;
    hs_report_put("fixes", t->count);
    hs_report_put("span_s", found->span_s);
    hs_report_put("median_interval_s", found->median_interval_s);
    hs_report_object("left_out");
    hs_report_put("malformed", f->reading.malformed);
    hs_report_put("out_of_order", f->reading.disordered);
    hs_report_put("without_position", f->reading.missing);
    hs_report_put("repeated_in_motion", f->repeats);
    hs_report_put("barometric_heights", f->reading.heights_left_out);
    hs_report_close();
    hs_report_put("gaps", found->gaps);
    hs_report_put("gap_limit_s", found->max_gap_s);
    hs_report_put("jumps", found->jumps);
    hs_report_put("repeated_positions", found->holds);
    hs_report_put("isolated_fixes", found->isolated);
    hs_report_put("height_datum", datum_name(t));
    hs_report_put("frames", sent->frames);
    hs_report_put("active_s", sent->active_s);
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
    struct findings found = {0};
    struct nav_sent sent;
    if (get_track(c, t, &found) != 0) {
        return -1;
    }
    set_datum(c, t);
    shift_track(c, t);
    nav_track_complete(t, &c->limits, &found.track);
    set_cut(c, t);
    if (write_log(c, t, &sent) != 0) {
        return -1;
    }
    report_json(t, &found, &sent);
    if (!c->is_quiet) {
        report(c, t, &found, &sent);
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
    int exit_code;
    struct nav_track track = {0};
    if (nav_options_read(&c, argc, argv, &exit_code)) {
        const bool is_live = c.flightgear_port > 0 || c.xplane_port > 0;
        const bool has_routes = !c.live_path || nav_live_read(&c.send.live, c.live_path) == 0;
        exit_code = has_routes && (is_live ? nav_fly_simulator(&c) : run(&c, &track)) == 0
                        ? HS_EXIT_OK
                        : HS_EXIT_FAILED;
    }
    nav_track_free(&track);
    return hs_report_end(exit_code);
}
