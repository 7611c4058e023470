/* Text of track files and options: lines and times. */
#ifndef NAV_PARSE_H
#define NAV_PARSE_H

#include <stdbool.h>
#include <stdint.h>

/* Cut the next line off `*text`, without its end (LF or CRLF), or return NULL at the end. */
char *nav_next_line(char **text);

/* "2020-06-25T08:23:06.5Z" (also with a blank for the T, without the Z, or with an offset such as
 * +02:00), or a count since 1970 in seconds, milliseconds (from 1e11) or microseconds (from 1e14).
 */
bool nav_parse_time(const char *text, int64_t *time_us);

#endif
