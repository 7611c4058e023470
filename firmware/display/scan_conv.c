#include "lm/scan_conv.h"

#include <stddef.h>

#include "fx/mem.h"
#include "fx/sat.h"
#include "fx/trig.h"

struct lm_frame lm_frame_of_display(uint16_t width_px, uint16_t height_px)
{
    /* In hundredths of half a screen: 20 from the left edge, 28 from the right, 25 from the top, 32
     * from the bottom. */
    const uint16_t left = (uint16_t)(width_px * 20u / 200u);
    const uint16_t top = (uint16_t)(height_px * 25u / 200u);
    return (struct lm_frame){.left_px = left,
                             .top_px = top,
                             .width_px = (uint16_t)(width_px * 172u / 200u - left),
                             .height_px = (uint16_t)(height_px * 168u / 200u - top)};
}

/* Mark a part of the plane in its damage. */
static void mark_part(const struct lm_plane *plane, const struct lm_rectangle *r)
{
    if (plane->damage) {
        lm_damage_mark(plane->damage, r);
    }
}

static void mark_frame(const struct lm_plane *plane, const struct lm_frame *f)
{
    const struct lm_rectangle r = {f->left_px, f->top_px, f->left_px + f->width_px,
                                   f->top_px + f->height_px};
    mark_part(plane, &r);
}

void lm_plane_clear(const struct lm_plane *plane, const struct lm_frame *frame)
{
    mark_frame(plane, frame);
    for (uint32_t y = frame->top_px; y < (uint32_t)frame->top_px + frame->height_px; y++) {
        memset(plane->pixels + y * plane->width_px + frame->left_px, 0, frame->width_px);
    }
}

uint16_t lm_ppi_radius_px(const struct lm_frame *frame, bool is_whole)
{
    if (!is_whole) {
        return frame->height_px;
    }
    /* A sector of +-60 degrees and radius r is sqrt 3 r wide and r high: 56756 / 65536 = sin 60. */
    const uint32_t by_width = ((uint32_t)frame->width_px << 15) / 56756u;
    return (uint16_t)(by_width < frame->height_px ? by_width : frame->height_px);
}

static int32_t tangent_q16_of(fx_bam_t azimuth)
{
    return (int32_t)((int64_t)fx_sin_q30(azimuth) * 65536 / fx_cos_q30(azimuth));
}

/* Edge of a wedge, row by row upwards from the apex. The centres of row 0 are half a pixel above
 * the apex. The edge's column is the first one, counted from the apex, whose centre is on the edge
 * or right of it. Both lines that share an edge get the same column from it, so they share no
 * pixel. */
struct edge {
    int64_t x_q17, step_q17;
};

static struct edge edge_at(fx_bam_t azimuth)
{
    /* Centre of column c is c + 1/2: c >= (row + 1/2) tan - 1/2, in Q17 (2 row + 1) tan - 2^16,
     * rounded up. */
    const int64_t tangent_q16 = tangent_q16_of(azimuth);
    return (struct edge){.x_q17 = tangent_q16 - 65536 + 131071, .step_q17 = 2 * tangent_q16};
}

static void skip_rows(struct edge *e, int32_t rows)
{
    e->x_q17 += rows * e->step_q17;
}

static inline int64_t next_column(struct edge *e)
{
    const int64_t column = e->x_q17 >> 17;
    e->x_q17 += e->step_q17;
    return column;
}

/* Direction of the wedge's middle, in cells a pixel. The range of a pixel is its projection on this
 * direction. */
struct direction {
    int64_t right_q32, up_q32;
};

static struct direction direction_of(fx_bam_t azimuth, uint32_t cells_per_px_q16)
{
    return (struct direction){(int64_t)fx_sin_q30(azimuth) * cells_per_px_q16 >> 14,
                              (int64_t)fx_cos_q30(azimuth) * cells_per_px_q16 >> 14};
}

