/* Tile of primary rays, followed through all their bounces by one thread. */
#ifndef TRACER_TRACE_TILE_H
#define TRACER_TRACE_TILE_H

#include "tracer/embree_baseline.h"
#include "tracer/ends.h"
#include "tracer/projection.h"
#include "tracer/records.h"
#include "tracer/scene.h"
#include "tracer/sensor.h"

/* A tile is as many whole rows of the sensor as have about so many rays, at least one. */
enum { TILE_RAYS = 4096 };

struct trace_tiles {
    const struct scene *scene; /* borrowed */
    struct trace_axes axes;
    struct trace_sensor sensor;
    struct ends ends; /* in the model's axes */
    bool is_plain;    /* one radar, far away */
    bool is_apart;    /* even after the first reflection the way back may be blocked */
    /* Primary rays are drawn, not cast, unless the model has more triangles than there are rays. */
    bool is_drawn;
    struct projection model, mirror; /* owned; a strip of each is a tile */
    double clear_m;                  /* nothing of the model is further from the origin */
    double turns_per_m;              /* of the echo's phase, by range: -2 / wavelength */
    uint32_t bounces, tile_rows, tile_rays, tile_count;
};

/* What becomes of a tile. The caller lends room for tile_rays records of each bounce; `parent`
 * counts from the tile's first record of the bounce before. */
struct tile_result {
    struct trace_bounce bounces[TRACE_BOUNCES_MAX]; /* records: borrowed */
    uint64_t rays_cast;
    struct embree_baseline_rays
        *baseline; /* borrowed, NULL but for measurements: keeps every ray */
};

/* Returns 0, or -1 out of memory with *t empty. */
int trace_tiles_open(struct trace_tiles *t, const struct scene *scene,
                     const struct trace_order *order);
void trace_tiles_close(struct trace_tiles *t);

/* Scratch of one thread, for any number of tiles. NULL out of memory. */
struct tile_work *tile_work_new(const struct trace_tiles *t);
void tile_work_free(struct tile_work *work);

/* Trace the rays from index * tile_rays on: tile_rays of them, or those that are left. */
void trace_tile(const struct trace_tiles *t, uint32_t index, struct tile_work *work,
                struct tile_result *result);

#endif
