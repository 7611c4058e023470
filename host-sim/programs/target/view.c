#include "view.h"

#include "tracer/trace.h"

#include <string.h>

enum { SAMPLES = 3 }; /* aside, in a pixel */

static const uint32_t sky = 0x182028;

static const uint8_t ground_tint[3] = {120, 150, 110};
static const uint8_t tints[][3] = {
    {210, 214, 220}, {150, 120, 90}, {160, 110, 110}, {190, 160, 120}, {140, 150, 190}};
enum { TINTS = sizeof tints / sizeof tints[0] };

/* Of one ray's facet: red, green, blue. */
static void shade(const struct scene *s, uint32_t facet, struct vec along, struct vec light,
                  double rgb[3])
{
    if (facet == SCENE_MISS) {
        for (int c = 0; c < 3; c++) {
            rgb[c] += sky >> (16 - 8 * c) & 0xff;
        }
        return;
    }
    const struct vec n = s->facets[facet].normal;
    const double side = vec_dot(n, along) > 0 ? -1 : 1;
    const double bright = 0.25 + 0.75 * fmax(0, side * vec_dot(n, light));
    const uint8_t material = s->facet_materials[facet];
    const bool is_ground = strcmp(s->materials[material], "ground") == 0;
    const uint8_t *tint = is_ground ? ground_tint : tints[material % TINTS];
    for (int c = 0; c < 3; c++) {
        rgb[c] += tint[c] * bright;
    }
}

static uint32_t pixel_at(const struct scene *s, const struct trace_axes *axes, struct vec light,
                         double across_m, double up_m, double pixel_m)
{
    const double back_m = 2 * fmax(vec_length(s->low), vec_length(s->high)) + 50;
    double rgb[3] = {0, 0, 0};
    for (int first = 0; first < SAMPLES * SAMPLES; first += SCENE_PACKET) {
        struct scene_rays rays = {.count = 0};
        uint32_t facets[SCENE_PACKET];
        for (int k = first; k < SAMPLES * SAMPLES && k < first + SCENE_PACKET; k++) {
            const double right = across_m + (k % SAMPLES + 0.5) / SAMPLES * pixel_m;
            const double rise = up_m - ((double)(k / SAMPLES) + 0.5) / SAMPLES * pixel_m;
            const struct vec at = vec_mad(vec_scale(axes->across, right), axes->rise, rise);
            scene_rays_add(&rays, vec_mad(at, axes->sight, -back_m), axes->sight);
        }
        scene_meet(s, &rays, facets);
        for (uint32_t k = 0; k < rays.count; k++) {
            shade(s, facets[k], axes->sight, light, rgb);
        }
    }
    uint32_t pixel = 0;
    for (int c = 0; c < 3; c++) {
        pixel = pixel << 8 | (uint32_t)(rgb[c] / (SAMPLES * SAMPLES));
    }
    return pixel;
}

void view_draw(const struct scene *s, const struct view *v, uint32_t *pixels, int size_px,
               int stride_px)
{
    const struct trace_look look = {v->azimuth_deg, v->depression_deg, TRACE_WAVELENGTH_M};
    const struct trace_axes axes = trace_axes_of(&look);
    const struct vec toward = {-0.5, -0.6, 1.0}; /* across, away, up: the light */
    const struct vec sum =
        vec_add(vec_add(vec_scale(axes.across, toward.x), vec_scale(axes.away, toward.y)),
                (struct vec){0, 0, toward.z});
    const struct vec light = vec_scale(sum, 1 / vec_length(sum));
    const double pixel_m = v->span_m / size_px;
    for (int row = 0; row < size_px; row++) {
        for (int column = 0; column < size_px; column++) {
            pixels[row * stride_px + column] =
                pixel_at(s, &axes, light, column * pixel_m - v->span_m / 2,
                         v->span_m / 2 - row * pixel_m, pixel_m);
        }
    }
}
