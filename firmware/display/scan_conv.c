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

enum { CELL_Q7 = 1 << 7, ROWS_AT_ONCE = 64 };

/* Where a row lies, in cells above the middle of cell 0: row r of n at (r + 1/2) C / n - 1/2, of C
 * cells. Below the point is the share of the upper of the two that it lies between. */
static uint32_t cell_q7_of(const struct lm_patch_painter *p, uint32_t row)
{
    const uint32_t rows = p->square.height_px;
    const int64_t above_q7 = (int64_t)(2 * row + 1) * p->cells * CELL_Q7 / (2 * rows) - CELL_Q7 / 2;
    return (uint32_t)fx_clamp_i64(above_q7, 0, (int64_t)(p->cells - 1) * CELL_Q7);
}

/* Set the cells of a group of rows. They lie among 2^10 * 15 / 183 + 1 cells at most, for no square
 * has fewer than 183 rows: with what `first` is held back, below 2^8. */
static void set_cells(struct lm_patch_painter *p, uint32_t group)
{
    struct lm_k_patch_cells *c = &p->row_cells;
    const uint32_t row0 = group * LM_K_PATCH_GROUP;
    const uint32_t room = p->cells < LM_K_PATCH_CLOSE ? 0 : p->cells - LM_K_PATCH_CLOSE;
    const uint32_t first = fx_min_u32(cell_q7_of(p, row0) / CELL_Q7, room);
    c->first[group] = (uint16_t)first;
    for (uint32_t row = row0; row < row0 + LM_K_PATCH_GROUP; row++) {
        const uint32_t cell_q7 = cell_q7_of(p, row);
        c->above[row] = (uint8_t)(cell_q7 / CELL_Q7 - first);
        c->part_q7[row] = (uint8_t)(cell_q7 % CELL_Q7);
        c->are_close = c->are_close && c->above[row] < LM_K_PATCH_CLOSE;
    }
}

/* Lines a pixel in a row. Row r lies (2 r + 1) C / 2 n cells beyond the near edge, of C cells in n
 * rows. With S the range of the middle, s that of the row and ds a cell, a pixel is
 *
 *     C / n S / s lines = 2 C S / (2 n (S - C ds / 2) + (2 r + 1) C ds)
 *
 * Ranges are below 2^26, C and n at most 2^10: numerator and denominator are below 2^38. A pixel
 * that is more than 2^6 lines is at the antenna's feet, in no patch. */
static int32_t step_q20_of(const struct lm_patch_painter *p, const struct lm_patch_fan *fan,
                           uint32_t row)
{
    const int64_t rows = p->square.height_px, side_m_q8 = (int64_t)fan->cells * fan->cell_m_q8;
    const int64_t middle = 2 * (int64_t)fan->cells * fan->centre_m_q8;
    const int64_t there =
        rows * (2 * (int64_t)fan->centre_m_q8 - side_m_q8) + (2 * (int64_t)row + 1) * side_m_q8;
    const int64_t most_q20 = (int64_t)LM_K_LINE_Q20 << 6;
    const int64_t step_q20 = there > 0 ? middle * LM_K_LINE_Q20 / there : most_q20;
    return (int32_t)fx_clamp_i64(step_q20, LM_K_LINE_Q20 >> 6, most_q20);
}

void lm_patch_painter_set(struct lm_patch_painter *p, const struct lm_frame *frame,
                          const struct lm_patch_fan *fan)
{
    p->square = lm_patch_square(frame);
    p->lines = fan->lines;
    p->cells = fan->cells;
    p->waiting = 0;
    p->row_cells.are_close = fan->cells >= LM_K_PATCH_CLOSE;
    const uint32_t rows = p->square.height_px;
    uint32_t least_q20 = UINT32_MAX;
    for (uint32_t row = 0; row < rows; row++) {
        p->step_q20[row] = step_q20_of(p, fan, row);
        least_q20 = fx_min_u32(least_q20, (uint32_t)p->step_q20[row]);
    }
    for (uint32_t group = 0; group * LM_K_PATCH_GROUP < rows; group++) {
        set_cells(p, group);
    }
    /* Over n lines lie n / step pixels, and one more at most where that is no whole number. */
    const uint32_t lines = LM_K_STRIP_PX * least_q20 / LM_K_LINE_Q20;
    p->is_wide = lines == 0;
    p->strip_lines = fx_min_u32(fx_max_u32(lines, 1), LM_K_STRIP_LINES);
}

/* Begin at the left edge of each row. The middle of the leftmost of n pixels lies (n - 1) / 2
 * pixels left of the square's middle, and line -1, which is equal to line 0, (N + 1) / 2 lines. */
static void begin(struct lm_patch_painter *p, const uint8_t *grey)
{
    const int64_t middle_q20 = ((int64_t)p->lines + 1) * (LM_K_LINE_Q20 / 2);
    for (uint32_t row = 0; row < p->square.height_px; row++) {
        const int64_t left_q20 = (p->square.width_px - 1) * (int64_t)p->step_q20[row] / 2;
        p->on_q20[row] = (int32_t)fx_clamp_i64(middle_q20 - left_q20, 0, INT32_MAX / 2);
        p->column_px[row] = p->square.left_px;
    }
    lm_k_patch_hold(&p->row_cells, grey, p->square.height_px, p->held, 0);
    p->waiting = 0;
}

