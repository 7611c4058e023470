/* Palettes, primitives, text and the picture's colours. */
#include "check.h"
#include "glass_text.h"
#include "lm/composer.h"
#include "lm/font.h"
#include "lm/overlay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_MAX = 1024, GUARD = 64, CANARY = 0x7EADBEEF };

static const struct lm_warning_reasons reasons = {.database = "IMAGE KU  RADAR X",
                                                  .unable = "TOO NEAR",
                                                  .exercise = "TARGETS",
                                                  .sender = "STUCK NODE 200"};

/* A surface with a margin around it that nothing may touch. */
static struct lm_surface make_surface(uint16_t width, uint16_t height)
{
    const size_t stride = width + 2u * GUARD;
    uint32_t *block = malloc(stride * (height + 2u * GUARD) * sizeof *block);
    assert_non_null(block);
    for (size_t i = 0; i < stride * (height + 2u * GUARD); i++) {
        block[i] = CANARY;
    }
    return (struct lm_surface){.pixels = block + GUARD * stride + GUARD,
                               .stride_px = (uint32_t)stride,
                               .width_px = width,
                               .height_px = height};
}

static void free_surface(struct lm_surface *s)
{
    const int32_t height = s->height_px, width = s->width_px;
    for (int32_t y = -GUARD; y < height + GUARD; y++) {
        for (int32_t x = -GUARD; x < width + GUARD; x++) {
            if (y < 0 || y >= height || x < 0 || x >= width) {
                assert_int_equal(s->pixels[y * (int32_t)s->stride_px + x], CANARY);
            }
        }
    }
    free(s->pixels - GUARD * s->stride_px - GUARD);
}

static unsigned part(uint32_t colour, int which)
{
    return colour >> (16 - 8 * which) & 255;
}

TEST(the_palette_as_delivered_shows_every_grey_as_it_is)
{
    struct lm_palette p;
    lm_palette_set(&p, &(struct lm_palette_config){0});
    for (uint32_t i = 0; i < 256; i++) {
        assert_int_equal(p.picture[i], i * 0x010101u);
    }
}

TEST(every_palette_rises_from_black_and_keeps_symbols_apart_from_the_picture)
{
    for (uint8_t tint = 0; tint < LM_TINTS; tint++) {
        for (int night = 0; night < 2; night++) {
            struct lm_palette p;
            lm_palette_set(&p, &(struct lm_palette_config){.tint = tint, .is_night = night});
            assert_int_equal(p.picture[0], 0);
            for (uint32_t i = 1; i < 256; i++) {
                for (int c = 0; c < 3; c++) {
                    assert_true(part(p.picture[i], c) >= part(p.picture[i - 1], c));
                }
                assert_int_not_equal(p.picture[i], p.symbol);
                assert_int_not_equal(p.picture[i], p.warning);
            }
            assert_int_not_equal(p.symbol, p.warning);
            assert_true(part(p.warning, 0) >= 120); /* seen by night as well */
        }
    }
}

TEST(night_takes_light_away_from_everything)
{
    for (uint8_t tint = 0; tint < LM_TINTS; tint++) {
        struct lm_palette day, night;
        lm_palette_set(&day, &(struct lm_palette_config){.tint = tint});
        lm_palette_set(&night, &(struct lm_palette_config){.tint = tint, .is_night = true});
        for (int c = 0; c < 3; c++) {
            assert_true(part(night.picture[255], c) * 2 < part(day.picture[255], c) + 1);
            assert_true(part(night.symbol, c) * 2 < part(day.symbol, c) + 1);
        }
    }
}

