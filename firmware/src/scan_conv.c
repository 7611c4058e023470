#include "lm/scan_conv.h"

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

void lm_plane_clear(const struct lm_plane *plane, const struct lm_frame *frame)
{
    for (uint32_t y = frame->top_px; y < (uint32_t)frame->top_px + frame->height_px; y++) {
        memset(plane->pixels + y * plane->width_px + frame->left_px, 0, frame->width_px);
    }
}

uint16_t lm_ppi_radius_px(const struct lm_frame *frame)
{
    /* A sector of +-60 degrees and radius r is sqrt 3 r wide and r high: 56756 / 65536 = sin 60. */
    const uint32_t by_width = ((uint32_t)frame->width_px << 15) / 56756u;
    return (uint16_t)(by_width < frame->height_px ? by_width : frame->height_px);
}

static int32_t tangent_q16_of(fx_bam_t azimuth)
{
    return (int32_t)((int64_t)fx_sin_q30(azimuth) * 65536 / fx_cos_q30(azimuth));
}

/* An edge of a wedge, row by row upwards from the apex; row 0 has its centres half a pixel above
 * it. The column is the first one, counted from the apex, whose centre is at or right of the edge:
 * the same edge gives the same column to the lines on both its sides. */
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

static inline int32_t next_column(struct edge *e)
{
    const int32_t column = (int32_t)(e->x_q17 >> 17);
    e->x_q17 += e->step_q17;
    return column;
}

/* The direction of the wedge's middle in cells a pixel, Q16: a pixel's projection on it is its
 * range. */
struct direction {
    int32_t right_q16, up_q16;
};

/* Rows that may hold a pixel in range: on neither edge does a row lie nearer than this many cells.
 */
static int32_t rows_in_range(const struct direction *d, const struct edge *left,
                             const struct edge *right, uint32_t cells, int32_t radius_px)
{
    const int64_t at_left_q16 = d->up_q16 + (d->right_q16 * left->step_q17 >> 17);
    const int64_t at_right_q16 = d->up_q16 + (d->right_q16 * right->step_q17 >> 17);
    const int64_t nearest_q16 = at_left_q16 < at_right_q16 ? at_left_q16 : at_right_q16;
    const int64_t rows = ((int64_t)cells << 16) / (nearest_q16 > 1 ? nearest_q16 : 1) + 2;
    return rows < radius_px ? (int32_t)rows : radius_px;
}

void lm_ppi_paint(const struct lm_plane *plane, const struct lm_frame *frame, fx_bam_t left,
                  fx_bam_t right, const uint8_t *grey, uint32_t cells)
{
    const fx_bam_t middle = left + (right - left) / 2;
    const int32_t radius_px = lm_ppi_radius_px(frame);
    const int32_t leftmost = -(int32_t)(frame->width_px / 2);
    const int32_t beyond_right = frame->width_px + leftmost;
    const struct direction d = {
        .right_q16 = (int32_t)((int64_t)fx_sin_q30(middle) * (int32_t)cells / radius_px >> 14),
        .up_q16 = (int32_t)((int64_t)fx_cos_q30(middle) * (int32_t)cells / radius_px >> 14)};
    struct edge from_edge = edge_at(left), to_edge = edge_at(right);
    const int32_t rows = rows_in_range(&d, &from_edge, &to_edge, cells, radius_px);
    uint8_t *apex = plane->pixels + frame->left_px + frame->width_px / 2 +
                    (uint32_t)(frame->top_px + frame->height_px - 1) * plane->width_px;
    /* Ranges in cells of pixel centres, which lie at odd halves: Q17. |2 c + 1| < 2^12, slopes
     * below 2^18. */
    int32_t row_q17 = d.up_q16;
    for (int32_t row = 0; row < rows; row++, apex -= plane->width_px, row_q17 += 2 * d.up_q16) {
        const int32_t from = fx_max_i32(next_column(&from_edge), leftmost);
        const int32_t to = fx_min_i32(next_column(&to_edge), beyond_right);
        int32_t cell_q17 = row_q17 + (2 * from + 1) * d.right_q16;
        for (int32_t column = from; column < to; column++, cell_q17 += 2 * d.right_q16) {
            const uint32_t cell = (uint32_t)(cell_q17 >> 17);
            if (cell < cells) {
                apex[column] = grey[cell];
            }
        }
    }
}

uint16_t lm_patch_cell_px(const struct lm_frame *frame, uint32_t cells)
{
    const uint32_t side = frame->width_px < frame->height_px ? frame->width_px : frame->height_px;
    return (uint16_t)(side >= cells ? side / cells : 1);
}

/* One cell as a square of side_px pixels, upwards from its lower left corner. */
static void paint_cell(uint8_t *corner, uint32_t width_px, uint32_t side_px, uint8_t grey)
{
    for (uint32_t row = 0; row < side_px; row++, corner -= width_px) {
        for (uint32_t column = 0; column < side_px; column++) {
            corner[column] = grey;
        }
    }
}

void lm_patch_paint(const struct lm_plane *plane, const struct lm_frame *frame, uint32_t line,
                    const uint8_t *grey, uint32_t cells)
{
    const int32_t cell_px = lm_patch_cell_px(frame, cells), side_px = cell_px * (int32_t)cells;
    const int32_t left = (frame->width_px - side_px) / 2 + (int32_t)line * cell_px;
    const int32_t bottom = (frame->height_px + side_px) / 2 - 1;
    /* A frame smaller than the patch shows its middle. Cells are single pixels then. */
    if (left < 0 || left + cell_px > frame->width_px) {
        return;
    }
    const uint32_t first = (uint32_t)fx_max_i32(bottom + 1 - frame->height_px, 0);
    const uint32_t end = fx_min_u32(cells, (uint32_t)bottom + 1);
    const uint32_t width_px = plane->width_px, up = (uint32_t)cell_px * width_px;
    uint8_t *pixel = plane->pixels + ((uint32_t)(frame->top_px + bottom) - first) * width_px +
                     frame->left_px + left;
    if (cell_px == 1) { /* the common case without a loop around each cell */
        for (uint32_t i = first; i < end; i++, pixel -= width_px) {
            *pixel = grey[i];
        }
        return;
    }
    for (uint32_t i = first; i < end; i++, pixel -= up) {
        paint_cell(pixel, width_px, (uint32_t)cell_px, grey[i]);
    }
}
