#include "tile_work.h"

static bool is_on_ground(const struct trace_tiles *t, struct vec middle, uint32_t column)
{
    const double across_m = across_of(t, column), half_m = t->scene->ground_half_m;
    return half_m > 0 && fabs(middle.x + across_m * t->axes.across.x) <= half_m &&
           fabs(middle.y + across_m * t->axes.across.y) <= half_m;
}

/* A row of rays before the model is drawn over it: they meet the ground as far as it reaches. */
static void lay_ground(const struct trace_tiles *t, uint32_t row, float *depths_m, uint32_t *facets)
{
    const uint32_t columns = t->sensor.columns;
    const double depth_m = ground_depth_m(t, row);
    const struct vec middle =
        vec_mad(vec_scale(t->axes.rise, up_of(t, row)), t->axes.sight, depth_m);
    /* The ground is convex. */
    const bool is_whole = is_on_ground(t, middle, 0) && is_on_ground(t, middle, columns - 1);
    for (uint32_t column = 0; column < columns; column++) {
        const bool is_met = is_whole || is_on_ground(t, middle, column);
        depths_m[column] = is_met ? (float)depth_m : INFINITY;
        facets[column] = is_met ? t->scene->triangle_count : SCENE_MISS;
    }
}

/* A primary ray of ends that are not plain starts outside the model and above the ground, but not
 * behind the transmitter. Far from the model single precision would lose its place. */
static bool add_apart(const struct trace_tiles *t, struct packet *p, uint32_t column, uint32_t row,
                      uint32_t asker)
{
    const struct ends_primary ray = primary_apart(t, column, row);
    const double far_m = t->ends.out.distance_m;
    const double most_m = far_m > 0 ? far_m + ray.way_m : INFINITY;
    double back_m = t->clear_m + fmax(vec_dot(ray.from, ray.along), 0);
    if (ray.from.z < 0 && ray.along.z < 0) {
        back_m += ray.from.z / ray.along.z;
    }
    return packet_add(p, vec_mad(ray.from, ray.along, -fmin(back_m, most_m)), ray.along, asker);
}

/* What each primary ray of the tile meets, asked of Embree. */
static void cast_primaries(const struct trace_tiles *t, uint32_t index, struct tile_work *w)
{
    const struct rows rows = rows_of(t, index);
    const uint32_t columns = t->sensor.columns;
    struct packet p = {.rays.count = 0};
    for (uint32_t column = 0; column < columns; column++) {
        for (uint32_t row = rows.first; row < rows.end; row++) {
            const uint32_t at = (row - rows.first) * columns + column;
            w->mirrored[at] = TILE_NOT_ASKED;
            const bool is_full =
                t->is_plain ? packet_add(&p, primary_start(t, column, row), t->axes.sight, at)
                            : add_apart(t, &p, column, row, at);
            if (is_full) {
                packet_meet(t->scene, &p, w->facets);
            }
        }
    }
    packet_meet(t->scene, &p, w->facets);
}

/* What each primary ray of the tile meets, and what it would meet after the ground, without Embree.
 */
static void draw_primaries(const struct trace_tiles *t, uint32_t index, struct tile_work *w)
{
    const struct rows rows = rows_of(t, index);
    const uint32_t columns = t->sensor.columns, rays = (rows.end - rows.first) * columns;
    for (uint32_t row = rows.first; row < rows.end; row++) {
        const size_t at = (size_t)(row - rows.first) * columns;
        w->near_m[row - rows.first] = -INFINITY;
        lay_ground(t, row, w->depths_m + at, w->facets + at);
    }
    projection_draw(&t->model, index, w->near_m, w->depths_m, w->facets);
    for (uint32_t row = rows.first; row < rows.end; row++) {
        w->near_m[row - rows.first] =
            (float)(ground_depth_m(t, row) - TILE_LIFT_M / t->axes.sight.z);
    }
    for (uint32_t i = 0; i < rays; i++) {
        w->depths_m[i] = INFINITY;
        w->mirrored[i] = SCENE_MISS;
    }
    if (t->scene->ground_half_m > 0) {
        projection_draw(&t->mirror, index, w->near_m, w->depths_m, w->mirrored);
    }
}

/* How deep a facet lies along a row of primary rays. As they are square to the plane, way, range
 * and depth of an echo are one. */
struct depth {
    double start_m, per_metre; /* across */
};

