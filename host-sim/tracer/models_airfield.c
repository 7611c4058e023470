/* What stands on an airfield. Overall dimensions as the header says; all within is estimated: right
 * parts at about the right places, not drawings. */
#include "shapes.h"

#include "tracer/models.h"

/* ---- aircraft ---- */

/* A wing, tailplane or fin: root and tip, each from front to back edge, so thick, so far out. */
struct edge {
    double front, back, thick, out;
};

/* To the left of the aircraft for side 1, to its right for -1; its middle at height z. */
static void wing(struct mesh *m, const struct edge *root, const struct edge *tip, double z,
                 double side, uint32_t material)
{
    const struct edge *ends[2] = {side > 0 ? root : tip, side > 0 ? tip : root};
    struct vec corners[2][4];
    for (int i = 0; i < 2; i++) { /* seen from the right, where x runs to the right: clockwise */
        const struct edge *e = ends[i];
        const double y = side * e->out, low = z - e->thick / 2, high = z + e->thick / 2;
        corners[i][0] = (struct vec){e->back, y, high};
        corners[i][1] = (struct vec){e->front, y, high};
        corners[i][2] = (struct vec){e->front, y, low};
        corners[i][3] = (struct vec){e->back, y, low};
    }
    shape_loft(m, corners[0], corners[1], 4, true, material);
}

static void fin(struct mesh *m, const struct edge *root, const struct edge *tip, uint32_t material)
{
    const struct edge *ends[2] = {root, tip};
    struct vec corners[2][4];
    for (int i = 0; i < 2; i++) { /* seen from below, where y runs to the right: clockwise */
        const struct edge *e = ends[i];
        corners[i][0] = (struct vec){e->front, -e->thick / 2, e->out};
        corners[i][1] = (struct vec){e->front, e->thick / 2, e->out};
        corners[i][2] = (struct vec){e->back, e->thick / 2, e->out};
        corners[i][3] = (struct vec){e->back, -e->thick / 2, e->out};
    }
    shape_loft(m, corners[0], corners[1], 4, true, material);
}

static void fuselage(struct mesh *m, uint32_t metal)
{
    const struct shape_round parts[] = {
        {{7.0, 0, 2.1}, {7.53, 0, 2.1}, 0.03, 0.02, 12, true},   /* probe */
        {{4.6, 0, 2.05}, {7.1, 0, 2.1}, 0.48, 0.06, 72, true},   /* radome */
        {{1.2, 0, 2.0}, {4.6, 0, 2.05}, 0.72, 0.48, 72, true},   /* forebody */
        {{-4.6, 0, 2.0}, {1.2, 0, 2.0}, 0.78, 0.72, 72, true},   /* body */
        {{-7.53, 0, 2.05}, {-4.6, 0, 2.0}, 0.5, 0.78, 72, true}, /* engine */
        {{3.4, 0, 2.6}, {4.6, 0, 2.4}, 0.38, 0.08, 48, true},    /* canopy */
        {{1.4, 0, 2.6}, {3.4, 0, 2.6}, 0.3, 0.38, 48, true},
    };
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        shape_round(m, &parts[i], metal);
    }
}

/* A duct below, open ahead. */
static void intake(struct mesh *m, uint32_t metal)
{
    shape_box(m, (struct vec){-2.5, -0.55, 0.95}, (struct vec){1.6, 0.55, 1.6}, metal);
    shape_box(m, (struct vec){1.6, -0.55, 0.95}, (struct vec){3.2, 0.55, 1.0}, metal);
    shape_box(m, (struct vec){1.6, -0.55, 1.0}, (struct vec){3.2, -0.5, 1.6}, metal);
    shape_box(m, (struct vec){1.6, 0.5, 1.0}, (struct vec){3.2, 0.55, 1.6}, metal);
}

/* With its axle across. */
static void wheel(struct mesh *m, double x, double y, double radius, double half_width,
                  uint32_t rubber)
{
    const struct shape_round r = {
        {x, y - half_width, radius}, {x, y + half_width, radius}, radius, radius, 36, true};
    shape_round(m, &r, rubber);
}

