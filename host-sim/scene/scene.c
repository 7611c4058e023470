#include "scene/scene.h"

struct brush scene_ground(enum material m, uint64_t variant, material_set over)
{
    return (struct brush){m, (uint8_t)variant, 0, over};
}

struct brush scene_solid(enum material m, uint64_t variant, double height_m)
{
    return (struct brush){m, (uint8_t)variant, height_m, 0};
}

int scene_make(struct scene *s)
{
    if (land_make(&s->land, s->seed, s->size * s->cell_m) != 0) {
        return -1;
    }
    if (canvas_init(&s->canvas, s->size, s->cell_m) != 0) {
        land_free(&s->land);
        return -1;
    }
    scene_paint_nature(s);
    scene_paint_farms(s);
    scene_paint_streams(s);
    scene_paint_towns(s);
    scene_paint_port(s);
    scene_paint_airfield(s);
    scene_paint_roads(s);
    return 0;
}

void scene_free(struct scene *s)
{
    land_free(&s->land);
    canvas_free(&s->canvas);
}
