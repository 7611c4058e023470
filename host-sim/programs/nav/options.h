/* Command line of landmass-nav. */
#ifndef NAV_OPTIONS_H
#define NAV_OPTIONS_H

#include "nav/make_track.h"
#include "nav/read_track.h"
#include "nav/send.h"

struct command {
    const char *track_path;
    const char *out_path;  /* NULL: standard output */
    const char *live_path; /* routes of live targets; NULL: none */
    enum nav_format format;
    bool is_strict, is_quiet, has_circle, has_straight, has_begin;
    struct nav_circle circle;
    struct nav_straight straight;
    struct nav_limits limits;
    struct nav_send_options send;
    double start_s, seconds; /* seconds: 0 when not given */
    double height_offset_m;
    double speed_ms; /* fly the points as a route; NAN: as the record's times say */
    double qnh_hpa;  /* NAN: not given */
    enum nav_datum datum;
    bool keeps_repeats;
    int64_t begin_us;
    /* Of a simulator. */
    long flightgear_port, xplane_port; /* 0: not given */
    const char *bind, *can, *from, *ask;
};

/* Returns true to go on. Otherwise *exit_code is an hs_exit: help was printed, or the mistake
 * reported. */
bool nav_options_read(struct command *c, int argc, char **argv, int *exit_code);

#endif
