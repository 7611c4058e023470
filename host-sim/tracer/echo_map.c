#include "tracer/echo_map.h"

#include "hs/error.h"
#include "tracer/ends.h"
#include "tracer/mesh_audit.h"
#include "tracer/sensor.h"

#include <stdlib.h>

static const double step_off_m = 1e-3; /* from a facet, to look at it */

/* The strongest ray of a cell so far, and sums over its rays. */
struct sums {
    const struct trace_record *record;
    uint32_t bounce;
    double height, square;
};

struct maker {
    const struct trace_records *records;
    const struct reflect_law *law;
    struct echo_cell *cells;
    struct sums *sums;
};

static void add_echo(const struct maker *m, uint32_t b, const struct trace_record *t, double power)
{
    const int32_t place =
        t->flags & TRACE_BLOCKED ? -1 : trace_cell(&m->records->grid, t->across_m, t->range_m);
    if (place < 0 || !(power > 0)) {
        return;
    }
    struct echo_cell *cell = &m->cells[place];
    struct sums *sums = &m->sums[place];
    const double height_m = origin_of(m->records, b, t).height_m;
    cell->power_m2 += power;
    sums->height += power * height_m;
    sums->square += power * height_m * height_m;
    if (power > cell->strongest) {
        cell->strongest = power;
        cell->reflections = b + 1;
        sums->record = t;
        sums->bounce = b;
    }
}

static int add_all(const struct maker *m)
{
    const struct trace_records *r = m->records;
    double *in = NULL;
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        double *out = malloc((r->bounces[b].count + 1) * sizeof *out);
        for (uint32_t i = 0; out && i < r->bounces[b].count; i++) {
            const struct trace_record *t = &r->bounces[b].records[i];
            const struct reflect_shares s = reflect_record(m->law, t);
            const double arriving = in ? in[t->parent] : 1;
            out[i] = arriving * (double)s.specular;
            add_echo(m, b, t, arriving * (double)s.back * ends_echo_m2(r, b, t));
        }
        free(in);
        in = out;
        if (!out) {
            return -1;
        }
    }
    free(in);
    return 0;
}

/* Across, away, up to the model's axes. */
static struct vec to_model(const struct trace_axes *axes, struct vec v)
{
    const struct vec level = vec_add(vec_scale(axes->across, v.x), vec_scale(axes->away, v.y));
    return (struct vec){level.x, level.y, v.z};
}

/* The facet at a place: what a ray meets that comes down its normal. */
static int32_t facet_at(const struct scene *s, const struct trace_axes *axes, struct vec place,
                        const struct trace_record *t)
{
    const struct vec n = {(double)t->normal[0], (double)t->normal[1], (double)t->normal[2]};
    const struct vec normal = to_model(axes, n);
    uint32_t facets[SCENE_PACKET];
    struct scene_rays ray = {.count = 0};
    scene_rays_add(&ray, vec_mad(to_model(axes, place), normal, step_off_m), vec_scale(normal, -1));
    scene_meet(s, &ray, facets);
    if (facets[0] == SCENE_MISS) {
        return ECHO_MAP_UNKNOWN;
    }
    return facets[0] < s->triangle_count ? (int32_t)facets[0] : ECHO_MAP_GROUND;
}

static void name_facets(const struct maker *m, const struct scene *s, const int32_t *part_of,
                        struct echo_cell *cell, const struct sums *sums)
{
    const struct trace_axes axes = trace_axes_of(&m->records->look);
    const struct origin origin = origin_of(m->records, sums->bounce, sums->record);
    const struct trace_record *t = sums->record;
    for (uint32_t b = origin.count; b-- > 0;) {
        cell->facets[b] = facet_at(s, &axes, origin.places[b], t);
        cell->parts[b] = cell->facets[b] < 0 ? cell->facets[b] : part_of[cell->facets[b]];
        t = b > 0 ? &m->records->bounces[b - 1].records[t->parent] : NULL;
    }
}

static void finish(const struct maker *m, const struct scene *s, const int32_t *part_of)
{
    const struct trace_grid *grid = &m->records->grid;
    for (uint32_t i = 0; i < grid->cells_across * grid->cells_range; i++) {
        struct echo_cell *cell = &m->cells[i];
        const struct sums *sums = &m->sums[i];
        cell->height_m = cell->height_spread_m = NAN;
        if (sums->record) {
            const double mean_m = sums->height / cell->power_m2;
            cell->height_m = mean_m;
            cell->height_spread_m = sqrt(fmax(sums->square / cell->power_m2 - mean_m * mean_m, 0));
            name_facets(m, s, part_of, cell, sums);
        }
    }
}

int echo_map_make(struct echo_map *map, const struct trace_records *r,
                  const struct reflect_law *law, const struct scene *s, const struct mesh *m)
{
    const size_t cells = (size_t)r->grid.cells_across * r->grid.cells_range;
    const struct maker maker = {r, law, calloc(cells, sizeof *map->cells),
                                calloc(cells, sizeof *maker.sums)};
    *map = (struct echo_map){.cells = maker.cells,
                             .part_of = malloc((m->triangle_count + 1) * sizeof *map->part_of)};
    int result = maker.cells && maker.sums && map->part_of ? 0 : -1;
    if (result == 0) {
        result = mesh_parts(m, map->part_of, &map->part_count) == 0 ? add_all(&maker) : -1;
    }
    if (result == 0) {
        finish(&maker, s, map->part_of);
    } else {
        echo_map_free(map);
        hs_error("map", "give fewer --cells", "out of memory");
    }
    free(maker.sums);
    return result;
}

void echo_map_free(struct echo_map *map)
{
    free(map->cells);
    free(map->part_of);
    *map = (struct echo_map){0};
}
