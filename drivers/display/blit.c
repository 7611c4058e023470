#include "drv/blit.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Where the pixels of a row come from: `from` moves by `step` pixels for each one. */
struct walk {
    const uint32_t *start;
    ptrdiff_t along_x, along_y;
};

static struct walk walk_of(const struct lm_surface *s, enum drv_turn turn)
{
    const ptrdiff_t stride = (ptrdiff_t)s->stride_px;
    const ptrdiff_t right = s->width_px - 1, bottom = (ptrdiff_t)(s->height_px - 1) * stride;
    switch (turn) {
    case DRV_TURN_90: /* the top left of the panel shows the bottom left of the picture */
        return (struct walk){s->pixels + bottom, -stride, 1};
    case DRV_TURN_180:
        return (struct walk){s->pixels + bottom + right, -1, -stride};
    case DRV_TURN_270:
        return (struct walk){s->pixels + right, stride, -1};
    case DRV_TURN_0:
    default:
        return (struct walk){s->pixels, 1, stride};
    }
}

/* One direction of the centring: `count` pixels from `source` on go to `target` on. */
struct span {
    uint32_t source, target, count;
};

static struct span centre(uint32_t source_px, uint32_t target_px)
{
    if (source_px > target_px) {
        return (struct span){(source_px - target_px) / 2, 0, target_px};
    }
    return (struct span){0, (target_px - source_px) / 2, source_px};
}

static void row_of_xrgb(uint32_t *to, const uint32_t *from, ptrdiff_t step, uint32_t count)
{
    if (step == 1) {
        memcpy(to, from, count * sizeof *to);
        return;
    }
    for (uint32_t i = 0; i < count; i++, from += step) {
        to[i] = *from;
    }
}

static void row_of_565(uint16_t *to, const uint32_t *from, ptrdiff_t step, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, from += step) {
        to[i] = (uint16_t)((*from >> 8 & 0xf800u) | (*from >> 5 & 0x07e0u) | (*from >> 3 & 0x1fu));
    }
}

void drv_blit(const struct drv_target *to, const struct lm_surface *from, enum drv_turn turn)
{
    const bool is_upright = turn == DRV_TURN_0 || turn == DRV_TURN_180;
    const struct span x = centre(is_upright ? from->width_px : from->height_px, to->width_px);
    const struct span y = centre(is_upright ? from->height_px : from->width_px, to->height_px);
    const struct walk walk = walk_of(from, turn);
    for (uint32_t row = 0; row < y.count; row++) {
        const uint32_t *source =
            walk.start + (y.source + row) * walk.along_y + x.source * walk.along_x;
        char *target = (char *)to->bytes + (size_t)(y.target + row) * to->stride_bytes;
        if (to->format == DRV_RGB565) {
            row_of_565((uint16_t *)(void *)target + x.target, source, walk.along_x, x.count);
        } else {
            row_of_xrgb((uint32_t *)(void *)target + x.target, source, walk.along_x, x.count);
        }
    }
}

void drv_blit_clear(const struct drv_target *to)
{
    const size_t row_bytes = (size_t)to->width_px * (to->format == DRV_RGB565 ? 2 : 4);
    for (uint32_t row = 0; row < to->height_px; row++) {
        memset((char *)to->bytes + (size_t)row * to->stride_bytes, 0, row_bytes);
    }
}