/* Rows, counted from the apex: `first` up to, not including, `end`. */
struct rows {
    int32_t first, end;
};

/* The rows from `first` up to, not including, `end` that are in `all`. An empty result is at the
 * end of `all`. */
static struct rows clip_rows(const struct rows *all, int64_t first, int64_t end)
{
    const int64_t from = first > all->first ? first : all->first;
    const int64_t to = end < all->end ? end : all->end;
    return from < to ? (struct rows){(int32_t)from, (int32_t)to}
                     : (struct rows){all->end, all->end};
}

/* The rows of the clip that may hold a pixel in range. *sure gets those of them whose pixels are
 * all in range. A row's nearest and farthest pixels are on the edges, so the edges bound both. */
static struct rows rows_in_range(const struct lm_ppi *ppi, const struct direction *d,
                                 const struct edge *left, const struct edge *right, uint32_t cells,
                                 struct rows *sure)
{
    const struct lm_frame *clip = &ppi->clip;
    const int32_t bottom = ppi->apex_y_px - clip->top_px - clip->height_px;
    const struct rows all = {fx_max_i32(bottom, 0), ppi->apex_y_px - clip->top_px};
    /* Cells a row along each edge, in Q32: below 2^37. */
    const int64_t at_left = d->up_q32 + (d->right_q32 * left->step_q17 >> 17);
    const int64_t at_right = d->up_q32 + (d->right_q32 * right->step_q17 >> 17);
    const int64_t least = at_left < at_right ? at_left : at_right;
    const int64_t most = at_left < at_right ? at_right : at_left;
    *sure = (struct rows){all.end, all.end};
    if (least <= 0) {
        return all;
    }
    const int64_t near_q32 = (int64_t)ppi->near_cells_q8 * (1 << 24);
    const int64_t far_q32 = near_q32 + ((int64_t)cells << 32);
    const struct rows found = clip_rows(&all, near_q32 / most - 2, far_q32 / least + 2);
    /* Each column before a pixel cuts less than 2^-17 of a cell off its range. A margin of one cell
     * covers the sum. */
    const int64_t cell_q32 = (int64_t)1 << 32;
    *sure = clip_rows(&found, (near_q32 + cell_q32) / least + 2, (far_q32 - cell_q32) / most - 2);
    return found;
}

/* Columns that may be painted, counted from the apex: `first` up to, not including, `end`. */
struct columns {
    int32_t first, end;
};

/* Leave out rows where a + row * b is certainly below 0. */
static void keep_above(struct rows *rows, int64_t a, int64_t b)
{
    const int64_t crossing = b == 0 ? 0 : -a / b; /* rounded towards row 0 */
    if (b > 0 && crossing > rows->first) {
        rows->first = crossing < rows->end ? (int32_t)crossing : rows->end;
    } else if (b < 0 && crossing + 1 < rows->end) {
        rows->end = crossing >= rows->first ? (int32_t)crossing + 1 : rows->first;
    }
}

/* Leave out rows where the wedge is beside the columns: most rows, in a window. */
static void keep_meeting(struct rows *rows, const struct edge *left, const struct edge *right,
                         const struct columns *columns)
{
    keep_above(rows, columns->end * (1LL << 17) - left->x_q17, -left->step_q17);
    keep_above(rows, right->x_q17 - columns->first * (1LL << 17), right->step_q17);
}

/* True if no row of the wedge reaches beyond the columns. The edges are straight, so the first and
 * the last row tell. */
static bool are_inside(const struct edge *left, const struct edge *right, const struct rows *rows,
                       const struct columns *columns)
{
    const int64_t last = rows->end - 1 - rows->first;
    const int64_t left_q17 = left->x_q17 + last * left->step_q17;
    const int64_t right_q17 = right->x_q17 + last * right->step_q17;
    return left->x_q17 >> 17 >= columns->first && left_q17 >> 17 >= columns->first &&
           right->x_q17 >> 17 <= columns->end && right_q17 >> 17 <= columns->end;
}

