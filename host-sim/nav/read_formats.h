/* Readers of the formats of track files. Each appends the fixes of a text to `t`; the text
 * may be overwritten. nav_read_text judges the whole.
 *
 * Returns 0, or -1 with the error reported: not such a format, a bad line while `is_strict`, or no
 * memory. */
#ifndef NAV_READ_FORMATS_H
#define NAV_READ_FORMATS_H

#include "nav/reading.h"

int nav_read_csv(char *text, struct nav_track *t, struct nav_reading *r);
int nav_read_gpx(const char *text, size_t size, struct nav_track *t, struct nav_reading *r);
int nav_read_igc(char *text, struct nav_track *t, struct nav_reading *r);
int nav_read_kml(const char *text, size_t size, struct nav_track *t, struct nav_reading *r);

/* Is it an archive, as KMZ is? */
bool nav_is_kmz(const char *bytes, size_t size);

/* The KML text within a KMZ archive, ending in '\0'; the caller frees. NULL, with the error
 * reported, for a damaged archive, one without KML, and one whose KML is above 256 MiB. */
char *nav_unpack_kmz(const char *bytes, size_t size, const char *name, size_t *text_size);

#endif
