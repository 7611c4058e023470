/* All tiles of an image, from the finest level to the coarsest, in an order that needs little
 * memory: a tile row is made once the two rows below it are, and only then are those forgotten. */
#ifndef BUILD_PYRAMID_H
#define BUILD_PYRAMID_H

#include "build/tile.h"
#include "image/writer.h"

struct build_level_counts {
    uint32_t tiles[LM_DB_LEVELS_MAX];
};

/* Make the tiles of b->plan and append them to the writer. Memory: two tile rows a level, 38 kB a
 * tile. Returns 0, or -1 with the error reported. */
int build_pyramid(struct build_context *b, struct image_writer *writer,
                  struct build_level_counts *counts);

#endif
