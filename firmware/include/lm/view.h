/* How a picture on the glass lies over the ground: one point of both, the direction that is up, and
 * the scale. Sector and patch are the same to whoever draws a symbol or moves the cursor. */
#ifndef LM_VIEW_H
#define LM_VIEW_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/draw.h"
#include "lm/geo.h"
#include "lm/scan_conv.h"

struct lm_view {
    struct lm_place origin;
    fx_bam_t up;           /* azimuth from north that points up */
    struct lm_point at;    /* the origin on the glass */
    uint32_t mm_q8_per_px; /* scale, millimetres * 256 a pixel; below 2^30 */
    int32_t radius_px;     /* of the sector; half a side of the patch */
};

/* The sector around `place`: its apex at the bottom centre of the frame. */
struct lm_view lm_view_of_sector(const struct lm_frame *frame, struct lm_place place,
                                 fx_bam_t heading, uint32_t range_m);

/* A patch of cells x cells around `centre`, seen along `look`. */
struct lm_view lm_view_of_patch(const struct lm_frame *frame, struct lm_place centre, fx_bam_t look,
                                uint32_t cells, uint32_t cell_mm);

/* A point of the glass with parts of a pixel, pixels * 256, from the view's origin: x to the right,
 * y up. */
struct lm_offset {
    int32_t x_q8, y_q8;
};

/* Where a place lies. False, and *offset unchanged, further than 250 km from the origin or further
 * than LM_DRAW_FAR pixels from it. Cost: about 500 instructions. */
bool lm_view_find(const struct lm_view *v, struct lm_place place, struct lm_offset *offset);

/* The place under an offset, at most 250 km away. Cost: about 1,000 instructions. */
struct lm_place lm_view_place(const struct lm_view *v, struct lm_offset offset);

/* The pixel of an offset. */
struct lm_point lm_view_point(const struct lm_view *v, struct lm_offset offset);

#endif
