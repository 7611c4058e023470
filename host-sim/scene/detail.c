#include "scene/detail.h"

#include <math.h>
#include <stdlib.h>

enum { CORNERS_OF_A_BUILDING = 8 };

/* Room for one more of an array of `size` bytes an entry, which doubles. NULL when memory is short;
 * the array is then as it was. */
static void *room_for(struct detail *d, void **array, int count, size_t size)
{
    if (count == 0 || (count >= 16 && (count & (count - 1)) == 0)) {
        void *larger = realloc(*array, (count == 0 ? 16 : 2 * (size_t)count) * size);
        if (!larger) {
            d->is_short = true;
            return NULL;
        }
        *array = larger;
    }
    return (char *)*array + (size_t)count * size;
}

static void add_block(struct detail *d, const struct detail_block *block)
{
    struct detail_block *added =
        room_for(d, (void **)&d->blocks, d->block_count, sizeof *d->blocks);
    if (added) {
        *added = *block;
        d->block_count++;
    }
}

/* Area of a polygon, m2, and its centre of gravity. */
static double area_of(const struct point *p, int count, struct point *centre)
{
    double twice = 0, u = 0, v = 0;
    for (int i = 0; i < count; i++) {
        const struct point a = p[i], b = p[(i + 1) % count];
        const double cross = (a.u - p[0].u) * (b.v - p[0].v) - (b.u - p[0].u) * (a.v - p[0].v);
        twice += cross;
        u += cross * (a.u + b.u - 2 * p[0].u) / 3;
        v += cross * (a.v + b.v - 2 * p[0].v) / 3;
    }
    *centre = twice == 0 ? p[0] : (struct point){p[0].u + u / twice, p[0].v + v / twice};
    return fabs(0.5 * twice);
}

/* The frame along the longest edge, and the polygon's extents in it. */
static struct frame frame_of(const struct point *p, int count, double *length_m, double *width_m)
{
    struct frame f = {p[0], 1, 0};
    double longest = 0;
    for (int i = 0; i < count; i++) {
        const struct point a = p[i], b = p[(i + 1) % count];
        const double edge = point_distance(a, b);
        if (edge > longest) {
            longest = edge;
            f = (struct frame){a, (b.u - a.u) / edge, (b.v - a.v) / edge};
        }
    }
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < count; i++) {
        const double du = p[i].u - f.origin.u, dv = p[i].v - f.origin.v;
        const double place[2] = {f.cos * du + f.sin * dv, f.cos * dv - f.sin * du};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], place[k]);
            high[k] = fmax(high[k], place[k]);
        }
    }
    *length_m = high[0] - low[0];
    *width_m = high[1] - low[1];
    return f;
}

/* Two squares across each other, together about as large as a disc of that area. */
static void add_disc(struct detail *d, struct detail_block *block, double area_m2)
{
    const double turned = sqrt(0.5);
    block->length_m = block->width_m = 0.95 * sqrt(area_m2);
    add_block(d, block);
    const double cosine = block->middle.cos, sine = block->middle.sin;
    block->middle.cos = turned * (cosine - sine);
    block->middle.sin = turned * (cosine + sine);
    add_block(d, block);
}

void detail_add_footprint(struct detail *d, const struct point *p, int count,
                          const struct detail_block *what)
{
    struct detail_block block = *what;
    struct point centre;
    const double area_m2 = area_of(p, count, &centre);
    if (area_m2 < 1) {
        return;
    }
    block.middle = frame_of(p, count, &block.length_m, &block.width_m);
    block.middle.origin = centre;
    if (count > CORNERS_OF_A_BUILDING) {
        add_disc(d, &block, area_m2);
        return;
    }
    const double shrink = sqrt(area_m2 / (block.length_m * block.width_m));
    block.length_m *= shrink;
    block.width_m *= shrink;
    add_block(d, &block);
}

void detail_add_line(struct detail *d, struct point from, struct point to,
                     enum detail_line_kind kind)
{
    struct detail_line *added = room_for(d, (void **)&d->lines, d->line_count, sizeof *d->lines);
    if (added) {
        *added = (struct detail_line){from, to, kind};
        d->line_count++;
    }
}

void detail_add_strip(struct detail *d, const struct detail_strip *strip)
{
    struct detail_strip *added =
        room_for(d, (void **)&d->strips, d->strip_count, sizeof *d->strips);
    if (added) {
        *added = *strip;
        d->strip_count++;
    }
}

void detail_add_fence(struct detail *d, const struct point *p, int count)
{
    for (int i = 0; i < count; i++) {
        detail_add_line(d, p[i], p[(i + 1) % count], DETAIL_FENCE);
    }
}

void detail_add_power_line(struct detail *d, struct point from, struct point to, double span_m,
                           double height_m)
{
    const int spans = (int)fmax(1, round(point_distance(from, to) / span_m));
    for (int i = 0; i <= spans; i++) {
        struct detail_mast *added =
            room_for(d, (void **)&d->masts, d->mast_count, sizeof *d->masts);
        const struct point at = point_between(from, to, (double)i / spans);
        if (added) {
            *added = (struct detail_mast){at, height_m};
            d->mast_count++;
        }
        if (i < spans) {
            detail_add_line(d, at, point_between(from, to, (i + 1.0) / spans), DETAIL_WIRE);
        }
    }
}

void detail_free(struct detail *d)
{
    free(d->blocks);
    free(d->lines);
    free(d->masts);
    free(d->strips);
    *d = (struct detail){0};
}