/* The part of a wedge that is not painted yet. `apex` is the pixel of the next row above the apex,
 * and `range_q33` the range in cells of that pixel's centre. Centres are at odd halves of a pixel,
 * so ranges are sums of half steps: Q32 becomes Q33. They stay below 2^52, as |2 c + 1| < 2^15 and
 * cells a pixel are below 2^36 in Q32. */
struct wedge {
    struct edge left, right;
    struct direction along;
    uint8_t *apex;
    ptrdiff_t width_px;
    int64_t range_q33;
};

/* Tests of a pixel before it is painted. Callers pass constants, so that the compiler drops the
 * tests that are not needed. */
struct asked {
    bool is_in_columns, is_in_range;
};

static inline void paint_row(const struct wedge *w, int64_t from, int64_t to, bool is_range_asked,
                             const uint8_t *grey, uint32_t cells)
{
    if (from >= to) {
        return;
    }
    int32_t cell_q17 = (int32_t)((w->range_q33 + 2 * from * w->along.right_q32) >> 16);
    uint8_t *pixel = w->apex + from;
    const uint8_t *const end = w->apex + to;
    do {
        const uint32_t cell = (uint32_t)(cell_q17 >> 17);
        if (!is_range_asked || cell < cells) {
            *pixel = grey[cell];
        }
        cell_q17 += (int32_t)(w->along.right_q32 >> 15);
    } while (++pixel != end);
}

static inline struct wedge paint_rows(struct wedge w, int32_t rows, struct asked asked,
                                      const struct columns *columns, const uint8_t *grey,
                                      uint32_t cells)
{
    const uint8_t *const end = w.apex - rows * w.width_px;
    for (; w.apex != end; w.apex -= w.width_px, w.range_q33 += 2 * w.along.up_q32) {
        int64_t from = next_column(&w.left), to = next_column(&w.right);
        if (asked.is_in_columns) {
            from = from > columns->first ? from : columns->first;
            to = to < columns->end ? to : columns->end;
        }
        paint_row(&w, from, to, asked.is_in_range, grey, cells);
    }
    return w;
}

/* Mark the rows of a wedge in a plane's damage, band by band. Its edges are straight, so they are
 * farthest out in the first or the last row of a band, of which the first band and the last may
 * have fewer: what they mark beside the wedge is a pixel or two. `left` and `right` are at the
 * first row. */
static void mark_wedge(const struct lm_plane *plane, const struct lm_ppi *ppi,
                       const struct edge *left, const struct edge *right, const struct rows *rows,
                       const struct columns *columns)
{
    const int32_t first = ppi->apex_x_px + columns->first, end = ppi->apex_x_px + columns->end;
    const int64_t apex_q17 = ppi->apex_x_px * (1LL << 17);
    const int32_t y = ppi->apex_y_px - 1 - rows->first, last_y = ppi->apex_y_px - rows->end;
    const int64_t before = LM_BLOCK_HEIGHT_PX - 1 - y % LM_BLOCK_HEIGHT_PX; /* rows of the first */
    const int64_t last = LM_BLOCK_HEIGHT_PX - 1;
    int64_t from_q17 = apex_q17 + left->x_q17 - before * left->step_q17 +
                       (left->step_q17 < 0 ? last * left->step_q17 : 0);
    int64_t to_q17 = apex_q17 + right->x_q17 - before * right->step_q17 +
                     (right->step_q17 > 0 ? last * right->step_q17 : 0);
    for (int32_t band = y / LM_BLOCK_HEIGHT_PX; band >= last_y / LM_BLOCK_HEIGHT_PX; band--) {
        lm_damage_mark_band(plane->damage, (uint32_t)band,
                            fx_max_i32((int32_t)(from_q17 >> 17), first),
                            fx_min_i32((int32_t)(to_q17 >> 17), end));
        from_q17 += LM_BLOCK_HEIGHT_PX * left->step_q17;
        to_q17 += LM_BLOCK_HEIGHT_PX * right->step_q17;
    }
}

