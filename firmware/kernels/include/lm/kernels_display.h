/* Kernel of the glass: pixels of a picture through its palette. What holds for every kernel is in
 * lm/kernels_map.h. */
#ifndef LM_KERNELS_DISPLAY_H
#define LM_KERNELS_DISPLAY_H

#include <stdbool.h>
#include <stdint.h>

enum { LM_K_GREYS = 256, LM_K_COLOUR_BYTES = 4 };

/* The colours of the greys: 0x00RRGGBB << shift, which is 0 or 8. */
struct lm_k_colours {
    uint32_t of_grey[LM_K_GREYS];
    uint8_t byte[LM_K_COLOUR_BYTES][LM_K_GREYS]; /* the same, lowest bytes first */
    uint8_t shift;
    bool is_neutral; /* red, green and blue are equal in each */
};

/* A rectangle of a picture, and where it goes. Strides are of rows, in pixels. */
struct lm_k_area {
    const uint8_t *grey;
    uint32_t *pixel;
    uint32_t grey_stride, pixel_stride;
    uint32_t width, height;
};

/* Give each pixel of an area the colour of its grey. Writes no other pixel. Cost: 1 a pixel where
 * the colours are neutral, 3 where not. */
void lm_k_colour_area(const struct lm_k_colours *colours, const struct lm_k_area *area);

#endif
