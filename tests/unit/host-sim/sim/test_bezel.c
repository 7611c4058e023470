/* The bezel around the glass, and the hands that work it. */
#include "sim/bezel.h"
#include "sim/hands.h"

#include <stdlib.h>

#include "check.h"
#include "control_asserts.h"

static const uint16_t sizes[][2] = {{256, 256}, {480, 480}, {1024, 1024}, {256, 1024}, {1024, 400}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static int overlap(struct bezel_box a, struct bezel_box b)
{
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
           b.y < a.y + a.height;
}

TEST(buttons_lie_on_the_bezel_apart_from_each_other_and_from_the_glass)
{
    for (size_t i = 0; i < SIZES; i++) {
        const struct bezel b = bezel_around(sizes[i][0], sizes[i][1]);
        const struct bezel_box glass = {b.margin_px, b.margin_px, b.glass_width_px,
                                        b.glass_height_px};
        for (int32_t button = 1; button <= LM_BUTTONS; button++) {
            const struct bezel_box box = bezel_box_of(&b, button);
            assert_true(box.x >= 0 && box.x + box.width <= b.width_px);
            assert_true(box.y >= 0 && box.y + box.height <= b.height_px);
            assert_false(overlap(box, glass));
            for (int32_t other = 1; other < button; other++) {
                assert_false(overlap(box, bezel_box_of(&b, other)));
            }
        }
    }
}

TEST(every_point_of_a_button_is_that_button_and_the_glass_is_none)
{
    const struct bezel b = bezel_around(480, 480);
    uint32_t seen = 0, points = 0, area = 0;
    for (int32_t button = 1; button <= LM_BUTTONS; button++) {
        const struct bezel_box box = bezel_box_of(&b, button);
        area += (uint32_t)(box.width * box.height);
    }
    for (int32_t y = -5; y < b.height_px + 5; y++) {
        for (int32_t x = -5; x < b.width_px + 5; x++) {
            const int32_t button = bezel_button_at(&b, x, y);
            assert_in_range(button, 0, LM_BUTTONS);
            if (button) {
                seen |= 1u << (button - 1);
                points++;
            }
        }
    }
    assert_int_equal(seen, (1u << LM_BUTTONS) - 1);
    assert_int_equal(points, area);
}

TEST(keys_stand_clockwise_from_the_top_left)
{
    const struct bezel b = bezel_around(480, 480);
    for (int32_t i = 1; i < 5; i++) {
        assert_true(bezel_box_of(&b, i).x < bezel_box_of(&b, i + 1).x);
        assert_true(bezel_box_of(&b, i + 5).y < bezel_box_of(&b, i + 6).y);
        assert_true(bezel_box_of(&b, i + 10).x > bezel_box_of(&b, i + 11).x);
        assert_true(bezel_box_of(&b, i + 15).y > bezel_box_of(&b, i + 16).y);
    }
    assert_true(bezel_box_of(&b, 1).y < 60 && bezel_box_of(&b, 6).x > 540);
    assert_true(bezel_box_of(&b, 11).y > 540 && bezel_box_of(&b, 16).x < 60);
}

TEST(the_picture_holds_the_glass_whole_and_lights_what_is_down)
{
    for (size_t i = 0; i < SIZES; i++) {
        const struct bezel b = bezel_around(sizes[i][0], sizes[i][1]);
        const size_t pixels = (size_t)b.width_px * b.height_px;
        uint32_t *glass = malloc(sizeof *glass * b.glass_width_px * b.glass_height_px);
        uint32_t *dark = malloc(sizeof *dark * pixels), *lit = malloc(sizeof *lit * pixels);
        assert_true(glass && dark && lit);
        for (uint32_t n = 0; n < (uint32_t)b.glass_width_px * b.glass_height_px; n++) {
            glass[n] = n & 0xFFFFFF;
        }
        bezel_draw(&b, dark, glass, 0);
        for (uint32_t y = 0; y < b.glass_height_px; y += 7) {
            for (uint32_t x = 0; x < b.glass_width_px; x++) {
                assert_int_equal(dark[(y + b.margin_px) * b.width_px + x + b.margin_px],
                                 glass[y * b.glass_width_px + x]);
            }
        }
        for (int32_t button = 1; button <= LM_BUTTONS; button++) {
            const struct bezel_box box = bezel_box_of(&b, button);
            bezel_draw(&b, lit, glass, 1u << (button - 1));
            for (size_t n = 0; n < pixels; n++) {
                const int32_t x = (int32_t)(n % b.width_px), y = (int32_t)(n / b.width_px);
                const int is_inside =
                    x >= box.x && x < box.x + box.width && y >= box.y && y < box.y + box.height;
                assert_true(is_inside || lit[n] == dark[n]);
            }
            const size_t corner = (size_t)(box.y + 2) * b.width_px + (size_t)box.x + 2;
            assert_int_not_equal(lit[corner], dark[corner]);
        }
        free(glass);
        free(dark);
        free(lit);
    }
}

TEST(hands_speak_after_the_script_and_let_go_of_everything)
{
    struct hands h;
    struct lm_control c;
    hands_init(&h, NULL);
    hands_button(&h, 5, true);
    hands_button(&h, 5, true); /* by mouse and keyboard: once */
    hands_arrow(&h, HANDS_LEFT, true);
    hands_arrow(&h, HANDS_UP, true);
    hands_off(&h);
    const struct lm_control expected[] = {
        lm_control_button(true, 5),  lm_control_slew(-1000, 0), lm_control_slew(-1000, 1000),
        lm_control_button(false, 5), lm_control_slew(0, 1000),  lm_control_slew(0, 0),
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        assert_int_equal(h.port.next(h.port.ctx, &c), 1);
        assert_same_control(&c, expected[i]);
    }
    assert_int_equal(h.port.next(h.port.ctx, &c), 0);
}

TEST(the_knob_stops_at_its_ends_and_a_full_queue_is_counted)
{
    struct hands h;
    struct lm_control c;
    hands_init(&h, NULL);
    for (int i = 0; i < HANDS_QUEUE + 5; i++) {
        hands_turn_knob(&h, 100);
    }
    assert_int_equal(h.knob, LM_FULL_DEFLECTION);
    assert_int_equal(h.lost, 5);
    int taken = 0;
    while (h.port.next(h.port.ctx, &c) == 1) {
        assert_in_range(c.knob, 100, LM_FULL_DEFLECTION);
        taken++;
    }
    assert_int_equal(taken, HANDS_QUEUE);
    hands_turn_knob(&h, -9000);
    assert_int_equal(h.knob, -LM_FULL_DEFLECTION);
}
