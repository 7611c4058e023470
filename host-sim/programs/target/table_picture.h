/* Table picture: traced records as [Niu]'s Table I shows them. */
#ifndef TARGET_TABLE_PICTURE_H
#define TARGET_TABLE_PICTURE_H

#include "tracer/records.h"

/* Draw the channels of a bounce (0-based) as pictures of the plane that sent the rays, each from
 * its own least (black) to its largest number (white); blue where a ray has no such reflection.
 * Returns 0, or -1 with the error reported. */
int table_picture(const struct trace_records *r, uint32_t bounce, const char *path);

#endif
