/* The airfield: x along the runway, y towards the apron. */
#include "noise.h"
#include "painters.h"

enum { SEED_AIRFIELD = 1400 };

static const double half_runway = 1100, half_width = 22.5, taxiway_y = 190;

struct builder {
    struct scene *scene;
    struct frame frame;
    struct hs_rng rng;
};

static void put(struct builder *b, double x0, double y0, double x1, double y1, enum material m,
                double height_m)
{
    const struct shape r = frame_rectangle(&b->frame, x0, y0, x1, y1);
    const struct brush brush = scene_solid(m, 118 + hs_rng_below(&b->rng, 20), height_m);
    canvas_shape(&b->scene->canvas, &r, &brush);
}

/* Markings after ICAO Annex 14, figure 5-2, coarsely: centre line, threshold, aiming point. */
static void mark_runway(struct builder *b)
{
    for (double x = -half_runway + 90; x < half_runway - 90; x += 50) {
        put(b, x, -1.3, x + 30, 1.3, PAINT, 0);
    }
    for (int end = -1; end <= 1; end += 2) {
        for (int k = 0; k < 8; k++) {
            const double y = -19 + k * 5.1;
            const double x = end * (half_runway - 8);
            put(b, end > 0 ? x - 30 : x, y, end > 0 ? x : x + 30, y + 2.6, PAINT, 0);
        }
        for (int side = -1; side <= 1; side += 2) {
            const double x = end * (half_runway - 400);
            put(b, x - 25, side > 0 ? 6 : -14, x + 25, side > 0 ? 14 : -6, PAINT, 0);
        }
    }
}

static void lay_pavements(struct builder *b)
{
    static const struct point corner[] = {{-1480, -90}, {-1250, -170}, {1180, -190},
                                          {1500, -100}, {1480, 120},   {1010, 500},
                                          {-640, 540},  {-760, 330},   {-1470, 260}};
    struct point outline[9];
    for (int i = 0; i < 9; i++) {
        outline[i] = frame_point(&b->frame, corner[i].u, corner[i].v);
    }
    const struct brush grass = scene_solid(GRASS, 128, 0), road = scene_solid(ASPHALT_OLD, 140, 0);
    canvas_polygon(&b->scene->canvas, outline, 9, &grass);
    canvas_line(&b->scene->canvas, outline, 9, 5, &road);
    put(b, -half_runway - 60, -half_width - 7, half_runway + 60, half_width + 7, ASPHALT_OLD, 0);
    put(b, -half_runway, -half_width, half_runway, half_width, ASPHALT_NEW, 0);
    put(b, -half_runway, -half_width, -half_runway + 150, half_width, CONCRETE_OLD, 0);
    put(b, half_runway - 150, -half_width, half_runway, half_width, CONCRETE_OLD, 0);
    put(b, -half_runway + 5, taxiway_y - 11, half_runway - 5, taxiway_y + 11, ASPHALT_OLD, 0);
    static const double connector[] = {-1084, -520, 150, 640, 1062};
    for (int i = 0; i < 5; i++) {
        put(b, connector[i], half_width, connector[i] + 23, taxiway_y, ASPHALT_OLD, 0);
    }
    put(b, -420, taxiway_y + 11, 330, 360, CONCRETE, 0);
    put(b, 430, taxiway_y + 11, 455, 270, ASPHALT_OLD, 0);
    put(b, 400, 250, 900, 340, CONCRETE_OLD, 0);
    put(b, -420, 430, 330, 480, ASPHALT_NEW, 0); /* car park */
    put(b, -700, 486, 900, 496, ASPHALT_OLD, 0); /* road behind */
    mark_runway(b);
}

/* An aircraft on the ground is a cross of bright metal. */
static void park_aircraft(struct builder *b, double x, double y, double span)
{
    put(b, x - 2, y - span / 2, x + 2, y + span / 2, ROOF_WHITE, 5);
    put(b, x - span / 2, y - 2.5, x + span / 2, y + 2.5, ROOF_WHITE, 5);
}

static void raise_buildings(struct builder *b)
{
    put(b, -330, 366, -60, 412, ROOF_WHITE, 14); /* terminal */
    put(b, -20, 370, 40, 405, ROOF_DARK, 9);
    put(b, 60, 374, 78, 392, ROOF_METAL, 38); /* tower */
    put(b, 100, 368, 175, 425, ROOF_METAL, 16);
    put(b, 190, 368, 265, 425, ROOF_METAL, 16);
    for (int i = 0; i < 5; i++) {
        put(b, 410 + 96 * i, 346, 480 + 96 * i, 402, i % 2 ? ROOF_METAL : ROOF_BLUE, 13);
    }
    for (int i = 0; i < 4; i++) {
        put(b, 420 + 60 * i, 425, 450 + 60 * i, 470, ROOF_TILE, 7);
        const struct brush tank = scene_solid(TANK, 128, 9);
        canvas_disc(&b->scene->canvas, frame_point(&b->frame, -600 + 32 * i, 400), 11, &tank);
    }
    for (int i = 0; i < 6; i++) {
        park_aircraft(b, -360 + 78 * i, 300, 34);
    }
    for (int i = 0; i < 5; i++) {
        park_aircraft(b, 440 + 80 * i, 300, 15);
    }
}

void scene_paint_airfield(struct scene *s)
{
    struct builder b = {.scene = s, .frame = land_airfield()};
    hs_rng_seed(&b.rng, noise_hash(s->seed + SEED_AIRFIELD, 0, 0));
    lay_pavements(&b);
    raise_buildings(&b);
}
