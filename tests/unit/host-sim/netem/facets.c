#include "facets.h"
#include "check.h"

#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static float between(struct hs_rng *rng, double low, double high)
{
    return (float)(low + (high - low) * hs_rng_uniform(rng));
}

static struct trace_record reflection(struct hs_rng *rng, uint32_t ray, uint32_t parent,
                                      double reach_m, int is_first)
{
    struct trace_record t = {.ray = ray, .parent = parent, .normal = {0, 0, 1}};
    t.across_m = between(rng, -reach_m, reach_m);
    t.range_m = between(rng, -reach_m, reach_m);
    t.incidence_rad = between(rng, 0.02, 1.5);
    t.echo_rad = is_first ? t.incidence_rad : between(rng, 0.02, 1.5);
    const double apart = fabs((double)t.incidence_rad - (double)t.echo_rad);
    t.turn_rad = is_first ? 0 : between(rng, apart, (double)(t.incidence_rad + t.echo_rad));
    t.material = (uint8_t)hs_rng_below(rng, 3);
    t.flags = hs_rng_below(rng, 10) == 0 ? TRACE_BLOCKED : 0;
    return t;
}

static void first_bounce(struct trace_records *r, struct hs_rng *rng, double reach_m)
{
    struct trace_bounce *b = &r->bounces[0];
    b->count = r->sensor.columns * r->sensor.rows;
    b->records = calloc(b->count, sizeof *b->records);
    assert_non_null(b->records);
    for (uint32_t i = 0; i < b->count; i++) {
        b->records[i] = reflection(rng, i, 0, reach_m, 1);
    }
}

static void next_bounce(struct trace_records *r, uint32_t bounce, struct hs_rng *rng,
                        double reach_m)
{
    struct trace_bounce *before = &r->bounces[bounce - 1], *b = &r->bounces[bounce];
    b->records = calloc(before->count + 1, sizeof *b->records);
    assert_non_null(b->records);
    for (uint32_t i = 0; i < before->count; i++) {
        if (hs_rng_below(rng, 2) == 0) {
            before->records[i].flags |= TRACE_GOES_ON;
            b->records[b->count++] = reflection(rng, before->records[i].ray, i, reach_m, 0);
        }
    }
}

void facets_make(struct trace_records *r, uint64_t seed, uint32_t side, uint32_t cells)
{
    const double reach_m = 0.055 * cells;
    *r = (struct trace_records){
        .look = {10, 15, 0.03125},
        .grid = {cells, cells, 0.1},
        .sensor = {side, side, 0.1 * cells / side, 0.1 * cells / side, -0.05 * cells,
                   -0.05 * cells},
        .material_count = 3,
        .materials = {"metal", "ground", "rubber"},
        .bounce_count = TRACE_BOUNCES_MAX,
    };
    struct hs_rng rng;
    hs_rng_seed(&rng, seed);
    first_bounce(r, &rng, reach_m);
    for (uint32_t b = 1; b < r->bounce_count; b++) {
        next_bounce(r, b, &rng, reach_m);
    }
    assert_int_equal(trace_records_check(r, "facets"), 0);
}
