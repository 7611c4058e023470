#include "scene/scene.h"

#include "hs/error.h"
#include "painters.h"

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
    scene_paint_lines(s);
    canvas_trim_detail(&s->canvas);
    return s->canvas.detail.is_short ? hs_error("detail", "make the scene smaller", "out of memory")
                                     : 0;
}

void scene_free(struct scene *s)
{
    land_free(&s->land);
    canvas_free(&s->canvas);
}
