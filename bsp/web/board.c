/* The board of a browser. JavaScript brings the devices (bsp/web/page/unit.mjs): it hands over
 * frames and controls before each step, answers reads of the flash, and takes pictures.
 *
 * A module has one unit. All its memory is static, so that what it takes is known when it is
 * linked. */
#include "web.h"

#include "fx/crc32c.h"
#include "lm/overlay.h"

/* As many as bench and ZCU102 have, so that the same frames are shown. */
enum { BUFFERS = 2, TILES = 384, POLLS = 1 };

struct web web;
struct lm_tile web_pool[LM_TILE_SLOTS_MAX];
uint8_t web_plane[WEB_SIDE_MAX_PX * WEB_SIDE_MAX_PX];
uint32_t web_surface[WEB_SURFACES][WEB_SIDE_MAX_PX * WEB_SIDE_MAX_PX];
static uint8_t canvas[WEB_SIDE_MAX_PX * WEB_SIDE_MAX_PX * 4]; /* red, green, blue, opaque */

/* ---- devices ---- */

int web_read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    const struct web *w = ctx;
    if (offset > w->flash.size_bytes || length > w->flash.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    return web_flash_start((double)offset, destination, length);
}

int web_read_poll(void *ctx)
{
    (void)ctx;
    return web_flash_poll();
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct web_frame_ring *r = &((struct web *)ctx)->frames;
    if (r->head == r->tail) {
        return 0;
    }
    *frame = r->frame[r->tail++ % WEB_FRAMES];
    return 1;
}

static int next_control(void *ctx, struct lm_control *control)
{
    return drv_control_ring_take(&((struct web *)ctx)->acts, control);
}

static int acquire(void *ctx, struct lm_surface *s)
{
    const struct web *w = ctx;
    *s = (struct lm_surface){.pixels = web_surface[(w->pictures + 1) % BUFFERS],
                             .stride_px = w->display.width_px,
                             .width_px = w->display.width_px,
                             .height_px = w->display.height_px,
                             .age = w->pictures >= BUFFERS ? BUFFERS : 0};
    return LM_OK;
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct web *w = ctx;
    lm_damage_add(&w->stale, changed);
    w->pictures++;
    return LM_OK;
}

/* ---- what the page calls ---- */

WEB_EXPORT("open") int web_open(double flash_bytes, uint32_t width_px, uint32_t height_px)
{
    if (!(flash_bytes >= 0 && flash_bytes < 9007199254740992.0) || width_px < WEB_SIDE_MIN_PX ||
        width_px > WEB_SIDE_MAX_PX || height_px < WEB_SIDE_MIN_PX || height_px > WEB_SIDE_MAX_PX) {
        return LM_ERR_RANGE;
    }
    __builtin_memset(&web, 0, sizeof web);
    web.flash = (struct lm_flash){&web, (uint64_t)flash_bytes, web_read_start, web_read_poll};
    web.can = (struct lm_can){&web, receive, NULL};
    web.controls = (struct lm_controls){&web, next_control, NULL};
    web.display =
        (struct lm_display){&web, (uint16_t)width_px, (uint16_t)height_px, acquire, present};
    web.board =
        (struct lm_board){.flash = &web.flash,
                          .can = &web.can,
                          .controls = &web.controls,
                          .display = &web.display,
                          .tile_pool = web_pool,
                          .tile_pool_bytes = TILES * sizeof *web_pool,
                          .plane = web_plane,
                          .glass_step_px = LM_GLASS_STEP_PX, /* as bench and panel have it */
                          .flash_poll_limit = POLLS};
    return lm_unit_init(&web.unit, &web.board);
}

WEB_EXPORT("step") void web_step(double now_us)
{
    lm_unit_step(&web.unit, (uint64_t)now_us);
}

WEB_EXPORT("frame")
bool web_frame(uint32_t id, bool is_extended, uint32_t length, uint32_t first, uint32_t second,
               double time_us)
{
    struct web_frame_ring *r = &web.frames;
    if (r->head - r->tail == WEB_FRAMES || length > 8) {
        web.frames_lost++;
        return false;
    }
    struct lm_can_frame *f = &r->frame[r->head++ % WEB_FRAMES];
    *f = (struct lm_can_frame){.id = id,
                               .is_extended = is_extended,
                               .length = (uint8_t)length,
                               .time_us = (uint64_t)time_us};
    __builtin_memcpy(f->data, &first, sizeof first);
    __builtin_memcpy(f->data + 4, &second, sizeof second);
    return true;
}

