/* Symbols and picture on the same pixels: what is painted is found again where the view says that
 * it lies, to the very pixel. */
#include "lm/view.h"

#include "check.h"
#include "hs/angle.h"
#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 256, WIDTH = 600, HEIGHT = 512 };

static uint8_t pixels[WIDTH * HEIGHT];
static const struct lm_plane plane = {pixels, WIDTH, HEIGHT};

static struct lm_view_from from_here(void)
{
    return (struct lm_view_from){{hs_bam(46), hs_bam(11)}, hs_bam(20), 2000 * 1024};
}

static struct lm_view window_of(const struct lm_frame *frame, double azimuth_deg, double metres)
{
    struct lm_geo_origin origin;
    const struct lm_view_from from = from_here();
    lm_geo_set_origin(&origin, from.position);
    const struct lm_position centre =
        lm_geo_direct(&origin, hs_bam(20 + azimuth_deg), (uint32_t)(metres * 256));
    return lm_view_of_window(frame, &from, centre, 2315);
}

/* Lines of half a degree that carry their number, or cells that carry theirs. */
static void paint(const struct lm_ppi *ppi, int is_by_line, int32_t middle_deg)
{
    memset(pixels, 0, sizeof pixels);
    for (int32_t n = 0; n < 200; n++) {
        uint8_t grey[LM_DRAW_FAR];
        for (int i = 0; i < LM_DRAW_FAR; i++) {
            grey[i] = (uint8_t)(is_by_line ? n + 1 : i % 250 + 1);
        }
        const int32_t half_degrees = n - 100 + 2 * middle_deg;
        lm_scan_conv_sector(&plane, ppi, (fx_bam_t)(half_degrees * (int32_t)(FX_BAM_DEG(1) / 2)),
                            (fx_bam_t)((half_degrees + 1) * (int32_t)(FX_BAM_DEG(1) / 2)), grey,
                            LM_DRAW_FAR);
    }
}

/* Offsets anywhere in the view: the line and the cell painted on their pixel are those that hold
 * its middle, which is never farther than half a pixel and on the average nowhere else. */
static void judge_offsets(const struct lm_view *v, const struct lm_frame *frame, uint32_t cell_q8,
                          int32_t middle_deg)
{
    struct hs_rng rng;
    const struct lm_ppi ppi = lm_view_ppi(v, frame, cell_q8, 0);
    const double cells_per_px = v->scale_mm_per_px_q8 / 1000.0 / cell_q8;
    hs_rng_seed(&rng, 3);
    for (int is_by_line = 0; is_by_line < 2; is_by_line++) {
        double right_px = 0, up_px = 0;
        int seen = 0;
        paint(&ppi, is_by_line, middle_deg);
        for (int i = 0; i < 20000; i++) {
            const struct lm_offset middle = lm_view_middle(v);
            const struct lm_offset o = {
                middle.x_px_q8 + (int32_t)hs_rng_below(&rng, 400 * 256) - 200 * 256,
                middle.y_px_q8 + (int32_t)hs_rng_below(&rng, 400 * 256) - 200 * 256};
            const struct lm_point at = lm_view_point(v, o);
            const struct lm_frame *clip = &ppi.clip;
            const bool is_on_glass = at.x >= clip->left_px &&
                                     at.x < clip->left_px + clip->width_px &&
                                     at.y >= clip->top_px && at.y < clip->top_px + clip->height_px;
            if (!is_on_glass || pixels[at.y * WIDTH + at.x] == 0) {
                continue;
            }
            const int painted = pixels[at.y * WIDTH + at.x] - 1;
            const double right = o.x_px_q8 / 256.0, up = o.y_px_q8 / 256.0;
            /* Half a pixel's diagonal each way, and the range's projection on the line. */
            const double azimuth = (atan2(right, up) * 57.29578 - middle_deg) * 2 + 100;
            const double range = hypot(right, up) * cells_per_px;
            const double slack = is_by_line ? 0.71 / hypot(right, up) * 57.29578 * 2
                                            : 0.71 * cells_per_px + 2e-5 * range;
            const double wanted = is_by_line ? azimuth : range;
            const double off =
                is_by_line ? painted + 0.5 - wanted : remainder(painted + 0.5 - wanted, 250);
            assert_true(fabs(off) < 0.5 + slack);
            right_px += at.x + 0.5 - v->at.x - right;
            up_px += v->at.y - at.y - 0.5 - up;
            seen++;
        }
        assert_true(seen > 5000);
        assert_true(fabs(right_px / seen) < 0.02 && fabs(up_px / seen) < 0.02);
    }
}

