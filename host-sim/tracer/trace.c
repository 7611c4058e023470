#include "tracer/trace.h"

#include "hs/error.h"
#include "hs/team.h"
#include "tracer/ends.h"
#include "tracer/trace_tile.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Tiles to trace, and what comes of each. */
struct tiles_work {
    const struct trace_tiles *tiles;
    struct tile_result *results;
};

static void *begin_tiles(void *ctx)
{
    return tile_work_new(((struct tiles_work *)ctx)->tiles);
}

static void trace_one(void *ctx, void *own, uint32_t tile)
{
    const struct tiles_work *work = ctx;
    trace_tile(work->tiles, tile, own, &work->results[tile]);
}

static void end_tiles(void *ctx, void *own)
{
    (void)ctx;
    tile_work_free(own);
}

/* Give each tile its own room in the lists. Most of it is never touched, and so costs nothing. */
static bool lend_room(struct tile_result *results, const struct trace_tiles *t,
                      struct trace_records *r)
{
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        struct trace_record *records =
            malloc((size_t)t->tile_count * t->tile_rays * sizeof *records);
        if (!records) {
            return false;
        }
        r->bounces[b].records = records;
        for (uint32_t i = 0; i < t->tile_count; i++) {
            results[i].bounces[b].records = records + (size_t)i * t->tile_rays;
        }
    }
    return true;
}

/* Close the gaps behind the tiles of bounce `b`, and give back what is left. `before` are the
 * places of the tiles' first records in the bounce before, and become those in this one. */
static void close_gaps(const struct tile_result *results, uint32_t tile_count, uint32_t b,
                       uint32_t *before, struct trace_bounce *whole)
{
    for (uint32_t i = 0; i < tile_count; i++) {
        const struct trace_bounce *part = &results[i].bounces[b];
        struct trace_record *to = whole->records + whole->count;
        if (to != part->records) {
            memmove(to, part->records, part->count * sizeof *to);
        }
        for (uint32_t k = 0; b > 0 && k < part->count; k++) {
            to[k].parent += before[i];
        }
        before[i] = whole->count;
        whole->count += part->count;
    }
    struct trace_record *less =
        realloc(whole->records, (size_t)(whole->count + 1) * sizeof *whole->records);
    whole->records = less ? less : whole->records;
}

static int run_tiles(const struct trace_tiles *tiles, uint32_t threads, struct trace_records *r,
                     uint64_t *rays_cast)
{
    const uint32_t count = tiles->tile_count;
    struct tiles_work work = {.tiles = tiles, .results = calloc(count, sizeof *work.results)};
    const struct hs_team team = {&work, begin_tiles, trace_one, end_tiles, NULL};
    uint32_t *before = calloc(count, sizeof *before);
    const bool is_done = before && work.results && lend_room(work.results, tiles, r) &&
                         hs_team_run(&team, count, threads) == 0;
    for (uint32_t b = 0; is_done && b < r->bounce_count; b++) {
        close_gaps(work.results, count, b, before, &r->bounces[b]);
    }
    for (uint32_t i = 0; is_done && rays_cast && i < count; i++) {
        *rays_cast += work.results[i].rays_cast;
    }
    free(before);
    free(work.results);
    return is_done ? 0 : -1;
}

int trace_run(const struct scene *s, const struct trace_order *o, const char *place,
              struct trace_records *r, uint64_t *rays_cast)
{
    *r = (struct trace_records){0};
    if (rays_cast) {
        *rays_cast = 0;
    }
    if (ends_check(s, o) != 0) {
        return -1;
    }
    *r = (struct trace_records){
        .look = o->look,
        .grid = o->grid,
        .sensor = trace_sensor_for(s, o),
        .material_count = s->material_count,
        .bounce_count = o->bounces,
        .ends = o->ends,
    };
    memcpy(r->materials, s->materials, sizeof r->materials);
    const struct trace_sensor *sensor = &r->sensor;
    struct trace_tiles tiles = {0};
    const bool is_done = sensor->rows <= TRACE_RAYS_MAX / sensor->columns &&
                         trace_tiles_open(&tiles, s, o) == 0 &&
                         run_tiles(&tiles, o->threads, r, rays_cast) == 0;
    trace_tiles_close(&tiles);
    if (!is_done) {
        hs_error(place, "trace fewer rays a cell, or fewer cells",
                 "%u x %u rays are too many for the memory here", sensor->columns, sensor->rows);
        trace_records_free(r);
        return -1;
    }
    return 0;
}
