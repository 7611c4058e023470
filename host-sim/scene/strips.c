/* Paving as strips: the straight edges that a raster of cells cannot hold. */
#include "scene/canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sides of a strip. */
enum side { LEFT, RIGHT, SIDES };

static const double piece_m = 30; /* of a strip is judged at a time */

static bool is_paved(enum material_class c)
{
    return c == CLASS_ASPHALT || c == CLASS_CONCRETE;
}

/* Class at a place; CLASS_COUNT off the image. */
static enum material_class class_at(const struct canvas *c, const struct frame *f, double x,
                                    double y)
{
    const enum material m = canvas_at(c, frame_point(f, x, y));
    return m == MATERIAL_COUNT ? CLASS_COUNT : material_look(m)->group;
}

void canvas_add_paving(struct canvas *c, const struct point *p, int count, const struct brush *b)
{
    const enum material_class ground = material_look(b->material)->group;
    if (count != 4 || b->height_m > 0 || b->material == PAINT || !is_paved(ground)) {
        return;
    }
    const double sides[2] = {point_distance(p[0], p[1]), point_distance(p[1], p[2])};
    const bool is_rectangle = fabs(sides[0] - point_distance(p[2], p[3])) < 0.01 &&
                              fabs(sides[1] - point_distance(p[3], p[0])) < 0.01 &&
                              fabs(point_distance(p[0], p[2]) - point_distance(p[1], p[3])) < 0.01;
    if (is_rectangle && sides[0] >= sides[1]) {
        detail_add_strip(&c->detail, &(struct detail_strip){point_between(p[0], p[3], 0.5),
                                                            point_between(p[1], p[2], 0.5),
                                                            sides[1], ground, false});
    } else if (is_rectangle) {
        detail_add_strip(&c->detail, &(struct detail_strip){point_between(p[0], p[1], 0.5),
                                                            point_between(p[3], p[2], 0.5),
                                                            sides[0], ground, false});
    }
}

/* A strip in its own frame: x along it, y to the left. */
struct walk {
    const struct canvas *canvas;
    struct detail *to;
    const struct detail_strip *strip;
    struct frame frame;
    double verge_m;
};

/* A piece of a strip: whether the paving still shows, and what grows on either side. */
struct piece {
    bool is_there;
    enum material_class beside[SIDES]; /* CLASS_COUNT: paved, built, or not the same all along */
};

static bool are_alike(struct piece a, struct piece b)
{
    return a.is_there == b.is_there && a.beside[LEFT] == b.beside[LEFT] &&
           a.beside[RIGHT] == b.beside[RIGHT];
}

/* The one class that grows at some places, or CLASS_COUNT. */
static enum material_class what_grows(const struct walk *w, const struct point *local, int count)
{
    const enum material_class first = class_at(w->canvas, &w->frame, local[0].u, local[0].v);
    bool is_one = first != CLASS_COUNT && first != CLASS_STRUCTURE && !is_paved(first);
    for (int i = 1; i < count; i++) {
        is_one = is_one && class_at(w->canvas, &w->frame, local[i].u, local[i].v) == first;
    }
    return is_one ? first : CLASS_COUNT;
}

/* What grows from x0 to x1 along a line at `y`, and 0.4 of a verge to either side of it. */
static enum material_class grows_along(const struct walk *w, double x0, double x1, double y)
{
    struct point at[6];
    for (int i = 0; i < 6; i++) {
        at[i].u = x0 + (x1 - x0) * (0.1 + 0.4 * (i % 3));
        at[i].v = y + (i < 3 ? -0.4 : 0.4) * w->verge_m;
    }
    return what_grows(w, at, 6);
}

static struct piece judge(const struct walk *w, double x0, double x1)
{
    const double half = w->strip->width_m / 2;
    int own = 0, other = 0;
    for (int i = 0; i < 9; i++) {
        const enum material_class k =
            class_at(w->canvas, &w->frame, x0 + (x1 - x0) * (0.1 + 0.4 * (i % 3)),
                     (i / 3 - 1) * 0.84 * half);
        own += k == w->strip->ground;
        other += !is_paved(k) && k != CLASS_STRUCTURE;
    }
    return (struct piece){own >= 5 && other == 0,
                          {grows_along(w, x0, x1, half + w->verge_m / 2),
                           grows_along(w, x0, x1, -half - w->verge_m / 2)}};
}

static void add(struct walk *w, double x0, double y0, double x1, double y1, double width_m,
                enum material_class ground)
{
    detail_add_strip(w->to, &(struct detail_strip){frame_point(&w->frame, x0, y0),
                                                   frame_point(&w->frame, x1, y1), width_m, ground,
                                                   ground != w->strip->ground});
}

/* A verge across an end of the strip, where it ends in the green. */
static void close_end(struct walk *w, double x, int outwards)
{
    const double half = w->strip->width_m / 2, middle = x + outwards * w->verge_m / 2;
    struct point at[6];
    for (int i = 0; i < 6; i++) {
        at[i].u = middle + (i < 3 ? -0.4 : 0.4) * w->verge_m;
        at[i].v = (i % 3 - 1) * 0.8 * half;
    }
    const enum material_class k = what_grows(w, at, 6);
    if (k != CLASS_COUNT) {
        add(w, middle, -half - w->verge_m, middle, half + w->verge_m, w->verge_m, k);
    }
}

/* Add a run of alike pieces. */
static void add_run(struct walk *w, struct piece run, double x0, double x1)
{
    const double aside = (w->strip->width_m + w->verge_m) / 2;
    if (!run.is_there) {
        return;
    }
    for (int side = 0; side < SIDES; side++) {
        const double y = side == LEFT ? aside : -aside;
        if (run.beside[side] != CLASS_COUNT) {
            add(w, x0, y, x1, y, w->verge_m, run.beside[side]);
        }
    }
    close_end(w, x0, -1);
    close_end(w, x1, 1);
    add(w, x0, 0, x1, 0, w->strip->width_m, w->strip->ground);
}

static void walk_strip(struct walk *w, double length_m)
{
    const int pieces = (int)fmax(1, round(length_m / piece_m));
    struct piece run = {0};
    double from = 0;
    for (int i = 0; i < pieces; i++) {
        const double x = length_m * i / pieces;
        const struct piece next = judge(w, x, length_m * (i + 1) / pieces);
        if (i > 0 && !are_alike(run, next)) {
            add_run(w, run, from, x);
            from = x;
        }
        run = next;
    }
    add_run(w, run, from, length_m);
}

void canvas_trim_paving(struct canvas *c)
{
    struct detail *d = &c->detail, done = {0};
    for (int i = 0; i < d->strip_count; i++) {
        const struct detail_strip *s = &d->strips[i];
        const double length = point_distance(s->from, s->to);
        if (length >= 1 && s->width_m >= 1) {
            struct walk w = {
                .canvas = c,
                .to = &done,
                .strip = s,
                .frame = {s->from, (s->to.u - s->from.u) / length, (s->to.v - s->from.v) / length},
                .verge_m = 1.5 * CANVAS_SUB * c->cell_m};
            walk_strip(&w, length);
        }
    }
    free(d->strips);
    d->strips = done.strips;
    d->strip_count = done.strip_count;
    d->is_short = d->is_short || done.is_short;
}