TEST(a_symbol_over_a_sector_is_on_the_pixel_of_its_place)
{
    const struct lm_frame frame = lm_frame_of_display(WIDTH, HEIGHT);
    const struct lm_view_from from = from_here();
    const struct lm_view v = lm_view_of_sector(&frame, &from, 18520, false);
    judge_offsets(&v, &frame, 72 * 256, 0);
    judge_offsets(&v, &frame, 300 * 256, 0);
}

TEST(a_symbol_over_a_window_is_on_the_pixel_of_its_place)
{
    const struct lm_frame frame = lm_frame_of_display(WIDTH, HEIGHT);
    for (int32_t azimuth_deg = -50; azimuth_deg <= 50; azimuth_deg += 25) {
        const struct lm_view v = window_of(&frame, azimuth_deg, 12000);
        judge_offsets(&v, &frame, 18 * 256, azimuth_deg);
    }
}

/* The square of a window lies about its centre as evenly as whole pixels can. */
TEST(the_middle_of_a_window_is_that_of_its_square)
{
    const struct lm_frame frame = lm_frame_of_display(WIDTH, HEIGHT);
    const struct lm_frame square = lm_frame_square(&frame);
    const struct lm_view v = window_of(&frame, 30, 12000);
    assert_in_range(2 * v.middle.x, 2 * square.left_px + square.width_px - 1,
                    2 * square.left_px + square.width_px);
    assert_in_range(2 * v.middle.y, 2 * square.top_px + square.height_px - 1,
                    2 * square.top_px + square.height_px);
}

TEST(a_symbol_over_a_patch_is_on_the_cell_of_its_place)
{
    static const uint16_t sizes[][2] = {{600, 512}, {333, 401}, {512, 512}};
    for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++) {
        const struct lm_frame frame = {5, 3, sizes[n][0] / 2, sizes[n][1] / 2};
        const uint32_t cells = 64;
        const struct lm_view v =
            lm_view_of_patch(&frame, (struct lm_position){0, 0}, 0, cells, 5000);
        for (uint32_t line = 0; line < cells; line++) {
            uint8_t grey[64];
            memset(grey, (int)line + 1, sizeof grey);
            lm_scan_conv_patch(&plane, &frame, line, grey, cells);
        }
        const int32_t cell_px = lm_patch_cell_px(&frame, cells);
        for (int32_t line = 0; line < (int32_t)cells; line++) {
            /* The middle of the line's cells, half-way between cells up. */
            const struct lm_offset o = {(2 * line + 1 - (int32_t)cells) * cell_px * 128, 128};
            const struct lm_point at = lm_view_point(&v, o);
            assert_int_equal(pixels[at.y * WIDTH + at.x], line + 1);
            const struct lm_point left =
                lm_view_point(&v, (struct lm_offset){o.x_px_q8 - cell_px * 128 + 1, o.y_px_q8});
            assert_int_equal(pixels[left.y * WIDTH + left.x], line + 1);
        }
        for (uint32_t line = 0; line < cells; line++) {
            uint8_t grey[64];
            for (uint8_t i = 0; i < 64; i++) {
                grey[i] = i;
            }
            lm_scan_conv_patch(&plane, &frame, line, grey, cells);
        }
        for (int32_t cell = 0; cell < (int32_t)cells; cell++) {
            const int32_t low_q8 = (2 * cell - (int32_t)cells) * cell_px * 128;
            const struct lm_point low = lm_view_point(&v, (struct lm_offset){128, low_q8 + 1});
            const struct lm_point high =
                lm_view_point(&v, (struct lm_offset){128, low_q8 + cell_px * 256 - 1});
            assert_int_equal(pixels[low.y * WIDTH + low.x], cell);
            assert_int_equal(pixels[high.y * WIDTH + high.x], cell);
        }
    }
}

TEST(the_place_of_the_origin_is_the_origin)
{
    const struct lm_frame frame = lm_frame_of_display(WIDTH, HEIGHT);
    const struct lm_view_from from = from_here();
    const struct lm_view views[] = {lm_view_of_sector(&frame, &from, 18520, false),
                                    lm_view_of_patch(&frame, from.position, from.up, 256, 5000)};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        const struct lm_position place = lm_view_position(&views[i], (struct lm_offset){0, 0});
        assert_memory_equal(&place, &from.position, sizeof place);
    }
}
