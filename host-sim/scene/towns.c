/* Streets, blocks and buildings. */
#include "district.h"
#include "noise.h"
#include "painters.h"

#include <math.h>

enum { SEED_TOWN = 1200, SEED_VILLAGE = 1210 };

static const double quarter_m = 430;

struct builder {
    struct scene *scene;
    material_set ground; /* what may be built on */
};

static void put(struct builder *b, const struct shape *s, enum material m, uint64_t variant,
                double height_m)
{
    const struct brush brush = {m, (uint8_t)variant, height_m, b->ground};
    canvas_shape(&b->scene->canvas, s, &brush);
}

static void plant_tree(struct builder *b, struct hs_rng *r, struct point at)
{
    const struct brush tree = {BROADLEAF, (uint8_t)hs_rng_u64(r), 5 + 6 * hs_rng_uniform(r),
                               MATERIAL_BIT(GARDEN) | MATERIAL_BIT(GRASS)};
    canvas_disc(&b->scene->canvas, at, 2.5 + 3 * hs_rng_uniform(r), &tree);
}

static void plant_trees(struct builder *b, struct hs_rng *r, const struct shape *s, int count)
{
    const struct point centre = shape_centre(s);
    for (int i = 0; i < count && s->count > 0; i++) {
        const struct point corner = s->p[hs_rng_below(r, (uint32_t)s->count)];
        const struct point next = s->p[hs_rng_below(r, (uint32_t)s->count)];
        const struct point edge = point_between(corner, next, hs_rng_uniform(r));
        plant_tree(b, r, point_between(centre, edge, hs_rng_uniform(r)));
    }
}

static enum material pick_roof(struct hs_rng *r, double tile_share)
{
    static const enum material others[] = {ROOF_DARK, ROOF_DARK, ROOF_METAL, ROOF_WHITE};
    return hs_rng_uniform(r) < tile_share ? ROOF_TILE : others[hs_rng_below(r, 4)];
}

static void build_on_lot(void *context, struct hs_rng *r, const struct shape *lot)
{
    const double height_m = 9 + 3 * hs_rng_below(r, 5);
    const uint64_t variant = hs_rng_u64(r);
    put(context, lot, pick_roof(r, 0.62), variant, height_m);
}

/* A closed ring of houses round a court. */
static void build_closed_block(struct builder *b, struct hs_rng *r, const struct shape *block)
{
    static const struct division lots = {420, {0, 0, 0}, 0.15, 2};
    const struct shape walls = shape_inset(block, 2.5), court = shape_inset(block, 16);
    put(b, block, CONCRETE_OLD, hs_rng_u64(r), 0);
    district_divide(&walls, &lots, r, build_on_lot, b);
    if (court.count > 0 && shape_area(&court) > 250) {
        const uint64_t variant = hs_rng_u64(r);
        put(b, &court, hs_rng_uniform(r) < 0.6 ? GARDEN : ASPHALT_OLD, variant, 0);
        plant_trees(b, r, &court, (int)(shape_area(&court) / 150));
    }
}

/* Detached houses along the streets, gardens behind. */
static void build_houses(struct builder *b, struct hs_rng *r, const struct shape *block)
{
    put(b, block, GARDEN, hs_rng_u64(r), 0);
    const struct shape inner = shape_inset(block, 6);
    plant_trees(b, r, &inner, (int)(shape_area(block) / 260));
    const double lot_m = 17 + 7 * hs_rng_uniform(r);
    for (int i = 0; i < block->count; i++) {
        const struct point from = block->p[i], to = block->p[(i + 1) % block->count];
        const double length = point_distance(from, to);
        const struct frame f = {from, (to.u - from.u) / length, (to.v - from.v) / length};
        for (double x = 6; x + lot_m < length - 10; x += lot_m) {
            const double wide = 9 + 4 * hs_rng_uniform(r), deep = 8 + 3 * hs_rng_uniform(r);
            const double back = 5 + 3 * hs_rng_uniform(r), side = 2 * hs_rng_uniform(r);
            const struct shape house =
                frame_rectangle(&f, x + side, back, x + side + wide, back + deep);
            if (hs_rng_uniform(r) < 0.93 && shape_contains(block, shape_centre(&house))) {
                const double height_m = 5 + hs_rng_below(r, 4);
                const uint64_t variant = hs_rng_u64(r);
                put(b, &house, pick_roof(r, 0.85), variant, height_m);
            }
        }
    }
}

