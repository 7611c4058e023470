/* From lines to the picture's plane: one byte of grey a pixel, painted line by line and kept
 * between frames. docs/EQUATIONS.md, "On the glass". */
#ifndef LM_SCAN_CONV_H
#define LM_SCAN_CONV_H

#include <stdint.h>

#include "fx/types.h"

/* The plane, lent by the board: width * height bytes, row 0 on top. */
struct lm_plane {
    uint8_t *pixels;
    uint16_t width_px, height_px;
};

/* Where a sector or a patch lies in the plane. Sector: the apex at the bottom centre of this
 * rectangle; patch: in its middle. */
struct lm_frame {
    uint16_t left_px, top_px, width_px, height_px;
};

/* The rectangle of the plane that shows radar: in units of half a screen from its centre, top
 * +0.75, bottom -0.68, left -0.80, right +0.72. */
struct lm_frame lm_frame_of_display(uint16_t width_px, uint16_t height_px);

void lm_plane_clear(const struct lm_plane *plane, const struct lm_frame *frame);

/* Radius of the largest sector of +-60 degrees that fits the frame, pixels. */
uint16_t lm_ppi_radius_px(const struct lm_frame *frame);

/* How a fan of lines lies on the plane: where they meet and how large their cells are. The apex of
 * a window's lines is far below it. */
struct lm_ppi {
    struct lm_frame clip;         /* nothing is painted outside */
    int32_t apex_x_px, apex_y_px; /* a corner of pixels, from the plane's upper left; below 2^14 */
    uint32_t cells_per_px_q16;    /* 1..2^20 */
    int32_t near_cells_q8; /* where the lines' first cell begins, cells * 256 from the apex */
};

/* Paint the wedge from azimuth `left` up to, not including, `right` (from straight up, clockwise,
 * both within +-80 degrees, right after left). Lines that share an edge share no pixel and leave
 * none out. */
void lm_scan_conv_sector(const struct lm_plane *plane, const struct lm_ppi *ppi, fx_bam_t left,
                         fx_bam_t right, const uint8_t *grey, uint32_t cells);

/* Move the frame's picture by whole pixels, right and down; what comes in from outside is empty. */
void lm_plane_shift(const struct lm_plane *plane, const struct lm_frame *frame, int32_t right_px,
                    int32_t down_px);

/* The largest square in the middle of the frame. */
struct lm_frame lm_frame_square(const struct lm_frame *frame);

/* Pixels along one side of a patch's cell: the largest whole number with which `cells` fit, at
 * least 1. */
uint16_t lm_patch_cell_px(const struct lm_frame *frame, uint32_t cells);

/* Paint column `line` of a patch of cells x cells; grey[0] is the nearest cell, at the bottom. */
void lm_scan_conv_patch(const struct lm_plane *plane, const struct lm_frame *frame, uint32_t line,
                        const uint8_t *grey, uint32_t cells);

#endif
