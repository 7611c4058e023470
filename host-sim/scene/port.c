/* The port at the head of the bay: x inland, y along the quay. */
#include "noise.h"
#include "painters.h"

#include <math.h>

enum { SEED_PORT = 1300 };

static const double quay_x = -170;

static void put(struct scene *s, const struct frame *f, double x0, double y0, double x1, double y1,
                const struct brush *b)
{
    const struct shape r = frame_rectangle(f, x0, y0, x1, y1);
    canvas_shape(&s->canvas, &r, b);
}

static struct brush random_solid(struct hs_rng *r, enum material m, double height_m)
{
    return scene_solid(m, hs_rng_u64(r), height_m);
}

/* Rubble with a concrete crown, and a light at its end. */
static void build_mole(struct scene *s, const struct frame *f, const struct point *local, int count)
{
    struct point bend[8], line[64];
    for (int i = 0; i < count; i++) {
        bend[i] = frame_point(f, local[i].u, local[i].v);
    }
    const int n = line_smooth(bend, count, 8, line);
    const struct brush rubble = scene_solid(ROCK, 70, 3), crown = scene_solid(CONCRETE_OLD, 120, 5);
    const struct brush head = scene_solid(CONCRETE, 128, 5),
                       light = scene_solid(ROOF_WHITE, 128, 14);
    canvas_line(&s->canvas, line, n, 30, &rubble);
    canvas_line(&s->canvas, line, n, 14, &crown);
    canvas_disc(&s->canvas, line[n - 1], 18, &head);
    canvas_disc(&s->canvas, line[n - 1], 6, &light);
}

static void enclose_basin(struct scene *s, const struct frame *f)
{
    static const struct point north[] = {
        {-60, 860}, {-520, 960}, {-980, 840}, {-1190, 560}, {-1215, 260}};
    static const struct point south[] = {
        {-60, -860}, {-560, -940}, {-1060, -760}, {-1290, -380}, {-1320, 60}};
    struct brush calm = scene_ground(HARBOUR_WATER, 128, material_set_of_class(CLASS_WATER));
    const struct point basin[] = {frame_point(f, 60, 880),     frame_point(f, -520, 960),
                                  frame_point(f, -980, 840),   frame_point(f, -1190, 560),
                                  frame_point(f, -1215, 260),  frame_point(f, -1320, 60),
                                  frame_point(f, -1290, -380), frame_point(f, -1060, -760),
                                  frame_point(f, -560, -940),  frame_point(f, 60, -880)};
    canvas_polygon(&s->canvas, basin, 10, &calm);
    build_mole(s, f, north, 5);
    build_mole(s, f, south, 5);
}

/* Bow towards +x. The bridge stands aft. */
static void moor_ship(struct scene *s, struct hs_rng *r, const struct frame *f, double length_m)
{
    const double half = length_m / 2, beam = 0.075 * length_m;
    const struct point hull[] = {frame_point(f, -half, -beam), frame_point(f, 0.7 * half, -beam),
                                 frame_point(f, half, 0), frame_point(f, 0.7 * half, beam),
                                 frame_point(f, -half, beam)};
    const struct brush deck = random_solid(r, SHIP, 11), bridge = random_solid(r, ROOF_WHITE, 24);
    canvas_polygon(&s->canvas, hull, 5, &deck);
    put(s, f, -0.9 * half, -0.8 * beam, -0.66 * half, 0.8 * beam, &bridge);
}

static void build_pier(struct scene *s, struct hs_rng *r, const struct frame *f, double y0,
                       double y1, double out_m)
{
    struct brush b = scene_ground(CONCRETE, hs_rng_u64(r), 0);
    put(s, f, quay_x - out_m, y0, quay_x, y1, &b);
    for (double x = quay_x - out_m + 40; x + 100 < quay_x - 30; x += 125) {
        b = random_solid(r, ROOF_METAL, 9);
        put(s, f, x, y0 + 18, x + 100, y1 - 18, &b);
    }
    const double sides[2] = {y0 - 15, y1 + 15};
    for (int i = 0; i < 2; i++) {
        const double bow_deg = hs_rng_uniform(r) < 0.5 ? 180 : 0;
        const double x = quay_x - out_m / 2 - 40 * hs_rng_uniform(r);
        const struct frame berth = frame_at(frame_point(f, x, sides[i]), bow_deg);
        moor_ship(s, r, &berth, 130 + 50 * hs_rng_uniform(r));
    }
}

