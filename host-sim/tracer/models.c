#include "tracer/models.h"

#include "shapes.h"

#include <string.h>

enum { FACETS = 180, ARC = 45 };

static const double pi = 3.14159265358979323846;

/* ---- SLICY ---- */

static void quarter_round(struct mesh *m, uint32_t metal)
{
    const double x = 1.0657, z = 0.4604, radius = 0.3136;
    double xz[ARC + 2][2] = {{x, z}};
    for (int i = 0; i <= ARC; i++) {
        const double turn = pi / 2 * i / ARC;
        xz[i + 1][0] = x + radius * cos(turn);
        xz[i + 1][1] = z + radius * sin(turn);
    }
    shape_profile(m, (const double(*)[2])xz, ARC + 2, -0.1915, 0.9156, metal);
}

static void slicy_trihedral(struct mesh *m, uint32_t metal)
{
    const double side = 0.207, height = 0.2927;
    const struct vec corner = {0.3227, 0.3783, 0.774}, top = {0.3227, 0.3783, 0.774 + height};
    const struct vec left = vec_add(corner, (struct vec){side, side, 0});
    const struct vec right = vec_add(corner, (struct vec){side, -side, 0});
    shape_triangle(m, corner, top, left, metal);
    shape_triangle(m, corner, right, top, metal);
}

void model_slicy(struct mesh *m)
{
    const uint32_t metal = mesh_material(m, "metal");
    shape_box(m, (struct vec){-1.0657, -1.375, 0}, (struct vec){1.3793, 1.375, 0.4604}, metal);
    shape_box(m, (struct vec){-1.0657, -1.375, 0.4604}, (struct vec){1.0657, 1.375, 0.774}, metal);
    quarter_round(m, metal);
    slicy_trihedral(m, metal);
    const struct shape_round solid = {
        {-0.3365, 0.5838, 0.774}, {-0.3365, 0.5838, 1.689}, 0.33, 0.33, FACETS, true};
    const struct shape_round tube = {
        {-0.3365, -0.5821, 0.774}, {-0.3365, -0.5821, 1.232}, 0.33, 0.33, FACETS, false};
    shape_round(m, &solid, metal);
    shape_round(m, &tube, metal);
}

/* ---- tank ---- */

/* Skirts close the width of 3.59 m. */
static void skirts(struct mesh *m, uint32_t steel)
{
    for (int side = -1; side <= 1; side += 2) {
        const double inner = side * 1.745, outer = side * 1.795;
        shape_box(m, (struct vec){-2.9, fmin(inner, outer), 0.72},
                  (struct vec){2.75, fmax(inner, outer), 1.3}, steel);
    }
}

static void hull(struct mesh *m, uint32_t steel)
{
    const double side_view[][2] = {{2.55, 0.49}, {3.475, 0.95}, {2.2, 1.42},
                                   {-3.3, 1.42}, {-3.475, 1.0}, {-2.95, 0.49}};
    shape_profile(m, side_view, 6, -1.05, 1.05, steel);
    const double fender[][2] = {{2.7, 1.08}, {2.9, 1.2}, {2.2, 1.38}, {-3.3, 1.38}, {-3.3, 1.08}};
    shape_profile(m, fender, 5, 1.05, 1.745, steel);
    shape_profile(m, fender, 5, -1.745, -1.05, steel);
}

/* A wheel or drum with its axle across the tank. */
static void wheel(struct mesh *m, double x, double z, double radius, double inner, double outer,
                  uint32_t material)
{
    const struct shape_round r = {{x, inner, z}, {x, outer, z}, radius, radius, 36, true};
    shape_round(m, &r, material);
}

/* A strip of track as seen from the side, from (x0, z0) to (x1, z1), 0.05 m thick upwards. */
static void track_run(struct mesh *m, double x0, double z0, double x1, double z1, double right,
                      double left, uint32_t steel)
{
    const double xz[][2] = {{x0, z0}, {x1, z1}, {x1, z1 + 0.05}, {x0, z0 + 0.05}};
    shape_profile(m, xz, 4, right, left, steel);
}

static void running_gear(struct mesh *m, double right, double left, uint32_t steel, uint32_t rubber)
{
    for (int i = 0; i < 6; i++) {
        wheel(m, -2.15 + 0.86 * i, 0.425, 0.375, right + 0.09, left - 0.09, rubber);
    }
    wheel(m, 2.95, 0.72, 0.27, right + 0.09, left - 0.09, steel);
    wheel(m, -2.95, 0.72, 0.3, right + 0.09, left - 0.09, steel);
    track_run(m, -2.2, 0, 2.2, 0, right, left, steel);
    track_run(m, 2.2, 0, 3.1, 0.45, right, left, steel);
    track_run(m, -3.1, 0.4, -2.2, 0, right, left, steel);
    track_run(m, -3.0, 1.0, 3.0, 1.0, right, left, steel);
}

