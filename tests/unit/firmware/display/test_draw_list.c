/* The list of what is drawn over the picture: what is noted is drawn as it would be at once, and
 * what does not fit is left out. */
#include "check.h"
#include "lm/composer.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 512, INK = 0x00ABCDEF };

struct fixture {
    uint32_t now[SIDE * SIDE], noted[SIDE * SIDE];
    struct lm_draw_list list;
    struct lm_damage damage, all;
    struct lm_composer composer;
};

static const struct lm_rectangle glass = {0, 0, SIDE, SIDE};

static struct lm_surface surface_on(uint32_t *pixels)
{
    return (struct lm_surface){
        .pixels = pixels, .stride_px = SIDE, .width_px = SIDE, .height_px = SIDE};
}

static struct lm_pen pen_on(uint32_t *pixels)
{
    const struct lm_surface surface = surface_on(pixels);
    return lm_pen_for(&surface, INK);
}

static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    *state = f;
    if (f) {
        lm_damage_mark(&f->all, &glass);
    }
    return f ? 0 : -1;
}

static int tear_down(void **state)
{
    free(*state);
    return 0;
}

/* Draw by `draw`, at once and from the list. */
static void draw_both(struct fixture *f, struct lm_pen pen, void (*draw)(const struct lm_pen *pen))
{
    const struct lm_surface noted = surface_on(f->noted);
    draw(&pen);
    pen.list = &f->list;
    lm_draw_list_begin(&f->list, &f->damage);
    draw(&pen);
    lm_draw_list_end(&f->list);
    lm_draw_list_paint(&f->list, &noted, &f->all);
}

static uint32_t inked(const uint32_t *pixels)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        count += pixels[i] == INK;
    }
    return count;
}

static void draw_lines(const struct lm_pen *pen)
{
    lm_draw_line(pen, (struct lm_point){20, 30}, (struct lm_point){480, 290});
    lm_draw_line(pen, (struct lm_point){400, 10}, (struct lm_point){390, 500});
}

TEST_WITH(a_slanted_line_is_the_same_from_the_list, set_up, tear_down)
{
    struct fixture *f = *state;
    draw_both(f, pen_on(f->now), draw_lines);
    assert_memory_equal(f->now, f->noted, sizeof f->now);
    assert_true(inked(f->now) > 900);
}

/* Wider than the dots of a line that is drawn without a look at the clip. */
TEST_WITH(a_slanted_line_is_as_wide_both_ways_as_its_pen, set_up, tear_down)
{
    struct fixture *f = *state;
    struct lm_pen pen = pen_on(f->now);
    uint32_t wanted = 0;
    pen.line_px = 1;
    draw_lines(&pen);
    pen = pen_on(f->noted);
    pen.line_px = 4;
    draw_lines(&pen);
    for (int32_t y = 3; y < SIDE; y++) {
        for (int32_t x = 3; x < SIDE; x++) {
            bool is_wanted = false;
            for (int32_t k = 0; k < 16; k++) {
                is_wanted |= f->now[(y - k / 4) * SIDE + x - k % 4] == INK;
            }
            assert_int_equal(f->noted[y * SIDE + x] == INK, is_wanted);
            wanted += is_wanted;
        }
    }
    assert_true(wanted > 3000);
}

/* Words longer than a row are cut where a row ends. */
TEST_WITH(words_of_the_list_are_as_long_as_a_row_at_most, set_up, tear_down)
{
    struct fixture *f = *state;
    struct lm_pen pen = pen_on(f->now);
    char words[LM_TEXT_MAX + 8];
    memset(words, 'W', sizeof words);
    words[sizeof words - 1] = '\0';
    pen.list = &f->list;
    lm_draw_list_begin(&f->list, &f->damage);
    lm_draw_text(&pen, 5, 5, words);
    lm_draw_text(&pen, 5, 50, "NAV");
    lm_draw_list_end(&f->list);
    assert_int_equal(strlen(f->list.words[0]), LM_TEXT_MAX);
    assert_string_equal(f->list.words[1], "NAV");
}

TEST_WITH(a_full_list_leaves_out_what_comes_later, set_up, tear_down)
{
    struct fixture *f = *state;
    const struct lm_surface noted = surface_on(f->noted);
    struct lm_pen pen = pen_on(f->now);
    pen.list = &f->list;
    for (int frame = 0; frame < 2; frame++) {
        lm_draw_list_begin(&f->list, &f->damage);
        for (int i = 0; i < LM_DRAW_TEXTS + 3; i++) {
            lm_draw_text(&pen, 5, 5, "X");
        }
        assert_int_equal(f->list.texts, LM_DRAW_TEXTS);
        assert_int_equal(f->list.count, LM_DRAW_TEXTS);
        for (int i = 0; i < LM_DRAW_ITEMS; i++) {
            lm_draw_box(&pen, i % SIDE, 100, 1, 1);
        }
        assert_int_equal(f->list.count, LM_DRAW_ITEMS);
        lm_draw_box(&pen, 10, 400, 5, 5);
        lm_draw_list_end(&f->list);
    }
    lm_draw_list_paint(&f->list, &noted, &f->all);
    assert_int_equal(f->noted[100 * SIDE + LM_DRAW_ITEMS - LM_DRAW_TEXTS - 1], INK);
    assert_int_equal(f->noted[100 * SIDE + LM_DRAW_ITEMS - LM_DRAW_TEXTS], 0);
    assert_int_equal(f->noted[402 * SIDE + 12], 0);
}

