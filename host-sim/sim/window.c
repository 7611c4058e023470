#include "sim/window.h"

#include "hs/error.h"

#include <SDL.h>
#include <stdlib.h>

struct window {
    struct bezel bezel;
    struct hands *hands;
    struct window_player *player; /* NULL: the unit is operated */
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *texture;
    int32_t mouse_button; /* the one that the mouse holds down, or 0 */
};

const char window_keys_help[] =
    "  1 .. 9, 0          option select buttons 1 to 10 (top, right)\n"
    "  F1 .. F10          option select buttons 11 to 20 (bottom, left)\n"
    "  arrows             cursor; Return designates, Backspace drops\n"
    "  Q/A W/S E/D R/F    rockers GAIN, SYM, BRT, CON: more/less\n"
    "  Page up, down      range knob (fine gain), as does the mouse wheel\n"
    "  mouse              the buttons of the bezel\n"
    "  Escape             ends\n";

const char window_player_help[] =
    "  Space              stands still, or goes on\n"
    "  left, right        ten seconds back, forward\n"
    "  up, down           twice, half as fast\n"
    "  Escape             ends\n";

enum { KNOB_STEP = 100, JUMP_S = 10, SPEED_MOST = 64 };

/* The button of a key, or 0. */
static int32_t button_of_key(SDL_Keycode key)
{
    static const SDL_Keycode rockers[2 * LM_ROCKERS] = {SDLK_q, SDLK_a, SDLK_w, SDLK_s,
                                                        SDLK_e, SDLK_d, SDLK_r, SDLK_f};
    if (key >= SDLK_1 && key <= SDLK_9) {
        return key - SDLK_1 + 1;
    }
    if (key == SDLK_0) {
        return 10;
    }
    if (key >= SDLK_F1 && key <= SDLK_F10) {
        return key - SDLK_F1 + 11;
    }
    for (int32_t i = 0; i < 2 * LM_ROCKERS; i++) {
        if (key == rockers[i]) {
            return LM_OSBS + 1 + i;
        }
    }
    return 0;
}

static bool take_arrow(struct hands *h, SDL_Keycode key, bool is_down)
{
    static const SDL_Keycode arrows[4] = {[HANDS_LEFT] = SDLK_LEFT,
                                          [HANDS_RIGHT] = SDLK_RIGHT,
                                          [HANDS_UP] = SDLK_UP,
                                          [HANDS_DOWN] = SDLK_DOWN};
    for (int i = 0; i < 4; i++) {
        if (key == arrows[i]) {
            hands_arrow(h, (enum hands_arrow)i, is_down);
            return true;
        }
    }
    return false;
}

static void take_press(struct hands *h, SDL_Keycode key)
{
    switch (key) {
    case SDLK_RETURN:
    case SDLK_KP_ENTER:
        hands_designate(h);
        break;
    case SDLK_BACKSPACE:
        hands_drop(h);
        break;
    case SDLK_PAGEUP:
        hands_turn_knob(h, KNOB_STEP);
        break;
    case SDLK_PAGEDOWN:
        hands_turn_knob(h, -KNOB_STEP);
        break;
    default:
        break;
    }
}

static void take_key(struct hands *h, const SDL_KeyboardEvent *event)
{
    const bool is_down = event->type == SDL_KEYDOWN;
    const SDL_Keycode key = event->keysym.sym;
    const int32_t button = button_of_key(key);
    if (event->repeat) {
        return; /* the firmware knows which of its keys repeat */
    }
    if (button) {
        hands_button(h, button, is_down);
    } else if (!take_arrow(h, key, is_down) && is_down) {
        take_press(h, key);
    }
}

static void take_mouse(struct window *w, const SDL_MouseButtonEvent *event)
{
    if (event->button != SDL_BUTTON_LEFT) {
        return;
    }
    if (w->mouse_button) {
        hands_button(w->hands, w->mouse_button, false);
        w->mouse_button = 0;
    }
    if (event->type == SDL_MOUSEBUTTONDOWN) {
        w->mouse_button = bezel_button_at(&w->bezel, event->x, event->y);
        if (w->mouse_button) {
            hands_button(w->hands, w->mouse_button, true);
        }
    }
}

