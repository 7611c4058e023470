/* Tracks from files: CSV, GPX and IGC, plain or compressed by gzip. */
#ifndef NAV_READ_TRACK_H
#define NAV_READ_TRACK_H

#include "nav/track.h"

enum nav_format { NAV_FORMAT_BY_NAME, NAV_FORMAT_CSV, NAV_FORMAT_GPX, NAV_FORMAT_IGC };

/* How the reading went. A line that is malformed or not later than the one before is left out,
 * counted, and (the first few) warned about with its line number. */
struct nav_reading {
    const char *name;   /* for messages; borrowed */
    bool is_strict;     /* the first such line is an error instead */
    size_t malformed;   /* lines that cannot be read as a fix */
    size_t disordered;  /* fixes not later than the one before */
    size_t missing;     /* lines that honestly say that there was no fix */
    bool is_barometric; /* heights come from a barometric altitude */
};

/* Read the whole of `path` ("-": standard input) and append its fixes to `t`. Returns 0, or -1 with
 * the error reported: unreadable, not such a format, no fix in it, or more bad lines than good. */
int nav_read_track(const char *path, enum nav_format format, struct nav_track *t,
                   struct nav_reading *r);

/* The same for text already in memory; `text[size]` is '\0'. May overwrite the text. */
int nav_read_text(char *text, size_t size, enum nav_format format, struct nav_track *t,
                  struct nav_reading *r);

/* The three formats; for nav_read_text, which judges the whole. 0, or -1 with the error reported.
 */
int nav_read_csv(char *text, struct nav_track *t, struct nav_reading *r);
int nav_read_gpx(const char *text, size_t size, struct nav_track *t, struct nav_reading *r);
int nav_read_igc(char *text, struct nav_track *t, struct nav_reading *r);

/* Shared by them: count (and warn about) a line that cannot be used, in printf's manner. Returns 0,
 * or -1 when strict. */
int nav_bad_line(struct nav_reading *r, long line, const char *cause, ...)
    __attribute__((format(printf, 3, 4)));

/* Append a fix after checking its ranges and order. Returns 0 also when the fix was left out. */
int nav_accept(struct nav_track *t, struct nav_reading *r, const struct nav_fix *fix, long line);

/* Cut the next line off `*text`, without its end (LF or CRLF), or return NULL at the end. */
char *nav_next_line(char **text);

/* A number filling the whole of `text` but for blanks. False when it is not one or not finite. */
bool nav_parse_number(const char *text, double *value);

/* "2020-06-25T08:23:06.5Z" (also with a blank for the T, without the Z, or with an offset such as
 * +02:00), or a count since 1970 in seconds, milliseconds (from 1e11) or microseconds (from 1e14).
 */
bool nav_parse_time(const char *text, int64_t *time_us);

#endif