TEST_WITH(text_is_drawn_in_the_blocks_that_a_pen_keeps_to_and_in_no_other, set_up, tear_down)
{
    struct fixture *f = *state;
    struct lm_pen pen = pen_on(f->now);
    lm_draw_text(&pen, 3, 5, "WARNING");
    const struct lm_rectangle left = {0, 0, 32, 16};
    struct lm_damage within = {{0}};
    lm_damage_mark(&within, &left);
    pen = pen_on(f->noted);
    pen.within = &within;
    lm_draw_text(&pen, 3, 5, "WARNING");
    for (int32_t y = 0; y < SIDE; y++) {
        for (int32_t x = 0; x < SIDE; x++) {
            const bool is_within = x < left.right && y < left.bottom;
            assert_int_equal(f->noted[y * SIDE + x], is_within ? f->now[y * SIDE + x] : 0);
        }
    }
    assert_true(inked(f->noted) > 20 && inked(f->noted) < inked(f->now));
}

TEST_WITH(every_character_is_the_same_in_the_blocks_of_a_pen_as_without_any, set_up, tear_down)
{
    struct fixture *f = *state;
    struct lm_pen pen = pen_on(f->now), within = pen_on(f->noted);
    within.within = &f->all;
    for (int32_t row = 0; row < 4; row++) {
        char words[17] = {0};
        for (int i = 0; i < 16; i++) {
            words[i] = (char)(' ' + row * 16 + i);
        }
        lm_draw_text(&pen, 5, 10 + 30 * row, words);
        lm_draw_text(&within, 5, 10 + 30 * row, words);
    }
    assert_memory_equal(f->now, f->noted, sizeof f->now);
    assert_true(inked(f->now) > 500);
}

TEST_WITH(lines_are_drawn_in_the_blocks_that_a_pen_keeps_to_and_in_no_other, set_up, tear_down)
{
    struct fixture *f = *state;
    for (int32_t width = 1; width <= 3; width++) {
        struct lm_pen pen = pen_on(f->now);
        memset(f->now, 0, sizeof f->now);
        memset(f->noted, 0, sizeof f->noted);
        pen.line_px = width;
        draw_lines(&pen);
        /* Every third block, so that both neighbours of a dot on a border have their turn. */
        struct lm_damage within = {{0}};
        for (int32_t y = 0; y < SIDE; y += LM_BLOCK_HEIGHT_PX) {
            for (int32_t x = 0; x < SIDE; x += LM_BLOCK_WIDTH_PX) {
                if ((x / LM_BLOCK_WIDTH_PX + y / LM_BLOCK_HEIGHT_PX) % 3 == 0) {
                    const struct lm_rectangle block = {x, y, x + 1, y + 1};
                    lm_damage_mark(&within, &block);
                }
            }
        }
        pen = pen_on(f->noted);
        pen.line_px = width;
        pen.within = &within;
        draw_lines(&pen);
        for (int32_t y = 0; y < SIDE; y++) {
            for (int32_t x = 0; x < SIDE; x++) {
                const bool is_within = (x / LM_BLOCK_WIDTH_PX + y / LM_BLOCK_HEIGHT_PX) % 3 == 0;
                assert_int_equal(f->noted[y * SIDE + x], is_within ? f->now[y * SIDE + x] : 0);
            }
        }
        assert_true(inked(f->noted) > 200 && inked(f->noted) < inked(f->now));
    }
}

/* What lies beside the glass one way is empty there, and its corners mean nothing. */
TEST_WITH(a_box_that_is_empty_either_way_is_not_noted, set_up, tear_down)
{
    struct fixture *f = *state;
    struct lm_pen pen = pen_on(f->now);
    pen.list = &f->list;
    lm_draw_list_begin(&f->list, &f->damage);
    lm_draw_box(&pen, -50, 100, 20, 20);
    lm_draw_box(&pen, SIDE + 50, 100, 20, 20);
    lm_draw_box(&pen, 100, -50, 20, 20);
    lm_draw_box(&pen, 100, SIDE + 50, 20, 20);
    lm_draw_box(&pen, 100, 100, 0, 20);
    lm_draw_box(&pen, 100, 100, 20, 0);
    lm_draw_list_end(&f->list);
    assert_int_equal(f->list.count, 0);
    assert_false(lm_damage_meets(&f->damage, &glass));
}

/* Of memory that holds a picture too old, or anything, all is due. */
TEST_WITH(a_surface_that_is_new_or_too_old_is_drawn_whole, set_up, tear_down)
{
    struct fixture *f = *state;
    struct lm_palette palette;
    struct lm_surface surface = surface_on(f->now);
    lm_palette_set(&palette, &(struct lm_palette_config){0});
    lm_composer_init(&f->composer, SIDE, SIDE);
    for (uint32_t frame = 0; frame < 12; frame++) {
        surface.age = (uint8_t)(frame < LM_AGES ? 0 : frame % (LM_AGES + 2));
        lm_composer_begin(&f->composer, &surface);
        const uint32_t due = lm_composer_take(&f->composer, &palette);
        const bool is_known = surface.age >= 1 && surface.age <= LM_AGES;
        assert_int_equal(due, is_known ? 0 : SIDE * SIDE);
        while (!lm_composer_run(&f->composer, NULL, UINT32_MAX)) {
        }
        lm_composer_finish(&f->composer);
    }
}
