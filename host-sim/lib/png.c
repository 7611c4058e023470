#include "hs/png.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

#include <png.h>
#include <stdlib.h>

typedef void row_maker(const void *pixels, int row, size_t stride, int width, uint8_t *out);

struct picture {
    const void *pixels;
    int width, height;
    size_t stride;
    int colour_type;
    row_maker *make_row;
};

static void copy_grey(const void *pixels, int row, size_t stride, int width, uint8_t *out)
{
    const uint8_t *from = (const uint8_t *)pixels + (size_t)row * stride;
    for (int i = 0; i < width; i++) {
        out[i] = from[i];
    }
}

static void copy_rgb(const void *pixels, int row, size_t stride, int width, uint8_t *out)
{
    copy_grey(pixels, row, stride, 3 * width, out);
}

static void unpack_xrgb(const void *pixels, int row, size_t stride, int width, uint8_t *out)
{
    const uint32_t *from = (const uint32_t *)pixels + (size_t)row * stride;
    for (int i = 0; i < width; i++) {
        out[3 * i] = (uint8_t)(from[i] >> 16);
        out[3 * i + 1] = (uint8_t)(from[i] >> 8);
        out[3 * i + 2] = (uint8_t)from[i];
    }
}

/* libpng leaves through longjmp; nothing that it could leave changed is used after it. */
static int encode(FILE *stream, const struct picture *p, uint8_t *row)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return -1;
    }
    png_init_io(png, stream);
    png_set_compression_level(png, 4);
    png_set_IHDR(png, info, (png_uint_32)p->width, (png_uint_32)p->height, 8, p->colour_type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < p->height; y++) {
        p->make_row(p->pixels, y, p->stride, p->width, row);
        png_write_row(png, row);
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return 0;
}

static int write_picture(const char *path, const struct picture *p)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    uint8_t *row = malloc(3 * (size_t)p->width);
    const int failed = !row || encode(file.stream, p, row) != 0;
    free(row);
    if (failed) {
        hs_atomic_abort(&file);
        return hs_error(path, "free some space and run again", "the picture could not be written");
    }
    return hs_atomic_commit(&file);
}

int hs_png_write_grey(const char *path, const uint8_t *pixels, int width, int height,
                      size_t stride_bytes)
{
    const struct picture p = {pixels, width, height, stride_bytes, PNG_COLOR_TYPE_GRAY, copy_grey};
    return write_picture(path, &p);
}

int hs_png_write_rgb(const char *path, const uint8_t *pixels, int width, int height,
                     size_t stride_bytes)
{
    const struct picture p = {pixels, width, height, stride_bytes, PNG_COLOR_TYPE_RGB, copy_rgb};
    return write_picture(path, &p);
}

int hs_png_write_xrgb(const char *path, const uint32_t *pixels, int width, int height,
                      size_t stride_pixels)
{
    const struct picture p = {pixels,     width, height, stride_pixels, PNG_COLOR_TYPE_RGB,
                              unpack_xrgb};
    return write_picture(path, &p);
}

int hs_png_encode_rgb(FILE *stream, const uint8_t *pixels, int width, int height)
{
    const struct picture p = {pixels,  width, height, 3 * (size_t)width, PNG_COLOR_TYPE_RGB,
                              copy_rgb};
    uint8_t *row = malloc(p.stride);
    const int status = row ? encode(stream, &p, row) : -1;
    free(row);
    return status;
}
