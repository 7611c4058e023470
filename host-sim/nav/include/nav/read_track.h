/* Track files: CSV, GPX, IGC and KML, plain or compressed by gzip; KML also as KMZ. */
#ifndef NAV_READ_TRACK_H
#define NAV_READ_TRACK_H

#include "nav/reading.h"

enum nav_format {
    NAV_FORMAT_BY_NAME,
    NAV_FORMAT_CSV,
    NAV_FORMAT_GPX,
    NAV_FORMAT_IGC,
    NAV_FORMAT_KML
};

/* Read the whole of `path` ("-": standard input) and append its fixes to `t`. Returns 0, or -1 with
 * the error reported: unreadable, not such a format, no fix in it, or more bad lines than good. */
int nav_read_track(const char *path, enum nav_format format, struct nav_track *t,
                   struct nav_reading *r);

/* The same for text already in memory; `text[size]` is '\0'. May overwrite the text. */
int nav_read_text(char *text, size_t size, enum nav_format format, struct nav_track *t,
                  struct nav_reading *r);

#endif