void lm_scan_conv_sector(const struct lm_plane *plane, const struct lm_ppi *ppi, fx_bam_t left,
                         fx_bam_t right, const uint8_t *grey, uint32_t cells)
{
    const struct lm_frame *clip = &ppi->clip;
    const int32_t leftmost = clip->left_px - ppi->apex_x_px;
    const struct columns columns = {leftmost, leftmost + clip->width_px};
    struct wedge w = {.left = edge_at(left),
                      .right = edge_at(right),
                      .along = direction_of(left + (right - left) / 2, ppi->cells_per_px_q16),
                      .width_px = plane->width_px};
    struct rows sure, rows = rows_in_range(ppi, &w.along, &w.left, &w.right, cells, &sure);
    keep_meeting(&rows, &w.left, &w.right, &columns);
    if (rows.first >= rows.end) {
        return;
    }
    skip_rows(&w.left, rows.first);
    skip_rows(&w.right, rows.first);
    if (plane->damage) {
        mark_wedge(plane, ppi, &w.left, &w.right, &rows, &columns);
    }
    w.apex =
        plane->pixels + ppi->apex_x_px + (ptrdiff_t)(ppi->apex_y_px - 1 - rows.first) * w.width_px;
    w.range_q33 = (2 * rows.first + 1) * w.along.up_q32 + w.along.right_q32 -
                  (int64_t)ppi->near_cells_q8 * (1 << 25);
    const struct rows middle = clip_rows(&rows, sure.first, sure.end);
    if (!are_inside(&w.left, &w.right, &rows, &columns)) {
        const struct asked both = {true, true}, in_columns = {true, false};
        w = paint_rows(w, middle.first - rows.first, both, &columns, grey, cells);
        w = paint_rows(w, middle.end - middle.first, in_columns, &columns, grey, cells);
        paint_rows(w, rows.end - middle.end, both, &columns, grey, cells);
        return;
    }
    const struct asked range = {false, true}, nothing = {false, false};
    w = paint_rows(w, middle.first - rows.first, range, &columns, grey, cells);
    w = paint_rows(w, middle.end - middle.first, nothing, &columns, grey, cells);
    paint_rows(w, rows.end - middle.end, range, &columns, grey, cells);
}

void lm_plane_keep_wedge(const struct lm_plane *plane, const struct lm_ppi *ppi, fx_bam_t left,
                         fx_bam_t right)
{
    const struct lm_frame *clip = &ppi->clip;
    const int64_t first = clip->left_px - ppi->apex_x_px, end = first + clip->width_px;
    const int32_t top = ppi->apex_y_px - clip->top_px; /* rows from the apex to the clip's top */
    const int32_t bottom = top - clip->height_px;
    struct edge left_edge = edge_at(left), right_edge = edge_at(right);
    mark_frame(plane, clip);
    skip_rows(&left_edge, fx_max_i32(bottom, 0));
    skip_rows(&right_edge, fx_max_i32(bottom, 0));
    for (int32_t row = bottom; row < top; row++) {
        uint8_t *apex = plane->pixels + (ptrdiff_t)(ppi->apex_y_px - 1 - row) * plane->width_px +
                        ppi->apex_x_px;
        int64_t from = end, to = end; /* below the apex nothing is kept */
        if (row >= 0) {
            from = fx_clamp_i64(next_column(&left_edge), first, end);
            to = fx_clamp_i64(next_column(&right_edge), from, end);
        }
        memset(apex + first, 0, (size_t)(from - first));
        memset(apex + to, 0, (size_t)(end - to));
    }
}

struct lm_frame lm_frame_square(const struct lm_frame *frame)
{
    const uint16_t side = frame->width_px < frame->height_px ? frame->width_px : frame->height_px;
    return (struct lm_frame){.left_px = (uint16_t)(frame->left_px + (frame->width_px - side) / 2),
                             .top_px = (uint16_t)(frame->top_px + (frame->height_px - side) / 2),
                             .width_px = side,
                             .height_px = side};
}

