/* Texture of a visual database, with its smaller sizes, each half of the one before. */
#ifndef VISUAL_TEXTURE_H
#define VISUAL_TEXTURE_H

#include "visual/model.h"

enum {
    VISUAL_TEXTURE_SIDE_MAX = 16384, /* pixels; a larger one counts as missing */
    VISUAL_TEXTURE_LEVELS = 15
};

struct visual_texture {
    int width, height, level_count;
    uint8_t *levels[VISUAL_TEXTURE_LEVELS]; /* owned: red, green, blue, opacity; from the top */
};

/* Read whatever GDAL reads: grey, colours or a palette, 8 bits each, with opacity or without.
 * Returns 0, or -1 without a word and nothing to free: it cannot be read, has more than 8 bits or
 * more than VISUAL_TEXTURE_SIDE_MAX pixels on a side, or there is no memory. */
int visual_texture_load(struct visual_texture *t, const char *path);

/* The pixel at (u, v), v from below, of the level `level`, which is cut to those there are. */
const uint8_t *visual_texture_at(const struct visual_texture *t, double u, double v, int level,
                                 const uint8_t wrap[2]);

/* Harmless on a zeroed struct. */
void visual_texture_free(struct visual_texture *t);

#endif
