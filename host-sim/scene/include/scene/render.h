/* Rendering of the canvas as an imaging satellite sees it, and the true classes behind it. */
#ifndef SCENE_RENDER_H
#define SCENE_RENDER_H

#include "scene/scene.h"

/* Rows of one pixel after the other, `size` * `size` of them; the caller owns and frees. */
struct picture {
    uint16_t *image; /* BAND_COUNT to a pixel: reflectance times 10000, at least 1 */
    uint8_t *truth;  /* enum material_class: the class of most of the pixel */
    float *height_m; /* of the structures and trees that fill at least half of the pixel, or 0 */
};

/* Materials mixed at edges, their variation within a class, light and shade of terrain and of what
 * stands on it, and the sensor's noise. Returns 0, or -1 when memory is short (reported). */
int render_picture(const struct scene *s, struct picture *p);
void render_free(struct picture *p);

#endif