TEST(rockers_move_brightness_slope_and_symbols_one_way_each)
{
    struct lm_palette_config c = {0};
    struct lm_palette p, before;
    for (int8_t step = -LM_ROCKER_STEPS; step < LM_ROCKER_STEPS; step++) {
        c = (struct lm_palette_config){.brightness = step};
        lm_palette_set(&before, &c);
        c.brightness++;
        lm_palette_set(&p, &c);
        assert_int_equal(part(p.picture[128], 0) - part(before.picture[128], 0), 12);
        c = (struct lm_palette_config){.contrast = step};
        lm_palette_set(&before, &c);
        c.contrast++;
        lm_palette_set(&p, &c);
        /* 32 greys above the middle, 4^(step / 8) times as far */
        const double above = fmin(32 * pow(4, (step + 1) / 8.0), 127);
        assert_true(fabs(part(p.picture[160], 0) - 128.0 - above) <= 1);
        c = (struct lm_palette_config){.symbology = step};
        lm_palette_set(&before, &c);
        c.symbology++;
        lm_palette_set(&p, &c);
        assert_true(part(p.symbol, 1) > part(before.symbol, 1) || part(before.symbol, 1) == 255);
        assert_true(part(before.symbol, 1) > 40); /* never out */
        assert_int_equal(p.warning, before.warning);
    }
}

TEST(settings_out_of_range_count_as_the_nearest)
{
    struct lm_palette p, q;
    lm_palette_set(&p, &(struct lm_palette_config){200, false, 127, 127, 127});
    lm_palette_set(&q, &(struct lm_palette_config){0, false, 8, 8, 8});
    assert_memory_equal(&p, &q, sizeof p);
    lm_palette_set(&p, &(struct lm_palette_config){0, true, -128, -128, -128});
    lm_palette_set(&q, &(struct lm_palette_config){0, true, -8, -8, -8});
    assert_memory_equal(&p, &q, sizeof p);
}

TEST(the_picture_goes_through_the_palette_pixel_by_pixel)
{
    struct lm_surface s = make_surface(300, 256);
    static uint8_t grey[300 * 256];
    for (size_t i = 0; i < sizeof grey; i++) {
        /* Rows black but for a pixel or two, and others with a black stretch of any length. */
        const size_t y = i / 300, x = i % 300;
        const bool is_black = y % 2 ? x % 257 != y : x > y && x < 250;
        grey[i] = is_black ? 0 : (uint8_t)(i * 7 + y);
    }
    struct lm_palette p;
    const struct lm_palette_config amber = {.tint = LM_TINT_AMBER, .contrast = 2};
    lm_palette_set(&p, &amber);
    const struct lm_plane plane = {.pixels = grey, .width_px = 300, .height_px = 256};
    static struct lm_composer composer;
    lm_composer_init(&composer, 300, 256);
    lm_composer_begin(&composer, &s);
    assert_int_equal(lm_composer_take(&composer, &p), 304 * 256); /* whole blocks */
    assert_true(lm_composer_run(&composer, &plane, UINT32_MAX));
    for (uint32_t y = 0; y < 256; y++) {
        for (uint32_t x = 0; x < 300; x++) {
            assert_int_equal(s.pixels[y * s.stride_px + x], p.picture[grey[y * 300 + x]]);
        }
    }
    free_surface(&s);
}

TEST(nothing_is_drawn_beyond_the_surface)
{
    const uint16_t sizes[][2] = {{256, 256}, {256, 1024}, {1024, 256}, {480, 480}, {1023, 1024}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct lm_surface s = make_surface(sizes[i][0], sizes[i][1]);
        const struct lm_pen pen = lm_pen_for(&s, 0x00FFFFFF);
        const int32_t far = LM_DRAW_FAR;
        lm_draw_line(&pen, (struct lm_point){-far, -far + 3}, (struct lm_point){far, far});
        lm_draw_line(&pen, (struct lm_point){-far, 100}, (struct lm_point){far, 100});
        lm_draw_line(&pen, (struct lm_point){100, far}, (struct lm_point){100, -far});
        lm_draw_line(&pen, (struct lm_point){0, 0},
                     (struct lm_point){s.width_px - 1, s.height_px - 1});
        lm_draw_line(&pen, (struct lm_point){0, s.height_px - pen.line_px},
                     (struct lm_point){s.width_px - pen.line_px, 0});
        lm_draw_box(&pen, -5, -5, 10, 10);
        lm_draw_box(&pen, s.width_px - 2, s.height_px - 2, 10, 10);
        lm_draw_box(&pen, 50, 50, -10, -10);
        lm_draw_text(&pen, -8, -9, "WMW");
        lm_draw_text(&pen, s.width_px - 9, s.height_px - 9, "WMW");
        lm_draw_arc(&pen, &(struct lm_arc){{800, 800}, 100, 0, FX_BAM_180});
        struct lm_palette palette;
        lm_palette_set(&palette, &(struct lm_palette_config){0});
        const struct lm_frame frame = lm_frame_of_display(s.width_px, s.height_px);
        const struct lm_glass g = {.surface = s, .frame = &frame, .palette = &palette};
        lm_overlay_test_pattern(&g);
        lm_overlay_warnings(&g, UINT32_MAX, &reasons);
        for (uint32_t row = 0; row < 60; row++) {
            lm_overlay_row(&g, row, "01234567890123456789012345678901234567890123456");
        }
        free_surface(&s);
    }
}

