#include "lm/scan_conv.h"

#include "fx/mem.h"
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

/* First pixel column, counted from the apex, whose centre is at or right of the edge in row `up` (0
 * is the row whose centres lie half a pixel above the apex). The same edge gives the same column to
 * the lines on both its sides. */
static int32_t edge_column(int32_t tangent_q16, int32_t up)
{
    /* Centre of column c is c + 1/2: c >= (up + 1/2) tan - 1/2. In Q17: (2 up + 1) tan - 2^16,
     * rounded up. */
    const int64_t x_q17 = (int64_t)(2 * up + 1) * tangent_q16 - 65536;
    return (int32_t)((x_q17 + 131071) >> 17);
}

static int32_t tangent_q16_of(fx_bam_t azimuth)
{
    return (int32_t)((int64_t)fx_sin_q30(azimuth) * 65536 / fx_cos_q30(azimuth));
}

struct wedge {
    int32_t left_tan_q16, right_tan_q16;
    int32_t cells_per_px_x_q16,
        cells_per_px_y_q16;              /* the centre line's direction, in cells a pixel */
    int32_t columns_left, columns_right; /* of the frame, from the apex */
};

static void paint_row(const struct wedge *w, uint8_t *apex, int32_t up, const uint8_t *grey,
                      uint32_t cells)
{
    int32_t from = edge_column(w->left_tan_q16, up), to = edge_column(w->right_tan_q16, up);
    from = from < -w->columns_left ? -w->columns_left : from;
    to = to > w->columns_right ? w->columns_right : to;
    /* Range of the first pixel's centre along the line, in cells, Q17 until halved: |2 c + 1| <
     * 2^12, slope < 2^18. */
    int32_t cell_q16 =
        ((2 * from + 1) * w->cells_per_px_x_q16 + (2 * up + 1) * w->cells_per_px_y_q16) >> 1;
    for (int32_t column = from; column < to; column++, cell_q16 += w->cells_per_px_x_q16) {
        const uint32_t cell = (uint32_t)cell_q16 >> 16;
        if (cell < cells) {
            apex[column] = grey[cell];
        }
    }
}

void lm_ppi_paint(const struct lm_plane *plane, const struct lm_frame *frame, fx_bam_t left,
                  fx_bam_t right, const uint8_t *grey, uint32_t cells)
{
    const fx_bam_t middle = left + (right - left) / 2;
    const int32_t radius_px = lm_ppi_radius_px(frame);
    const struct wedge w = {
        .left_tan_q16 = tangent_q16_of(left),
        .right_tan_q16 = tangent_q16_of(right),
        .cells_per_px_x_q16 =
            (int32_t)((int64_t)fx_sin_q30(middle) * (int32_t)cells / radius_px >> 14),
        .cells_per_px_y_q16 =
            (int32_t)((int64_t)fx_cos_q30(middle) * (int32_t)cells / radius_px >> 14),
        .columns_left = frame->width_px / 2,
        .columns_right = frame->width_px - frame->width_px / 2,
    };
    uint8_t *apex = plane->pixels + frame->left_px + frame->width_px / 2 +
                    (uint32_t)(frame->top_px + frame->height_px - 1) * plane->width_px;
    for (int32_t up = 0; up < radius_px; up++, apex -= plane->width_px) {
        paint_row(&w, apex, up, grey, cells);
    }
}

uint16_t lm_patch_cell_px(const struct lm_frame *frame, uint32_t cells)
{
    const uint32_t side = frame->width_px < frame->height_px ? frame->width_px : frame->height_px;
    return (uint16_t)(side >= cells ? side / cells : 1);
}

void lm_patch_paint(const struct lm_plane *plane, const struct lm_frame *frame, uint32_t line,
                    const uint8_t *grey, uint32_t cells)
{
    const int32_t cell_px = lm_patch_cell_px(frame, cells), side_px = cell_px * (int32_t)cells;
    const int32_t left = (frame->width_px - side_px) / 2 + (int32_t)line * cell_px;
    /* A frame smaller than the patch shows its middle. */
    if (left < 0 || left + cell_px > frame->width_px) {
        return;
    }
    int32_t y = (frame->height_px + side_px) / 2 - 1;
    uint8_t *column =
        plane->pixels + (int32_t)frame->top_px * plane->width_px + frame->left_px + left;
    for (uint32_t i = 0; i < cells; i++) {
        for (int32_t row = 0; row < cell_px; row++, y--) {
            if (y >= 0 && y < frame->height_px) {
                memset(column + y * plane->width_px, grey[i], (size_t)cell_px);
            }
        }
    }
}
