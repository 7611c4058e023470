/* Pyramid of an image: all its tiles, from the finest level to the coarsest. Memory holds few tile
 * rows at a time: a row is made as soon as the two rows below it are, and only then are those
 * freed. */
#ifndef BUILD_PYRAMID_H
#define BUILD_PYRAMID_H

#include "build/tile.h"
#include "image/writer.h"

struct build_level_counts {
    uint32_t tiles[LM_DB_LODS_MAX];
};

/* Make the tiles of b->plan and append them to the writer. Memory: two tile rows a level, 38 kB a
 * tile. Returns 0, or -1 with the error reported. */
int build_pyramid(struct build_context *b, struct image_writer *writer,
                  struct build_level_counts *counts);

#endif
