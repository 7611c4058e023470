/* The countries that the golden pictures show: sea and lakes, far shores, hills and a mountain,
 * towns, woods, an airfield, and a corner without data. Everything comes from whole numbers of a
 * place's binary angles, so that the image is the same on every machine. */
#ifndef GOLDEN_SCENE_H
#define GOLDEN_SCENE_H

#include "lm/geo.h"
#include "tiny_image.h"

enum golden_place {
    GOLDEN_MIDDLE,       /* 46 N 11 E */
    GOLDEN_BORDER,       /* 61.875 N: cells north of it are twice as wide */
    GOLDEN_ANTIMERIDIAN, /* 17 S 180 E */
    GOLDEN_NORTH,        /* 79 N: cells four times as wide */
    GOLDEN_PLACES
};

const char *golden_place_name(enum golden_place place);

/* The middle of the country. */
struct lm_position golden_centre(enum golden_place place);

/* Build its image: tiny_image_build's answer. The caller frees it. */
int golden_image(enum golden_place place, struct tiny_image *image);

#endif
