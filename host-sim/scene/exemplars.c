#include "scene/exemplars.h"

#include "noise.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "scene/output.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum {
    SEED_EXEMPLARS = 1500,
    TRIES = 60000,  /* places looked at for each material */
    PER_CLASS = 42, /* polygons aimed at, shared among its materials */
    PER_MATERIAL_MAX = 24,
    CORNERS = 8,
    LARGEST_PIXELS = 26, /* across */
    SMALLEST_PIXELS = 4
};

struct exemplar {
    struct point corner[CORNERS];
    enum material material;
};

/* An irregular octagon in an ellipse, the way a hand draws one. Pixel coordinates. */
struct outline {
    double x[CORNERS], y[CORNERS];
};

static struct outline draw(struct hs_rng *r, double x, double y, double long_px, double short_px,
                           double turn)
{
    struct outline o;
    for (int i = 0; i < CORNERS; i++) {
        const double angle = 2 * 3.14159265358979323846 * (i + 0.5 * hs_rng_uniform(r)) / CORNERS;
        const double out = 0.42 + 0.08 * hs_rng_uniform(r);
        const double a = out * long_px * cos(angle), b = out * short_px * sin(angle);
        o.x[i] = x + a * cos(turn) - b * sin(turn);
        o.y[i] = y + a * sin(turn) + b * cos(turn);
    }
    return o;
}

static bool contains(const struct outline *o, double x, double y)
{
    bool is_inside = false;
    for (int i = 0, k = CORNERS - 1; i < CORNERS; k = i++) {
        if ((o->y[i] > y) != (o->y[k] > y) &&
            x < o->x[i] + (o->x[k] - o->x[i]) * (y - o->y[i]) / (o->y[k] - o->y[i])) {
            is_inside = !is_inside;
        }
    }
    return is_inside;
}

/* Of the pixels whose centre lies inside, at least six, nine in ten have the class; none is off the
 * image. */
static bool is_pure(const struct scene *s, const struct picture *p, const struct outline *o,
                    enum material_class group)
{
    double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
    for (int i = 0; i < CORNERS; i++) {
        left = fmin(left, o->x[i]);
        right = fmax(right, o->x[i]);
        top = fmin(top, o->y[i]);
        bottom = fmax(bottom, o->y[i]);
    }
    if (left < 0 || top < 0 || right > s->size || bottom > s->size) {
        return false;
    }
    int inside = 0, good = 0;
    for (int y = (int)top; y <= (int)bottom && y < s->size; y++) {
        for (int x = (int)left; x <= (int)right && x < s->size; x++) {
            if (contains(o, x + 0.5, y + 0.5)) {
                inside++;
                good += p->truth[(size_t)y * (size_t)s->size + (size_t)x] == group;
            }
        }
    }
    return inside >= 6 && good * 10 >= inside * 9;
}

/* Try the place with ever smaller outlines; long things such as roads want a slim one at a lucky
 * angle. */
static bool fit(const struct scene *s, const struct picture *p, struct hs_rng *r, double x,
                double y, enum material_class group, struct outline *o)
{
    for (double across = LARGEST_PIXELS; across >= SMALLEST_PIXELS; across *= 0.72) {
        const double slim = hs_rng_uniform(r) < 0.5 ? 1 : 0.3;
        if (across * slim < 2.2) {
            continue;
        }
        *o = draw(r, x, y, across, across * slim, 3.14159265358979323846 * hs_rng_uniform(r));
        if (is_pure(s, p, o, group)) {
            return true;
        }
    }
    return false;
}

static struct exemplar to_ground(const struct scene *s, const struct outline *o, enum material m)
{
    struct exemplar e = {.material = m};
    const double half_m = 0.5 * s->size * s->cell_m;
    for (int i = 0; i < CORNERS; i++) {
        e.corner[i] = land_to_design(o->x[i] * s->cell_m - half_m, half_m - o->y[i] * s->cell_m);
    }
    return e;
}

static bool is_far_from(const struct exemplar *e, int count, const struct exemplar *candidate,
                        double least_m)
{
    for (int i = 0; i < count; i++) {
        if (point_distance(e[i].corner[0], candidate->corner[0]) < least_m) {
            return false;
        }
    }
    return true;
}

/* How many polygons a material is due. */
static int quota(enum material m)
{
    int sharing = 0;
    for (int k = 0; k < MATERIAL_COUNT; k++) {
        sharing += material_look((enum material)k)->group == material_look(m)->group;
    }
    const int due = PER_CLASS / sharing;
    return due < PER_MATERIAL_MAX ? due : PER_MATERIAL_MAX;
}

/* Look at random places for those made of `m`; returns how many exemplars were found. */
static int search(const struct scene *s, const struct picture *p, enum material m,
                  struct exemplar *found)
{
    struct hs_rng r;
    hs_rng_seed(&r, noise_hash(s->seed + SEED_EXEMPLARS, m, 0));
    const int due = quota(m);
    int count = 0;
    for (int t = 0; t < TRIES && count < due; t++) {
        const uint32_t x = hs_rng_below(&r, (uint32_t)s->size);
        const uint32_t y = hs_rng_below(&r, (uint32_t)s->size);
        const size_t sub = (size_t)(CANVAS_SUB * y) * (size_t)s->canvas.side + CANVAS_SUB * x;
        struct outline o;
        if (s->canvas.material[sub] != m ||
            !fit(s, p, &r, x + 0.5, y + 0.5, material_look(m)->group, &o)) {
            continue;
        }
        const struct exemplar e = to_ground(s, &o, m);
        if (is_far_from(found, count, &e, 12 * s->cell_m)) {
            found[count++] = e;
        }
    }
    return count;
}

static int print_exemplar(FILE *out, const struct exemplar *e, bool is_first)
{
    double longitude[CORNERS], latitude[CORNERS];
    if (output_geographic(e->corner, CORNERS, longitude, latitude) != 0) {
        return -1;
    }
    const struct material_look *look = material_look(e->material);
    fprintf(out,
            "%s{\"type\": \"Feature\", \"properties\": {\"class\": \"%s\", \"material\": \"%s\"},\n"
            " \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[",
            is_first ? "" : ",\n", material_class_name(look->group), material_name(e->material));
    /* Rows run south, so going round the other way makes the ring counter-clockwise as RFC 7946
     * wants. */
    for (int i = CORNERS; i >= 0; i--) {
        fprintf(out, "[%.7f, %.7f]%s", longitude[i % CORNERS], latitude[i % CORNERS],
                i > 0 ? ", " : "");
    }
    fputs("]]}}", out);
    return 0;
}

int exemplars_write(const struct scene *s, const struct picture *p, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("{\"type\": \"FeatureCollection\", \"name\": \"exemplars\", \"features\": [\n",
          file.stream);
    int written = 0;
    for (int m = 0; m < MATERIAL_COUNT; m++) {
        struct exemplar found[PER_MATERIAL_MAX];
        const int count = search(s, p, (enum material)m, found);
        for (int i = 0; i < count; i++) {
            if (print_exemplar(file.stream, &found[i], written++ == 0) != 0) {
                hs_atomic_abort(&file);
                return -1;
            }
        }
    }
    fputs("\n]}\n", file.stream);
    return hs_atomic_commit(&file);
}
