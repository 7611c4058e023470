/* Canopy: tops of trees of different heights, where the inputs give woods one height. */
#ifndef BUILD_CANOPY_H
#define BUILD_CANOPY_H

#include "build/tile.h"

/* Give each tree cell of a tile, if it is of the finest level, a height of its own: its height
 * times
 *
 *     1 + a P          P normal, smooth over 5 m, a function of the place; held within 0.4..1.6
 *                      a = 1/4, and in cells longer than 7 m, a tree, 1/4 of 7 m over the cell
 *
 * taken to one of the two height codes around it by chance, so that the mean stays. */
void build_canopy(const struct build_context *b, const struct image_frame *f,
                  struct image_ground *ground);

#endif
