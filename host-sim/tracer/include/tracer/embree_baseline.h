/* Embree baseline: all rays of a picture, kept to be cast by Embree alone. The tracer's speed is
 * measured against it. */
#ifndef TRACER_EMBREE_BASELINE_H
#define TRACER_EMBREE_BASELINE_H

#include "tracer/scene.h"

#include <stdbool.h>
#include <stddef.h>

struct embree_baseline_packet;

struct embree_baseline_rays {
    struct scene_rays pending[2];           /* not yet a packet: rays, and those that look back */
    struct embree_baseline_packet *packets; /* owned */
    size_t count, room;
    bool is_out_of_memory;
};

/* Keep a ray, and whether what it meets is asked for or only if it meets anything. Packets fill up
 * with rays of one kind as they come; the last ones wait for embree_baseline_flush. */
void embree_baseline_keep(struct embree_baseline_rays *b, struct vec from, struct vec along,
                          bool is_shadow);
void embree_baseline_flush(struct embree_baseline_rays *b);

/* Cast packets first..end - 1 again. Returns how many rays met something. */
size_t embree_baseline_cast(const struct scene *s, const struct embree_baseline_rays *b,
                            size_t first, size_t end);

/* Harmless on a zeroed struct. */
void embree_baseline_free(struct embree_baseline_rays *b);

#endif
