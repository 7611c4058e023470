/* Rays as Embree takes them, kept to be cast again by nothing but Embree: what the tracer is
 * measured against. */
#ifndef TARGET_BARE_H
#define TARGET_BARE_H

#include "scene.h"

#include <stdbool.h>
#include <stddef.h>

struct bare_packet;

struct bare_rays {
    struct bare_packet *packets; /* owned */
    size_t count, room;
    bool is_out_of_memory;
};

/* Keep the rays, and whether what they meet is asked for or only if they meet anything. */
void bare_keep(struct bare_rays *b, const struct scene_rays *rays, bool is_shadow);

/* Cast packets first..end - 1 again. Returns how many rays met something. */
size_t bare_cast(const struct scene *s, const struct bare_rays *b, size_t first, size_t end);

void bare_free(struct bare_rays *b);

#endif