static void stack_containers(struct scene *s, struct hs_rng *r, const struct frame *f)
{
    struct brush b = scene_ground(ASPHALT_OLD, 128, 0);
    put(s, f, -110, 350, 270, 780, &b);
    for (double x = -95; x < 240; x += 34) {
        for (double y = 365; y < 740; y += 78) {
            static const enum material paint[] = {CONTAINER, CONTAINER, ROOF_BLUE, ROOF_TILE};
            for (double row = 0; row < 21; row += 7) {
                const double height_m = 2.6 * (1 + hs_rng_below(r, 4));
                b = random_solid(r, paint[hs_rng_below(r, 4)], height_m);
                put(s, f, x + row, y, x + row + 6, y + 66, &b);
            }
        }
    }
    for (double y = 380; y < 760; y += 110) {
        b = random_solid(r, ROOF_BLUE, 48);
        put(s, f, quay_x + 6, y, quay_x + 32, y + 12, &b); /* cranes */
    }
    const struct frame berth = frame_at(frame_point(f, quay_x - 24, 560), 90);
    moor_ship(s, r, &berth, 240);
}

static void fill_tank_farm(struct scene *s, struct hs_rng *r, const struct frame *f)
{
    struct brush b = scene_ground(GRAVEL, 100, 0);
    put(s, f, -60, -790, 300, -420, &b);
    for (int j = 0; j < 5; j++) {
        for (int i = 0; i < 5; i++) {
            const double radius = 13 + 13 * hs_rng_uniform(r);
            const struct point at = frame_point(f, -20 + 70 * i, -755 + 74 * j);
            b = random_solid(r, TANK, 12 + radius / 4);
            if (hs_rng_uniform(r) < 0.85) {
                canvas_disc(&s->canvas, at, radius, &b);
            }
        }
    }
    const struct frame jetty = frame_at(frame_point(f, quay_x - 230, -640), 0);
    b = scene_ground(CONCRETE_OLD, 140, 0);
    put(s, f, quay_x - 330, -612, quay_x, -600, &b);
    moor_ship(s, r, &jetty, 210);
}

static void line_up_warehouses(struct scene *s, struct hs_rng *r, const struct frame *f)
{
    static const enum material roofs[] = {ROOF_METAL, ROOF_DARK, ROOF_METAL, ROOF_TILE, ROOF_BLUE};
    for (int row = 0; row < 3; row++) {
        const double x = -100 + 120 * row;
        for (double y = -385; y < 300; y += 136) {
            const double height_m = 8 + hs_rng_below(r, 6);
            const struct brush b = random_solid(r, roofs[hs_rng_below(r, 5)], height_m);
            put(s, f, x, y, x + 48 + 20 * hs_rng_uniform(r), y + 112, &b);
        }
        const struct brush road = scene_ground(ASPHALT_OLD, 150, 0);
        put(s, f, x + 84, -400, x + 98, 340, &road);
    }
}

void scene_paint_port(struct scene *s)
{
    struct hs_rng r;
    hs_rng_seed(&r, noise_hash(s->seed + SEED_PORT, 0, 0));
    const struct frame f = frame_at(land_port(), 0);
    enclose_basin(s, &f);
    const struct brush paving = scene_ground(CONCRETE_OLD, 150, 0);
    const struct brush apron = scene_ground(CONCRETE, 120, 0);
    put(s, &f, quay_x, -800, 320, 800, &paving);
    put(s, &f, quay_x, -800, quay_x + 45, 800, &apron);
    line_up_warehouses(s, &r, &f);
    stack_containers(s, &r, &f);
    fill_tank_farm(s, &r, &f);
    build_pier(s, &r, &f, -330, -250, 420);
    build_pier(s, &r, &f, 40, 130, 520);
    for (int i = 0; i < 4; i++) {
        const struct point at = {-4300 + 620 * i, 900 - 760.0 * (i % 2) + 300 * hs_rng_uniform(&r)};
        const struct frame anchored = frame_at(at, 200 + 25 * hs_rng_uniform(&r));
        if (land_at(&s->land, s->land.shore_m, at) < -250) {
            moor_ship(s, &r, &anchored, 110 + 90 * hs_rng_uniform(&r));
        }
    }
}
