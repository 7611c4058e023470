#include <stddef.h>

#include "fx/mem.h"
#include "lm/kernels_display.h"

enum { RUN = 16 };

/* Eight pixels, the first of them the lowest byte. */
static inline void colour_eight(uint32_t *restrict out, uint64_t greys,
                                const uint32_t *restrict colour)
{
    for (uint32_t k = 0; k < 8; k++) {
        out[k] = colour[greys >> 8 * k & 255];
    }
}

/* One look-up a pixel, except in runs of black: more than half of the glass is beside the sector or
 * patch. `restrict` tells the compiler that table and picture do not overlap. */
static void colour_row(uint32_t *restrict out, const uint8_t *restrict grey,
                       const uint32_t *restrict colour, uint32_t width)
{
    const uint32_t black = colour[0];
    const uint32_t *const end = out + width;
    for (; end - out >= RUN; out += RUN, grey += RUN) {
        const uint64_t first = fx_load_u64(grey), second = fx_load_u64(grey + 8);
        if ((first | second) == 0) {
            for (size_t k = 0; k < RUN; k++) {
                out[k] = black;
            }
        } else {
            colour_eight(out, first, colour);
            colour_eight(out + 8, second, colour);
        }
    }
    while (out < end) {
        *out++ = colour[*grey++];
    }
}

void lm_k_colour_area(const struct lm_k_colours *colours, const struct lm_k_area *area)
{
    for (uint32_t row = 0; row < area->height; row++) {
        colour_row(area->pixel + row * area->pixel_stride, area->grey + row * area->grey_stride,
                   colours->of_grey, area->width);
    }
}
