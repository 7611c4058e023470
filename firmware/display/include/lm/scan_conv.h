/* Scan conversion: lines of grey painted into the plane, where they stay from frame to frame. Law:
 * docs/EQUATIONS.md, "On the glass".
 *
 *     plane (as large as the glass)
 *     +----------------------------------+
 *     |     0.20                0.28     |     margins in halves of the glass;
 *     |    +----------------------+ 0.25 |     the frame is the rectangle that shows radar
 *     |    |                      |      |
 *     |    |        sector        |      |     sector: its apex is the middle of the frame's
 *     |    |  .                .  |      |             lower edge, its radius the frame's
 *     |    |     .          .     |      |             height; the frame cuts its wings
 *     |    |        .    .        |      |     window, patch: a square in the frame's middle
 *     |    +----------------------+ 0.32 |
 *     +----------------------------------+
 *
 * Nothing here fails. */
#ifndef LM_SCAN_CONV_H
#define LM_SCAN_CONV_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/damage.h"
#include "lm/kernels_display.h"

/* Plane: the picture before colours and symbols. */
struct lm_plane {
    uint8_t *pixels; /* lent by the board: width_px * height_px greys, the top row first */
    uint16_t width_px, height_px;
    struct lm_damage *damage; /* borrowed: takes the pixels that the functions below may change; or
                                 NULL */
};

/* Frame: a rectangle of the plane, and within it. */
struct lm_frame {
    uint16_t left_px, top_px, width_px, height_px;
};

/* The frame of a display of 256 to 1024 pixels a side, with the margins drawn above. */
struct lm_frame lm_frame_of_display(uint16_t width_px, uint16_t height_px);

/* The largest square in the middle of a frame. */
struct lm_frame lm_frame_square(const struct lm_frame *frame);

/* Make the frame black. */
void lm_plane_clear(const struct lm_plane *plane, const struct lm_frame *frame);

/* Move the frame's contents right and down by whole pixels. Pixels that come in from outside the
 * frame are black. */
void lm_plane_shift(const struct lm_plane *plane, const struct lm_frame *frame, int32_t right_px,
                    int32_t down_px);

/* Radius of a sector in pixels: the frame's height, as [FreeFalcon]'s viewport has it; or, if
 * `is_whole`, that of the largest sector of +-60 degrees that fits the frame. */
uint16_t lm_ppi_radius_px(const struct lm_frame *frame, bool is_whole);

/* Geometry of lines that meet in one point, the apex. In a window the apex is far below the
 * frame. */
struct lm_ppi {
    struct lm_frame clip;         /* nothing is painted outside */
    int32_t apex_x_px, apex_y_px; /* a corner of pixels, from the plane's upper left; below 2^14 */
    uint32_t cells_per_px_q16;    /* 1..2^20 */
    int32_t near_cells_q8;        /* from the apex to the near edge of the first cell */
};

/* Paint the wedge of one line: from azimuth `left` up to, not including, `right`. Azimuths are
 * clockwise from straight up, within +-80 degrees, and left is before right. `grey` holds `cells`
 * greys, near to far. Wedges that share an edge share no pixel and leave none out. */
void lm_scan_conv_sector(const struct lm_plane *plane, const struct lm_ppi *ppi, fx_bam_t left,
                         fx_bam_t right, const uint8_t *grey, uint32_t cells);

/* Make those pixels of the clip black whose centres lie outside the wedge from azimuth `left` up
 * to, not including, `right`: what lines between these two cannot paint. Azimuths are as in
 * lm_scan_conv_sector. Cost: some 30 instructions a row, and the pixels that are made black. */
void lm_plane_keep_wedge(const struct lm_plane *plane, const struct lm_ppi *ppi, fx_bam_t left,
                         fx_bam_t right);

/* The square of a patch: the largest of an even number of pixels in the middle of a frame. */
struct lm_frame lm_patch_square(const struct lm_frame *frame);

/* Pixels of a patch's square, a side, at most. */
enum { LM_PATCH_SIDE_MAX_PX = LM_K_PATCH_ROWS };

/* Geometry of a patch: its lines are rays from the antenna. */
struct lm_patch_fan {
    uint32_t lines,
        cells; /* both at least 1; the square is `cells` cells of the lines wide and deep */
    uint32_t centre_m_q8; /* from the antenna to the square's middle: beyond half the square */
    uint32_t cell_m_q8;   /* length of a cell, and distance of lines in the square's middle */
};

/* Painter of a patch. Every pixel of the square takes the grey between the four cells around it,
 * linear both ways. Lines are held until there are as many as have 16 pixels between them and the
 * last one that was painted: a strip. The strip is painted then, or when the last line comes.
 *
 *      line k - 1    k    k + 1
 *         \    . .  /  . .  /       . pixels of a strip of two lines
 *          \   . . / . .   /
 *           \  .  / . .   /        lines are closer together at the bottom, where the patch is
 *            \ . / .     /         nearer
 *
 * Up to 15 pixels to the right of a strip are painted before they are due; the next strip paints
 * them again. The caller owns the painter; all fields are read-only to others. Rows count upwards
 * from the bottom of the square. */
struct lm_patch_painter {
    struct lm_frame square;
    uint32_t lines, cells;
    uint32_t strip_lines; /* lines that a strip has: 1..LM_K_STRIP_LINES */
    bool is_wide;         /* there may be more than 16 pixels between two lines */
    uint32_t waiting;     /* lines that are held and not painted yet: less than strip_lines */
    struct lm_k_patch_cells row_cells;
    int32_t step_q20[LM_PATCH_SIDE_MAX_PX]; /* lines a pixel in a row */
    /* The next pixel of each row: its column, and how many lines beyond the line painted last. */
    uint16_t column_px[LM_PATCH_SIDE_MAX_PX];
    int32_t on_q20[LM_PATCH_SIDE_MAX_PX];
    /* Of each row the grey of the line painted last, and of those after it. */
    uint8_t held[LM_PATCH_SIDE_MAX_PX][LM_K_HELD];
};

/* Prepare a patch that fills the square of `frame` (lm_patch_square), of at most
 * LM_PATCH_SIDE_MAX_PX pixels a side. Cost: about 50 instructions a row. */
void lm_patch_painter_set(struct lm_patch_painter *p, const struct lm_frame *frame,
                          const struct lm_patch_fan *fan);

/* Take line `line`, and paint it if it ends a strip. Lines come in order; line 0 restarts the
 * painter. grey[0] is the nearest cell, at the bottom; there are p->cells of them, and one more
 * byte is read. Pixels beyond the first and the last line and cell take these. Cost:
 * docs/benchmarks.md. */
void lm_scan_conv_patch(struct lm_patch_painter *p, const struct lm_plane *plane, uint32_t line,
                        const uint8_t *grey);

#endif
