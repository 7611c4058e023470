/* Tile work: what the parts of the tracer share, that is a tile's scratch memory, the rays under
 * way in it, and the events at a reflection. */
#ifndef TRACER_TILE_WORK_H
#define TRACER_TILE_WORK_H

#include "tracer/trace_tile.h"

/* New rays start this far off the surface, so that they do not meet it again. It is a hundred times
 * the rounding of Embree's single precision 10 m from the centre. */
#define TILE_LIFT_M 1e-4

/* A surface seen more edge-on than this is taken for missed: where single precision says that the
 * ray meets it and where its plane is met could differ by centimetres. */
#define TILE_GRAZING_COS 2e-4

/* Of a flight of which nobody has asked yet what it meets. */
#define TILE_NOT_ASKED (SCENE_MISS - 1)

/* Flight: a ray that has not ended. */
struct flight {
    struct vec from, along;
    struct vec start; /* `from`, lifted off its surface: where Embree's ray begins */
    double across_m;  /* where its primary ray left the plane */
    double way_m;     /* from the plane through the origin to `from` */
    uint32_t ray, column, parent;
};

/* By ray: what it meets, how far away; and what it meets when the ground has reflected it. Then the
 * flights that go on. */
struct tile_work {
    uint32_t *facets, *mirrored; /* owned */
    float *depths_m, *near_m;    /* owned; the latter by row */
    struct flight *flights;      /* owned */
    uint32_t *next;              /* owned: what each flight meets, SCENE_MISS or TILE_NOT_ASKED */
    uint32_t *order, *begins;    /* owned: flights column by column, and where each begins */
    uint32_t flight_count;
};

/* Rays that are asked together, and for whom. */
struct packet {
    struct scene_rays rays;
    uint32_t asker[SCENE_PACKET];
};

/* Add a ray to the packet. True if the packet is then full. */
static inline bool packet_add(struct packet *p, struct vec from, struct vec along, uint32_t asker)
{
    p->asker[p->rays.count] = asker;
    scene_rays_add(&p->rays, from, along);
    return p->rays.count == SCENE_PACKET;
}

/* Ask what each ray meets: facets[asker]. Leaves the packet empty. */
static inline void packet_meet(const struct scene *s, struct packet *p, uint32_t *facets)
{
    uint32_t met[SCENE_PACKET];
    if (p->rays.count > 0) {
        scene_meet(s, &p->rays, met);
    }
    for (uint32_t i = 0; i < p->rays.count; i++) {
        facets[p->asker[i]] = met[i];
    }
    p->rays.count = 0;
}

/* An angle of so many turns, without the whole ones. */
static inline float angle_of_turns(double turns)
{
    return (float)(2 * 3.14159265358979323846 * (turns - (double)lrint(turns)));
}

/* Angles of a reflection: what depends on its plane and the ray's direction alone. Neighbours share
 * them. */
struct ray_angles {
    const struct scene_facet *plane;
    struct vec normal, along;   /* on the side that the ray comes from; of the specular ray */
    double pace;                /* of the way, along the plane's normal: -1..1 */
    struct trace_record record; /* angles, material and flags */
};

/* Returns false when the facet is too edge-on. `bounce` counts from 0. */
bool ray_angles_at(const struct trace_tiles *t, uint32_t facet, struct vec along, uint32_t bounce,
                   struct ray_angles *g);

/* The same, where the receiver sees the reflection along `seen`. */
void ray_angles_apart(struct ray_angles *g, struct vec along, struct vec seen);

/* Let the specular ray go on from `at`. */
static inline void flight_turn(struct flight *f, struct vec at, const struct ray_angles *g)
{
    f->from = at;
    f->start = vec_mad(at, g->normal, TILE_LIFT_M);
    f->along = g->along;
}

/* Rows first..end - 1 of the sensor are a tile. */
struct rows {
    uint32_t first, end;
};

static inline struct rows rows_of(const struct trace_tiles *t, uint32_t index)
{
    const uint32_t first = index * t->tile_rows, end = first + t->tile_rows;
    return (struct rows){first, end < t->sensor.rows ? end : t->sensor.rows};
}

static inline double across_of(const struct trace_tiles *t, uint32_t column)
{
    return t->sensor.low_across_m + (column + 0.5) * t->sensor.step_across_m;
}

static inline double up_of(const struct trace_tiles *t, uint32_t row)
{
    return t->sensor.low_up_m + (row + 0.5) * t->sensor.step_up_m;
}

/* From the plane to the ground: the same all along a row. */
static inline double ground_depth_m(const struct trace_tiles *t, uint32_t row)
{
    return -up_of(t, row) * t->axes.rise.z / t->axes.sight.z;
}

/* Start of a primary ray: outside the model, and above the ground where the plane dips below it. */
static inline struct vec primary_start(const struct trace_tiles *t, uint32_t column, uint32_t row)
{
    const struct vec on_plane =
        vec_mad(vec_scale(t->axes.rise, up_of(t, row)), t->axes.across, across_of(t, column));
    const double below_m = ground_depth_m(t, row) < 0 ? -ground_depth_m(t, row) : 0;
    return vec_mad(on_plane, t->axes.sight, -t->clear_m - below_m);
}

/* Record the reflection of flight `f`, and make its specular ray, which may be at the same place.
 */
void tile_reflect(const struct trace_tiles *t, const struct flight *f, const struct ray_angles *g,
                  struct trace_bounce *bounce, struct flight *on);

/* Primary ray of ends that are not plain. */
static inline struct ends_primary primary_apart(const struct trace_tiles *t, uint32_t column,
                                                uint32_t row)
{
    return ends_primary(&t->ends, across_of(t, column), up_of(t, row));
}

/* Find what the tile's primary rays meet, make the records of their reflections, and flights of the
 * rays that may meet something else; for measurements, of all. */
void first_bounce(const struct trace_tiles *t, uint32_t index, struct tile_work *w,
                  struct tile_result *result);

#endif
