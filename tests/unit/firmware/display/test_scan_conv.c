/* From lines to the plane: every pixel of a sector belongs to exactly one line, at the right range.
 */
#include "check.h"
#include "fx/types.h"
#include "lm/radar.h"
#include "lm/scan_conv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;
enum { CELLS = 256, PATCH_CELLS = 400, GUARD = 0xEE };

/* A plane with guard bytes on all sides of its memory. */
struct glass {
    uint8_t *memory;
    struct lm_plane plane;
    struct lm_frame frame;
    bool is_whole; /* the first format of the sector */
};

static void make_glass(struct glass *g, uint16_t width_px, uint16_t height_px)
{
    const size_t bytes = (size_t)width_px * height_px;
    g->memory = malloc(3 * bytes);
    assert_non_null(g->memory);
    memset(g->memory, GUARD, 3 * bytes);
    g->plane = (struct lm_plane){
        .pixels = g->memory + bytes, .width_px = width_px, .height_px = height_px};
    g->frame = lm_frame_of_display(width_px, height_px);
    g->is_whole = false;
    lm_plane_clear(&g->plane, &g->frame);
}

static int is_inside(const struct glass *g, int32_t x, int32_t y)
{
    const struct lm_frame *f = &g->frame;
    return x >= f->left_px && x < f->left_px + f->width_px && y >= f->top_px &&
           y < f->top_px + f->height_px;
}

/* Nothing outside the frame was written; then the memory goes. */
static void close_glass(struct glass *g)
{
    const int32_t width = g->plane.width_px, height = g->plane.height_px;
    for (int32_t y = -height; y < 2 * height; y++) {
        for (int32_t x = 0; x < width; x++) {
            if (!is_inside(g, x, y)) {
                assert_int_equal(g->memory[(y + height) * width + x], GUARD);
            }
        }
    }
    free(g->memory);
}

/* A pixel as the apex at the bottom centre of the frame sees its centre. */
struct polar {
    double right_px, up_px, azimuth, radius_px;
};

static struct polar polar_of(const struct glass *g, int32_t x, int32_t y)
{
    const struct lm_frame *f = &g->frame;
    struct polar p;
    p.right_px = x + 0.5 - (f->left_px + f->width_px / 2);
    p.up_px = f->top_px + f->height_px - y - 0.5;
    p.azimuth = atan2(p.right_px, p.up_px);
    p.radius_px = hypot(p.right_px, p.up_px);
    return p;
}

/* A sector, as a view of one lays it out: `CELLS` cells in its radius. */
static struct lm_ppi sector_ppi(const struct lm_frame *frame, bool is_whole)
{
    return (struct lm_ppi){
        .clip = *frame,
        .apex_x_px = frame->left_px + frame->width_px / 2,
        .apex_y_px = frame->top_px + frame->height_px,
        .cells_per_px_q16 = (CELLS << 16) / lm_ppi_radius_px(frame, is_whole),
    };
}

static void paint(const struct glass *g, int32_t left_bam, int32_t right_bam, uint8_t grey)
{
    uint8_t line[CELLS];
    memset(line, grey, sizeof line);
    const struct lm_ppi ppi = sector_ppi(&g->frame, g->is_whole);
    lm_scan_conv_sector(&g->plane, &ppi, (fx_bam_t)left_bam, (fx_bam_t)right_bam, line, CELLS);
}