/* Copy a row, shifted to the right; the rows may be the same. */
static void shift_row(uint8_t *to, const uint8_t *from, int32_t width_px, int32_t right_px)
{
    const uint32_t blank = fx_min_u32(fx_abs_u32(right_px), (uint32_t)width_px);
    const uint32_t kept = (uint32_t)width_px - blank;
    if (right_px > 0) {
        memmove(to + blank, from, kept);
        memset(to, 0, blank);
    } else {
        memmove(to, from + blank, kept);
        memset(to + kept, 0, blank);
    }
}

void lm_plane_shift(const struct lm_plane *plane, const struct lm_frame *frame, int32_t right_px,
                    int32_t down_px)
{
    const int32_t height = frame->height_px;
    uint8_t *top = plane->pixels + frame->top_px * plane->width_px + frame->left_px;
    mark_frame(plane, frame);
    /* In this order no row is overwritten before it is read. */
    for (int32_t n = 0; n < height; n++) {
        const int32_t to = down_px > 0 ? height - 1 - n : n, from = to - down_px;
        uint8_t *const row = top + to * plane->width_px;
        if (from >= 0 && from < height) {
            shift_row(row, top + from * plane->width_px, frame->width_px, right_px);
        } else {
            memset(row, 0, frame->width_px);
        }
    }
}

struct lm_frame lm_patch_square(const struct lm_frame *frame)
{
    struct lm_frame square = lm_frame_square(frame);
    square.width_px &= 0xFFFEu;
    square.height_px &= 0xFFFEu;
    return square;
}

enum { LINE_Q20 = 1 << 20, SHARE_Q7 = 1 << 7, ROWS_AT_ONCE = 64 };

/* Set the cells that a row lies between: row r of n is (r + 1/2) C / n - 1/2 above the middle of
 * cell 0, of C cells. */
static void set_cells(struct lm_patch_painter *p, uint32_t row)
{
    const uint32_t rows = p->square.height_px;
    const int64_t above_q7 =
        (int64_t)(2 * row + 1) * p->cells * SHARE_Q7 / (2 * rows) - SHARE_Q7 / 2;
    const int64_t last_q7 = (int64_t)(p->cells - 1) * SHARE_Q7;
    const uint32_t held_q7 = (uint32_t)fx_clamp_i64(above_q7, 0, last_q7);
    p->cell[row] = (uint16_t)(held_q7 / SHARE_Q7);
    p->part_q7[row] = (uint16_t)(held_q7 % SHARE_Q7);
}

/* Set the lines of a row. Row r lies (2 r + 1) C / 2 n cells beyond the near edge, of C cells in n
 * rows. With S the range of the middle, s that of the row and ds a cell, a pixel is
 *
 *     C / n S / s lines = 2 C S / (2 n (S - C ds / 2) + (2 r + 1) C ds)
 *
 * Ranges are below 2^26, C and n at most 2^10: numerator and denominator are below 2^38. A pixel
 * that is more than 2^6 lines is at the antenna's feet, in no patch. */
static void set_lines(struct lm_patch_painter *p, const struct lm_patch_fan *fan, uint32_t row)
{
    const int64_t rows = p->square.height_px, side_m_q8 = (int64_t)fan->cells * fan->cell_m_q8;
    const int64_t middle = 2 * (int64_t)fan->cells * fan->centre_m_q8;
    const int64_t there =
        rows * (2 * (int64_t)fan->centre_m_q8 - side_m_q8) + (2 * (int64_t)row + 1) * side_m_q8;
    const int64_t most_q20 = (int64_t)LINE_Q20 << 6;
    const int64_t step_q20 =
        fx_clamp_i64(there > 0 ? middle * LINE_Q20 / there : most_q20, LINE_Q20 >> 6, most_q20);
    /* The middle of the leftmost pixel lies (n - 1) / 2 pixels left of the square's middle, and
     * line -1 (N + 1) / 2 lines. */
    const int64_t start_q20 =
        ((int64_t)fan->lines + 1) * (LINE_Q20 / 2) - (p->square.width_px - 1) * step_q20 / 2;
    p->step_q20[row] = (int32_t)step_q20;
    p->start_q20[row] = (int32_t)fx_clamp_i64(start_q20, 0, INT32_MAX / 2);
    p->most_px = fx_max_u32(p->most_px, (uint32_t)((LINE_Q20 + step_q20 - 1) / step_q20));
}

