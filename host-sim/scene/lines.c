/* What is too thin for the canvas: the fence of the airfield, and a power line over the plain. */
#include "painters.h"

static void fence_airfield(struct scene *s)
{
    /* A little outside of the perimeter road. */
    static const struct point corner[] = {{-1490, -100}, {-1255, -180}, {1185, -200},
                                          {1512, -105},  {1490, 126},   {1014, 510},
                                          {-646, 550},   {-768, 338},   {-1480, 268}};
    const struct frame f = land_airfield();
    struct point outline[9];
    for (int i = 0; i < 9; i++) {
        outline[i] = frame_point(&f, corner[i].u, corner[i].v);
    }
    detail_add_fence(&s->canvas.detail, outline, 9);
}

static void lead_power(struct scene *s)
{
    static const struct point way[] = {{-650, -1500}, {900, -1750}, {2600, -1600}, {6300, -3000}};
    for (int i = 0; i + 1 < 4; i++) {
        detail_add_power_line(&s->canvas.detail, way[i], way[i + 1], 320, 42);
    }
}

void scene_paint_lines(struct scene *s)
{
    fence_airfield(s);
    lead_power(s);
}
