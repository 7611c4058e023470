/* Canvas: the ground seen from above, painted with materials at half the pixel size of the image,
 * so that the pixels on an edge mix. */
#ifndef SCENE_CANVAS_H
#define SCENE_CANVAS_H

#include "scene/detail.h"
#include "scene/material.h"
#include "scene/shape.h"

#include <stddef.h>
#include <stdint.h>

enum { CANVAS_SUB = 2 }; /* sub-pixels a side of a pixel */

struct canvas {
    int side;             /* sub-pixels a side */
    double cell_m;        /* of a sub-pixel */
    uint8_t *material;    /* enum material */
    uint8_t *variant;     /* which of 256 looks of the material: one to an object */
    uint8_t *height_hm;   /* of what stands there, in half metres */
    struct detail detail; /* outlines of what is built, as they were painted */
};

/* Brush: the paint and where it takes. */
struct brush {
    enum material material;
    uint8_t variant;
    double height_m;   /* of what is painted, up to 127 */
    material_set over; /* only where the ground is one of these; 0 means everywhere */
};

/* `size` pixels of `cell_m` a side. Returns 0, or -1 when memory is short (reported). */
int canvas_init(struct canvas *c, int size, double cell_m);
void canvas_free(struct canvas *c);

/* Places are in the axes of the design (land.h); what lies off the image is left out. A sub-pixel
 * is painted when its centre is inside. Polygons may be concave; at most 4096 corners. What is
 * built and stands out of the ground is added to the detail, too, where its middle is painted.
 * Rectangles of asphalt and concrete are added as strips. */
void canvas_polygon(struct canvas *c, const struct point *p, int count, const struct brush *b);
void canvas_shape(struct canvas *c, const struct shape *s, const struct brush *b);
void canvas_disc(struct canvas *c, struct point centre, double radius_m, const struct brush *b);
void canvas_line(struct canvas *c, const struct point *p, int count, double width_m,
                 const struct brush *b);

/* Cut the blocks of the detail down to what the canvas still shows of them: what was painted later
 * covers what was painted before. Blocks of which little is left are taken out. */
void canvas_trim_detail(struct canvas *c);

/* Cut the strips of the detail into the pieces that the canvas still shows, and add their verges:
 * one and a half pixels of the image wide, where one class grows beside the strip. */
void canvas_trim_paving(struct canvas *c);

/* Add a polygon to the strips if it is a rectangle of paving. */
void canvas_add_paving(struct canvas *c, const struct point *p, int count, const struct brush *b);

/* The material at a place, or MATERIAL_COUNT off the image. */
enum material canvas_at(const struct canvas *c, struct point p);
/* The variant there; 0 off the image. */
uint8_t canvas_variant_at(const struct canvas *c, struct point p);

#endif
