#include "footprint.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* UNSOURCED: how much of its rectangle a house fills, and the least side of a slice. */
static const double full_share = 0.88, least_m = 0.5;

struct edge {
    double ax, ay, bx, by;
};

struct outline {
    struct edge *edges; /* owned; turned so that most walls run along x or y */
    int count;
    double x, y;         /* what they are turned around */
    double cosine, sine; /* of the walls' direction */
    double area_m2;
};

/* ---- edges ---- */

static int gather_edges(struct outline *o, OGRGeometryH polygon)
{
    int points = 0, used = 0;
    for (int i = 0; i < OGR_G_GetGeometryCount(polygon); i++) {
        points += OGR_G_GetPointCount(OGR_G_GetGeometryRef(polygon, i));
    }
    o->edges = malloc(((size_t)points + 1) * sizeof *o->edges);
    if (!o->edges) {
        return -1;
    }
    for (int i = 0; i < OGR_G_GetGeometryCount(polygon); i++) {
        OGRGeometryH ring = OGR_G_GetGeometryRef(polygon, i);
        for (int k = 0; k + 1 < OGR_G_GetPointCount(ring); k++) {
            o->edges[used++] = (struct edge){OGR_G_GetX(ring, k), OGR_G_GetY(ring, k),
                                             OGR_G_GetX(ring, k + 1), OGR_G_GetY(ring, k + 1)};
        }
    }
    o->count = used;
    o->area_m2 = OGR_G_Area(polygon);
    return 0;
}

/* Directions modulo a right angle: four times the angle, weighted by length. */
static void find_direction(struct outline *o)
{
    double c = 0, s = 0;
    for (int i = 0; i < o->count; i++) {
        const struct edge *e = &o->edges[i];
        const double du = e->bx - e->ax, dv = e->by - e->ay;
        const double angle = 4 * atan2(dv, du), length = hypot(du, dv);
        c += length * cos(angle);
        s += length * sin(angle);
    }
    const double turn = atan2(s, c) / 4;
    o->cosine = cos(turn);
    o->sine = sin(turn);
    o->x = o->edges[0].ax;
    o->y = o->edges[0].ay;
}

static void turn_edges(struct outline *o)
{
    for (int i = 0; i < o->count; i++) {
        struct edge *e = &o->edges[i];
        const double a = e->ax - o->x, b = e->ay - o->y, c = e->bx - o->x, d = e->by - o->y;
        *e = (struct edge){o->cosine * a + o->sine * b, o->cosine * b - o->sine * a,
                           o->cosine * c + o->sine * d, o->cosine * d - o->sine * c};
    }
}

static void swap_axes(struct outline *o)
{
    for (int i = 0; i < o->count; i++) {
        const struct edge e = o->edges[i];
        o->edges[i] = (struct edge){e.ay, e.ax, e.by, e.bx};
    }
}

/* ---- slices ---- */

/* In the turned frame. */
struct slice {
    double left, right, low, high;
};

struct slices {
    struct slice items[FOOTPRINT_BOXES_MAX];
    int count;
    bool is_full; /* there would be more */
};

