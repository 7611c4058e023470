/* All rays of a picture as Embree takes them, kept to be cast by nothing but Embree: what the
 * tracer is measured against. */
#ifndef TARGET_BARE_H
#define TARGET_BARE_H

#include "scene.h"

#include <stdbool.h>
#include <stddef.h>

struct bare_packet;

struct bare_rays {
    struct scene_rays pending[2]; /* not yet a packet: rays, and those that look back */
    struct bare_packet *packets;  /* owned */
    size_t count, room;
    bool is_out_of_memory;
};

/* Keep a ray, and whether what it meets is asked for or only if it meets anything. Packets fill up
 * with rays of one kind as they come; the last ones wait for bare_flush. */
void bare_keep(struct bare_rays *b, struct vec from, struct vec along, bool is_shadow);
void bare_flush(struct bare_rays *b);

/* Cast packets first..end - 1 again. Returns how many rays met something. */
size_t bare_cast(const struct scene *s, const struct bare_rays *b, size_t first, size_t end);

void bare_free(struct bare_rays *b);

#endif
