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
    double wavelength_m;
    uint32_t bounces;
};

struct tile_result {
    struct trace_bounce bounces[TRACE_BOUNCES_MAX]; /* parents count from the tile's first record */
    uint32_t first[TRACE_BOUNCES_MAX];              /* where they begin among those of all tiles */
    uint64_t rays_cast;
    struct bare_rays *bare; /* borrowed, NULL but for measurements: keeps every ray cast */
    bool is_out_of_memory;
};

/* Trace rays index * TILE_RAYS and the next TILE_RAYS - 1, as far as there are any. */
void trace_tile(const struct trace_tiles *t, uint32_t index, struct tile_result *result);

void tile_result_free(struct tile_result *result);

#endif