/* What is on both sides: wing, rail with a missile at its tip, tank below it, tailplane, leg. */
static void half_aircraft(struct mesh *m, double side, uint32_t metal, uint32_t rubber)
{
    static const struct edge root = {1.3, -3.6, 0.22, 0.7}, tip = {-1.9, -3.2, 0.05, 4.82};
    static const struct edge tail_root = {-5.0, -7.4, 0.12, 0.6},
                             tail_tip = {-6.5, -7.4, 0.04, 2.8};
    wing(m, &root, &tip, 2.0, side, metal);
    wing(m, &tail_root, &tail_tip, 2.0, side, metal);
    const struct shape_round parts[] = {
        {{-3.6, side * 4.9, 2.0}, {-0.6, side * 4.9, 2.0}, 0.08, 0.08, 24, true},
        {{-3.3, side * 1.9, 1.4}, {1.0, side * 1.9, 1.4}, 0.33, 0.33, 48, true},
        {{1.0, side * 1.9, 1.4}, {2.0, side * 1.9, 1.4}, 0.33, 0.05, 48, true},
    };
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        shape_round(m, &parts[i], metal);
    }
    shape_box(m, (struct vec){-2.2, side * 1.9 - 0.05, 1.6},
              (struct vec){0.2, side * 1.9 + 0.05, 1.95}, metal);
    const struct shape_round leg = {
        {-1.2, side * 1.15, 0.35}, {-1.2, side * 0.5, 1.5}, 0.07, 0.07, 12, true};
    shape_round(m, &leg, metal);
    wheel(m, -1.2, side * 1.25, 0.35, 0.1, rubber);
}

void model_aircraft(struct mesh *m)
{
    const uint32_t metal = mesh_material(m, "metal"), rubber = mesh_material(m, "rubber");
    static const struct edge fin_root = {-3.4, -6.9, 0.16, 2.4}, fin_tip = {-6.3, -7.3, 0.06, 4.88};
    fuselage(m, metal);
    intake(m, metal);
    fin(m, &fin_root, &fin_tip, metal);
    half_aircraft(m, 1, metal, rubber);
    half_aircraft(m, -1, metal, rubber);
    const struct shape_round leg = {{2.8, 0, 0.23}, {2.8, 0, 1.2}, 0.06, 0.06, 12, true};
    shape_round(m, &leg, metal);
    wheel(m, 2.8, 0, 0.23, 0.08, rubber);
}

/* ---- lorry and shelter ---- */

void model_lorry(struct mesh *m)
{
    const uint32_t metal = mesh_material(m, "metal"), rubber = mesh_material(m, "rubber");
    const double cab[][2] = {{1.9, 1.0}, {3.6, 1.0}, {3.6, 1.8}, {3.2, 2.8}, {1.9, 2.8}};
    shape_profile(m, cab, 5, -1.2, 1.2, metal);
    shape_box(m, (struct vec){-3.5, -0.45, 0.75}, (struct vec){3.5, 0.45, 1.0}, metal);
    shape_box(m, (struct vec){-3.6, -1.25, 1.05}, (struct vec){1.7, 1.25, 3.1}, metal);
    shape_box(m, (struct vec){3.6, -1.2, 0.55}, (struct vec){3.7, 1.2, 0.9}, metal);
    static const double axles[] = {2.6, -1.6, -2.9};
    for (int i = 0; i < 3; i++) {
        wheel(m, axles[i], 1.0, 0.52, 0.2, rubber);
        wheel(m, axles[i], -1.0, 0.52, 0.2, rubber);
    }
}

void model_shelter(struct mesh *m)
{
    enum { ARC = 180 };
    const uint32_t metal = mesh_material(m, "metal");
    const double half_width = 12, height = 8, half_length = 15;
    const double radius = (half_width * half_width + height * height) / (2 * height);
    const double turn = asin(half_width / radius);
    struct vec back[ARC + 1], front[ARC + 1];
    for (int i = 0; i <= ARC; i++) { /* seen from behind, from the left over the top */
        const double at = turn * (1 - 2.0 * i / ARC);
        const double y = radius * sin(at), z = fmax(radius * cos(at) - (radius - height), 0);
        back[i] = (struct vec){-half_length, y, z};
        front[i] = (struct vec){half_length, y, z};
    }
    shape_loft(m, back, front, ARC + 1, true, metal);
}