static void put(struct lm_control control)
{
    web.acts_lost += !drv_control_ring_put(&web.acts, control);
}

WEB_EXPORT("button") void web_button(bool is_down, int32_t number)
{
    put(lm_control_button(is_down, number));
}

WEB_EXPORT("knob") void web_knob(int32_t deflection)
{
    put(lm_control_knob(deflection));
}

WEB_EXPORT("slew") void web_slew(int32_t x, int32_t y)
{
    put(lm_control_slew(x, y));
}

WEB_EXPORT("designate") void web_designate(void)
{
    put(lm_control_designate());
}

WEB_EXPORT("drop") void web_drop(void)
{
    put(lm_control_drop());
}

WEB_EXPORT("patch") void web_patch(uint32_t latitude, uint32_t longitude, uint32_t cell_mm)
{
    const struct lm_sar_command sar = {.centre = {.latitude = latitude, .longitude = longitude},
                                       .cell_mm = cell_mm,
                                       .is_from_ownship = true};
    put((struct lm_control){.kind = LM_CONTROL_SAR, .sar = sar});
}

/* Swap a row's pixels into the canvas's order of bytes. */
static void paint_row(uint8_t *to, const uint32_t *from, int32_t pixels)
{
    for (int32_t x = 0; x < pixels; x++) {
        to[4 * x] = (uint8_t)(from[x] >> 16);
        to[4 * x + 1] = (uint8_t)(from[x] >> 8);
        to[4 * x + 2] = (uint8_t)from[x];
        to[4 * x + 3] = 255;
    }
}

const uint32_t *web_glass(void)
{
    return web.is_replay ? replay_glass(&web.replay) : web_surface[web.pictures % BUFFERS];
}

WEB_EXPORT("checksum") uint32_t web_checksum(void)
{
    const size_t pixels = (size_t)web.display.width_px * web.display.height_px;
    return fx_crc32c(0, web_glass(), pixels * sizeof(uint32_t));
}

WEB_EXPORT("paint") uint8_t *web_paint(void)
{
    const struct lm_rectangle glass = {0, 0, web.display.width_px, web.display.height_px};
    struct lm_damage_walk walk = lm_damage_walk(&glass);
    const uint32_t *shown = web_glass();
    struct lm_rectangle r;
    while (lm_damage_next(&web.stale, &walk, &r)) {
        for (int32_t y = r.top; y < r.bottom; y++) {
            const size_t at = (size_t)y * (size_t)glass.right + (size_t)r.left;
            paint_row(canvas + 4 * at, shown + at, r.right - r.left);
        }
    }
    lm_damage_clear(&web.stale);
    return canvas;
}

WEB_EXPORT("value") double web_value(enum web_value which)
{
    const struct lm_unit *u = &web.unit;
    switch (which) {
    case WEB_PICTURES:
        return web.pictures;
    case WEB_FLAGS:
        return u->flags;
    case WEB_MODE:
        return u->page.picture == LM_PICTURE_PATCH ? WEB_MODE_PATCH : u->page.mode;
    case WEB_FOV:
        return u->page.fov;
    case WEB_RANGE_NM:
        return u->page.radar->range[u->page.range_index].range_nm;
    case WEB_CURSOR_LATITUDE:
        return u->cursor.position.latitude;
    case WEB_CURSOR_LONGITUDE:
        return u->cursor.position.longitude;
    case WEB_IS_CURSOR_PLACED:
        return u->cursor.is_placed;
    case WEB_FRAMES_LOST:
        return web.frames_lost;
    case WEB_ACTS_LOST:
        return web.acts_lost;
    case WEB_LINES_DROPPED:
        return u->count.lines_dropped;
    case WEB_IS_FORMAT_RADAR:
        return u->page.format == LM_FORMAT_RADAR;
    case WEB_IS_MAP_USABLE:
        return u->map.is_usable;
    case WEB_REFUSED:
        return u->count.commands_refused;
    default:
        return web_replay_value(which);
    }
}

WEB_EXPORT("flag_word") const char *web_flag_word(uint32_t number)
{
    return number < LM_FLAGS ? lm_flag_word(number) : NULL;
}