void lm_patch_painter_set(struct lm_patch_painter *p, const struct lm_frame *frame,
                          const struct lm_patch_fan *fan)
{
    p->square = lm_patch_square(frame);
    p->lines = fan->lines;
    p->cells = fan->cells;
    p->most_px = 0;
    /* Whole groups of rows, as they are painted. */
    for (uint32_t row = 0; row < (uint32_t)p->square.height_px + ROWS_AT_ONCE - 1; row++) {
        set_cells(p, row % LM_PATCH_SIDE_MAX_PX);
        set_lines(p, fan, row % LM_PATCH_SIDE_MAX_PX);
    }
}

/* Some rows of a strip, which lies between two lines. From its next pixel on, each row has four
 * pixels of it at most. */
struct strip {
    uint16_t grey[ROWS_AT_ONCE];        /* of the second line */
    uint16_t column_px[ROWS_AT_ONCE];   /* of the next pixel */
    uint16_t share_q7[4][ROWS_AT_ONCE]; /* of the second line in each pixel; all of it behind it */
    /* Greys, two pixels in a number: the left one is the lower byte. */
    uint16_t pair[ROWS_AT_ONCE][2];
};

/* Grey between two. A difference is below 2^8, times 2^7: 16 bits hold it. */
static inline uint16_t grey_between(uint16_t first, uint16_t second, uint16_t share_q7)
{
    const int16_t more = (int16_t)((int16_t)(second - first) * (int16_t)share_q7 + SHARE_Q7 / 2);
    return (uint16_t)(first + (more >> 7));
}

/* Greys of the second line at the middles of the rows. Two cells are read as one number, and four
 * rows at once: more are read before one is written, and a turn has little beside. */
static inline void set_greys(const struct lm_patch_painter *p, uint32_t first, const uint8_t *grey,
                             struct strip *s)
{
    const uint16_t *cell = p->cell + first;
    for (uint16_t *to = s->grey; to != s->grey + ROWS_AT_ONCE; to += 4, cell += 4) {
        const uint16_t a = fx_load_u16(grey + cell[0]), b = fx_load_u16(grey + cell[1]);
        const uint16_t c = fx_load_u16(grey + cell[2]), d = fx_load_u16(grey + cell[3]);
        to[0] = a;
        to[1] = b;
        to[2] = c;
        to[3] = d;
        __asm__("" : "+r"(to), "+r"(cell)); /* else all turns are written out: 1 kB */
    }
    for (uint32_t i = 0; i < ROWS_AT_ONCE; i++) {
        s->grey[i] = grey_between(s->grey[i] & 255, s->grey[i] >> 8, p->part_q7[first + i]);
    }
}

/* Shares of the second line in the next pixels of each row. Then move on, by the pixels that lie
 * before the second line: those whose shares are not whole. What is 2^8 lines beyond it shares as
 * what is farther does; three steps are 2^7.6 lines more, and in 128ths all takes 16 bits. */
