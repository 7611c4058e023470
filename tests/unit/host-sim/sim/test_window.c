/* The bench's window on SDL's dummy screen: every key of --help, the mouse, and the end. */
#include "sim/window.h"

#include <SDL.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "control_asserts.h"

struct bench {
    struct bezel bezel;
    struct hands hands;
    struct window *window;
};

static void open_bench(struct bench *b)
{
    setenv("SDL_VIDEODRIVER", "dummy", 1);
    setenv("SDL_RENDER_DRIVER", "software", 1);
    b->bezel = bezel_around(480, 480);
    hands_init(&b->hands, NULL);
    b->window = window_open(&b->bezel, &b->hands);
    assert_non_null(b->window);
    assert_true(window_poll(b->window));
    hands_init(&b->hands, NULL); /* whatever opening the window brought */
}

static void key(SDL_Keycode code, bool is_down, bool is_repeat)
{
    SDL_Event e = {.key = {.type = is_down ? SDL_KEYDOWN : SDL_KEYUP,
                           .repeat = is_repeat,
                           .keysym = {.sym = code}}};
    SDL_PushEvent(&e);
}

static void expect(struct bench *b, struct lm_control expected)
{
    struct lm_control c;
    assert_int_equal(b->hands.port.next(b->hands.port.ctx, &c), 1);
    assert_same_control(&c, expected);
}

static void expect_nothing(struct bench *b)
{
    struct lm_control c;
    assert_int_equal(b->hands.port.next(b->hands.port.ctx, &c), 0);
}

TEST(each_button_has_its_key)
{
    struct bench b;
    open_bench(&b);
    const SDL_Keycode keys[LM_BUTTONS] = {
        SDLK_1,  SDLK_2,  SDLK_3,  SDLK_4,  SDLK_5,  SDLK_6,  SDLK_7,  SDLK_8,  SDLK_9,  SDLK_0,
        SDLK_F1, SDLK_F2, SDLK_F3, SDLK_F4, SDLK_F5, SDLK_F6, SDLK_F7, SDLK_F8, SDLK_F9, SDLK_F10,
        SDLK_q,  SDLK_a,  SDLK_w,  SDLK_s,  SDLK_e,  SDLK_d,  SDLK_r,  SDLK_f};
    for (int i = 0; i < LM_BUTTONS; i++) {
        key(keys[i], true, false);
        key(keys[i], true, true); /* the keyboard's own repeat is not ours */
        key(keys[i], false, false);
        assert_true(window_poll(b.window));
        expect(&b, lm_control_button(true, i + 1));
        expect(&b, lm_control_button(false, i + 1));
        expect_nothing(&b);
    }
    window_close(b.window);
}

TEST(arrows_return_backspace_and_page_keys_work_the_hand_controller)
{
    struct bench b;
    open_bench(&b);
    key(SDLK_UP, true, false);
    key(SDLK_RIGHT, true, false);
    key(SDLK_UP, false, false);
    key(SDLK_RIGHT, false, false);
    key(SDLK_RETURN, true, false);
    key(SDLK_BACKSPACE, true, false);
    key(SDLK_PAGEUP, true, false);
    key(SDLK_PAGEDOWN, true, false);
    key(SDLK_z, true, false);
    assert_true(window_poll(b.window));
    expect(&b, lm_control_slew(0, 1000));
    expect(&b, lm_control_slew(1000, 1000));
    expect(&b, lm_control_slew(1000, 0));
    expect(&b, lm_control_slew(0, 0));
    expect(&b, lm_control_designate());
    expect(&b, lm_control_drop());
    expect(&b, lm_control_knob(100));
    expect(&b, lm_control_knob(0));
    expect_nothing(&b);
    window_close(b.window);
}

static void mouse(uint32_t type, int x, int y)
{
    SDL_Event e = {.button = {.type = type, .button = SDL_BUTTON_LEFT, .x = x, .y = y}};
    SDL_PushEvent(&e);
}

TEST(a_click_holds_the_button_under_the_mouse_until_it_is_let_go_anywhere)
{
    struct bench b;
    open_bench(&b);
    for (int32_t button = 1; button <= LM_BUTTONS; button++) {
        const struct bezel_box box = bezel_box_of(&b.bezel, button);
        mouse(SDL_MOUSEBUTTONDOWN, box.x + box.width / 2, box.y + box.height / 2);
        assert_true(window_poll(b.window));
        expect(&b, lm_control_button(true, button));
        expect_nothing(&b);
        mouse(SDL_MOUSEBUTTONUP, 300, 300);
        assert_true(window_poll(b.window));
        expect(&b, lm_control_button(false, button));
    }
    mouse(SDL_MOUSEBUTTONDOWN, 300, 300); /* on the glass */
    mouse(SDL_MOUSEBUTTONUP, 300, 300);
    assert_true(window_poll(b.window));
    expect_nothing(&b);
    window_close(b.window);
}

TEST(a_window_that_loses_the_keyboard_lets_go_of_everything)
{
    struct bench b;
    open_bench(&b);
    key(SDLK_7, true, false);
    key(SDLK_LEFT, true, false);
    SDL_Event e = {.window = {.type = SDL_WINDOWEVENT, .event = SDL_WINDOWEVENT_FOCUS_LOST}};
    SDL_PushEvent(&e);
    assert_true(window_poll(b.window));
    expect(&b, lm_control_button(true, 7));
    expect(&b, lm_control_slew(-1000, 0));
    expect(&b, lm_control_button(false, 7));
    expect(&b, lm_control_slew(0, 0));
    expect_nothing(&b);
    window_close(b.window);
}

TEST(escape_and_closing_end_it)
{
    struct bench b;
    open_bench(&b);
    key(SDLK_ESCAPE, true, false);
    assert_false(window_poll(b.window));
    assert_true(window_poll(b.window));
    SDL_Event e = {.type = SDL_QUIT};
    SDL_PushEvent(&e);
    assert_false(window_poll(b.window));
    window_close(b.window);
}

TEST(the_window_shows_the_pixels_it_is_given)
{
    struct bench b;
    open_bench(&b);
    const size_t pixels = (size_t)b.bezel.width_px * b.bezel.height_px;
    uint32_t *out = malloc(sizeof *out * pixels), *back = malloc(sizeof *back * pixels);
    uint32_t *glass = calloc(480 * 480, sizeof *glass);
    assert_true(out && back && glass);
    for (uint32_t i = 0; i < 480 * 480; i++) {
        glass[i] = i * 2654435761u >> 8;
    }
    bezel_draw(&b.bezel, out, glass, 1u << 6);
    window_show(b.window, out);
    SDL_Window *window = SDL_GetWindowFromID(1);
    assert_non_null(window);
    assert_int_equal(SDL_RenderReadPixels(SDL_GetRenderer(window), NULL, SDL_PIXELFORMAT_RGB888,
                                          back, b.bezel.width_px * 4),
                     0);
    for (size_t i = 0; i < pixels; i++) {
        assert_int_equal(back[i] & 0xFFFFFF, out[i]);
    }
    free(out);
    free(back);
    free(glass);
    window_close(b.window);
}
