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
static const struct lm_plane plane = {.pixels = pixels, .width_px = WIDTH, .height_px = HEIGHT};

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

/* A bright cell on a dark patch is painted about the pixel on which a symbol at its place is drawn,
 * wherever the patch is seen from. */
static void judge_cell(const struct lm_patch_fan *fan, const struct lm_view *v,
                       const struct lm_frame *frame, uint32_t line, uint32_t cell)
{
    static struct lm_patch_painter painter;
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, v->origin);
    memset(pixels, 0, sizeof pixels);
    lm_patch_painter_set(&painter, frame, fan);
    for (uint32_t k = 0; k < fan->lines; k++) {
        uint8_t grey[64] = {0};
        grey[cell] = k == line ? 255 : 0;
        lm_scan_conv_patch(&painter, &plane, k, grey);
    }
    const double cell_m = fan->cell_m_q8 / 256.0, range_m = fan->centre_m_q8 / 256.0;
    const double along_m = (cell + 0.5 - fan->cells / 2.0) * cell_m;
    const double across_m =
        (line + 0.5 - fan->lines / 2.0) * cell_m * (range_m + along_m) / range_m;
    if (fabs(across_m) > (fan->cells / 2.0 - 2) * cell_m) {
        return; /* beside the square */
    }
    const struct lm_position place =
        lm_geo_direct(&origin, v->up + hs_bam(atan2(across_m, along_m) * 57.29577951308232),
                      (uint32_t)lround(hypot(across_m, along_m) * 256));
    struct lm_offset offset;
    assert_true(lm_view_find(v, place, &offset));
    double sum = 0, x = 0, y = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        sum += pixels[i];
        x += pixels[i] * (i % WIDTH + 0.5);
        y += pixels[i] * (i / WIDTH + 0.5);
    }
    assert_true(fabs(x / sum - (v->at.x + offset.x_px_q8 / 256.0)) < 0.15);
    assert_true(fabs(y / sum - (v->at.y - offset.y_px_q8 / 256.0)) < 0.15);
    const struct lm_position found = lm_view_position(v, offset);
    const double off_m = hypot((int32_t)(found.latitude - place.latitude),
                               (int32_t)(found.longitude - place.longitude) * cos(0.8)) *
                         40007863.0 / 4294967296.0;
    assert_true(off_m < 0.1 * cell_m);
}

TEST(a_symbol_over_a_patch_is_on_the_cell_of_its_place)
{
    static const uint16_t sizes[][2] = {{600, 512}, {333, 401}, {512, 512}};
    static const uint32_t ranges_m[] = {3000, 60000};
    for (size_t n = 0; n < 2 * sizeof sizes / sizeof *sizes; n++) {
        const struct lm_frame frame = {5, 3, sizes[n / 2][0] / 2, sizes[n / 2][1] / 2};
        const uint32_t range_m = ranges_m[n % 2], side_m = 64 * 20;
        const struct lm_patch_fan fan = {
            2 * (uint32_t)ceil(32.0 * range_m / (range_m - side_m / 2.0)), 64, range_m * 256,
            20 * 256};
        const struct lm_view v =
            lm_view_of_patch(&frame, from_here().position, from_here().up, 64, 20000);
        const uint32_t shown = (fan.lines - 64) / 2;
        for (uint32_t line = shown + 4; line < shown + 60; line += 11) {
            for (uint32_t cell = 20; cell < 60; cell += 13) {
                judge_cell(&fan, &v, &frame, line, cell);
            }
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

TEST(a_window_far_beside_is_out_of_sight_as_one_far_ahead_is)
{
    const struct lm_frame frame = lm_frame_of_display(WIDTH, HEIGHT);
    const struct lm_view ahead = window_of(&frame, 0, 240000),
                         beside = window_of(&frame, 90, 240000);
    assert_int_equal(ahead.at.x, ahead.middle.x);
    assert_int_equal(ahead.at.y, ahead.middle.y + LM_VIEW_APEX_FAR_PX);
    assert_memory_equal(&ahead.at, &beside.at, sizeof ahead.at);
}

TEST(no_place_is_farther_than_any_range)
{
    const struct lm_frame frame = lm_frame_of_display(WIDTH, HEIGHT);
    const struct lm_view_from from = from_here();
    const struct lm_view v = lm_view_of_patch(&frame, from.position, from.up, 1024, 100000);
    double farther_m = 0;
    for (int32_t out = 100; out <= LM_DRAW_FAR; out += 100) {
        uint32_t distance_m_q8;
        fx_bam_t azimuth;
        const struct lm_position at =
            lm_view_position(&v, (struct lm_offset){out * 256, -out * 256});
        lm_geo_inverse(from.position, at, &distance_m_q8, &azimuth);
        assert_true(distance_m_q8 / 256.0 >= farther_m - 20000);
        assert_true(distance_m_q8 / 256.0 < 600000);
        farther_m = distance_m_q8 / 256.0;
    }
    const struct lm_position a = lm_view_position(&v, (struct lm_offset){2000 * 256, 0});
    const struct lm_position b = lm_view_position(&v, (struct lm_offset){LM_DRAW_FAR * 256, 0});
    assert_memory_equal(&a, &b, sizeof a);
}

TEST(a_window_far_ahead_or_far_aside_shows_nothing_and_its_apex_stays_near_enough)
{
    const struct lm_frame frame = lm_frame_of_display(WIDTH, HEIGHT);
    static const double azimuths_deg[] = {0, 90, -90, 180};
    for (size_t i = 0; i < sizeof azimuths_deg / sizeof *azimuths_deg; i++) {
        const struct lm_view v = window_of(&frame, azimuths_deg[i], 240000);
        const struct lm_offset middle = lm_view_middle(&v);
        assert_int_equal(middle.x_px_q8, 0);
        assert_int_equal(middle.y_px_q8, LM_VIEW_APEX_FAR_PX * 256);
    }
}
