#include "classify/split.h"

#include "hs/error.h"
#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void shuffle(uint32_t *items, size_t count, struct hs_rng *rng)
{
    for (size_t i = count; i > 1; i--) {
        const uint32_t j = hs_rng_below(rng, (uint32_t)i);
        const uint32_t t = items[i - 1];
        items[i - 1] = items[j];
        items[j] = t;
    }
}

static void give_pixels(struct db_samples *s, int class_index, double fraction, struct hs_rng *rng,
                        enum db_part part, uint32_t *order)
{
    size_t count = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (s->items[i].class_index == class_index && s->items[i].part == DB_PART_TRAIN) {
            order[count++] = (uint32_t)i;
        }
    }
    shuffle(order, count, rng);
    const size_t give = (size_t)(fraction * (double)count);
    for (size_t i = 0; i < give; i++) {
        s->items[order[i]].part = (uint8_t)part;
    }
}

/* Training exemplars of one class by region. */
struct region_counts {
    size_t *pixels;  /* of each region */
    uint32_t *order; /* the regions that have any, shuffled */
    size_t count;    /* of them */
    size_t total;    /* their pixels */
};

static void count_class(struct region_counts *c, const struct db_samples *s, size_t region_count,
                        int class_index)
{
    memset(c->pixels, 0, region_count * sizeof *c->pixels);
    c->count = c->total = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (s->items[i].class_index == class_index && s->items[i].part == DB_PART_TRAIN &&
            ++c->total && c->pixels[s->items[i].region]++ == 0) {
            c->order[c->count++] = s->items[i].region;
        }
    }
}

/* Mark in `given` the regions to give away; returns how many. */
static size_t choose_regions(const struct region_counts *c, double fraction, uint8_t *given)
{
    const double target = fraction * (double)c->total;
    size_t got = 0, chosen = 0, smallest = 0;
    for (size_t i = 0; i < c->count && chosen + 1 < c->count; i++) {
        const size_t pixels = c->pixels[c->order[i]];
        smallest = pixels < c->pixels[c->order[smallest]] ? i : smallest;
        if ((double)got < target && (double)(got + pixels) <= 1.5 * target) {
            given[c->order[i]] = 1;
            got += pixels;
            chosen++;
        }
    }
    if (chosen == 0 && c->count > 1) {
        given[c->order[smallest]] = 1;
        chosen = 1;
    }
    return chosen;
}

static void give_regions(struct db_samples *s, int class_index, const uint8_t *given,
                         enum db_part part)
{
    for (size_t i = 0; i < s->count; i++) {
        struct db_exemplar *item = &s->items[i];
        if (item->class_index == class_index && item->part == DB_PART_TRAIN &&
            given[item->region]) {
            item->part = (uint8_t)part;
        }
    }
}

int db_split(struct db_samples *s, size_t region_count, const struct db_class_table *table,
             bool by_regions, double fraction, uint64_t seed, enum db_part part, bool quiet)
{
    const size_t most = region_count > s->count ? region_count : s->count;
    struct region_counts c = {calloc(region_count + 1, sizeof *c.pixels),
                              calloc(most + 1, sizeof *c.order), 0, 0};
    uint8_t *given = calloc(region_count + 1, 1);
    if (!c.pixels || !c.order || !given) {
        free(c.pixels);
        free(c.order);
        free(given);
        return hs_error("hold-out", NULL, "out of memory");
    }
    struct hs_rng rng;
    hs_rng_seed(&rng, seed);
    for (int i = 0; i < table->count; i++) {
        if (!by_regions) {
            give_pixels(s, i, fraction, &rng, part, c.order);
            continue;
        }
        count_class(&c, s, region_count, i);
        shuffle(c.order, c.count, &rng);
        if (choose_regions(&c, fraction, given) == 0 && c.total > 0 && !quiet) {
            hs_warn(table->items[i].name, "draw a second polygon of this class elsewhere",
                    "has one region only, so nothing of it can be held out");
        }
        give_regions(s, i, given, part);
    }
    free(c.pixels);
    free(c.order);
    free(given);
    return 0;
}

static uint64_t hash_cell(const struct db_samples *s, size_t i, const float *scale, double cell)
{
    uint64_t hash = 0x9e3779b97f4a7c15u * (uint64_t)(s->items[i].class_index + 1);
    const float *row = s->inputs + i * (size_t)s->input_count;
    for (int f = 0; f < s->input_count; f++) {
        const int64_t q = (int64_t)floor((double)row[f] / ((double)scale[f] * cell));
        hash = (hash ^ (uint64_t)q) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return hash;
}

/* Two different cells share a 64-bit hash about once in 10^9 sets of 10^5 exemplars: a lost
 * exemplar in that event does no harm, so the hash alone decides. An open table of at least twice
 * the exemplars. */
long db_thin(struct db_samples *s, const float *scale, double cell)
{
    size_t size = 1024;
    while (size < 2 * s->count) {
        size *= 2;
    }
    uint64_t *seen = calloc(size, sizeof *seen);
    if (!seen) {
        return hs_error("exemplars", NULL, "out of memory");
    }
    const size_t width = (size_t)s->input_count;
    size_t kept = 0;
    for (size_t i = 0; i < s->count; i++) {
        bool is_new = true;
        if (s->items[i].part == DB_PART_TRAIN) {
            const uint64_t hash = hash_cell(s, i, scale, cell) | 1u;
            size_t at = (hash >> 8) & (size - 1);
            while (seen[at] && seen[at] != hash) {
                at = (at + 1) & (size - 1);
            }
            is_new = seen[at] == 0;
            seen[at] = hash;
        }
        if (is_new) {
            s->items[kept] = s->items[i];
            memmove(s->inputs + kept * width, s->inputs + i * width, width * sizeof *s->inputs);
            kept++;
        }
    }
    free(seen);
    const size_t dropped = s->count - kept;
    s->count = kept;
    return (long)dropped;
}
