/* Running water and what grows along it. */
#include "noise.h"
#include "painters.h"

#include <math.h>

enum { SEED_BANKS = 1100 };

/* Trees on both banks of stretch `i` of a stream, with gaps that come and go along the way. */
static void plant_banks(struct scene *s, const struct point *p, int i, double width_m, int64_t name)
{
    const double luck = noise_value(s->seed + SEED_BANKS, i * 0.21, (double)name * 7.3);
    struct brush trees = scene_solid(BROADLEAF, noise_hash(s->seed, name, i), 9);
    trees.over = SCENE_OPEN | MATERIAL_BIT(GRASS) | MATERIAL_BIT(MAQUIS);
    if (luck > -0.1) {
        canvas_line(&s->canvas, p + i, 2, width_m + 7 + 20 * fmax(0, luck), &trees);
    }
}

static material_set land_set(void)
{
    return ~material_set_of_class(CLASS_WATER);
}

static void paint_stream(struct scene *s, int index)
{
    const struct land_stream *stream = &s->land.stream[index];
    for (int i = 0; i + 1 < stream->count; i++) {
        plant_banks(s, stream->p, i, stream->width_m, index);
    }
    const struct brush water = scene_ground(RIVER_WATER, 128, land_set());
    canvas_line(&s->canvas, stream->p, stream->count, stream->width_m, &water);
}

/* Gravel bars lie along the upper river, where it runs fast. */
static void paint_river(struct scene *s)
{
    const struct land *l = &s->land;
    for (int i = 0; i + 1 < l->river_count; i++) {
        const double width = land_river_width(l->river_m[i]);
        plant_banks(s, l->river, i, width, 1000);
        const double bar = 22 * noise_value(s->seed + SEED_BANKS, i * 0.3, 99);
        const struct brush gravel = scene_ground(GRAVEL, noise_hash(s->seed, i, 3), land_set());
        if (bar > 3 && l->river_m[i] > 2500) {
            canvas_line(&s->canvas, l->river + i, 2, width + bar, &gravel);
            canvas_disc(&s->canvas, l->river[i], (width + bar) / 2, &gravel);
        }
    }
    for (int i = 0; i + 1 < l->river_count; i++) {
        const double width = land_river_width(l->river_m[i]);
        const struct brush water =
            scene_ground(RIVER_WATER, 110 + noise_hash(s->seed, i, 4) % 36, land_set());
        canvas_line(&s->canvas, l->river + i, 2, width, &water);
        canvas_disc(&s->canvas, l->river[i], width / 2, &water);
    }
}

void scene_paint_streams(struct scene *s)
{
    for (int i = 0; i < s->land.stream_count; i++) {
        paint_stream(s, i);
    }
    paint_river(s);
}
