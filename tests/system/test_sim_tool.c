/* What test_sim.sh cannot do by itself: make a flash image and look at a picture.
 *
 *   test_sim_tool image FILE            a small image round 46 N 11 E, 5 MB
 *   test_sim_tool break-fine FILE       the same, each record below the coarsest level damaged
 *   test_sim_tool leave-fine-out FILE   the same without the two finest levels
 *   test_sim_tool range FILE            an image with cells half as long around 46.02 N 11.03 E
 *   test_sim_tool other-range FILE      the same with other ground
 *   test_sim_tool pixels FILE.png RRGGBB    print how many pixels have that colour
 *   test_sim_tool differ A.png B.png        print how many pixels are not the same
 *   test_sim_tool size FILE.png             print WIDTHxHEIGHT */
#include "tiny_country.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TOP_LEVEL = 5 };

static bool is_fine(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    (void)ctx;
    (void)row;
    (void)column;
    return level < 2;
}

static int write_image(const char *path, bool is_broken, bool is_coarse)
{
    struct tiny_spec spec = tiny_country(8);
    spec.level_count = TOP_LEVEL + 1;
    spec.margin = 2;
    spec.leave_out = is_coarse ? is_fine : NULL;
    struct tiny_image image;
    if (tiny_image_build(&image, &spec) != 0) {
        return 1;
    }
    for (size_t i = 0; is_broken && i < image.record_count; i++) {
        uint8_t *record = image.bytes + image.tiles_offset + i * LM_TILE_BYTES;
        record[1000] ^= (uint8_t)(record[4] < TOP_LEVEL); /* byte 4: level */
    }
    const int status = tiny_image_write(&image, path);
    tiny_image_free(&image);
    return status != 0;
}

static struct tiny_cell trees(void *ctx, const struct tiny_place *p)
{
    const double *dice_m = ctx;
    const bool is_dark = ((int)(p->east_m / *dice_m) + (int)(p->north_m / 90)) % 2 == 0;
    return (struct tiny_cell){is_dark ? -30 : -5, is_dark ? TINY_SOIL : TINY_TREES, 0};
}

static int write_range(const char *path, double dice_m)
{
    struct tiny_spec spec = tiny_country(8);
    spec.latitude_deg += 0.02;
    spec.longitude_deg += 0.03;
    spec.shift0--;
    spec.rows = spec.columns = 6;
    spec.level_count = 3;
    spec.cell = trees;
    spec.ctx = &dice_m;
    struct tiny_image image;
    if (tiny_image_build(&image, &spec) != 0) {
        return 1;
    }
    const int status = tiny_image_write(&image, path);
    tiny_image_free(&image);
    return status != 0;
}

/* The pixels of a picture, red, green and blue; NULL with the cause told. */
static uint8_t *read_png(png_image *png, const char *path)
{
    *png = (png_image){.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(png, path)) {
        fprintf(stderr, "%s: %s\n", path, png->message);
        return NULL;
    }
    png->format = PNG_FORMAT_RGB;
    uint8_t *pixels = malloc(PNG_IMAGE_SIZE(*png));
    return pixels && png_image_finish_read(png, NULL, pixels, 0, NULL) ? pixels : NULL;
}

static int differ(const char *first, const char *second)
{
    png_image a, b;
    uint8_t *one = read_png(&a, first), *other = read_png(&b, second);
    if (!one || !other || a.width != b.width || a.height != b.height) {
        return 1;
    }
    size_t count = 0;
    for (size_t i = 0; i < (size_t)a.width * a.height; i++) {
        count += memcmp(one + 3 * i, other + 3 * i, 3) != 0;
    }
    printf("%zu\n", count);
    free(one);
    free(other);
    return 0;
}

static int look(const char *path, const char *colour)
{
    png_image png;
    uint8_t *pixels = read_png(&png, path);
    if (!pixels) {
        return 1;
    }
    const size_t count = (size_t)png.width * png.height;
    if (!colour) {
        printf("%ux%u\n", png.width, png.height);
    } else {
        const unsigned long wanted = strtoul(colour, NULL, 16);
        size_t found = 0;
        for (const uint8_t *p = pixels; p < pixels + 3 * count; p += 3) {
            found += ((unsigned long)p[0] << 16 | (unsigned long)p[1] << 8 | p[2]) == wanted;
        }
        printf("%zu\n", found);
    }
    free(pixels);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "image") == 0) {
        return write_image(argv[2], false, false);
    }
    if (argc == 3 && strcmp(argv[1], "break-fine") == 0) {
        return write_image(argv[2], true, false);
    }
    if (argc == 3 && strcmp(argv[1], "leave-fine-out") == 0) {
        return write_image(argv[2], false, true);
    }
    if (argc == 3 && strcmp(argv[1], "range") == 0) {
        return write_range(argv[2], 120);
    }
    if (argc == 3 && strcmp(argv[1], "other-range") == 0) {
        return write_range(argv[2], 70);
    }
    if (argc == 4 && strcmp(argv[1], "differ") == 0) {
        return differ(argv[2], argv[3]);
    }
    if (argc == 4 && strcmp(argv[1], "pixels") == 0) {
        return look(argv[2], argv[3]);
    }
    if (argc == 3 && strcmp(argv[1], "size") == 0) {
        return look(argv[2], NULL);
    }
    return 2;
}
