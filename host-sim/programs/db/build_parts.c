#include "build_parts.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

enum { RELEASE_TILES = 512 }; /* at most 58 MB of the parts, as the tile above needs 95 kB of one */

int build_parts_begin(struct build_parts *p, const struct build_work *work, const char *plan,
                      struct build_context *b)
{
    *p = (struct build_parts){.work = work,
                              .plan = plan,
                              .b = b,
                              .parts = calloc((size_t)work->shard_count + 1, sizeof *p->parts)};
    return p->parts ? 0 : hs_error(plan, NULL, "out of memory");
}

/* Is this part the one of its shard in the plan? */
static int check_part(const struct build_work *work, const struct build_part *p)
{
    const struct build_part_head *h = &p->head;
    const uint32_t count = (uint32_t)work->shard_count;
    if (h->number >= count || h->shard_count != count) {
        return hs_error(p->path, "give the parts of this plan",
                        "is shard %u of %u, and the plan has %u", (unsigned)h->number,
                        (unsigned)h->shard_count, (unsigned)count);
    }
    const struct build_work_shard *s = &work->shards[h->number];
    if (memcmp(h->key, s->key, sizeof h->key) != 0 || h->level != s->place.level ||
        h->zone != s->place.zone || h->row0 != s->place.row0 || h->rows != s->place.rows ||
        h->column0 != s->place.column0 || h->columns != s->place.columns) {
        return hs_error(p->path, "make this shard again",
                        "is shard %u of another plan, or of other sources", (unsigned)h->number);
    }
    return 0;
}

int build_parts_add(struct build_parts *p, const char *path)
{
    struct build_part part;
    if (build_part_open(&part, path) != 0) {
        return -1;
    }
    int result = check_part(p->work, &part);
    if (result == 0 && p->parts[part.head.number].bytes) {
        result = hs_error(path, "leave one of them out", "is shard %u, and so is %s",
                          (unsigned)part.head.number, p->parts[part.head.number].path);
    }
    if (result != 0) {
        build_part_close(&part);
        return -1;
    }
    p->parts[part.head.number] = part;
    return 0;
}

static void release(struct build_parts *p)
{
    for (int i = 0; i < p->work->shard_count; i++) {
        build_part_release(&p->parts[i]);
    }
    p->taken = 0;
}

/* As struct build_made has it. */
static int take(void *ctx, int level, uint32_t row, uint32_t column, struct lm_tile *record,
                struct build_tile *tile)
{
    struct build_parts *p = ctx;
    const struct build_plan *plan = &p->b->plan;
    if (++p->taken == RELEASE_TILES) {
        release(p);
    }
    const struct lm_band *band = build_plan_band(plan, level, row);
    const uint8_t shift = (uint8_t)(plan->shift0 + (unsigned)level);
    for (int i = 0; i < p->work->shard_count; i++) {
        const int k = (p->last + i) % p->work->shard_count;
        const struct build_shard *s = &p->work->shards[k].place;
        if (build_shard_holds(plan, s, level, row, column) && band->zone == s->zone) {
            const struct image_frame f = image_frame_of(shift, band->zone, row, column);
            const uint32_t mask = image_columns_round(shift, band->zone) - 1;
            const uint32_t entry = band->entry0 + (row - band->row0) * band->columns +
                                   ((column - band->column0) & mask);
            p->last = k;
            return build_part_take(&p->parts[k], entry, &f, level, record, tile);
        }
    }
    return hs_error(p->plan, "make it again with `landmass-db plan`",
                    "no shard has row %u, column %u of level %d", (unsigned)row, (unsigned)column,
                    level);
}

/* What a part counted, to what is counted here. */
static void add_sums(struct build_context *b, const struct build_part_head *h)
{
    struct build_counts *n = &b->counts;
    for (int k = 0; k < LM_DB_CLASSES; k++) {
        n->cells[k] += h->counts.cells[k];
        build_sum_join(&n->area_m2[k], &h->counts.area_m2[k]);
    }
    n->cells_by_rule += h->counts.cells_by_rule;
    n->cells_beyond_terrain += h->counts.cells_beyond_terrain;
    n->heights_cut += h->counts.heights_cut;
    build_sum_join(&n->land_area_m2, &h->counts.land_area_m2);
    build_sum_join(&n->land_metres_m2, &h->counts.land_metres_m2);
    build_towns_join(&b->towns, &h->towns);
}

int build_parts_join(struct build_parts *p, struct build_made *made)
{
    for (int i = 0; i < p->work->shard_count; i++) {
        if (!p->parts[i].bytes) {
            return hs_error(p->plan, "make it with `landmass-db build --shard`",
                            "shard %d is missing", i);
        }
        add_sums(p->b, &p->parts[i].head);
    }
    *made = (struct build_made){p, p->work->shards[0].place.level, take};
    return 0;
}

void build_parts_end(struct build_parts *p)
{
    for (int i = 0; p->parts && i < p->work->shard_count; i++) {
        build_part_close(&p->parts[i]);
    }
    free(p->parts);
    *p = (struct build_parts){.work = NULL};
}
