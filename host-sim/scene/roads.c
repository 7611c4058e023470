/* The roads that lead across the country, and their bridges. */
#include "painters.h"

#include <math.h>

enum { CONTROLS_MAX = 12, STEPS = 14, LINE_MAX = CONTROLS_MAX * STEPS };

struct road {
    double width_m;
    int count;
    struct point control[CONTROLS_MAX];
};

static const struct road roads[] = {
    {16,
     7,
     {{-250, 150},
      {700, -150},
      {1500, -250},
      {2300, -700},
      {3600, -1150},
      {5400, -1050},
      {9500, -1500}}},
    {16,
     8,
     {{-350, 100},
      {-500, -900},
      {-450, -1800},
      {-250, -2700},
      {-500, -3400},
      {-1000, -4600},
      {-1100, -6000},
      {-900, -9500}}},
    {12,
     9,
     {{-250, 250},
      {700, 600},
      {1500, 1300},
      {2300, 1850},
      {2900, 2450},
      {3900, 3250},
      {5300, 4450},
      {7200, 6100},
      {9500, 8000}}},
    {10,
     6,
     {{-900, 900}, {-1300, 1700}, {-1950, 2350}, {-2500, 3300}, {-2900, 4700}, {-2900, 9000}}},
    {10, 5, {{-250, -2700}, {250, -3250}, {350, -3700}, {420, -3780}, {440, -3790}}},
    {10, 5, {{2300, -700}, {2350, -2200}, {2800, -3600}, {2900, -5400}, {3300, -9000}}},
};

static bool crossing(struct point a, struct point b, struct point c, struct point d,
                     struct point *at)
{
    const double det = (b.u - a.u) * (d.v - c.v) - (b.v - a.v) * (d.u - c.u);
    if (fabs(det) < 1e-9) {
        return false;
    }
    const double s = ((c.u - a.u) * (d.v - c.v) - (c.v - a.v) * (d.u - c.u)) / det;
    const double t = ((c.u - a.u) * (b.v - a.v) - (c.v - a.v) * (b.u - a.u)) / det;
    *at = point_between(a, b, s);
    return s >= 0 && s <= 1 && t >= 0 && t <= 1;
}

static void build_bridge(struct scene *s, struct point at, struct point a, struct point b,
                         double road_m, double river_m)
{
    const double length = point_distance(a, b), half = 0.75 * river_m + 18;
    const struct frame f = {at, (b.u - a.u) / length, (b.v - a.v) / length};
    const struct shape deck = frame_rectangle(&f, -half, -road_m / 2 - 2.5, half, road_m / 2 + 2.5);
    const struct brush concrete = scene_solid(CONCRETE_OLD, 150, 6);
    canvas_shape(&s->canvas, &deck, &concrete);
    detail_add_line(&s->canvas.detail, deck.p[0], deck.p[1], DETAIL_RAILING);
    detail_add_line(&s->canvas.detail, deck.p[3], deck.p[2], DETAIL_RAILING);
}

static void bridge_river(struct scene *s, const struct point *line, int count, double road_m)
{
    const struct land *l = &s->land;
    for (int i = 0; i + 1 < count; i++) {
        for (int k = 0; k + 1 < l->river_count; k++) {
            struct point at;
            if (crossing(line[i], line[i + 1], l->river[k], l->river[k + 1], &at)) {
                build_bridge(s, at, line[i], line[i + 1], road_m, land_river_width(l->river_m[k]));
            }
        }
    }
}

void scene_paint_roads(struct scene *s)
{
    const material_set open_water = MATERIAL_BIT(SEA_DEEP) | MATERIAL_BIT(SEA_SHALLOW) |
                                    MATERIAL_BIT(SEA_TURBID) | MATERIAL_BIT(LAKE_WATER) |
                                    MATERIAL_BIT(LAKE_ALGAE) | MATERIAL_BIT(HARBOUR_WATER);
    const struct brush asphalt = scene_ground(ASPHALT_OLD, 100, ~open_water);
    const struct brush verge = scene_ground(GRASS, 90,
                                            SCENE_OPEN | MATERIAL_BIT(MAQUIS) |
                                                MATERIAL_BIT(BROADLEAF) | MATERIAL_BIT(CONIFER));
    for (size_t i = 0; i < sizeof roads / sizeof *roads; i++) {
        struct point line[LINE_MAX];
        const int n = line_smooth(roads[i].control, roads[i].count, STEPS, line);
        canvas_line(&s->canvas, line, n, roads[i].width_m + 12, &verge);
        canvas_line(&s->canvas, line, n, roads[i].width_m, &asphalt);
        bridge_river(s, line, n, roads[i].width_m);
    }
}