static const uint16_t sizes[][2] = {{256, 256}, {512, 512}, {384, 512}, {1024, 1024}, {1000, 600}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

/* Paint all lines with their numbers, from 1, or backwards. A pixel that two lines claim shows one
 * of them in one plane and another in the other. */
static void paint_sector(const struct glass *g, int32_t half_bam, int32_t line_bam,
                         int is_backwards)
{
    const int32_t lines = 2 * half_bam / line_bam;
    assert_in_range(lines, 1, 256);
    lm_plane_clear(&g->plane, &g->frame);
    for (int32_t n = 0; n < lines; n++) {
        const int32_t line = is_backwards ? lines - 1 - n : n;
        const int32_t left = -half_bam + line * line_bam;
        /* Numbers repeat after 255 lines, which lie 119 degrees apart. */
        paint(g, left, left + line_bam, (uint8_t)(1 + line % 255));
    }
}

TEST(every_pixel_of_a_sector_is_painted_by_exactly_one_line)
{
    for (int n = 0; n < 2 * SIZES; n++) {
        for (int a = 0; a < LM_AZIMUTHS; a++) {
            struct glass g;
            make_glass(&g, sizes[n / 2][0], sizes[n / 2][1]);
            struct glass back;
            make_glass(&back, sizes[n / 2][0], sizes[n / 2][1]);
            g.is_whole = back.is_whole = n % 2;
            /* A line is a whole share of 120 degrees; sectors are cut to whole lines. */
            const int32_t line = (int32_t)lm_radar_default.line;
            const int32_t half =
                (int32_t)(lm_radar_default.azimuth_half[a] / (uint32_t)line) * line;
            paint_sector(&g, half, line, 0);
            paint_sector(&back, half, line, 1);
            const double half_rad = half / 2147483648.0 * 180 * degree;
            const double radius_px = lm_ppi_radius_px(&g.frame, g.is_whole);
            for (int32_t y = g.frame.top_px; y < g.frame.top_px + g.frame.height_px; y++) {
                for (int32_t x = g.frame.left_px; x < g.frame.left_px + g.frame.width_px; x++) {
                    const struct polar p = polar_of(&g, x, y);
                    const uint8_t shown = g.plane.pixels[y * g.plane.width_px + x];
                    assert_int_equal(shown, back.plane.pixels[y * g.plane.width_px + x]);
                    /* Half a pixel of doubt at the rim and at the outer edges. */
                    const double off_edge_px = (half_rad - fabs(p.azimuth)) * p.radius_px;
                    if (p.radius_px < radius_px - 1 && off_edge_px > 0.01) {
                        assert_true(shown != 0);
                    } else if (p.radius_px > radius_px + 1 || off_edge_px < -0.01) {
                        assert_int_equal(shown, 0);
                    }
                }
            }
            close_glass(&back);
            close_glass(&g);
        }
    }
}

TEST(a_pixel_shows_the_cell_at_its_range)
{
    uint8_t line[CELLS];
    for (int i = 0; i < CELLS; i++) {
        line[i] = (uint8_t)i;
    }
    for (int n = 0; n < 2 * SIZES; n++) {
        struct glass g;
        make_glass(&g, sizes[n / 2][0], sizes[n / 2][1]);
        g.is_whole = n % 2;
        const struct lm_ppi ppi = sector_ppi(&g.frame, g.is_whole);
        const double cells_per_px = CELLS / (double)lm_ppi_radius_px(&g.frame, g.is_whole);
        const int32_t width = (int32_t)lm_radar_default.line;
        for (int32_t i = -128; i < 128; i += 9) {
            memset(g.plane.pixels, GUARD, (size_t)g.plane.width_px * g.plane.height_px);
            lm_plane_clear(&g.plane, &g.frame);
            lm_scan_conv_sector(&g.plane, &ppi, (fx_bam_t)(i * width), (fx_bam_t)((i + 1) * width),
                                line, CELLS);
            for (int32_t y = g.frame.top_px; y < g.frame.top_px + g.frame.height_px; y++) {
                for (int32_t x = g.frame.left_px; x < g.frame.left_px + g.frame.width_px; x++) {
                    const double radius_px = polar_of(&g, x, y).radius_px;
                    const uint8_t shown = g.plane.pixels[y * g.plane.width_px + x];
                    if (shown != 0) {
                        assert_true(fabs(shown + 0.5 - radius_px * cells_per_px) <= 1);
                    }
                }
            }
        }
        close_glass(&g);
    }
}

/* Lines all the way across, each of another grey, cut to the clip. */
static void paint_fan(const struct glass *g, const struct lm_ppi *ppi)
{
    const int32_t line_bam = (int32_t)FX_BAM_DEG(1) / 4, half = 280;
    uint8_t line[CELLS];
    for (int32_t n = -half; n < half; n++) {
        for (int i = 0; i < CELLS; i++) {
            line[i] = (uint8_t)(1 + (n + half + 3 * i) % 255);
        }
        lm_scan_conv_sector(&g->plane, ppi, (fx_bam_t)(n * line_bam),
                            (fx_bam_t)((n + 1) * line_bam), line, CELLS);
    }
}

TEST(a_window_shows_what_it_would_show_in_a_wider_one)
{
    static const int32_t apex[][2] = {{250, 400}, {30, 500}, {480, 430}, {-200, 700}, {700, 520}};
    for (int n = 0; n < 5; n++) {
        struct glass wide, narrow;
        make_glass(&wide, 512, 512);
        make_glass(&narrow, 512, 512);
        struct lm_ppi ppi = {.clip = wide.frame,
                             .apex_x_px = apex[n][0],
                             .apex_y_px = apex[n][1],
                             .cells_per_px_q16 = 40000,
                             .near_cells_q8 = 20 * 256};
        paint_fan(&wide, &ppi);
        ppi.clip = (struct lm_frame){203, 140, 120, 97};
        paint_fan(&narrow, &ppi);
        for (int32_t y = ppi.clip.top_px; y < ppi.clip.top_px + ppi.clip.height_px; y++) {
            const int32_t row = y * wide.plane.width_px + ppi.clip.left_px;
            assert_memory_equal(narrow.plane.pixels + row, wide.plane.pixels + row,
                                ppi.clip.width_px);
        }
        close_glass(&wide);
        close_glass(&narrow);
    }
}

TEST(what_a_wedge_does_not_cover_is_made_black_and_the_rest_is_kept)
{
    static const int32_t apex[][2] = {{250, 400}, {30, 500}, {203, 200}, {-9000, 9000}, {700, 100}};
    static const int32_t edges[][2] = {{-60, 60}, {-60, -59}, {20, 50}, {-10, 0}, {0, 0}};
    for (int n = 0; n < 25; n++) {
        struct glass g;
        make_glass(&g, 512, 512);
        const struct lm_ppi ppi = {
            .clip = {203, 140, 120, 97}, .apex_x_px = apex[n % 5][0], .apex_y_px = apex[n % 5][1]};
        const int32_t left = edges[n / 5][0], right = edges[n / 5][1];
        memset(g.plane.pixels, 7, 512 * 512);
        lm_plane_keep_wedge(&g.plane, &ppi, (fx_bam_t)left * FX_BAM_DEG(1),
                            (fx_bam_t)right * FX_BAM_DEG(1));
        for (int32_t y = 0; y < 512; y++) {
            for (int32_t x = 0; x < 512; x++) {
                const bool is_in_clip = x >= 203 && x < 323 && y >= 140 && y < 237;
                const double right_px = x + 0.5 - ppi.apex_x_px, up_px = ppi.apex_y_px - y - 0.5;
                const double azimuth = atan2(right_px, up_px) / degree;
                const double off_px =
                    fmin(azimuth - left, right - azimuth) * degree * hypot(right_px, up_px);
                if (is_in_clip && fabs(off_px) < 0.2 && up_px > 0) {
                    continue;
                }
                assert_int_equal(g.plane.pixels[y * 512 + x], !is_in_clip || off_px > 0 ? 7 : 0);
            }
        }
        memset(g.memory, GUARD, (size_t)3 * 512 * 512);
        close_glass(&g);
    }
}

TEST(hostile_wedges_stay_inside_the_frame)
{
    struct glass g;
    make_glass(&g, 300, 200);
    const int32_t deg = (int32_t)FX_BAM_DEG(1);
    paint(&g, -62 * deg, 62 * deg, 9);
    paint(&g, -62 * deg, -61 * deg, 9);
    paint(&g, 61 * deg, 62 * deg, 9);
    paint(&g, 5, 5, 9);
    paint(&g, 20 * deg, 10 * deg, 9);
    close_glass(&g);
}

/* The frame that the glass of [Heaton]'s display leaves to the picture. */
TEST(the_frame_is_the_share_of_the_display_that_is_promised)
{
    const struct lm_frame f = lm_frame_of_display(1000, 1000);
    assert_int_equal(f.left_px, 100);              /* -0.80 of half a screen */
    assert_int_equal(f.left_px + f.width_px, 860); /* +0.72 */
    assert_int_equal(f.top_px, 125);               /* +0.75 */
    assert_int_equal(f.top_px + f.height_px, 840); /* -0.68 */
}

TEST(a_whole_sector_fits_its_frame)
{
    for (uint16_t w = 100; w < 2000; w = (uint16_t)(w + 37)) {
        for (uint16_t h = 100; h < 2000; h = (uint16_t)(h + 41)) {
            const struct lm_frame f = {0, 0, w, h};
            const double radius = lm_ppi_radius_px(&f, true), sin_60 = sqrt(0.75);
            assert_true(radius <= h && 2 * radius * sin_60 <= w + 1e-9);
            assert_true(radius + 1 > h || 2 * (radius + 1.01) * sin_60 > w);
        }
    }
}

TEST(a_sector_is_as_high_as_its_frame_and_fills_two_fifths_of_the_glass)
{
    static const uint16_t sides[] = {480, 768, 1024};
    for (size_t n = 0; n < sizeof sides / sizeof *sides; n++) {
        struct glass g;
        make_glass(&g, sides[n], sides[n]);
        const int32_t line = (int32_t)lm_radar_default.line;
        assert_in_range(lm_ppi_radius_px(&g.frame, false), g.frame.height_px - 1,
                        g.frame.height_px + 1);
        paint_sector(&g, 128 * line, line, 0);
        uint32_t painted = 0;
        for (int32_t y = g.frame.top_px; y < g.frame.top_px + g.frame.height_px; y++) {
            for (int32_t x = g.frame.left_px; x < g.frame.left_px + g.frame.width_px; x++) {
                painted += g.plane.pixels[y * sides[n] + x] != 0;
            }
        }
        assert_true(painted >= 0.4 * sides[n] * sides[n]);
        close_glass(&g);
    }
}

/* ---- patches ---- */

/* A patch over a plane ramp of greys, in thousandths of the square to the right and up. */
struct ramp {
    double at_middle, right, up;
};

static double ramp_grey(const struct ramp *r, double right, double up)
{
    return r->at_middle + r->right * right + r->up * up;
}

/* How far right a line is at a cell, and how far up, in squares from the middle. */
static double right_of(const struct lm_patch_fan *fan, uint32_t line, double up)
{
    const double side_m_q8 = (double)fan->cells * fan->cell_m_q8;
    return (line + 0.5 - fan->lines / 2.0) / fan->cells * (1 + up * side_m_q8 / fan->centre_m_q8);
}

static double up_of(const struct lm_patch_fan *fan, uint32_t cell)
{
    return (cell + 0.5) / fan->cells - 0.5;
}

static uint32_t lines_of(uint32_t cells, double range_m, double cell_m)
{
    return 2 * (uint32_t)ceil(cells * range_m / (2 * (range_m - cells * cell_m / 2)));
}

static struct lm_patch_fan fan_of(uint32_t cells, double range_m, double cell_m)
{
    return (struct lm_patch_fan){lines_of(cells, range_m, cell_m), cells,
                                 (uint32_t)lround(range_m * 256), (uint32_t)lround(cell_m * 256)};
}

static void paint_patch(const struct glass *g, const struct lm_patch_fan *fan,
                        const struct ramp *ramp)
{
    static struct lm_patch_painter painter;
    lm_patch_painter_set(&painter, &g->frame, fan);
    for (uint32_t line = 0; line < fan->lines; line++) {
        uint8_t grey[PATCH_CELLS + 1] = {0}; /* one more is read */
        for (uint32_t i = 0; i < fan->cells; i++) {
            const double up = up_of(fan, i);
            const double value = ramp_grey(ramp, right_of(fan, line, up), up);
            grey[i] = (uint8_t)lround(fmin(fmax(value, 0), 255));
        }
        lm_scan_conv_patch(&painter, &g->plane, line, grey);
    }
}

/* Bilinear painting keeps a plane, whatever the fan: the rays' lines lie where they are. */
TEST(a_patch_fills_its_square_and_shows_every_place_where_it_is)
{
    static const uint16_t px[][2] = {{256, 256}, {480, 480},  {512, 512},  {768, 768},
                                     {700, 900}, {1024, 768}, {1024, 1024}};
    static const double fans[][3] = {{256, 60000, 5}, {256, 15000, 20}, {256, 9600, 40},
                                     {64, 20000, 1},  {100, 5000, 30},  {PATCH_CELLS, 60000, 3}};
    enum { GLASSES = sizeof px / sizeof *px, FANS = sizeof fans / sizeof *fans };
    const struct ramp ramp = {127, 160, 60};
    for (int n = 0; n < GLASSES * FANS; n++) {
        const double *f = fans[n % FANS];
        const struct lm_patch_fan fan = fan_of((uint32_t)f[0], f[1], f[2]);
        struct glass g;
        make_glass(&g, px[n / FANS][0], px[n / FANS][1]);
        const struct lm_frame s = lm_patch_square(&g.frame);
        paint_patch(&g, &fan, &ramp);
        double worst = 0;
        for (int32_t y = g.frame.top_px; y < g.frame.top_px + g.frame.height_px; y++) {
            for (int32_t x = g.frame.left_px; x < g.frame.left_px + g.frame.width_px; x++) {
                const double right = (x + 0.5 - s.left_px) / s.width_px - 0.5;
                const double up = 0.5 - (y + 0.5 - s.top_px) / s.height_px;
                const uint8_t shown = g.plane.pixels[y * g.plane.width_px + x];
                if (fabs(right) > 0.5 || fabs(up) > 0.5) {
                    assert_int_equal(shown, 0);
                } else if (fabs(up) < 0.5 - 0.5 / fan.cells) { /* the ends are held */
                    worst = fmax(worst, fabs(shown - ramp_grey(&ramp, right, up)));
                }
            }
        }
        /* Half a grey of the cells and one of each step of the painter. */
        assert_true(worst < 2);
        close_glass(&g);
    }
}

TEST(a_patch_takes_half_of_any_glass)
{
    static const uint16_t px[] = {480, 512, 768, 1024};
    for (int n = 0; n < 4; n++) {
        const struct lm_frame frame = lm_frame_of_display(px[n], px[n]);
        const struct lm_frame s = lm_patch_square(&frame);
        assert_int_equal(s.width_px, s.height_px);
        assert_int_equal(s.width_px % 2, 0);
        assert_true(2 * s.width_px * s.height_px >= px[n] * px[n]);
    }
}

/* While the patch is drawn, it is right up to the last line of the last strip, and soon behind that
 * line nothing is painted. */
static void grow_patch(uint16_t side_px, const struct lm_patch_fan *fan)
{
    static struct lm_patch_painter painter;
    struct glass g;
    uint8_t grey[PATCH_CELLS + 1];
    memset(grey, 200, sizeof grey);
    make_glass(&g, side_px, side_px);
    const struct lm_frame s = lm_patch_square(&g.frame);
    lm_patch_painter_set(&painter, &g.frame, fan);
    /* What vectors ask for: only lines of less than 32 cells go without. */
    assert_int_equal(painter.row_cells.are_close, fan->cells >= LM_K_PATCH_CLOSE);
    for (uint32_t line = 0; line < fan->lines; line++) {
        lm_scan_conv_patch(&painter, &g.plane, line, grey);
        assert_true(painter.waiting < painter.strip_lines);
        if (line % 9 != 0 || painter.waiting > line) { /* no strip is whole yet */
            continue;
        }
        for (int32_t y = s.top_px; y < s.top_px + s.height_px; y++) {
            const double up = 0.5 - (y + 0.5 - s.top_px) / s.height_px;
            const double end =
                s.left_px + (right_of(fan, line - painter.waiting, up) + 0.5) * s.width_px;
            for (int32_t x = s.left_px; x < s.left_px + s.width_px; x++) {
                const uint8_t shown = g.plane.pixels[y * g.plane.width_px + x];
                if (x + 0.5 < end - 0.1) {
                    assert_int_equal(shown, 200);
                } else if (x + 0.5 > end + LM_K_STRIP_PX) {
                    assert_int_equal(shown, 0);
                }
            }
        }
    }
    close_glass(&g);
}

TEST(a_patch_grows_strip_by_strip)
{
    const struct lm_patch_fan usual = fan_of(256, 15000, 20), few = fan_of(20, 15000, 20);
    grow_patch(256, &usual);
    grow_patch(512, &usual);
    grow_patch(1024, &usual);
    grow_patch(768, &few); /* more than 16 pixels from line to line */
}

static uint32_t blocks_of(const struct lm_damage *d)
{
    uint32_t count = 0;
    for (uint32_t band = 0; band < LM_BANDS; band++) {
        count += (uint32_t)__builtin_popcountll(d->band[band]);
    }
    return count;
}

/* What a line changes is in the damage, and the lines of a patch mark no more than a few times as
 * many blocks as it has. */
TEST(a_patch_marks_what_it_paints)
{
    const struct lm_patch_fan fan = fan_of(256, 60000, 5);
    static struct lm_patch_painter painter;
    static uint8_t before[512 * 512];
    struct lm_damage damage;
    struct glass g;
    uint32_t blocks = 0;
    make_glass(&g, 512, 512);
    g.plane.damage = &damage;
    lm_patch_painter_set(&painter, &g.frame, &fan);
    for (uint32_t line = 0; line < fan.lines; line++) {
        uint8_t grey[PATCH_CELLS + 1];
        memset(grey, line % 2 ? 200 : 60, sizeof grey);
        memcpy(before, g.plane.pixels, sizeof before);
        lm_damage_clear(&damage);
        lm_scan_conv_patch(&painter, &g.plane, line, grey);
        blocks += blocks_of(&damage);
        for (int32_t i = 0; i < 512 * 512; i++) {
            const struct lm_rectangle pixel = {i % 512, i / 512, i % 512 + 1, i / 512 + 1};
            assert_true(before[i] == g.plane.pixels[i] || lm_damage_covers(&damage, &pixel));
        }
    }
    const struct lm_frame s = lm_patch_square(&g.frame);
    const uint32_t all = s.width_px / LM_BLOCK_WIDTH_PX * (s.height_px / LM_BLOCK_HEIGHT_PX);
    assert_in_range(blocks, all, 5 * all);
    close_glass(&g);
}

/* What a pixel of a frame that was moved shows: that of where it came from, or black. */
static uint8_t moved(const struct glass *g, const uint8_t *before, int32_t x, int32_t y)
{
    return is_inside(g, x, y) ? before[y * g->plane.width_px + x] : 0;
}

TEST(a_picture_is_moved_whole_in_every_direction_and_black_comes_in)
{
    static const int32_t far[] = {0, 1, -1, 7, -7, 16, -16, 100, -100, 300, -300, 5000, -5000};
    enum { FAR = sizeof far / sizeof far[0], SIDE = 256 };
    static uint8_t before[SIDE * SIDE];
    for (int32_t n = 0; n < FAR * FAR; n++) {
        struct glass g;
        make_glass(&g, SIDE, SIDE);
        for (int32_t y = g.frame.top_px; y < g.frame.top_px + g.frame.height_px; y++) {
            for (int32_t x = g.frame.left_px; x < g.frame.left_px + g.frame.width_px; x++) {
                g.plane.pixels[y * SIDE + x] = (uint8_t)(x * 31 + y * 17);
            }
        }
        memcpy(before, g.plane.pixels, sizeof before);
        const int32_t right = far[n % FAR], down = far[n / FAR];
        lm_plane_shift(&g.plane, &g.frame, right, down);
        for (int32_t y = g.frame.top_px; y < g.frame.top_px + g.frame.height_px; y++) {
            for (int32_t x = g.frame.left_px; x < g.frame.left_px + g.frame.width_px; x++) {
                assert_int_equal(g.plane.pixels[y * SIDE + x],
                                 moved(&g, before, x - right, y - down));
            }
        }
        close_glass(&g);
    }
}

/* Nearer than half its side, a patch would begin behind the antenna. */
TEST(a_row_behind_the_antenna_is_as_wide_as_a_row_can_be)
{
    static struct lm_patch_painter p;
    const struct lm_frame frame = lm_frame_of_display(480, 480);
    const struct lm_patch_fan fan = {128, 64, 16 * 20 * 256, 20 * 256};
    lm_patch_painter_set(&p, &frame, &fan);
    for (uint32_t row = 0; row < p.square.height_px; row++) {
        assert_true(p.step_q20[row] > 0 && p.step_q20[row] <= LM_K_LINE_Q20 << 6);
        assert_true(row == 0 || p.step_q20[row] <= p.step_q20[row - 1]);
    }
    assert_int_equal(p.step_q20[0], LM_K_LINE_Q20 << 6);
}
