#include "tile_work.h"

#include <stdlib.h>
#include <string.h>

/* Rays that look back at the radar: their askers are records. */
static void packet_look(const struct trace_tiles *t, struct packet *p, struct trace_bounce *bounce)
{
    const uint32_t blocked = p->rays.count > 0 ? scene_is_blocked(t->scene, &p->rays) : 0;
    for (uint32_t i = 0; i < p->rays.count; i++) {
        bounce->records[p->asker[i]].flags |= blocked >> i & 1 ? TRACE_BLOCKED : 0;
    }
    p->rays.count = 0;
}

/* Flights are asked for column by column: what shares a packet then starts close together, which
 * row by row, across a whole tile, it does not. Embree needs half the time (measured). */
static void put_in_order(const struct trace_tiles *t, struct tile_work *w)
{
    const uint32_t columns = t->sensor.columns;
    memset(w->begins, 0, (columns + 1) * sizeof *w->begins);
    for (uint32_t i = 0; i < w->flight_count; i++) {
        w->begins[w->flights[i].column + 1]++;
    }
    for (uint32_t c = 0; c < columns; c++) {
        w->begins[c + 1] += w->begins[c];
    }
    for (uint32_t i = 0; i < w->flight_count; i++) {
        w->order[w->begins[w->flights[i].column]++] = i;
    }
}

static void meet_flights(const struct trace_tiles *t, struct tile_work *w)
{
    struct packet p = {.rays.count = 0};
    for (uint32_t k = 0; k < w->flight_count; k++) {
        const uint32_t i = w->order[k];
        const struct flight *f = &w->flights[i];
        if (w->next[i] == TILE_NOT_ASKED && packet_add(&p, f->start, f->along, i)) {
            packet_meet(t->scene, &p, w->next);
        }
    }
    packet_meet(t->scene, &p, w->next);
}

/* Where the receiver sees the echo from `at`, and at what angles. `way_m` is that from the
 * transmitter. */
static void see_apart(const struct trace_tiles *t, const struct flight *f, struct vec at,
                      double way_m, struct ray_angles *g)
{
    const struct end_view view = end_view(&t->ends.back, at);
    const double range_m = (way_m + view.way_m) / 2;
    ray_angles_apart(g, f->along, view.along);
    g->record.across_m = (float)((f->across_m + view.across_m) / 2);
    g->record.range_m = (float)range_m;
    g->record.phase_rad = angle_of_turns(range_m * t->turns_per_m);
}

void tile_reflect(const struct trace_tiles *t, const struct flight *f, const struct ray_angles *g,
                  struct trace_bounce *bounce, struct flight *on)
{
    const double hop_m = (g->plane->offset_m - vec_dot(g->plane->normal, f->from)) / g->pace;
    const double across_m = f->across_m, way_m = f->way_m + hop_m;
    const struct vec at = vec_mad(f->from, f->along, hop_m);
    struct trace_record *record = &bounce->records[bounce->count];
    if (t->is_plain) {
        const double range_m = (way_m + vec_dot(at, t->axes.sight)) / 2;
        *record = g->record;
        record->across_m = (float)((across_m + vec_dot(at, t->axes.across)) / 2);
        record->range_m = (float)range_m;
        record->phase_rad = angle_of_turns(range_m * t->turns_per_m);
    } else {
        struct ray_angles seen = *g;
        see_apart(t, f, at, way_m, &seen);
        *record = seen.record;
    }
    record->ray = f->ray;
    record->parent = f->parent;
    record->hop_m = (float)hop_m;
    on->across_m = across_m;
    on->way_m = way_m;
    on->ray = record->ray;
    on->column = f->column;
    on->parent = bounce->count++;
    flight_turn(on, at, g);
}

/* Make records of the flights that met something, and mark their parents. As each goes on, a
 * record and its flight have the same number. */
static void reflect_flights(const struct trace_tiles *t, struct tile_work *w, uint32_t b,
                            struct tile_result *result)
{
    const uint32_t count = w->flight_count;
    struct trace_bounce *bounce = &result->bounces[b];
    w->flight_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct flight *f = &w->flights[i];
        struct ray_angles g;
        if (w->next[i] == SCENE_MISS || !ray_angles_at(t, w->next[i], f->along, b, &g)) {
            continue;
        }
        bounce[-1].records[f->parent].flags |= TRACE_GOES_ON;
        w->next[w->flight_count] = TILE_NOT_ASKED;
        tile_reflect(t, f, &g, bounce, &w->flights[w->flight_count++]);
    }
}

/* Look back at the radar from where each flight starts, as far as its surface faces it. */
static void look_back(const struct trace_tiles *t, const struct tile_work *w,
                      struct trace_bounce *bounce, struct tile_result *result)
{
    struct vec back = vec_scale(t->axes.sight, -1);
    struct packet p = {.rays.count = 0};
    for (uint32_t k = 0; k < w->flight_count; k++) {
        const uint32_t i = w->order[k];
        if (bounce->records[i].flags & TRACE_BLOCKED) {
            continue;
        }
        if (!t->is_plain) {
            back = vec_scale(end_view(&t->ends.back, w->flights[i].from).along, -1);
        }
        result->rays_cast++;
        if (result->baseline) {
            embree_baseline_keep(result->baseline, w->flights[i].start, back, true);
        }
        if (packet_add(&p, w->flights[i].start, back, i)) {
            packet_look(t, &p, bounce);
        }
    }
    packet_look(t, &p, bounce);
}