/* Paint a strip pixel by pixel, as far as the rows reach: for those that end in it, and for strips
 * of more pixels than a kernel takes. */
static void paint_pixels(const struct lm_k_patch_strip *s, uint32_t right)
{
    const int32_t end_q20 = (int32_t)s->lines * LM_K_LINE_Q20;
    uint8_t *pixels = s->pixels;
    for (uint32_t i = 0; i < s->rows; i++, pixels += s->up) {
        int32_t on_q20 = s->on_q20[i];
        uint32_t x = s->column_px[i];
        for (; on_q20 < end_q20 && x < right; x++, on_q20 += s->step_q20[i]) {
            const uint8_t *const held = s->held[i] + ((uint32_t)on_q20 >> 20);
            const uint16_t share_q7 = (uint16_t)((uint32_t)on_q20 >> 13 & (LM_K_LINE_Q7 - 1));
            pixels[x] = lm_k_grey_between(held[0], held[1], share_q7);
        }
        s->column_px[i] = (uint16_t)x;
        s->on_q20[i] = on_q20 - end_q20;
        s->held[i][0] = s->held[i][s->lines];
    }
}

/* Fill what is left of a strip's rows with the line that was painted last. */
static void fill(const struct lm_k_patch_strip *s, uint32_t right)
{
    uint8_t *pixels = s->pixels;
    for (uint32_t i = 0; i < s->rows; i++, pixels += s->up) {
        memset(pixels + s->column_px[i], s->held[i][0], right - s->column_px[i]);
    }
}

/* True if each row has room for a strip. */
static bool has_room(const struct lm_k_patch_strip *s, uint32_t right)
{
    uint32_t farthest = 0;
    for (uint32_t i = 0; i < s->rows; i++) {
        farthest = fx_max_u32(farthest, s->column_px[i]);
    }
    return farthest + LM_K_STRIP_PX <= right;
}

/* Mark what a strip has painted of some rows, which went on at column `from`. Rows lie along a ray,
 * so the first and the last go farthest, but for rounding. */
static void mark_strip(const struct lm_patch_painter *p, const struct lm_plane *plane,
                       uint32_t first, uint32_t rows, uint32_t from, bool is_last)
{
    const uint32_t last = first + rows - 1;
    const int32_t bottom = p->square.top_px + p->square.height_px - (int32_t)first;
    const int32_t right = p->square.left_px + p->square.width_px;
    const int32_t to = (int32_t)fx_max_u32(p->column_px[first], p->column_px[last]);
    const struct lm_rectangle part = {.left = (int32_t)from - 1,
                                      .top = bottom - (int32_t)rows,
                                      .right = is_last ? right
                                                       : fx_min_i32(to + LM_K_STRIP_PX + 1, right),
                                      .bottom = bottom};
    mark_part(plane, &part);
}

/* Paint the strip of the lines that wait. */
static void paint_strip(struct lm_patch_painter *p, const struct lm_plane *plane, bool is_last)
{
    const uint32_t all = p->square.height_px;
    const uint32_t right = (uint32_t)p->square.left_px + p->square.width_px;
    const ptrdiff_t up = -(ptrdiff_t)plane->width_px;
    uint8_t *pixels = plane->pixels + (p->square.top_px + all - 1) * plane->width_px;
    for (uint32_t row = 0; row < all; row += ROWS_AT_ONCE, pixels += ROWS_AT_ONCE * up) {
        const struct lm_k_patch_strip s = {.held = p->held + row,
                                           .lines = p->waiting,
                                           .step_q20 = p->step_q20 + row,
                                           .on_q20 = p->on_q20 + row,
                                           .column_px = p->column_px + row,
                                           .pixels = pixels,
                                           .up = up,
                                           .rows = fx_min_u32(all - row, ROWS_AT_ONCE)};
        const uint32_t from = fx_min_u32(p->column_px[row], p->column_px[row + s.rows - 1]);
        if (!p->is_wide && has_room(&s, right)) {
            lm_k_patch_paint(&s);
        } else {
            paint_pixels(&s, right);
        }
        if (is_last) {
            fill(&s, right);
        }
        mark_strip(p, plane, row, s.rows, from, is_last);
    }
    p->waiting = 0;
}

void lm_scan_conv_patch(struct lm_patch_painter *p, const struct lm_plane *plane, uint32_t line,
                        const uint8_t *grey)
{
    if (line == 0) {
        begin(p, grey);
    }
    const bool is_last = line == p->lines - 1;
    p->waiting++;
    lm_k_patch_hold(&p->row_cells, grey, p->square.height_px, p->held, p->waiting);
    if (p->waiting == p->strip_lines || is_last) {
        paint_strip(p, plane, is_last);
    }
}
