/* PNG files. Rows run from the top; the file appears whole or not at all. */
#ifndef HS_PNG_H
#define HS_PNG_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Write `height` rows of `width` pixels, 1 byte (grey) or 3 bytes (red, green, blue) each;
 * `stride_bytes` is the distance between rows. Return 0, or -1 with the error reported: the file
 * cannot be made or written (hs/atomic_file.h), or no memory. */
int hs_png_write_grey(const char *path, const uint8_t *pixels, int width, int height,
                      size_t stride_bytes);
int hs_png_write_rgb(const char *path, const uint8_t *pixels, int width, int height,
                     size_t stride_bytes);
/* The same of pixels 0x00RRGGBB, as the bench's framebuffer holds them; `stride_pixels` is the
 * distance between rows. */
int hs_png_write_xrgb(const char *path, const uint32_t *pixels, int width, int height,
                      size_t stride_pixels);

/* Write such a picture, whose rows follow each other, to a stream. Returns 0; -1, not reported:
 * writing failed, or no memory. */
int hs_png_encode_rgb(FILE *stream, const uint8_t *pixels, int width, int height);

#endif