static inline void set_shares(struct lm_patch_painter *p, uint32_t first, uint32_t most_px,
                              struct strip *s)
{
    for (uint32_t i = 0; i < ROWS_AT_ONCE; i++) {
        const uint32_t step_q20 = (uint32_t)p->step_q20[first + i];
        const uint32_t on_q20 = (uint32_t)p->on_q20[first + i];
        const uint32_t near_q20 = fx_min_u32(on_q20, (uint32_t)LINE_Q20 << 8);
        uint16_t count = 0;
        for (uint32_t k = 0; k < most_px; k++) {
            const uint16_t on_q7 = (uint16_t)((near_q20 + k * step_q20) >> 13);
            const uint16_t share_q7 = on_q7 < SHARE_Q7 ? on_q7 : SHARE_Q7;
            s->share_q7[k][i] = share_q7;
            count = (uint16_t)(count + (share_q7 < SHARE_Q7));
        }
        s->column_px[i] = p->column_px[first + i];
        p->column_px[first + i] = (uint16_t)(s->column_px[i] + count);
        p->on_q20[first + i] = (int32_t)(on_q20 + count * step_q20 - LINE_Q20);
    }
}

/* Greys of the next pixels of each row, which then lie side by side. */
static inline void set_pairs(struct lm_patch_painter *p, uint32_t first, uint32_t most_px,
                             struct strip *s)
{
    for (uint32_t i = 0; i < ROWS_AT_ONCE; i++) {
        const uint16_t before = p->grey[first + i], here = s->grey[i];
        for (uint32_t k = 0; k < most_px; k += 2) {
            const uint16_t left = grey_between(before, here, s->share_q7[k][i]);
            const uint16_t right = grey_between(before, here, s->share_q7[k + 1][i]);
            s->pair[i][k / 2] = (uint16_t)(left | right << 8);
        }
    }
}

/* True if no row ends within the next `most_px` pixels. */
static inline bool are_whole(const struct strip *s, uint32_t rows, uint32_t most_px, uint32_t right)
{
    uint16_t farthest = 0;
    for (uint32_t i = 0; i < rows; i++) {
        farthest = s->column_px[i] > farthest ? s->column_px[i] : farthest;
    }
    return farthest + most_px <= right;
}

/* Store the pixels of `rows` rows. If one of them ends, each is stored pixel by pixel. */
static inline void store(struct lm_patch_painter *p, uint32_t first, uint32_t rows,
                         uint32_t most_px, const struct strip *s, uint8_t *row, ptrdiff_t up)
{
    const uint32_t right = (uint32_t)p->square.left_px + p->square.width_px;
    if (are_whole(s, rows, most_px, right)) {
        const uint16_t *column_px = s->column_px;
        const uint16_t(*pair)[2] = s->pair;
        for (const uint16_t(*const end)[2] = pair + rows; pair != end; pair++, row += up) {
            if (most_px > 2) {
                fx_store_u32(row + *column_px++, fx_load_u32(pair));
            } else {
                fx_store_u16(row + *column_px++, (*pair)[0]);
            }
            /* Keep two pointers: the compiler would make both from one number in each turn. */
            __asm__("" : "+r"(column_px), "+r"(pair));
        }
        return;
    }
    for (uint32_t i = 0; i < rows; i++, row += up) {
        uint16_t *const end = &p->column_px[first + i];
        *end = (uint16_t)fx_min_u32(*end, right);
        for (uint32_t k = 0, x = s->column_px[i]; x < *end; k++, x++) {
            row[x] = (uint8_t)(s->pair[i][k / 2] >> k % 2 * 8);
        }
    }
}

/* Paint some rows of a strip. Callers pass constants for `most_px`, 2 or 4, so that the compiler
 * unrolls the loops over pixels. */
static inline void paint_strip(struct lm_patch_painter *p, uint32_t first, uint32_t rows,
                               uint32_t most_px, struct strip *s, uint8_t *row, ptrdiff_t up)
{
    set_shares(p, first, most_px, s);
    set_pairs(p, first, most_px, s);
    store(p, first, rows, most_px, s, row, up);
}

