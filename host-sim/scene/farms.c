/* Fields: each parcel one crop, lanes between them, trees along some borders, here and there a
 * farm. */
#include "district.h"
#include "noise.h"
#include "painters.h"

#include <math.h>

enum { SEED_FARMS = 1000, SEED_BORDERS = 1010 };

static const double spacing_m = 760;

static enum material pick_crop(struct hs_rng *r)
{
    static const struct {
        enum material crop;
        double share;
    } mix[] = {{WHEAT, 0.20},    {MAIZE, 0.18},     {MEADOW, 0.22},
               {STUBBLE, 0.09},  {SOIL_DARK, 0.08}, {SOIL_LIGHT, 0.05},
               {SOIL_RED, 0.04}, {ORCHARD, 0.08},   {RAPE, 0.06}};
    double x = hs_rng_uniform(r);
    for (size_t i = 0; i < sizeof mix / sizeof *mix; i++) {
        x -= mix[i].share;
        if (x < 0) {
            return mix[i].crop;
        }
    }
    return WHEAT;
}

/* A line of trees, with gaps, along one border of a parcel. */
static void plant_border(struct scene *s, struct hs_rng *r, struct point a, struct point b)
{
    const double length = point_distance(a, b);
    const int pieces = (int)ceil(length / 45);
    for (int i = 0; i < pieces; i++) {
        if (hs_rng_uniform(r) < 0.8) {
            const struct point line[2] = {point_between(a, b, (double)i / pieces),
                                          point_between(a, b, (i + 1.0) / pieces)};
            const double height_m = 6 + 5 * hs_rng_uniform(r);
            struct brush trees = scene_solid(BROADLEAF, hs_rng_u64(r), height_m);
            trees.over = SCENE_OPEN;
            canvas_line(&s->canvas, line, 2, 6 + 4 * hs_rng_uniform(r), &trees);
        }
    }
}

static void plough(void *context, struct hs_rng *r, const struct shape *parcel)
{
    struct scene *s = context;
    const struct shape field = shape_inset(parcel, 0.8);
    const enum material crop = pick_crop(r);
    struct brush b = scene_ground(crop, hs_rng_u64(r), MATERIAL_BIT(MEADOW) | MATERIAL_BIT(GRAVEL));
    b.height_m = crop == ORCHARD ? 3 : 0;
    canvas_shape(&s->canvas, &field, &b);
    for (int i = 0; i < parcel->count; i++) {
        if (hs_rng_uniform(r) < 0.11) {
            plant_border(s, r, parcel->p[i], parcel->p[(i + 1) % parcel->count]);
        }
    }
}

static void build_farm(struct scene *s, struct hs_rng *r, struct point at)
{
    const struct frame f = frame_at(at, 360 * hs_rng_uniform(r));
    const struct shape yard = frame_rectangle(&f, -32, -26, 32, 26);
    const enum material at_site = canvas_at(&s->canvas, at);
    if (at_site == MATERIAL_COUNT || !(SCENE_OPEN & MATERIAL_BIT(at_site))) {
        return;
    }
    const uint64_t grain = hs_rng_u64(r);
    struct brush b =
        scene_ground(hs_rng_uniform(r) < 0.5 ? GRAVEL : CONCRETE_OLD, grain, SCENE_OPEN);
    canvas_shape(&s->canvas, &yard, &b);
    const struct shape barn[2] = {frame_rectangle(&f, -30, 10, 12, 25),
                                  frame_rectangle(&f, 17, -20, 31, 20)};
    const struct shape house = frame_rectangle(&f, -26, -22, -11, -11);
    for (int i = 0; i < 2; i++) {
        const uint64_t roof = hs_rng_u64(r);
        b = scene_solid(hs_rng_uniform(r) < 0.6 ? ROOF_METAL : ROOF_TILE, roof, 8);
        canvas_shape(&s->canvas, &barn[i], &b);
    }
    b = scene_solid(ROOF_TILE, hs_rng_u64(r), 7);
    canvas_shape(&s->canvas, &house, &b);
    for (int i = 0; i < 9; i++) {
        b = scene_solid(BROADLEAF, hs_rng_u64(r), 9);
        b.over = SCENE_OPEN;
        const double radius_m = 3 + 3 * hs_rng_uniform(r);
        canvas_disc(&s->canvas, frame_point(&f, 42 - 90 * hs_rng_uniform(r), -36), radius_m, &b);
    }
}

/* Neighbours share a border, so what runs along it must not depend on who paints it. */
static void lay_border(struct scene *s, struct point a, struct point b)
{
    const int64_t u = llround((a.u + b.u) / 4), v = llround((a.v + b.v) / 4);
    const double pick = noise_at(s->seed + SEED_BORDERS, u, v);
    const bool is_road = pick < 0.62;
    const struct brush brush =
        scene_ground(is_road ? ASPHALT_OLD : GRAVEL, (uint64_t)(pick * 255), SCENE_OPEN);
    const struct point line[2] = {a, b};
    canvas_line(&s->canvas, line, 2, is_road ? 7 : 4.5, &brush);
    canvas_disc(&s->canvas, a, is_road ? 3.5 : 2.2, &brush);
}

static void farm_district(struct scene *s, int i, int j)
{
    static const struct division fields = {17000, {5, 4.5, 0}, 0.3, 5};
    const uint64_t seed = s->seed + SEED_FARMS;
    struct hs_rng r;
    hs_rng_seed(&r, noise_hash(seed, i, j));
    const struct shape district = district_shape(seed, i, j, spacing_m);
    const struct shape inside = shape_inset(&district, 3);
    const struct brush lane = scene_ground(GRAVEL, hs_rng_u64(&r), MATERIAL_BIT(MEADOW));
    canvas_shape(&s->canvas, &inside, &lane);
    district_divide(&inside, &fields, &r, plough, s);
    for (int k = 0; k < district.count; k++) {
        lay_border(s, district.p[k], district.p[(k + 1) % district.count]);
    }
    const struct shape core = shape_inset(&district, 60);
    for (int k = 0; k < core.count; k++) {
        if (hs_rng_uniform(&r) < 0.3) {
            build_farm(s, &r, core.p[k]);
        }
    }
}

void scene_paint_farms(struct scene *s)
{
    const int reach = (int)ceil(0.75 * s->size * s->cell_m / spacing_m) + 1;
    for (int j = -reach; j < reach; j++) {
        for (int i = -reach; i < reach; i++) {
            farm_district(s, i, j);
        }
    }
}