static void take_player_key(struct window_player *p, SDL_Keycode key)
{
    switch (key) {
    case SDLK_SPACE:
        p->is_paused = !p->is_paused;
        break;
    case SDLK_RIGHT:
        p->jump_s += JUMP_S;
        break;
    case SDLK_LEFT:
        p->jump_s -= JUMP_S;
        break;
    case SDLK_UP:
        p->speed = p->speed < SPEED_MOST ? p->speed * 2 : p->speed;
        break;
    case SDLK_DOWN:
        p->speed = p->speed > 1.0 / SPEED_MOST ? p->speed / 2 : p->speed;
        break;
    default:
        break;
    }
}

static bool take_player_event(struct window_player *p, const SDL_Event *event)
{
    if (event->type == SDL_KEYDOWN) {
        take_player_key(p, event->key.keysym.sym);
    }
    return event->type != SDL_QUIT &&
           (event->type != SDL_KEYDOWN || event->key.keysym.sym != SDLK_ESCAPE);
}

void window_watch(struct window *w, struct window_player *player)
{
    w->player = player;
}

static bool take_event(struct window *w, const SDL_Event *event)
{
    if (w->player) {
        return take_player_event(w->player, event);
    }
    switch (event->type) {
    case SDL_QUIT:
        return false;
    case SDL_KEYDOWN:
        if (event->key.keysym.sym == SDLK_ESCAPE) {
            return false;
        }
        take_key(w->hands, &event->key);
        break;
    case SDL_KEYUP:
        take_key(w->hands, &event->key);
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        take_mouse(w, &event->button);
        break;
    case SDL_MOUSEWHEEL:
        hands_turn_knob(w->hands, event->wheel.y * KNOB_STEP);
        break;
    case SDL_WINDOWEVENT:
        if (event->window.event == SDL_WINDOWEVENT_FOCUS_LOST) {
            hands_off(w->hands);
            w->mouse_button = 0;
        }
        break;
    default:
        break;
    }
    return true;
}

struct window *window_open(const struct bezel *bezel, struct hands *hands)
{
    struct window *w = calloc(1, sizeof *w);
    if (!w || SDL_Init(SDL_INIT_VIDEO) != 0) {
        hs_warn("window", "use --png DIR", "no screen: %s", SDL_GetError());
        free(w);
        return NULL;
    }
    w->bezel = *bezel;
    w->hands = hands;
    const int width = bezel->width_px, height = bezel->height_px;
    w->window = SDL_CreateWindow("landmass", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width,
                                 height, SDL_WINDOW_RESIZABLE);
    w->renderer = w->window ? SDL_CreateRenderer(w->window, -1, 0) : NULL;
    w->texture = w->renderer ? SDL_CreateTexture(w->renderer, SDL_PIXELFORMAT_RGB888,
                                                 SDL_TEXTUREACCESS_STREAMING, width, height)
                             : NULL;
    /* Mouse positions come in the bezel's pixels, however large the window is. */
    if (!w->texture || SDL_RenderSetLogicalSize(w->renderer, width, height) != 0) {
        hs_warn("window", "use --png DIR", "cannot be opened: %s", SDL_GetError());
        window_close(w);
        return NULL;
    }
    return w;
}

void window_close(struct window *w)
{
    if (!w) {
        return;
    }
    if (w->texture) {
        SDL_DestroyTexture(w->texture);
    }
    if (w->renderer) {
        SDL_DestroyRenderer(w->renderer);
    }
    if (w->window) {
        SDL_DestroyWindow(w->window);
    }
    SDL_Quit();
    free(w);
}

bool window_poll(struct window *w)
{
    SDL_Event event;
    bool goes_on = true;
    while (SDL_PollEvent(&event)) {
        goes_on &= take_event(w, &event);
    }
    return goes_on;
}

void window_show(struct window *w, const uint32_t *pixels)
{
    SDL_UpdateTexture(w->texture, NULL, pixels, w->bezel.width_px * 4);
    SDL_RenderClear(w->renderer);
    SDL_RenderCopy(w->renderer, w->texture, NULL, NULL);
    SDL_RenderPresent(w->renderer);
}
