/* Tracks from texts in memory, read without a word. */
#ifndef TEST_READ_TEXT_H
#define TEST_READ_TEXT_H

#include "nav/read_track.h"

struct result {
    struct nav_track track; /* the caller frees */
    struct nav_reading reading;
    int status;
};

struct result read_with(struct nav_reading reading, enum nav_format format, const char *text);
struct result read_as(enum nav_format format, bool is_strict, const char *text);
/* Points as a route, in the order of the file, whatever their times. */
struct result read_route(enum nav_format format, const char *text);
/* The same for a file. */
struct result read_file(struct nav_reading reading, const char *path);

void assert_near(double is, double wanted, double tolerance);

#endif
