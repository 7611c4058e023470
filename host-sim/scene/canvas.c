#include "scene/canvas.h"

#include "hs/error.h"
#include "scene/land.h"

#include <math.h>
#include <stdlib.h>

enum { CORNERS_MAX = 4096 };

int canvas_init(struct canvas *c, int size, double cell_m)
{
    const size_t side = (size_t)size * CANVAS_SUB;
    *c = (struct canvas){.side = (int)side, .cell_m = cell_m / CANVAS_SUB};
    c->material = calloc(side * side, 1);
    c->variant = calloc(side * side, 1);
    c->height_hm = calloc(side * side, 1);
    if (!c->material || !c->variant || !c->height_hm) {
        canvas_free(c);
        return hs_error("image", "make the scene smaller", "out of memory");
    }
    return 0;
}

void canvas_free(struct canvas *c)
{
    free(c->material);
    free(c->variant);
    free(c->height_hm);
    detail_free(&c->detail);
    *c = (struct canvas){0};
}

/* Sub-pixel coordinates: x to the east, y to the south, sub-pixel (0, 0) covers 0..1. */
static struct point to_canvas(const struct canvas *c, struct point p)
{
    double east, north;
    land_from_design(p, &east, &north);
    const double middle = 0.5 * c->side;
    return (struct point){middle + east / c->cell_m, middle - north / c->cell_m};
}

static void paint(struct canvas *c, int x, int y, const struct brush *b)
{
    const size_t i = (size_t)y * (size_t)c->side + (size_t)x;
    if (b->over == 0 || (b->over & MATERIAL_BIT(c->material[i]))) {
        c->material[i] = (uint8_t)b->material;
        c->variant[i] = b->variant;
        c->height_hm[i] = (uint8_t)lround(2 * b->height_m);
    }
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The edges cross the row's middle line; between crossings 0 and 1, 2 and 3, ... it is inside. */
static void paint_row(struct canvas *c, const struct point *q, int count, int y,
                      const struct brush *b)
{
    double crossing[64];
    int n = 0;
    const double middle = y + 0.5;
    for (int i = 0; i < count && n < 64; i++) {
        const struct point s = q[i], t = q[(i + 1) % count];
        if ((s.v <= middle) != (t.v <= middle)) {
            crossing[n++] = s.u + (t.u - s.u) * (middle - s.v) / (t.v - s.v);
        }
    }
    qsort(crossing, (size_t)n, sizeof *crossing, compare_doubles);
    for (int k = 0; k + 1 < n; k += 2) {
        const int from = (int)fmax(0, ceil(crossing[k] - 0.5));
        const int to = (int)fmin(c->side, ceil(crossing[k + 1] - 0.5));
        for (int x = from; x < to; x++) {
            paint(c, x, y, b);
        }
    }
}

static bool is_built(enum material m)
{
    return material_look(m)->group == CLASS_STRUCTURE;
}

/* Add what is built to the detail, if its middle is on the image and may be painted. */
static void add_footprint(struct canvas *c, const struct point *p, int count, const struct brush *b)
{
    struct point middle = {0, 0};
    for (int i = 0; i < count; i++) {
        middle.u += p[i].u / count;
        middle.v += p[i].v / count;
    }
    const enum material ground = canvas_at(c, middle);
    const bool takes =
        ground != MATERIAL_COUNT && (b->over == 0 || (b->over & MATERIAL_BIT(ground)));
    if (takes && is_built(b->material) && b->height_m > 0) {
        const struct detail_block what = {
            .height_m = b->height_m, .material = b->material, .variant = b->variant};
        detail_add_footprint(&c->detail, p, count, &what);
    }
}

void canvas_polygon(struct canvas *c, const struct point *p, int count, const struct brush *b)
{
    struct point q[CORNERS_MAX];
    double low = INFINITY, high = -INFINITY, left = INFINITY, right = -INFINITY;
    if (count < 3 || count > CORNERS_MAX) {
        return;
    }
    for (int i = 0; i < count; i++) {
        q[i] = to_canvas(c, p[i]);
        low = fmin(low, q[i].v);
        high = fmax(high, q[i].v);
        left = fmin(left, q[i].u);
        right = fmax(right, q[i].u);
    }
    if (right < 0 || left > c->side) {
        return;
    }
    add_footprint(c, p, count, b);
    canvas_add_paving(c, p, count, b);
    const int from = (int)fmax(0, ceil(low - 0.5)), to = (int)fmin(c->side, ceil(high - 0.5));
    for (int y = from; y < to; y++) {
        paint_row(c, q, count, y, b);
    }
}

void canvas_shape(struct canvas *c, const struct shape *s, const struct brush *b)
{
    canvas_polygon(c, s->p, s->count, b);
}

void canvas_disc(struct canvas *c, struct point centre, double radius_m, const struct brush *b)
{
    enum { CORNERS = 20 };
    struct point p[CORNERS];
    for (int i = 0; i < CORNERS; i++) {
        const double angle = i * 2 * 3.14159265358979323846 / CORNERS;
        p[i] = (struct point){centre.u + radius_m * cos(angle), centre.v + radius_m * sin(angle)};
    }
    canvas_polygon(c, p, CORNERS, b);
}

void canvas_line(struct canvas *c, const struct point *p, int count, double width_m,
                 const struct brush *b)
{
    const double half = width_m / 2;
    for (int i = 0; i + 1 < count; i++) {
        const double length = point_distance(p[i], p[i + 1]);
        if (length <= 0) {
            continue;
        }
        const struct frame f = {p[i], (p[i + 1].u - p[i].u) / length,
                                (p[i + 1].v - p[i].v) / length};
        const struct shape strip = frame_rectangle(&f, 0, -half, length, half);
        canvas_shape(c, &strip, b);
        if (i > 0) {
            canvas_disc(c, p[i], half, b);
        }
    }
}

/* Sub-pixel of a place, or -1 off the image. */
static int64_t pixel_at(const struct canvas *c, struct point p)
{
    const struct point q = to_canvas(c, p);
    const bool is_on = q.u >= 0 && q.v >= 0 && q.u < c->side && q.v < c->side;
    return is_on ? (int64_t)q.v * c->side + (int64_t)q.u : -1;
}

enum material canvas_at(const struct canvas *c, struct point p)
{
    const int64_t i = pixel_at(c, p);
    return i < 0 ? MATERIAL_COUNT : (enum material)c->material[i];
}

uint8_t canvas_variant_at(const struct canvas *c, struct point p)
{
    const int64_t i = pixel_at(c, p);
    return i < 0 ? 0 : c->variant[i];
}
