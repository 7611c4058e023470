/* Ground of a tile: its cells with the heights of structures alone, and how high its terrain really
 * stands. From these a coarser level is made (docs/FORMATS.md, 1.6).
 *
 *     coarse terrain        ________________       crest: what the posts of the coarser level lost
 *                          /    . |^  .     \
 *     finer terrain ______/____/ \||___\_____\__
 *                                 v
 *
 * Usage, from the finest level up: image_ground_init; image_ground_take for each quarter that has a
 * tile below; image_ground_encode. */
#ifndef IMAGE_GROUND_H
#define IMAGE_GROUND_H

#include "lm/db.h"

#include <stdint.h>

/* Place in a cell, from its south-west corner, in 2^-16 of the cell. */
struct image_place {
    uint16_t north_q16, east_q16;
};

/* The highest terrain of a cell, metres x 64, and where in the cell it is. */
struct image_top {
    double q6; /* whole numbers, quarters and their like: exact */
    struct image_place place;
};

struct image_ground {
    uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS]; /* height codes of structures */
    struct image_top top[LM_TILE_CELLS][LM_TILE_CELLS];
};

/* Tops of a tile's own terrain, in the middle of each cell. `tile` has its posts. */
void image_ground_init(struct image_ground *g, const struct lm_tile *tile);

/* Make a quarter (2 * north + east) from the tile below it: cells by image_reduce, tops from the
 * tops below. `tile` is the coarser one and has its posts. */
void image_ground_take(struct image_ground *g, const struct lm_tile *tile,
                       const struct image_ground *below, int quarter,
                       const struct lm_classes *classes);

/* The tops alone. */
void image_ground_take_tops(struct image_ground *g, const struct lm_tile *tile,
                            const struct image_ground *below, int quarter);

/* Height in metres of a cell's crest above its tile's terrain, 0 or more. */
double image_ground_crest_m(const struct image_ground *g, const struct lm_tile *tile, int row,
                            int column);

/* Put the cells into the record: the height code is that of the structures, or of the crest where
 * it is higher. Cells without data have none. */
void image_ground_encode(const struct image_ground *g, struct lm_tile *tile,
                         const uint16_t heights_dm[16]);

#endif