static int compare_numbers(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Add a slice, or lengthen the one below it of the same width. */
static void add_slice(struct slices *s, const struct slice *slice, double tolerance)
{
    for (int i = 0; i < s->count; i++) {
        struct slice *below = &s->items[i];
        if (below->high == slice->low && fabs(below->left - slice->left) < tolerance &&
            fabs(below->right - slice->right) < tolerance) {
            const double a = below->high - below->low, b = slice->high - slice->low;
            below->left = (a * below->left + b * slice->left) / (a + b);
            below->right = (a * below->right + b * slice->right) / (a + b);
            below->high = slice->high;
            return;
        }
    }
    if (s->count == FOOTPRINT_BOXES_MAX) {
        s->is_full = true;
        return;
    }
    s->items[s->count++] = *slice;
}

/* Slices between two heights, by the walls that its middle crosses. */
static void slice_between(const struct outline *o, double low, double high, double *crossings,
                          struct slices *s, double tolerance)
{
    const double middle = (low + high) / 2;
    int count = 0;
    for (int i = 0; i < o->count; i++) {
        const struct edge *e = &o->edges[i];
        if ((e->ay <= middle) != (e->by <= middle)) {
            crossings[count++] = e->ax + (middle - e->ay) * (e->bx - e->ax) / (e->by - e->ay);
        }
    }
    qsort(crossings, (size_t)count, sizeof *crossings, compare_numbers);
    for (int i = 0; i + 1 < count; i += 2) {
        const struct slice slice = {crossings[i], crossings[i + 1], low, high};
        if (slice.right - slice.left > 0.1) {
            add_slice(s, &slice, tolerance);
        }
    }
}

/* Cut at the corners, those nearer than `tolerance` together. `room` is for 2 * count numbers. */
static void cut_at_corners(const struct outline *o, double tolerance, double *room,
                           struct slices *s)
{
    double *const heights = room, *const crossings = room + o->count;
    *s = (struct slices){.count = 0};
    for (int i = 0; i < o->count; i++) {
        heights[i] = o->edges[i].ay;
    }
    qsort(heights, (size_t)o->count, sizeof *heights, compare_numbers);
    const double top = heights[o->count - 1];
    double low = heights[0];
    for (int i = 1; i < o->count; i++) {
        const bool is_last = i + 1 == o->count;
        if (is_last || (heights[i] - low >= tolerance && top - heights[i] >= tolerance)) {
            slice_between(o, low, heights[i], crossings, s, tolerance);
            low = heights[i];
        }
    }
}

static void cut(const struct outline *o, double *room, struct slices *s)
{
    double tolerance = least_m;
    do {
        cut_at_corners(o, tolerance, room, s);
        tolerance *= 1.5;
    } while (s->is_full);
}

/* ---- boxes ---- */

static void place_box(const struct outline *o, const struct slice *s, bool is_swapped,
                      struct footprint_box *box)
{
    const double a = (s->left + s->right) / 2, b = (s->low + s->high) / 2;
    const double u = is_swapped ? b : a, v = is_swapped ? a : b;
    const double along = is_swapped ? s->high - s->low : s->right - s->left,
                 across = is_swapped ? s->right - s->left : s->high - s->low;
    const bool is_long = along >= across;
    *box = (struct footprint_box){.x = o->x + o->cosine * u - o->sine * v,
                                  .y = o->y + o->sine * u + o->cosine * v,
                                  .length_m = is_long ? along : across,
                                  .width_m = is_long ? across : along,
                                  .east = is_long ? o->cosine : -o->sine,
                                  .north = is_long ? o->sine : o->cosine};
}

static struct slice rectangle_of(const struct outline *o)
{
    struct slice all = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < o->count; i++) {
        all.left = fmin(all.left, o->edges[i].ax);
        all.right = fmax(all.right, o->edges[i].ax);
        all.low = fmin(all.low, o->edges[i].ay);
        all.high = fmax(all.high, o->edges[i].ay);
    }
    return all;
}

/* Shrink a rectangle around its middle to the polygon's area. */
static void shrink(struct slice *s, double share)
{
    const double x = (1 - sqrt(share)) * (s->right - s->left) / 2,
                 y = (1 - sqrt(share)) * (s->high - s->low) / 2;
    *s = (struct slice){s->left + x, s->right - x, s->low + y, s->high - y};
}

/* The cut along that of the two axes which gives fewer boxes. */
static int cut_both_ways(struct outline *o, double *room, struct footprint_box *boxes)
{
    static struct slices ways[2];
    cut(o, room, &ways[0]);
    swap_axes(o);
    cut(o, room, &ways[1]);
    const int best = ways[1].count < ways[0].count;
    for (int i = 0; i < ways[best].count; i++) {
        place_box(o, &ways[best].items[i], best == 1, &boxes[i]);
    }
    return ways[best].count;
}

static int cut_outline(struct outline *o, struct footprint_box *boxes)
{
    find_direction(o);
    turn_edges(o);
    struct slice all = rectangle_of(o);
    const double share = o->area_m2 / ((all.right - all.left) * (all.high - all.low));
    if (share >= full_share) {
        shrink(&all, fmin(1, share));
        place_box(o, &all, false, &boxes[0]);
        return 1;
    }
    double *room = malloc(2 * (size_t)o->count * sizeof *room);
    const int count = room ? cut_both_ways(o, room, boxes) : -1;
    free(room);
    return count;
}

int footprint_cut(OGRGeometryH polygon, struct footprint_box boxes[FOOTPRINT_BOXES_MAX])
{
    struct outline o;
    if (gather_edges(&o, polygon) != 0) {
        return -1;
    }
    const int count = o.count >= 3 && o.area_m2 > 0 ? cut_outline(&o, boxes) : 0;
    free(o.edges);
    return count;
}