TEST(a_line_is_whole_and_as_wide_as_the_pen)
{
    struct lm_surface s = make_surface(256, 256);
    struct lm_pen pen = lm_pen_for(&s, 0x00112233);
    const struct lm_point ends[][2] = {
        {{10, 10}, {200, 60}}, {{200, 10}, {10, 240}}, {{5, 5}, {5, 90}}, {{90, 7}, {5, 7}}};
    for (size_t i = 0; i < 4; i++) {
        const uint32_t before = glass_count(&s, pen.colour);
        lm_draw_line(&pen, ends[i][0], ends[i][1]);
        const int32_t dx = abs(ends[i][1].x - ends[i][0].x), dy = abs(ends[i][1].y - ends[i][0].y);
        const int32_t longest = dx > dy ? dx : dy;
        const int32_t drawn = (int32_t)(glass_count(&s, pen.colour) - before);
        assert_in_range(drawn, longest - 3, longest + 1); /* less where lines cross */
        for (int e = 0; e < 2; e++) {
            const struct lm_point p = ends[i][e];
            assert_int_equal(s.pixels[(uint32_t)p.y * s.stride_px + (uint32_t)p.x], pen.colour);
        }
    }
    free_surface(&s);
}

TEST(text_keeps_its_share_of_the_glass_and_thirty_four_columns_fit)
{
    for (uint16_t side = 256; side <= 1024; side++) {
        const struct lm_surface s = {
            .pixels = NULL, .stride_px = side, .width_px = side, .height_px = side};
        const struct lm_pen pen = lm_pen_for(&s, 0);
        const double share = 7.0 * pen.dot_px / side;
        assert_true(share > 0.0165 && share < 0.034);
        assert_true(side / lm_column_px(&pen) >= 35);
        assert_true((side - 10 * pen.dot_px) / lm_row_px(&pen) >= 21);
    }
}

TEST(every_character_of_the_font_differs_from_every_other)
{
    for (int a = 1; a < 0x60; a++) {
        const int is_there = a <= 3 || a > 0x20;
        const int is_blank = memcmp(lm_font_glyph((char)a), lm_font_glyph(' '), 7) == 0;
        assert_int_equal(is_blank, !is_there);
        for (int b = 0x21; is_there && b < a; b++) {
            assert_memory_not_equal(lm_font_glyph((char)a), lm_font_glyph((char)b), 7);
        }
    }
    assert_ptr_equal(lm_font_glyph('q'), lm_font_glyph('Q'));
    assert_memory_equal(lm_font_glyph((char)200), lm_font_glyph(' '), 7);
}

TEST(text_is_cut_where_it_does_not_fit_and_numbers_are_exact)
{
    struct lm_text t = {0};
    lm_text_number(&t, 4294967295u, 1);
    lm_text_add(&t, " ");
    lm_text_number(&t, 7, 3);
    lm_text_add(&t, " ");
    lm_text_signed(&t, INT32_MIN);
    lm_text_signed(&t, 5);
    lm_text_signed(&t, 0);
    assert_string_equal(t.words, "4294967295 007 -2147483648+50");
    lm_text_tab(&t, 200);
    lm_text_add(&t, "X");
    lm_text_number(&t, 1, 10);
    assert_int_equal(strlen(t.words), LM_TEXT_MAX);
    assert_int_equal(t.length, LM_TEXT_MAX);
}

