/* Whole text of a source that does not say how long it is. */
#ifndef NAV_WHOLE_TEXT_H
#define NAV_WHOLE_TEXT_H

#include <stddef.h>
#include <stdint.h>

/* Read up to `bytes` bytes into `to`; returns how many, 0 at the end, below 0 for an error. */
typedef int64_t nav_source_fn(void *context, void *to, size_t bytes);

enum nav_whole { NAV_WHOLE_DONE, NAV_WHOLE_UNREADABLE, NAV_WHOLE_TOO_LARGE };

/* Read a source to its end into `*text`, ending in '\0', `*size` bytes long without it; the caller
 * frees. More than `most` bytes, or than there is memory for, are too large. `*text` is NULL unless
 * done. */
enum nav_whole nav_whole_text(nav_source_fn *read, void *context, size_t most, char **text,
                              size_t *size);

#endif
