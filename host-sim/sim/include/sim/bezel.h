/* Bezel around the display: 20 option select buttons where the page has their labels, and a rocker
 * in each corner. A picture, and a map from points to buttons; no window. */
#ifndef SIM_BEZEL_H
#define SIM_BEZEL_H

#include "lm/controls.h"
#include "lm/port.h"

#include <stdint.h>

struct bezel {
    uint16_t glass_width_px, glass_height_px;
    uint16_t margin_px;           /* on every side of the glass */
    uint16_t width_px, height_px; /* glass and margins */
};

/* The bezel for a display of that size. */
struct bezel bezel_around(uint16_t glass_width_px, uint16_t glass_height_px);

struct bezel_box {
    int32_t x, y, width, height;
};

/* Position of button 1..LM_BUTTONS. */
struct bezel_box bezel_box_of(const struct bezel *b, int32_t button);

/* The button at a point, or 0. */
int32_t bezel_button_at(const struct bezel *b, int32_t x, int32_t y);

/* Draw bezel and glass into `pixels`, width_px * height_px, 0x00RRGGBB. Buttons whose bit n - 1 of
 * `down` is set are lit. `glass` is glass_width_px * glass_height_px. */
void bezel_draw(const struct bezel *b, uint32_t *pixels, const uint32_t *glass, uint32_t down);

#endif