static void turret(struct mesh *m, bool has_gun, uint32_t steel)
{
    enum { GUN_PARTS = 2 };
    const struct shape_round parts[] = {
        {{0.2, 0, 1.42}, {0.2, 0, 1.72}, 1.2, 1.22, 72, true}, /* shell */
        {{0.2, 0, 1.72}, {0.2, 0, 2.05}, 1.22, 0.85, 72, true},
        {{-0.05, -0.5, 2.05}, {-0.05, -0.5, 2.23}, 0.36, 0.33, 36, true}, /* commander's cupola */
        {{0.1, 0.5, 2.05}, {0.1, 0.5, 2.12}, 0.32, 0.3, 36, true},        /* gunner's hatch */
        {{-1.6, 1.1, 1.75}, {0.1, 1.3, 1.75}, 0.1, 0.1, 24, true},        /* snorkel */
        {{-0.05, -0.5, 2.2}, {1.0, -0.5, 2.2}, 0.03, 0.03, 12, true},     /* machine gun */
        {{1.2, 0, 1.75}, {6.055, 0, 1.75}, 0.1, 0.085, 36, true},         /* gun */
        {{3.5, 0, 1.75}, {4.3, 0, 1.75}, 0.13, 0.13, 36, true},           /* its bore evacuator */
    };
    const size_t count = sizeof parts / sizeof parts[0] - (has_gun ? 0 : GUN_PARTS);
    for (size_t i = 0; i < count; i++) {
        shape_round(m, &parts[i], steel);
    }
    shape_box(m, (struct vec){1.1, -0.3, 1.5}, (struct vec){1.5, 0.3, 1.95}, steel);
    shape_box(m, (struct vec){1.2, -0.75, 1.75}, (struct vec){1.45, -0.4, 2.05}, steel);
    shape_box(m, (struct vec){-1.75, -0.8, 1.55}, (struct vec){-1.0, 0.8, 1.9}, steel);
}

static void tank(struct mesh *m, bool is_bare)
{
    const uint32_t steel = mesh_material(m, "metal"), rubber = mesh_material(m, "rubber");
    hull(m, steel);
    if (!is_bare) {
        skirts(m, steel);
    }
    running_gear(m, 1.1, 1.68, steel, rubber);
    running_gear(m, -1.68, -1.1, steel, rubber);
    turret(m, !is_bare, steel);
    if (is_bare) {
        return;
    }
    wheel(m, -3.55, 1.3, 0.12, -1.2, 1.2, rubber); /* unditching log */
    wheel(m, -3.6, 1.75, 0.28, 0.15, 1.05, steel); /* fuel drums */
    wheel(m, -3.6, 1.75, 0.28, -1.05, -0.15, steel);
}

void model_tank(struct mesh *m)
{
    tank(m, false);
}

static void model_tank_bare(struct mesh *m)
{
    tank(m, true);
}

/* ---- single reflectors, one metre a side, open towards the nose ---- */

static void model_plate(struct mesh *m)
{
    shape_plate(m, (struct vec){0, -0.5, 0.02}, (struct vec){0, 1, 0}, (struct vec){0, 0, 1},
                mesh_material(m, "metal"));
}

static void model_dihedral(struct mesh *m)
{
    const uint32_t metal = mesh_material(m, "metal");
    model_plate(m);
    shape_plate(m, (struct vec){0, -0.5, 0.02}, (struct vec){1, 0, 0}, (struct vec){0, 1, 0},
                metal);
}

static void model_trihedral(struct mesh *m)
{
    const uint32_t metal = mesh_material(m, "metal");
    const struct vec apex = {0, 0, 0.02}, up = {0, 0, 1};
    const struct vec left = {sqrt(0.5), sqrt(0.5), 0}, right = {sqrt(0.5), -sqrt(0.5), 0};
    shape_plate(m, apex, right, left, metal);
    shape_plate(m, apex, up, left, metal);
    shape_plate(m, apex, right, up, metal);
}

static void model_top_hat(struct mesh *m)
{
    const uint32_t metal = mesh_material(m, "metal");
    const struct shape_round brim = {{0, 0, 0}, {0, 0, 0.02}, 1.5, 1.5, FACETS, true};
    const struct shape_round crown = {{0, 0, 0.02}, {0, 0, 1.02}, 0.5, 0.5, FACETS, true};
    shape_round(m, &brim, metal);
    shape_round(m, &crown, metal);
}

const struct model_kind model_kinds[] = {
    {"slicy", "Sandia's test target of boxes, cylinders, dihedral and trihedral", true,
     model_slicy},
    {"tank", "a tank of a T-72's dimensions, of boxes, cylinders and plates", false, model_tank},
    {"tank-bare", "the same without gun, skirts, drums and log, as public chips of a T-72 show it",
     false, model_tank_bare},
    {"aircraft", "a fighter of an F-16's dimensions, of boxes, cones and plates", false,
     model_aircraft},
    {"lorry", "a lorry with a box body, 7.3 x 2.5 x 3.1 m", false, model_lorry},
    {"shelter", "an arched aircraft shelter, 30 x 24 x 8 m", false, model_shelter},
    {"plate", "an upright plate of 1 m, facing ahead", true, model_plate},
    {"dihedral", "an upright and a level plate of 1 m, open ahead", true, model_dihedral},
    {"trihedral", "three square plates of 1 m, open ahead", true, model_trihedral},
    {"tophat", "an upright cylinder, 1 m wide and high, on a disc of 3 m", false, model_top_hat},
};
const int model_kind_count = sizeof model_kinds / sizeof model_kinds[0];

const struct model_kind *model_find(const char *name)
{
    for (int i = 0; i < model_kind_count; i++) {
        if (strcmp(model_kinds[i].name, name) == 0) {
            return &model_kinds[i];
        }
    }
    return NULL;
}
