#include "memory_board.h"

enum { FLASH_POLLS = 100 };

static int acquire(void *ctx, struct lm_surface *surface)
{
    const struct memory_board *b = ctx;
    const struct lm_display *d = &b->display;
    *surface = (struct lm_surface){.pixels = b->glass,
                                   .stride_px = d->width_px,
                                   .width_px = d->width_px,
                                   .height_px = d->height_px,
                                   .age = b->presented > 0};
    return b->acquire_status;
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct memory_board *b = ctx;
    (void)changed;
    b->presented++;
    return b->present_status;
}

void memory_board_open(struct memory_board *b, const uint8_t *image, size_t image_bytes,
                       const struct memory_board_parts *parts)
{
    memory_flash_open(&b->flash, image, image_bytes);
    b->can = (struct lm_can){.ctx = parts->ctx, .receive = parts->receive};
    b->controls = (struct lm_controls){.ctx = parts->ctx, .next = parts->next_control};
    b->display = (struct lm_display){b, parts->width_px, parts->height_px, acquire, present};
    b->glass = parts->glass;
    b->presented = 0;
    b->acquire_status = b->present_status = LM_OK;
    b->lent = (struct lm_board){.radar = &lm_radar_default,
                                .flash = &b->flash.port,
                                .can = &b->can,
                                .controls = &b->controls,
                                .display = &b->display,
                                .tile_pool = parts->tile_pool,
                                .tile_pool_bytes = parts->tile_pool_bytes,
                                .plane = parts->plane,
                                .flash_poll_limit = FLASH_POLLS};
}