/* The same where more than four pixels of a row may lie between two lines. */
static void paint_wide_strip(struct lm_patch_painter *p, uint32_t first, uint32_t rows,
                             const struct strip *s, uint8_t *row, ptrdiff_t up)
{
    const uint32_t right = (uint32_t)p->square.left_px + p->square.width_px;
    for (uint32_t i = first; i < first + rows; i++, row += up) {
        for (; p->on_q20[i] < LINE_Q20 && p->column_px[i] < right; p->column_px[i]++) {
            row[p->column_px[i]] = (uint8_t)grey_between(p->grey[i], s->grey[i - first],
                                                         (uint16_t)(p->on_q20[i] >> 13));
            p->on_q20[i] += p->step_q20[i];
        }
        p->on_q20[i] -= p->on_q20[i] < LINE_Q20 ? 0 : LINE_Q20;
    }
}

/* Begin at the left edge of each row, with a line before line 0 that is equal to it. */
static void begin(struct lm_patch_painter *p)
{
    memcpy(p->on_q20, p->start_q20, sizeof p->on_q20);
    for (uint32_t row = 0; row < LM_PATCH_SIDE_MAX_PX; row++) {
        p->column_px[row] = p->square.left_px;
    }
}

/* Fill what is left of some rows. */
static void fill(const struct lm_patch_painter *p, uint32_t first, uint32_t rows, uint8_t *row,
                 ptrdiff_t up)
{
    const uint32_t right = (uint32_t)p->square.left_px + p->square.width_px;
    for (uint32_t i = first; i < first + rows; i++, row += up) {
        memset(row + p->column_px[i], p->grey[i], right - p->column_px[i]);
    }
}

/* Mark what a line has painted of some rows, which went on at column `from`. Rows lie along a ray,
 * so the first and the last go farthest, but for rounding. Up to three pixels more of a row are
 * painted than it goes on by. */
static void mark_strip(const struct lm_patch_painter *p, const struct lm_plane *plane,
                       uint32_t first, uint32_t rows, uint32_t from, bool is_last)
{
    const uint32_t last = first + rows - 1;
    const int32_t bottom = p->square.top_px + p->square.height_px - (int32_t)first;
    const int32_t right = p->square.left_px + p->square.width_px;
    const int32_t to = (int32_t)fx_max_u32(p->column_px[first], p->column_px[last]);
    const struct lm_rectangle part = {.left = (int32_t)from - 1,
                                      .top = bottom - (int32_t)rows,
                                      .right = is_last ? right : to + 5,
                                      .bottom = bottom};
    mark_part(plane, &part);
}

void lm_scan_conv_patch(struct lm_patch_painter *p, const struct lm_plane *plane, uint32_t line,
                        const uint8_t *grey)
{
    const uint32_t all = p->square.height_px;
    const ptrdiff_t up = -(ptrdiff_t)plane->width_px;
    uint8_t *row = plane->pixels + (p->square.top_px + all - 1) * plane->width_px;
    struct strip s;
    if (line == 0) {
        begin(p);
    }
    for (uint32_t first = 0; first < all; first += ROWS_AT_ONCE, row += ROWS_AT_ONCE * up) {
        const uint32_t rows = fx_min_u32(all - first, ROWS_AT_ONCE);
        const uint32_t from = fx_min_u32(p->column_px[first], p->column_px[first + rows - 1]);
        set_greys(p, first, grey, &s);
        if (line == 0) {
            memcpy(p->grey + first, s.grey, sizeof s.grey);
        }
        if (p->most_px <= 2) {
            paint_strip(p, first, rows, 2, &s, row, up);
        } else if (p->most_px <= 4) {
            paint_strip(p, first, rows, 4, &s, row, up);
        } else {
            paint_wide_strip(p, first, rows, &s, row, up);
        }
        memcpy(p->grey + first, s.grey, sizeof s.grey);
        if (line == p->lines - 1) {
            fill(p, first, rows, row, up);
        }
        mark_strip(p, plane, first, rows, from, line == p->lines - 1);
    }
}