static struct depth depth_along(const struct ray_angles *g, const struct trace_axes *axes,
                                struct vec middle)
{
    return (struct depth){
        (g->plane->offset_m - vec_dot(g->plane->normal, middle)) / g->pace,
        -vec_dot(g->plane->normal, axes->across) / g->pace,
    };
}

static void set_depth(struct trace_record *record, double depth_m, double turns_per_m)
{
    record->range_m = record->hop_m = (float)depth_m;
    record->phase_rad = angle_of_turns(depth_m * turns_per_m);
}

/* Make the records of the first bounce in a row, and flights of what may meet something. Along the
 * ground, and walls square to the radar, only `across_m` differs. */
static void reflect_row(const struct trace_tiles *t, uint32_t row, const uint32_t *facets,
                        const uint32_t *mirrored, struct tile_work *w, struct tile_result *result)
{
    struct trace_bounce *bounce = &result->bounces[0];
    const struct vec middle = vec_scale(t->axes.rise, up_of(t, row));
    struct ray_angles g = {0};
    struct depth depth = {0, 0};
    uint32_t glanced = SCENE_MISS;
    bool is_met = false;
    for (uint32_t column = 0; column < t->sensor.columns; column++) {
        const uint32_t facet = facets[column];
        if (facet != glanced) {
            glanced = facet;
            is_met = facet != SCENE_MISS && ray_angles_at(t, facet, t->axes.sight, 0, &g);
            depth = is_met ? depth_along(&g, &t->axes, middle) : depth;
            set_depth(&g.record, depth.start_m, t->turns_per_m);
        }
        if (!is_met) {
            continue;
        }
        const double across_m = across_of(t, column);
        const double depth_m = depth.start_m + across_m * depth.per_metre;
        struct trace_record *record = &bounce->records[bounce->count];
        *record = g.record;
        record->ray = row * t->sensor.columns + column;
        record->across_m = (float)across_m;
        if (depth.per_metre != 0) {
            set_depth(record, depth_m, t->turns_per_m);
        }
        const uint32_t next = facet < t->scene->triangle_count ? TILE_NOT_ASKED : mirrored[column];
        if (next != SCENE_MISS || result->baseline) {
            const struct vec on_plane = vec_mad(middle, t->axes.across, across_m);
            w->next[w->flight_count] = next;
            struct flight *f = &w->flights[w->flight_count++];
            f->across_m = across_m;
            f->way_m = depth_m;
            f->ray = record->ray;
            f->column = column;
            f->parent = bounce->count;
            flight_turn(f, vec_mad(on_plane, t->axes.sight, depth_m), &g);
        }
        bounce->count++;
    }
}

/* Likewise, for ends that are not plain: nothing is alike along a row. Each record has its flight,
 * of the same number. */
static void reflect_row_apart(const struct trace_tiles *t, uint32_t row, const uint32_t *facets,
                              struct tile_work *w, struct trace_bounce *bounce)
{
    for (uint32_t column = 0; column < t->sensor.columns; column++) {
        const struct ends_primary ray = primary_apart(t, column, row);
        struct ray_angles g = {0};
        if (facets[column] == SCENE_MISS || !ray_angles_at(t, facets[column], ray.along, 0, &g)) {
            continue;
        }
        const struct flight f = {
            .from = ray.from,
            .along = ray.along,
            .across_m = ray.across_m,
            .way_m = ray.way_m,
            .ray = row * t->sensor.columns + column,
            .column = column,
        };
        w->next[w->flight_count] = TILE_NOT_ASKED;
        tile_reflect(t, &f, &g, bounce, &w->flights[w->flight_count++]);
    }
}

void first_bounce(const struct trace_tiles *t, uint32_t index, struct tile_work *w,
                  struct tile_result *result)
{
    const struct rows rows = rows_of(t, index);
    w->flight_count = 0;
    if (t->is_drawn) {
        draw_primaries(t, index, w);
    } else {
        cast_primaries(t, index, w);
    }
    for (uint32_t row = rows.first; row < rows.end; row++) {
        const size_t at = (size_t)(row - rows.first) * t->sensor.columns;
        if (t->is_plain) {
            reflect_row(t, row, w->facets + at, w->mirrored + at, w, result);
        } else {
            reflect_row_apart(t, row, w->facets + at, w, &result->bounces[0]);
        }
    }
}
