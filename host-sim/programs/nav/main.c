/* landmass-nav: a recorded or invented flight as traffic of the avionics bus. */
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    if (get_track(c, t, &reading) != 0) {
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
    int exit_code;
    if (!nav_options_read(&c, argc, argv, &exit_code)) {
        return exit_code;
    }
    struct nav_track track = {0};
    const int failed = run(&c, &track);
    nav_track_free(&track);
    return failed ? HS_EXIT_FAILED : HS_EXIT_OK;
}
