/* Map of a tiny image: the image in a flash of memory, its database open, and a tile cache over it,
 * as the radar's stages are given them. For tests alone: what fails is an assertion of cmocka. */
#ifndef TINY_MAP_H
#define TINY_MAP_H

#include "lm/tile_cache.h"
#include "lm/tone.h"

#include "memory_flash.h"
#include "tiny_image.h"

struct tiny_map {
    struct tiny_image image;
    struct memory_flash flash; /* a test may let its reads fail */
    struct lm_db db;
    struct lm_tile_cache tiles;
    void *pool;
};

/* Build the image, and open it with a pool of `tiles` tiles, none of which is read yet but those of
 * the coarsest level. The map must not move. */
void tiny_map_open(struct tiny_map *m, const struct tiny_spec *spec, uint32_t tiles);
/* The same of flat soil for 5 km round 46 N 11 E, and the tone of a patch of the built-in radar. */
void tiny_map_open_soil(struct tiny_map *m, uint32_t tiles, struct lm_tone *tone);

void tiny_map_close(struct tiny_map *m);

/* Serve the cache until nothing that was asked for is missing; fails when that has no end. */
void tiny_map_read_tiles(struct tiny_map *m);

#endif