TEST(a_flag_that_does_not_exist_has_the_word_of_the_first)
{
    assert_string_equal(lm_flag_word(LM_FLAGS), lm_flag_word(0));
    assert_string_equal(lm_flag_word(UINT32_MAX), lm_flag_word(0));
}

/* A glass with nothing on it but the warnings of these flags. */
static struct lm_surface warned(uint16_t side, const struct lm_palette *palette, uint32_t flags)
{
    const struct lm_surface s = make_surface(side, side);
    const struct lm_frame frame = lm_frame_of_display(side, side);
    const struct lm_glass g = {.surface = s, .frame = &frame, .palette = palette};
    lm_overlay_blank(&g);
    lm_overlay_warnings(&g, flags, &reasons);
    return s;
}

TEST(each_flag_has_a_word_of_its_own_on_the_glass)
{
    struct lm_palette palette;
    lm_palette_set(&palette, &(struct lm_palette_config){0});
    for (uint16_t side = 256; side <= 1024; side += 256) {
        struct lm_surface s = warned(side, &palette, (1u << LM_FLAGS) - 1);
        for (uint32_t i = 0; i < LM_FLAGS; i++) {
            assert_true(glass_find(&s, lm_flag_word(i), palette.warning, palette.ink, NULL));
            for (uint32_t j = 0; j < i; j++) {
                assert_string_not_equal(lm_flag_word(i), lm_flag_word(j));
            }
        }
        free_surface(&s);
    }
}

static struct lm_surface test_pattern(uint16_t side, const struct lm_palette *palette)
{
    const struct lm_surface s = make_surface(side, side);
    const struct lm_frame frame = lm_frame_of_display(side, side);
    lm_overlay_test_pattern(&(struct lm_glass){.surface = s, .frame = &frame, .palette = palette});
    return s;
}

TEST(the_test_pattern_shows_sixteen_greys_every_colour_and_every_character)
{
    struct lm_palette palette;
    lm_palette_set(&palette, &(struct lm_palette_config){0});
    struct lm_surface s = make_surface(480, 480);
    const struct lm_frame frame = lm_frame_of_display(480, 480);
    const struct lm_glass g = {.surface = s, .frame = &frame, .palette = &palette};
    lm_overlay_test_pattern(&g);
    for (uint32_t i = 0; i < 16; i++) {
        assert_true(glass_count(&s, i * 17 * 0x010101u) > 1000);
    }
    const uint32_t colours[] = {palette.symbol, palette.faint, palette.warning,
                                0x00FF0000,     0x0000FF00,    0x000000FF};
    for (size_t i = 0; i < 6; i++) {
        assert_true(glass_count(&s, colours[i]) > 2000);
    }
    assert_true(glass_find(&s, "ABCDEFGHIJKLMNOPQRSTUVWXYZ", palette.symbol, 0, NULL));
    assert_true(glass_find(&s, "0123456789 !\"#$%&'()*+,-./", palette.symbol, 0, NULL));
    assert_true(glass_find(&s, ":;<=>?@[\\]^_\x01\x02\x03", palette.symbol, 0, NULL));
    free_surface(&s);
}

/* Rows that the bars of the test pattern cover. */
static bool is_bar_row(int32_t y)
{
    return (y >= 98 && y <= 177) || (y >= 223 && y <= 282) || (y >= 348 && y <= 402);
}

TEST(the_bars_of_the_test_pattern_have_no_gaps)
{
    struct lm_palette p;
    lm_palette_set(&p, &(struct lm_palette_config){.tint = 1});
    struct lm_surface s = test_pattern(512, &p);
    const uint32_t *greys = s.pixels + 120 * s.stride_px, *colours = s.pixels + 380 * s.stride_px;
    for (uint32_t x = 0; x < 512; x++) {
        assert_int_equal(greys[x], p.picture[x * 16 / 512 * 255 / 15]);
    }
    /* Nine colours: no column has another one than its own or, at a border, the next. */
    const uint32_t own[] = {p.symbol,   p.faint,    p.warning,  p.ink,     p.picture[255],
                            0x00FF0000, 0x0000FF00, 0x000000FF, 0x00FFFFFF};
    for (uint32_t x = 0; x < 512; x++) {
        const uint32_t i = x * 9 / 512;
        assert_true(colours[x] == own[i] || (i < 8 && colours[x] == own[i + 1]));
    }
    free_surface(&s);
}

