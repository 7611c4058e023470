/* picture_checksum: the golden checksum of a picture: "WIDTHxHEIGHT CRC-32C" of its pixels as the
 * firmware draws them, 0x00RRGGBB. Usage: picture_checksum FILE.ppm|FILE.png */
#include "fx/crc32c.h"
#include "hs/error.h"

#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct picture {
    unsigned width, height;
    uint8_t *rgb; /* owned */
};

static int read_ppm(struct picture *p, FILE *file)
{
    if (fscanf(file, "P6 %u %u 255", &p->width, &p->height) != 2 || getc(file) == EOF ||
        p->width > 4096 || p->height > 4096) {
        return -1;
    }
    const size_t size = (size_t)p->width * p->height * 3;
    p->rgb = malloc(size);
    return p->rgb && fread(p->rgb, 1, size, file) == size ? 0 : -1;
}

static int read_png(struct picture *p, FILE *file)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_stdio(&image, file)) {
        return -1;
    }
    image.format = PNG_FORMAT_RGB;
    p->width = image.width;
    p->height = image.height;
    p->rgb = malloc(PNG_IMAGE_SIZE(image));
    return p->rgb && png_image_finish_read(&image, NULL, p->rgb, 0, NULL) ? 0 : -1;
}

int main(int argc, char **argv)
{
    struct picture p = {0};
    hs_set_program("picture_checksum");
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file) {
        hs_error(argc > 1 ? argv[1] : "command line", NULL, "expected a picture");
        return HS_EXIT_USAGE;
    }
    const char *dot = strrchr(argv[1], '.');
    const int status = dot && strcmp(dot, ".png") == 0 ? read_png(&p, file) : read_ppm(&p, file);
    fclose(file);
    if (status != 0) {
        free(p.rgb);
        hs_error(argv[1], NULL, "is no PPM or PNG of 8 bits");
        return HS_EXIT_FAILED;
    }
    uint32_t checksum = 0;
    for (size_t i = 0; i < (size_t)p.width * p.height * 3; i += 3) {
        const uint8_t pixel[4] = {p.rgb[i + 2], p.rgb[i + 1], p.rgb[i], 0};
        checksum = fx_crc32c(checksum, pixel, sizeof pixel);
    }
    printf("%ux%u %08x\n", p.width, p.height, checksum);
    free(p.rgb);
    return HS_EXIT_OK;
}
