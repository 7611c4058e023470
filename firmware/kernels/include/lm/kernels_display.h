/* Kernels of the glass: pixels of a patch between its lines, and pixels of a picture through its
 * palette. What holds for every kernel is in lm/kernels_map.h. */
#ifndef LM_KERNELS_DISPLAY_H
#define LM_KERNELS_DISPLAY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    LM_K_PATCH_ROWS = 1024,  /* of a patch's picture, at most */
    LM_K_PATCH_GROUP = 16,   /* rows whose cells are fetched at once */
    LM_K_PATCH_CLOSE = 32,   /* cells among which these are, if they are close */
    LM_K_HELD = 16,          /* greys that have room beside one another for each row */
    LM_K_STRIP_LINES = 14,   /* lines of a strip, at most: one has a grey before and one behind */
    LM_K_LINE_Q20 = 1 << 20, /* from one line to the next, where a pixel's place is counted */
    LM_K_LINE_Q7 = 1 << 7,   /* and where a share is taken of it */
    LM_K_STRIP_PX = 16       /* pixels that a row has in a strip, at most */
};

/* The two cells of a line between whose middles each row lies, from the bottom up. */
struct lm_k_patch_cells {
    uint16_t first[LM_K_PATCH_ROWS / LM_K_PATCH_GROUP]; /* a cell for each group of rows */
    uint8_t above[LM_K_PATCH_ROWS];   /* from there to the lower cell of a row, in cells */
    uint8_t part_q7[LM_K_PATCH_ROWS]; /* the share of the upper one: 0..127 */
    bool are_close; /* each above[] is less than 32, and the line has 32 cells from first[] on */
};

/* Grey between two, a share of 0..2^7 from the first to the second. A difference is below 2^8,
 * times 2^7: 16 bits hold it. */
static inline uint8_t lm_k_grey_between(uint8_t first, uint8_t second, uint16_t share_q7)
{
    const int16_t more = (int16_t)((second - first) * (int16_t)share_q7 + LM_K_LINE_Q7 / 2);
    return (uint8_t)(first + (more >> 7));
}

/* Hold the greys of a line at the middles of `rows` rows: held[row][at]. Whole groups of rows are
 * written. grey[0] is the nearest cell; where a row's lower cell is the line's last, one more byte
 * may be read, and its share is 0. Cost: 2.4 a row. */
void lm_k_patch_hold(const struct lm_k_patch_cells *cells, const uint8_t *grey, uint32_t rows,
                     uint8_t (*held)[LM_K_HELD], uint32_t at);

/* A strip of a patch: rows of the picture between the line that was painted last and some more. */
struct lm_k_patch_strip {
    uint8_t (*held)[LM_K_HELD]; /* of each row: the line painted last, and those behind it */
    uint32_t lines;             /* behind it: 1..LM_K_STRIP_LINES */
    const int32_t *step_q20;    /* lines a pixel, of each row: 1..2^26 */
    /* The next pixel of each row: how many lines it lies beyond the line painted last, 0 or more,
     * and its column. */
    int32_t *on_q20;
    uint16_t *column_px;
    uint8_t *pixels; /* column 0 of the first row; LM_K_STRIP_PX may be written from each column */
    ptrdiff_t up;    /* from a row to the next */
    uint32_t rows;
};

/* Paint the pixels of a strip, of which no row has more than LM_K_STRIP_PX. A row that has any gets
 * LM_K_STRIP_PX written: behind those of the strip comes the grey of its last line. That line is
 * then the one painted last: `held`, `on_q20` and `column_px` go on to it, and to the first pixel
 * behind it. Cost: 52 a row. */
void lm_k_patch_paint(const struct lm_k_patch_strip *lent);

enum { LM_K_GREYS = 256, LM_K_COLOUR_BYTES = 4 };

/* The colours of the greys: 0x00RRGGBB << shift, which is 0 or 8. */
struct lm_k_colours {
    uint32_t of_grey[LM_K_GREYS];
    uint8_t byte[LM_K_COLOUR_BYTES][LM_K_GREYS]; /* the same, lowest bytes first */
    uint8_t shift;
    bool is_neutral; /* red, green and blue are equal in each */
};

/* A rectangle of a picture, and where it goes. Strides are of rows, in pixels. */
struct lm_k_area {
    const uint8_t *grey;
    uint32_t *pixel;
    uint32_t grey_stride, pixel_stride;
    uint32_t width, height;
};

/* Give each pixel of an area the colour of its grey. Writes no other pixel. Cost: 1 a pixel where
 * the colours are neutral, 3 where not. */
void lm_k_colour_area(const struct lm_k_colours *colours, const struct lm_k_area *area);

#endif