TEST(the_rows_of_characters_of_the_test_pattern_stand_further_apart_than_those_of_a_label)
{
    struct lm_palette p;
    lm_palette_set(&p, &(struct lm_palette_config){0});
    struct lm_surface s = test_pattern(480, &p);
    const struct lm_pen pen = lm_pen_for(&s, p.symbol);
    static const char *const rows[] = {"XYZ", "789", ":;<=>"};
    struct lm_point at[3];
    for (size_t i = 0; i < 3; i++) {
        assert_true(glass_find(&s, rows[i], p.symbol, 0, &at[i]));
        assert_true(i == 0 || at[i].y - at[i - 1].y > lm_row_px(&pen));
    }
    free_surface(&s);
}

TEST(below_the_sixteen_greys_of_the_test_pattern_are_all_256_in_order)
{
    struct lm_palette p;
    lm_palette_set(&p, &(struct lm_palette_config){.tint = 1});
    struct lm_surface s = test_pattern(512, &p);
    const uint32_t *greys = s.pixels + 160 * s.stride_px;
    for (uint32_t x = 0; x < 512; x++) {
        assert_int_equal(greys[x], p.picture[x / 2]);
    }
    free_surface(&s);
}

/* On glasses that neither 16 nor 256 divides, as well. */
TEST(each_column_of_the_test_patterns_bars_has_the_grey_of_its_place)
{
    struct lm_palette p;
    lm_palette_set(&p, &(struct lm_palette_config){.tint = 1});
    for (uint16_t side = 257; side < 1024; side += 109) {
        struct lm_surface s = test_pattern(side, &p);
        const uint32_t top = side * 2u / 10, height = side / 10;
        const uint32_t *bars = s.pixels + (top + height / 2) * s.stride_px;
        const uint32_t *all = s.pixels + (top + height + height / 4) * s.stride_px;
        for (uint32_t x = 0; x < side; x++) {
            const uint32_t bar = x * 16 / side;
            assert_true(bars[x] == p.picture[bar * 17] ||
                        (bar < 15 && bars[x] == p.picture[bar * 17 + 17]));
            assert_int_equal(all[x], p.picture[x * 256 / side]);
        }
        free_surface(&s);
    }
}

TEST(the_grid_of_the_test_pattern_reaches_from_edge_to_edge_and_its_circles_are_closed)
{
    struct lm_palette p;
    lm_palette_set(&p, &(struct lm_palette_config){0});
    struct lm_surface s = test_pattern(500, &p);
    for (uint32_t i = 0; i <= 10; i++) {
        const uint32_t at = 499 * i / 10;
        assert_int_equal(s.pixels[20 * s.stride_px + at],
                         at == 20 || at == 479 ? p.symbol : p.faint);
        assert_true(s.pixels[at * s.stride_px + 498] != 0 && s.pixels[at * s.stride_px + 499] != 0);
    }
    /* On the largest circle, up, down and to the sides of the middle. */
    const int32_t radius = 249;
    for (int32_t degrees = 0; degrees < 360; degrees += 3) {
        const double turn = degrees * 3.14159265358979323846 / 180;
        const int32_t x = (int32_t)lround(249 + radius * sin(turn));
        const int32_t y = (int32_t)lround(249 - radius * cos(turn));
        bool is_drawn = false;
        for (int32_t k = 0; k < 9; k++) {
            const int32_t u = x + k % 3 - 1, v = y + k / 3 - 1;
            is_drawn |= u >= 0 && v >= 0 && u < 500 && v < 500 &&
                        s.pixels[v * (int32_t)s.stride_px + u] == p.symbol;
        }
        assert_true(is_drawn || (is_bar_row(y)));
    }
    free_surface(&s);
}

/* ---- symbols of a patch ---- */

