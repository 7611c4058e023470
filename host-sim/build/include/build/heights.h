/* Heights of an image's height codes, chosen from what the image will hold: structures, trees, and
 * crests that coarser levels lose. */
#ifndef BUILD_HEIGHTS_H
#define BUILD_HEIGHTS_H

#include "build/tile.h"

#include <stdbool.h>
#include <stdint.h>

/* Which heights occur, by decimetres. */
struct build_heights {
    bool structures[BUILD_HEIGHT_MAX_DM + 1], crests[BUILD_HEIGHT_MAX_DM + 1];
};

/* Note the heights of classes that stand up, those of the height raster, and the crests of the
 * terrain, as far as 1024 tiles tell. Returns 0, or -1 with the error reported. Cost: reads the
 * height raster, and the terrain once more at its own level. */
int build_heights_survey(struct build_heights *h, struct build_context *b);

/* The table that misses these heights least: [0] is 0, and none is below the one before. A
 * miss counts by the square of its share of what may be missed: 2 % or 0.5 m of a structure, a
 * tenth or 2 m of a crest. A structure counts as 16 crests, and a single tower as much as a height
 * that is common. */
void build_heights_choose(const struct build_heights *h, uint16_t table_dm[16]);

#endif
