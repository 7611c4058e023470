/* How a picture on the glass lies over the ground: one point of both, the direction that is up, and
 * the scale. Sector and patch are the same to whoever draws a symbol or moves the cursor. */
#ifndef LM_VIEW_H
#define LM_VIEW_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/draw.h"
#include "lm/geo.h"
#include "lm/scan_conv.h"

/* A point of the glass with parts of a pixel, pixels * 256, from the view's origin: x to the right,
 * y up. */
struct lm_offset {
    int32_t x_px_q8, y_px_q8;
};

enum lm_view_shape {
    LM_VIEW_SECTOR, /* a sector around the ownship, the origin */
    LM_VIEW_WINDOW, /* a square cut out of such a sector, enlarged */
    LM_VIEW_PATCH   /* a square around the origin */
};

struct lm_view {
    enum lm_view_shape shape;
    struct lm_position origin;
    fx_bam_t up;            /* azimuth from north that points up */
    int32_t height_m_q10;   /* of the antenna above flat ground, metres * 1024: lengths are slant
                             ranges; 0 in a patch */
    struct lm_point at;     /* the origin on the glass, or far below it: the upper left corner of
                               this pixel */
    struct lm_point middle; /* of the window or patch, likewise; the origin in a sector */
    uint32_t scale_mm_per_px_q8; /* scale, millimetres * 256 a pixel; below 2^30 */
    int32_t radius_px;           /* of the sector; half a side of the window or patch */
};

/* Where a radar looks from. */
struct lm_view_from {
    struct lm_position position;
    fx_bam_t up;
    int32_t height_m_q10; /* above flat ground */
};

/* The sector around the ownship: its apex at the bottom centre of the frame. */
struct lm_view lm_view_of_sector(const struct lm_frame *frame, const struct lm_view_from *from,
                                 uint32_t range_m);

/* The window of half_m to each side around `centre`, in the middle of the frame's square. */
struct lm_view lm_view_of_window(const struct lm_frame *frame, const struct lm_view_from *from,
                                 struct lm_position centre, uint32_t half_m);

/* A patch of cells x cells around `centre`, seen along `look`. */
struct lm_view lm_view_of_patch(const struct lm_frame *frame, struct lm_position centre,
                                fx_bam_t look, uint32_t cells, uint32_t cell_mm);

/* The apex of a window's lines is not farther from its middle, either way. */
enum { LM_VIEW_APEX_FAR_PX = 16000 };

/* Where the middle lies. */
struct lm_offset lm_view_middle(const struct lm_view *v);

/* Where a place lies. False, and *offset unchanged, further than 250 km from the origin or further
 * than LM_DRAW_FAR pixels from the view's middle. Cost: about 500 instructions. */
bool lm_view_find(const struct lm_view *v, struct lm_position position, struct lm_offset *offset);

/* The place under an offset, at most 250 km away. Cost: about 1,000 instructions. */
struct lm_position lm_view_place(const struct lm_view *v, struct lm_offset offset);

/* How lines whose cells are `cell_m_q8` long (metres * 256) and begin `edge_m_q8` away from the
 * origin lie on the plane. */
struct lm_ppi lm_view_ppi(const struct lm_view *v, const struct lm_frame *frame, uint32_t cell_m_q8,
                          uint32_t edge_m_q8);

/* The pixel that holds an offset; of two, the upper one on the right. */
struct lm_point lm_view_point(const struct lm_view *v, struct lm_offset offset);

#endif