/* A black glass with the symbols of a patch of 256 cells, drawn in white. */
static struct lm_surface draw_patch_symbols(uint32_t cell_mm, double look_deg, struct lm_view *view)
{
    struct lm_surface surface = make_surface(768, 768);
    const struct lm_frame frame = lm_frame_of_display(768, 768);
    static struct lm_palette palette;
    palette = (struct lm_palette){.symbol = 0xFFFFFF};
    for (int i = 0; i < 768 * 768; i++) {
        surface.pixels[i / 768 * (int)surface.stride_px + i % 768] = 0;
    }
    const fx_bam_t look = (fx_bam_t)(int64_t)(look_deg / 360 * 4294967296.0);
    *view = lm_view_of_patch(&frame, (struct lm_position){0, 0}, look, 256, cell_mm);
    const struct lm_symbols symbols = {.view = *view, .patch_look = look, .patch_cell_mm = cell_mm};
    const struct lm_glass glass = {.surface = surface, .frame = &frame, .palette = &palette};
    lm_overlay_symbols(&glass, &symbols);
    return surface;
}

static bool is_drawn(const struct lm_surface *s, double x, double y)
{
    return s->pixels[(int)floor(y) * (int)s->stride_px + (int)floor(x)] != 0;
}

/* Longest horizontal line in the upper left quarter of the square: the bracket. */
static int bracket_px(const struct lm_surface *s, const struct lm_view *v)
{
    int longest = 0;
    for (int y = v->middle.y - v->radius_px; y < v->middle.y; y++) {
        for (int x = v->middle.x - v->radius_px, run = 0; x < v->middle.x + v->radius_px; x++) {
            run = is_drawn(s, x, y) ? run + 1 : 0;
            longest = run > longest ? run : longest;
        }
    }
    return longest;
}

TEST(the_bracket_of_a_patch_is_1500_feet_long_or_150)
{
    static const struct {
        uint32_t cell_mm;
        double feet;
    } cases[] = {{5000, 1500}, {20000, 1500}, {2000, 150}, {1000, 150}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lm_view v;
        struct lm_surface s = draw_patch_symbols(cases[i].cell_mm, 0, &v);
        const double side_m = 256 * cases[i].cell_mm / 1000.0;
        const double wanted_px = cases[i].feet * 0.3048 / side_m * 2 * v.radius_px;
        /* A line is a dot wide, two pixels here. */
        assert_true(fabs(bracket_px(&s, &v) - wanted_px) < 4);
        free_surface(&s);
    }
}

TEST(the_arrow_of_a_patch_points_along_the_line_of_sight_and_its_n_to_the_north)
{
    for (double look_deg = 15; look_deg < 360; look_deg += 30) {
        struct lm_view v;
        struct lm_surface s = draw_patch_symbols(5000, look_deg, &v);
        const double arm = 768 * 60 / 2000, corner = v.radius_px - 2 * arm;
        const double x = v.middle.x + corner + 0.5, y = v.middle.y + corner + 0.5;
        const double north = -look_deg / 57.29577951308232;
        assert_true(is_drawn(&s, x, y - arm + 2));
        assert_true(is_drawn(&s, x + 0.7 * arm * sin(north), y - 0.7 * arm * cos(north)));
        assert_false(is_drawn(&s, x - 0.7 * arm * sin(north), y + 0.7 * arm * cos(north)));
        free_surface(&s);
    }
}

/* Cells of the coarsest maps, on the smallest glass too, where elevation and longitude stand beside
 * them. */
TEST(the_length_of_long_map_cells_is_written)
{
    static const uint16_t sides_px[] = {256, 768};
    for (size_t i = 0; i < 2; i++) {
        const uint16_t side = sides_px[i];
        struct lm_surface surface = make_surface(side, side);
        const struct lm_frame frame = lm_frame_of_display(side, side);
        const struct lm_palette palette = {.symbol = 0xFFFFFF};
        struct lm_symbols symbols = {.coarse_mm = 2441887};
        symbols.view = lm_view_of_patch(&frame, (struct lm_position){0, 0}, 0, 256, 5000);
        for (int k = 0; k < side; k++) {
            memset(surface.pixels + (size_t)k * surface.stride_px, 0, side * sizeof(uint32_t));
        }
        const struct lm_glass glass = {.surface = surface, .frame = &frame, .palette = &palette};
        lm_overlay_symbols(&glass, &symbols);
        assert_true(glass_find(&surface, "MAP 2442M", palette.symbol, palette.ink, NULL));
        free_surface(&surface);
    }
}