/* Rows of flats with lawns and parking between. */
static void build_slabs(struct builder *b, struct hs_rng *r, const struct shape *block)
{
    put(b, block, GRASS, hs_rng_u64(r), 0);
    plant_trees(b, r, block, (int)(shape_area(block) / 300));
    const struct point from = block->p[0], to = block->p[1 % block->count];
    const double length = point_distance(from, to);
    const struct frame f = {from, (to.u - from.u) / length, (to.v - from.v) / length};
    for (double y = 9; y < 190; y += 42) {
        const struct shape slab = frame_rectangle(&f, 10, y, fmin(length - 10, 75), y + 13);
        const struct shape parking = frame_rectangle(&f, 10, y + 17, fmin(length - 10, 70), y + 32);
        if (shape_contains(block, slab.p[2]) && shape_contains(block, slab.p[3])) {
            put(b, &parking, ASPHALT_NEW, hs_rng_u64(r), 0);
            const double height_m = 15 + 3 * hs_rng_below(r, 5);
            const uint64_t variant = hs_rng_u64(r);
            put(b, &slab, hs_rng_uniform(r) < 0.5 ? ROOF_DARK : ROOF_WHITE, variant, height_m);
        }
    }
}

static void make_park(struct builder *b, struct hs_rng *r, const struct shape *block)
{
    put(b, block, GRASS, hs_rng_u64(r), 0);
    plant_trees(b, r, block, (int)(shape_area(block) / 110));
}

static void core_block(void *context, struct hs_rng *r, const struct shape *block)
{
    struct builder *b = context;
    const double pick = hs_rng_uniform(r);
    if (pick < 0.06) {
        make_park(b, r, block);
    } else if (pick < 0.11) {
        put(b, block, CONCRETE, hs_rng_u64(r), 0); /* a square */
    } else {
        build_closed_block(b, r, block);
    }
}

static void residential_block(void *context, struct hs_rng *r, const struct shape *block)
{
    const double pick = hs_rng_uniform(r);
    if (pick < 0.06) {
        make_park(context, r, block);
    } else if (pick < 0.22 && block->count >= 4) {
        build_slabs(context, r, block);
    } else {
        build_houses(context, r, block);
    }
}

static void build_hall(void *context, struct hs_rng *r, const struct shape *lot)
{
    static const enum material roofs[] = {ROOF_METAL, ROOF_METAL, ROOF_WHITE, ROOF_BLUE,
                                          ROOF_DARK,  ROOF_DARK,  ROOF_TILE};
    const struct shape hall = shape_inset(lot, 11 + 14 * hs_rng_uniform(r));
    if (hall.count > 0 && shape_area(&hall) > 300) {
        const double height_m = 8 + hs_rng_below(r, 7);
        const uint64_t variant = hs_rng_u64(r);
        put(context, &hall, roofs[hs_rng_below(r, 7)], variant, height_m);
    }
}

static void industrial_block(void *context, struct hs_rng *r, const struct shape *block)
{
    static const struct division lots = {9000, {0, 0, 0}, 0.2, 1};
    static const enum material yards[] = {ASPHALT_OLD, ASPHALT_OLD, CONCRETE_OLD, GRAVEL};
    const uint64_t variant = hs_rng_u64(r);
    put(context, block, yards[hs_rng_below(r, 4)], variant, 0);
    district_divide(block, &lots, r, build_hall, context);
}