/* For measurements: the rays that a tracer that drew nothing would have to cast. */
static void keep_primaries(const struct trace_tiles *t, uint32_t index,
                           struct embree_baseline_rays *baseline)
{
    const struct rows rows = rows_of(t, index);
    for (uint32_t column = 0; column < t->sensor.columns; column++) {
        for (uint32_t row = rows.first; row < rows.end; row++) {
            embree_baseline_keep(baseline, primary_start(t, column, row), t->axes.sight, false);
        }
    }
}

static void keep_flights(const struct tile_work *w, struct embree_baseline_rays *baseline)
{
    for (uint32_t k = 0; k < w->flight_count; k++) {
        const struct flight *f = &w->flights[w->order[k]];
        embree_baseline_keep(baseline, f->start, f->along, false);
    }
}

void trace_tile(const struct trace_tiles *t, uint32_t index, struct tile_work *work,
                struct tile_result *result)
{
    const struct rows rows = rows_of(t, index);
    first_bounce(t, index, work, result);
    put_in_order(t, work);
    if (t->is_apart) {
        look_back(t, work, &result->bounces[0], result);
    }
    if (result->baseline) {
        keep_primaries(t, index, result->baseline);
    }
    for (uint32_t b = 1; b < t->bounces && work->flight_count > 0; b++) {
        if (result->baseline) {
            keep_flights(work, result->baseline);
        }
        meet_flights(t, work);
        reflect_flights(t, work, b, result);
        put_in_order(t, work);
        look_back(t, work, &result->bounces[b], result);
    }
    result->rays_cast += (rows.end - rows.first) * t->sensor.columns;
    for (uint32_t b = 1; b < t->bounces; b++) {
        result->rays_cast += result->bounces[b - 1].count;
    }
}

static int open_projections(struct trace_tiles *t)
{
    const struct scene *s = t->scene;
    return projection_open(&t->model, s, &t->axes, &t->sensor, t->tile_rows, TILE_GRAZING_COS,
                           false) == 0 &&
                   (s->ground_half_m <= 0 ||
                    projection_open(&t->mirror, s, &t->axes, &t->sensor, t->tile_rows,
                                    TILE_GRAZING_COS, true) == 0)
               ? 0
               : -1;
}

int trace_tiles_open(struct trace_tiles *t, const struct scene *scene,
                     const struct trace_order *order)
{
    *t = (struct trace_tiles){
        .scene = scene,
        .axes = trace_axes_of(&order->look),
        .sensor = trace_sensor_for(scene, order),
        .clear_m = fmax(vec_length(scene->low), vec_length(scene->high)) + 1,
        .turns_per_m = -2 / order->look.wavelength_m,
        .ends = ends_of(&order->look, &order->ends, order->look.azimuth_deg),
        .is_plain = ends_are_plain(&order->ends),
        .is_apart = order->ends.is_apart,
        .bounces = order->bounces,
    };
    const uint32_t columns = t->sensor.columns, rows = t->sensor.rows;
    t->tile_rows = columns < TILE_RAYS ? TILE_RAYS / columns : 1;
    t->tile_rays = t->tile_rows * columns;
    t->tile_count = (rows + t->tile_rows - 1) / t->tile_rows;
    t->is_drawn = t->is_plain && !order->casts_all && scene->triangle_count < columns * rows;
    if (t->is_drawn && open_projections(t) != 0) {
        trace_tiles_close(t);
        return -1;
    }
    return 0;
}

void trace_tiles_close(struct trace_tiles *t)
{
    projection_close(&t->model);
    projection_close(&t->mirror);
    *t = (struct trace_tiles){0};
}

struct tile_work *tile_work_new(const struct trace_tiles *t)
{
    struct tile_work *w = calloc(1, sizeof *w);
    if (!w) {
        return NULL;
    }
    w->facets = malloc(t->tile_rays * sizeof *w->facets);
    w->mirrored = malloc(t->tile_rays * sizeof *w->mirrored);
    w->depths_m = malloc(t->tile_rays * sizeof *w->depths_m);
    w->near_m = malloc(t->tile_rows * sizeof *w->near_m);
    w->flights = malloc(t->tile_rays * sizeof *w->flights);
    w->next = malloc(t->tile_rays * sizeof *w->next);
    w->order = malloc(t->tile_rays * sizeof *w->order);
    w->begins = malloc((t->sensor.columns + 1) * sizeof *w->begins);
    if (!w->facets || !w->mirrored || !w->depths_m || !w->near_m || !w->flights || !w->next ||
        !w->order || !w->begins) {
        tile_work_free(w);
        return NULL;
    }
    return w;
}

void tile_work_free(struct tile_work *w)
{
    if (w) {
        free(w->facets);
        free(w->mirrored);
        free(w->depths_m);
        free(w->near_m);
        free(w->flights);
        free(w->next);
        free(w->order);
        free(w->begins);
    }
    free(w);
}
