/* Reading of a track file: which fixes are accepted, and what becomes of lines that cannot be
 * used. */
#ifndef NAV_READING_H
#define NAV_READING_H

#include "nav/track.h"

enum { NAV_WARNINGS_SHOWN = 5 };

/* Result of a reading. A line that is malformed or not later than the one before is left out,
 * counted, and (the first NAV_WARNINGS_SHOWN) warned about with its line number. */
struct nav_reading {
    const char *name;    /* for messages; borrowed */
    bool is_strict;      /* the first such line is an error instead */
    size_t malformed;    /* lines that cannot be read as a fix */
    size_t disordered;   /* fixes not later than the one before */
    size_t missing;      /* lines that honestly say that there was no fix */
    bool is_route;       /* read the points of a route or a track without their times: time_us is
                            0, and nav_fly_route gives the flight */
    bool is_datum_given; /* the user says what heights are measured from: KML's are taken even
                            where the file says that they are above the ground */
    size_t heights_left_out; /* barometric ones among others */
};

/* Warn about a line that cannot be used, in printf's manner; the caller counts it. Returns 0, or -1
 * when strict. */
int nav_bad_line(struct nav_reading *r, long line, const char *cause, ...)
    __attribute__((format(printf, 3, 4)));

/* Append a fix after checking its ranges and order. Returns 0 also when the fix was left out, or -1
 * with the error reported: strict, or no memory. */
int nav_accept(struct nav_track *t, struct nav_reading *r, const struct nav_fix *fix, long line);

#endif
