/* View: how a picture lies over the ground: origin, direction of up, and scale. Whoever draws a
 * symbol or moves the cursor asks the view, and need not know the kind of picture.
 *
 *          up                     up
 *     +-----|-----+           +----|----+
 *     |     |     |           |    |    |
 *     |     |     |           |    +    |  middle = origin
 *     |.    |    .|           |         |
 *     |  .  |  .  |           +---------+
 *     +-----+-----+
 *         origin
 *     sector: middle = origin    patch
 *
 * A window is a square cut out of a sector: its origin is the sector's apex, often far below the
 * glass, and its middle is the square's.
 *
 * Where the sector or window is seen from a height, lengths on the glass are slant ranges; in a
 * patch they are ground ranges. */
#ifndef LM_VIEW_H
#define LM_VIEW_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/draw.h"
#include "lm/geo.h"
#include "lm/scan_conv.h"

/* Offset: a point of the glass from the view's origin; x to the right, y up. */
struct lm_offset {
    int32_t x_px_q8, y_px_q8;
};

enum lm_view_shape {
    LM_VIEW_SECTOR, /* a sector around the ownship, which is the origin */
    LM_VIEW_WINDOW, /* a square cut out of such a sector, enlarged */
    LM_VIEW_PATCH   /* a square around the origin */
};

struct lm_view {
    enum lm_view_shape shape;
    struct lm_position origin;
    fx_bam_t up;                 /* azimuth from north that points up */
    int32_t height_m_q10;        /* of the antenna above flat ground; 0 in a patch */
    struct lm_point at;          /* the origin: the upper left corner of this pixel */
    struct lm_point middle;      /* of the window or patch: the upper left corner of this pixel; in
                                    a sector the same as `at` */
    uint32_t scale_mm_per_px_q8; /* below 2^30 */
    int32_t radius_px;           /* of the sector; half a side of the window or patch */
    int32_t aside_px, above_px;  /* sector: what the frame shows to each side of the origin, and
                                  * above it */
};

/* Position and direction that a sector or window is seen from. */
struct lm_view_from {
    struct lm_position position;
    fx_bam_t up;          /* azimuth from north that points up */
    int32_t height_m_q10; /* of the antenna above flat ground */
};

/* The view of a sector of radius `range_m`, its apex at the middle of the frame's lower edge;
 * `is_whole` as in lm_ppi_radius_px. */
struct lm_view lm_view_of_sector(const struct lm_frame *frame, const struct lm_view_from *from,
                                 uint32_t range_m, bool is_whole);

/* The view of a window that reaches `half_m` to each side of `centre`, in the frame's square. */
struct lm_view lm_view_of_window(const struct lm_frame *frame, const struct lm_view_from *from,
                                 struct lm_position centre, uint32_t half_m);

/* The view of a patch of cells x cells around `centre`, seen along azimuth `look`. */
struct lm_view lm_view_of_patch(const struct lm_frame *frame, struct lm_position centre,
                                fx_bam_t look, uint32_t cells, uint32_t cell_mm);

/* Greatest distance, in x and in y, from a window's middle to the apex of its lines. */
enum { LM_VIEW_APEX_FAR_PX = 16000 };

/* Offset of the view's middle. */
struct lm_offset lm_view_middle(const struct lm_view *v);

/* Find the offset of a position. False, and *offset unchanged, iff the position is
 * - farther than 250 km from the origin, or
 * - farther than LM_DRAW_FAR pixels from the view's middle, in x or in y.
 * Cost: about 500 instructions. */
bool lm_view_find(const struct lm_view *v, struct lm_position position, struct lm_offset *offset);

/* The position under an offset; one farther than 250 km from the origin is brought to 250 km. Cost:
 * about 1,000 instructions. */
struct lm_position lm_view_position(const struct lm_view *v, struct lm_offset offset);

/* Geometry for lm_scan_conv_sector of lines whose cells are `cell_m_q8` long, and whose first cell
 * begins `edge_m_q8` from the origin. */
struct lm_ppi lm_view_ppi(const struct lm_view *v, const struct lm_frame *frame, uint32_t cell_m_q8,
                          uint32_t edge_m_q8);

/* The pixel that holds an offset. An offset on the edge between two pixels belongs to the right or
 * the upper one. */
struct lm_point lm_view_point(const struct lm_view *v, struct lm_offset offset);

#endif
