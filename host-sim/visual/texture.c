#include "visual/texture.h"

#include "hs/input_file.h"

#include <gdal.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int read_band(GDALRasterBandH band, uint8_t *to, const struct visual_texture *t)
{
    if (GDALGetRasterDataType(band) != GDT_Byte) {
        return -1;
    }
    return GDALRasterIO(band, GF_Read, 0, 0, t->width, t->height, to, t->width, t->height, GDT_Byte,
                        4, 4 * t->width) == CE_None
               ? 0
               : -1;
}

static void apply_palette(const struct visual_texture *t, GDALColorTableH palette)
{
    const int count = GDALGetColorEntryCount(palette);
    uint8_t *p = t->levels[0];
    for (size_t i = 0; i < (size_t)t->width * (size_t)t->height; i++, p += 4) {
        GDALColorEntry e = {0, 0, 0, 0};
        if (p[0] < count) {
            GDALGetColorEntryAsRGB(palette, p[0], &e);
        }
        p[0] = (uint8_t)e.c1;
        p[1] = (uint8_t)e.c2;
        p[2] = (uint8_t)e.c3;
        p[3] = (uint8_t)e.c4;
    }
}

/* Bands 1, 2, 3, 4 are grey; grey and opacity; colours; colours and opacity. */
static int read_bands(struct visual_texture *t, GDALDatasetH file)
{
    const int bands = GDALGetRasterCount(file);
    const int first = bands < 3 ? 1 : 3;
    memset(t->levels[0], 255, 4 * (size_t)t->width * (size_t)t->height);
    for (int i = 0; i < 3; i++) {
        const int band = first == 1 ? 1 : i + 1;
        if (read_band(GDALGetRasterBand(file, band), t->levels[0] + i, t) != 0) {
            return -1;
        }
    }
    if (bands == 2 || bands == 4) {
        return read_band(GDALGetRasterBand(file, bands), t->levels[0] + 3, t);
    }
    GDALColorTableH palette = GDALGetRasterColorTable(GDALGetRasterBand(file, 1));
    if (bands == 1 && palette) {
        apply_palette(t, palette);
    }
    return 0;
}

static int side(int full, int level)
{
    return full >> level > 0 ? full >> level : 1;
}

/* The mean of the four pixels under each; what is transparent has no part in the colour. */
static void halve(const struct visual_texture *t, int level)
{
    const int w = side(t->width, level), h = side(t->height, level);
    const int from_w = side(t->width, level - 1), from_h = side(t->height, level - 1);
    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            unsigned sum[4] = {0, 0, 0, 0};
            for (int i = 0; i < 4; i++) {
                const int fx = 2 * x + (i & 1) < from_w ? 2 * x + (i & 1) : from_w - 1;
                const int fy = 2 * y + (i >> 1) < from_h ? 2 * y + (i >> 1) : from_h - 1;
                const uint8_t *p =
                    t->levels[level - 1] + 4 * ((size_t)fy * (size_t)from_w + (size_t)fx);
                for (int c = 0; c < 3; c++) {
                    sum[c] += (unsigned)p[c] * p[3];
                }
                sum[3] += p[3];
            }
            uint8_t *to = t->levels[level] + 4 * ((size_t)y * (size_t)w + (size_t)x);
            for (int c = 0; c < 3; c++) {
                to[c] = (uint8_t)(sum[3] ? (sum[c] + sum[3] / 2) / sum[3] : 0);
            }
            to[3] = (uint8_t)((sum[3] + 2) / 4);
        }
    }
}

static int make_levels(struct visual_texture *t)
{
    t->level_count = 1;
    while (t->level_count < VISUAL_TEXTURE_LEVELS &&
           (t->width >> t->level_count > 0 || t->height >> t->level_count > 0)) {
        const int l = t->level_count;
        t->levels[l] = malloc(4 * (size_t)side(t->width, l) * (size_t)side(t->height, l));
        if (!t->levels[l]) {
            return -1;
        }
        t->level_count++;
        halve(t, l);
    }
    return 0;
}

int visual_texture_load(struct visual_texture *t, const char *path)
{
    *t = (struct visual_texture){.width = 0};
    GDALDatasetH file = GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (!file) {
        return -1;
    }
    hs_input_note(path);
    t->width = GDALGetRasterXSize(file);
    t->height = GDALGetRasterYSize(file);
    const int bands = GDALGetRasterCount(file);
    int result = -1;
    if (bands >= 1 && t->width <= VISUAL_TEXTURE_SIDE_MAX && t->height <= VISUAL_TEXTURE_SIDE_MAX) {
        t->levels[0] = malloc(4 * (size_t)t->width * (size_t)t->height);
        result = t->levels[0] && read_bands(t, file) == 0 ? make_levels(t) : -1;
    }
    GDALClose(file);
    if (result != 0) {
        visual_texture_free(t);
    }
    return result;
}

static int pixel(double at, int count, uint8_t wrap)
{
    if (wrap == VISUAL_WRAP_CLAMP) {
        at = fmin(fmax(at, 0), 1);
    } else if (wrap == VISUAL_WRAP_MIRROR) {
        const double twice = at - 2 * floor(at / 2);
        at = twice > 1 ? 2 - twice : twice;
    } else {
        at -= floor(at);
    }
    const int i = (int)(at * count);
    return i < count ? i : count - 1;
}

const uint8_t *visual_texture_at(const struct visual_texture *t, double u, double v, int level,
                                 const uint8_t wrap[2])
{
    const int l = level < 0 ? 0 : level < t->level_count ? level : t->level_count - 1;
    const int w = side(t->width, l), h = side(t->height, l);
    const int x = pixel(u, w, wrap[0]), y = h - 1 - pixel(v, h, wrap[1]);
    return t->levels[l] + 4 * ((size_t)y * (size_t)w + (size_t)x);
}

void visual_texture_free(struct visual_texture *t)
{
    for (int i = 0; i < VISUAL_TEXTURE_LEVELS; i++) {
        free(t->levels[i]);
    }
    *t = (struct visual_texture){.width = 0};
}
