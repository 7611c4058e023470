#include "window.h"

#include "hs/error.h"

#include <SDL.h>
#include <stdlib.h>

struct window {
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *texture;
    int stride_bytes;
};

struct window *window_open(uint16_t width_px, uint16_t height_px)
{
    struct window *w = calloc(1, sizeof *w);
    if (!w || SDL_Init(SDL_INIT_VIDEO) != 0) {
        hs_warn("window", "use --png DIR", "no screen: %s", SDL_GetError());
        free(w);
        return NULL;
    }
    w->stride_bytes = width_px * 4;
    w->window = SDL_CreateWindow("landmass", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                 width_px, height_px, 0);
    w->renderer = w->window ? SDL_CreateRenderer(w->window, -1, 0) : NULL;
    w->texture = w->renderer ? SDL_CreateTexture(w->renderer, SDL_PIXELFORMAT_RGB888,
                                                 SDL_TEXTUREACCESS_STREAMING, width_px, height_px)
                             : NULL;
    if (!w->texture) {
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

bool window_show(struct window *w, const uint32_t *pixels)
{
    SDL_Event event;
    bool goes_on = true;
    while (SDL_PollEvent(&event)) {
        goes_on &= event.type != SDL_QUIT &&
                   !(event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE);
    }
    SDL_UpdateTexture(w->texture, NULL, pixels, w->stride_bytes);
    SDL_RenderCopy(w->renderer, w->texture, NULL, NULL);
    SDL_RenderPresent(w->renderer);
    return goes_on;
}
