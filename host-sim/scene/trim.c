/* What is left of a footprint when everything has been painted. */
#include "scene/canvas.h"

#include <string.h>

enum { SAMPLES = 12 }; /* of a block along each side */

static const double least_share = 0.3; /* of a block that is kept */

/* A part of the samples: x0..x1 along the length, y0..y1 along the width, ends not included. */
struct part {
    int x0, x1, y0, y1, score;
};

static bool shows(const struct canvas *c, const struct detail_block *b, double x, double y)
{
    const struct point at = frame_point(&b->middle, x * b->length_m, y * b->width_m);
    return canvas_at(c, at) == b->material && canvas_variant_at(c, at) == b->variant;
}

/* The part of rows y0..y1 that holds most samples with the block and fewest without: the run of
 * columns with the largest sum. */
static struct part best_of_rows(const int column[SAMPLES], int y0, int y1)
{
    struct part best = {0, 0, y0, y1, 0};
    int sum = 0, from = 0;
    for (int x = 0; x < SAMPLES; x++) {
        if (sum <= 0) {
            sum = 0;
            from = x;
        }
        sum += column[x];
        if (sum > best.score) {
            best = (struct part){from, x + 1, y0, y1, sum};
        }
    }
    return best;
}

static struct part find_part(const struct canvas *c, const struct detail_block *b)
{
    int value[SAMPLES][SAMPLES];
    struct part best = {0};
    for (int y = 0; y < SAMPLES; y++) {
        for (int x = 0; x < SAMPLES; x++) {
            value[y][x] =
                shows(c, b, (x + 0.5) / SAMPLES - 0.5, (y + 0.5) / SAMPLES - 0.5) ? 1 : -1;
        }
    }
    for (int y0 = 0; y0 < SAMPLES; y0++) {
        int column[SAMPLES] = {0};
        for (int y = y0; y < SAMPLES; y++) {
            for (int x = 0; x < SAMPLES; x++) {
                column[x] += value[y][x];
            }
            const struct part part = best_of_rows(column, y0, y + 1);
            best = part.score > best.score ? part : best;
        }
    }
    return best;
}

/* False if too little is left of the block. */
static bool trim(const struct canvas *c, struct detail_block *b)
{
    const struct part part = find_part(c, b);
    if (part.score < least_share * SAMPLES * SAMPLES) {
        return false;
    }
    const double x = (part.x0 + part.x1) / (2.0 * SAMPLES) - 0.5,
                 y = (part.y0 + part.y1) / (2.0 * SAMPLES) - 0.5;
    b->middle.origin = frame_point(&b->middle, x * b->length_m, y * b->width_m);
    b->length_m *= (double)(part.x1 - part.x0) / SAMPLES;
    b->width_m *= (double)(part.y1 - part.y0) / SAMPLES;
    return true;
}

void canvas_trim_detail(struct canvas *c)
{
    struct detail *d = &c->detail;
    int kept = 0;
    for (int i = 0; i < d->block_count; i++) {
        if (trim(c, &d->blocks[i])) {
            d->blocks[kept++] = d->blocks[i];
        }
    }
    d->block_count = kept;
}
