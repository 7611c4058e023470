#include "scene/scene.h"

#include "hs/error.h"
#include "hs/progress.h"
#include "painters.h"

/* In the order in which one lies over another. */
static void paint(struct scene *s)
{
    static void (*const painters[])(struct scene *) = {
        scene_paint_nature, scene_paint_farms,    scene_paint_streams, scene_paint_towns,
        scene_paint_port,   scene_paint_airfield, scene_paint_roads,   scene_paint_lines};
    const size_t count = sizeof painters / sizeof painters[0];
    struct hs_progress progress;
    hs_progress_begin(&progress, "painting the scene", count);
    for (size_t i = 0; i < count; i++) {
        painters[i](s);
        hs_progress_update(&progress, i + 1);
    }
    hs_progress_end(&progress);
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
    paint(s);
    canvas_trim_detail(&s->canvas);
    canvas_trim_paving(&s->canvas);
    return s->canvas.detail.is_short ? hs_error("detail", "make the scene smaller", "out of memory")
                                     : 0;
}

void scene_free(struct scene *s)
{
    land_free(&s->land);
    canvas_free(&s->canvas);
}
