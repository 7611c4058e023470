/* A tile of primary rays, followed through all their bounces by one thread. */
#ifndef TARGET_TRACE_TILE_H
#define TARGET_TRACE_TILE_H

#include "bare.h"
#include "records.h"
#include "scene.h"
#include "trace.h"

enum { TILE_RAYS = 1024 };

struct trace_tiles {
    const struct scene *scene;
    struct trace_axes axes;
    struct trace_sensor sensor;
    double turns_per_m; /* of the echo's phase, by range: -2 / wavelength */
    uint32_t bounces;
};

/* What becomes of a tile. The caller lends room for TILE_RAYS records of each bounce; `parent`
 * counts from the tile's first record of the bounce before. */
struct tile_result {
    struct trace_bounce bounces[TRACE_BOUNCES_MAX]; /* records: borrowed */
    uint64_t rays_cast;
    struct bare_rays *bare; /* borrowed, NULL but for measurements: keeps every ray cast */
};

/* Trace rays index * TILE_RAYS and the next TILE_RAYS - 1, as far as there are any. */
void trace_tile(const struct trace_tiles *t, uint32_t index, struct tile_result *result);

#endif