/* A black glass over a patch, with the mark of what is tracked at (600, 200), in white. */
static struct lm_surface draw_track_mark(enum lm_track_shape shape)
{
    struct lm_surface surface = make_surface(768, 768);
    const struct lm_frame frame = lm_frame_of_display(768, 768);
    const struct lm_palette palette = {.symbol = 0xFFFFFF};
    for (uint32_t y = 0; y < 768; y++) {
        memset(surface.pixels + y * surface.stride_px, 0, 768 * sizeof(uint32_t));
    }
    const struct lm_symbols symbols = {
        .view = lm_view_of_patch(&frame, (struct lm_position){0, 0}, 0, 256, 5000),
        .track_shape = shape,
        .track = {600, 200}};
    const struct lm_glass glass = {.surface = surface, .frame = &frame, .palette = &palette};
    lm_overlay_symbols(&glass, &symbols);
    return surface;
}

TEST(what_is_tracked_is_a_diamond_filled_to_its_edges_and_no_further)
{
    struct lm_surface hollow = draw_track_mark(LM_SHAPE_HOLLOW);
    struct lm_surface filled = draw_track_mark(LM_SHAPE_FILLED);
    int32_t rows = 0;
    for (int32_t y = 140; y < 260; y++) {
        int32_t first = 660, last = 539;
        for (int32_t x = 540; x < 660; x++) {
            if (is_drawn(&hollow, x, y)) {
                first = x < first ? x : first;
                last = x;
            }
        }
        rows += first < last;
        for (int32_t x = 540; x < 660; x++) {
            assert_int_equal(is_drawn(&filled, x, y), x >= first && x <= last);
        }
    }
    assert_true(rows > 40);
    free_surface(&hollow);
    free_surface(&filled);
}

/* Four triangles that point at it, each as far as 45 thousandths of half the glass. */
TEST(what_is_ranged_is_a_maltese_cross)
{
    struct lm_surface cross = draw_track_mark(LM_SHAPE_CROSS);
    const int32_t far = 384 * 45 / 1000, aside = 384 * 15 / 1000;
    assert_true(is_drawn(&cross, 600, 200));
    for (int32_t side = -1; side <= 1; side += 2) {
        for (int32_t along = -aside; along <= aside; along++) {
            assert_true(is_drawn(&cross, 600 + along, 200 + side * far));
            assert_true(is_drawn(&cross, 600 + side * far, 200 + along));
        }
        for (int32_t other = -1; other <= 1; other += 2) {
            assert_false(is_drawn(&cross, 600 + side * far / 2, 200 + other * far / 2));
        }
    }
    free_surface(&cross);
}

TEST(the_box_of_a_warning_is_as_wide_on_both_sides_of_its_words_on_any_glass)
{
    struct lm_palette palette;
    lm_palette_set(&palette, &(struct lm_palette_config){0});
    for (uint16_t side = 256; side <= 1024; side += 256) {
        struct lm_surface s = warned(side, &palette, 1);
        const struct lm_pen pen = lm_pen_for(&s, palette.warning);
        struct lm_point at;
        assert_true(glass_find(&s, lm_flag_word(0), palette.warning, palette.ink, &at));
        const int32_t end = at.x + lm_text_width(&pen, lm_flag_word(0)) - pen.dot_px;
        int32_t left = side, right = 0; /* of the line above the words */
        for (int32_t x = 0; x < side; x++) {
            if (s.pixels[(at.y - 3 * pen.dot_px) * (int32_t)s.stride_px + x] == palette.warning) {
                left = x < left ? x : left;
                right = x;
            }
        }
        assert_in_range(abs((at.x - left) - (right - end)), 0, pen.dot_px);
        free_surface(&s);
    }
}