enum quarter { QUARTER_NONE, QUARTER_CORE, QUARTER_HOUSES, QUARTER_INDUSTRY };

static enum quarter quarter_at(const struct scene *s, struct point p)
{
    const double wander = 170 * noise_value(s->seed + SEED_TOWN, p.u / 500, p.v / 500);
    const double from_town = point_distance(p, land_town()) + wander;
    const double south = point_distance(p, (struct point){-650, -850});
    const double north = point_distance(p, (struct point){-950, 1350});
    if (land_at(&s->land, s->land.shore_m, p) < 60) {
        return QUARTER_NONE;
    }
    if (from_town < 640) {
        return QUARTER_CORE;
    }
    if (south < 560 || north < 420) {
        return QUARTER_INDUSTRY;
    }
    return from_town < 1480 ? QUARTER_HOUSES : QUARTER_NONE;
}

static void build_quarter(struct builder *b, struct hs_rng *r, const struct shape *outline,
                          enum quarter kind)
{
    static const struct division core = {5200, {14, 10, 8}, 0.16, 4};
    static const struct division houses = {8200, {11, 8, 7}, 0.16, 5};
    static const struct division industry = {26000, {16, 12, 10}, 0.2, 2};
    const struct shape inside = shape_inset(outline, 6.5);
    put(b, outline, ASPHALT_OLD, 90 + hs_rng_below(r, 80), 0);
    district_divide(&inside,
                    kind == QUARTER_CORE     ? &core
                    : kind == QUARTER_HOUSES ? &houses
                                             : &industry,
                    r,
                    kind == QUARTER_CORE     ? core_block
                    : kind == QUARTER_HOUSES ? residential_block
                                             : industrial_block,
                    b);
}

static void build_town(struct builder *b)
{
    const uint64_t seed = b->scene->seed + SEED_TOWN;
    const int reach = (int)ceil(2600 / quarter_m);
    for (int j = -reach; j <= reach; j++) {
        for (int i = -reach; i <= reach; i++) {
            const struct point site = district_site(seed, i, j, quarter_m);
            const enum quarter kind = quarter_at(b->scene, site);
            if (kind != QUARTER_NONE) {
                struct hs_rng r;
                hs_rng_seed(&r, noise_hash(seed, i, j));
                const struct shape outline = district_shape(seed, i, j, quarter_m);
                build_quarter(b, &r, &outline, kind);
            }
        }
    }
}

static void build_village(struct builder *b, int index, struct point at, double radius_m)
{
    struct hs_rng r;
    hs_rng_seed(&r, noise_hash(b->scene->seed + SEED_VILLAGE, index, 0));
    struct shape outline = {.count = 9};
    for (int i = 0; i < outline.count; i++) {
        const double angle = 2 * 3.14159265358979323846 * i / outline.count;
        const double out = radius_m * (0.85 + 0.3 * hs_rng_uniform(&r));
        outline.p[i] = (struct point){at.u + out * cos(angle), at.v + out * sin(angle)};
    }
    build_quarter(b, &r, &outline, QUARTER_HOUSES);
}

void scene_paint_towns(struct scene *s)
{
    static const struct {
        struct point at;
        double radius_m;
    } villages[] = {{{2900, -450}, 230},  {{-2300, -3500}, 210}, {{1750, 1650}, 190},
                    {{5450, -1250}, 240}, {{2900, -5400}, 200},  {{-1900, 2350}, 200},
                    {{2820, 2300}, 170},  {{-900, -2750}, 160},  {{2300, -2200}, 180}};
    struct builder b = {s, ~material_set_of_class(CLASS_WATER)};
    for (int i = 0; i < (int)(sizeof villages / sizeof *villages); i++) {
        build_village(&b, i, villages[i].at, villages[i].radius_m);
    }
    build_town(&b);
}
