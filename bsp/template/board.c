/* The board that you copy: every port of the unit, with nothing behind it. Replace one after the
 * other; docs/PORTING.md says in which order. */
#include "drv/not_fitted.h"
#include "lm/unit.h"

#include <stddef.h>

int main(void);

enum {
    WIDTH_PX = 768,
    HEIGHT_PX = 768,
    TILES = 256,   /* docs/PORTING.md says what serves which mode */
    STEP_US = 2000 /* as often as a line is due at the fastest scale */
};

/* Memory that the board lends. Static, so that the linker's map says where it all went. */
static struct lm_tile tile_pool[TILES];
static uint8_t plane[WIDTH_PX * HEIGHT_PX];
static uint32_t pixels[WIDTH_PX * HEIGHT_PX];
static struct lm_unit unit;

/* Microseconds since the start. Yours reads a timer; this one lets a step take what it should. */
static uint64_t now_us(void)
{
    static uint64_t time_us;
    return time_us += STEP_US;
}

static int acquire(void *ctx, struct lm_surface *surface)
{
    (void)ctx;
    /* One buffer, which holds the picture shown last, once there was one. */
    static uint8_t age;
    *surface = (struct lm_surface){.pixels = pixels,
                                   .stride_px = WIDTH_PX,
                                   .width_px = WIDTH_PX,
                                   .height_px = HEIGHT_PX,
                                   .age = age};
    age = 1;
    return LM_OK;
}

/* Yours puts the pixels on the glass; those of *changed suffice. */
static int present(void *ctx, const struct lm_damage *changed)
{
    (void)ctx;
    (void)changed;
    return LM_OK;
}

int main(void)
{
    static const struct lm_display display = {NULL, WIDTH_PX, HEIGHT_PX, acquire, present};
    const struct lm_board board = {.flash = &drv_no_flash,
                                   .can = &drv_no_can,
                                   .controls = &drv_no_controls,
                                   .display = &display,
                                   .tile_pool = tile_pool,
                                   .tile_pool_bytes = sizeof tile_pool,
                                   .plane = plane,
                                   .glass_step_px = LM_GLASS_STEP_PX,
                                   .flash_poll_limit = 1000000};
    if (lm_unit_init(&unit, &board) != LM_OK) {
        return 1;
    }
    /* Yours runs for ever; this one for a second, and is content when pictures came. */
    while (unit.count.frames < 30) {
        lm_unit_step(&unit, now_us());
    }
    return unit.flags & LM_FLAG_DB ? 0 : 1;
}
