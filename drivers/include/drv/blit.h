/* Blit: copy of the firmware's picture to the pixels of a panel, with format, rotation and
 * centring. Pure; nothing fails. */
#ifndef DRV_BLIT_H
#define DRV_BLIT_H

#include <stdint.h>

#include "lm/damage.h"
#include "lm/port.h"

enum drv_format {
    DRV_XRGB8888, /* 32 bits, blue in the lowest byte */
    DRV_RGB565    /* 16 bits, blue in the lowest five; each colour is cut, not rounded */
};

/* Clockwise rotation of the picture, as the operator sees it. */
enum drv_turn { DRV_TURN_0, DRV_TURN_90, DRV_TURN_180, DRV_TURN_270 };

/* Target: memory that a panel shows, the top row first. */
struct drv_target {
    void *bytes;           /* borrowed; aligned to its pixels */
    uint32_t stride_bytes; /* distance between rows, a multiple of the pixel's size */
    uint16_t width_px, height_px;
    enum drv_format format;
};

/* Copy the picture to the middle of the target: the blocks of *changed, which is borrowed for the
 * call, or all of it for NULL. A larger picture is cut equally on both sides, with
 * an odd pixel at the right and at the bottom. A smaller one leaves a border, which is not
 * changed. */
void drv_blit(const struct drv_target *to, const struct lm_surface *from, enum drv_turn turn,
              const struct lm_damage *changed);

/* Find the parts of the target that drv_blit writes: at most `most` rectangles, 1 or more, the last
 * of which holds all that are left. Returns how many there are. */
uint32_t drv_blit_parts(const struct drv_target *to, const struct lm_surface *from,
                        enum drv_turn turn, const struct lm_damage *changed,
                        struct lm_rectangle *part, uint32_t most);

/* Make the whole target black. */
void drv_blit_clear(const struct drv_target *to);

#endif
