/* View of a model as an eye at the radar's azimuth sees it, to lay beside its radar picture. */
#ifndef TARGET_VIEW_H
#define TARGET_VIEW_H

#include "tracer/scene.h"

#include <stdint.h>

struct view {
    double azimuth_deg, depression_deg; /* of the eye, as in struct trace_look; 90 is from above */
    double span_m;                      /* of the picture, across; the origin is in the middle */
};

/* Draw `size_px` * size_px pixels 0x00RRGGBB, `stride_px` between rows, the top row first: parallel
 * projection, lit from above over the viewer's left shoulder. */
void view_draw(const struct scene *s, const struct view *v, uint32_t *pixels, int size_px,
               int stride_px);

#endif
