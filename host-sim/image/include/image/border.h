/* Border of a tile's record: rows and columns 0 and 65, which repeat the neighbours' points
 * (docs/FORMATS.md, 1.6). */
#ifndef IMAGE_BORDER_H
#define IMAGE_BORDER_H

#include "lm/db.h"

/* Where the neighbours come from. `find` returns the tile of the same LOD at (row, column), which
 * are tiles of the Earth, or NULL where the image has none. A pointer is used before the next call.
 */
struct image_neighbours {
    const struct lm_tile *(*find)(void *ctx, uint8_t lod, uint32_t row, uint32_t column);
    void *ctx;
    uint8_t shift0;
};

/* Elevation of a post beyond the edge, metres x 64, and whether a neighbour has this very post.
 * Where its columns are wider, the mean of the two on both sides stands for it. */
struct image_border_post {
    int64_t q6;
    bool is_neighbours;
};

/* What the format says of the border points of `tile` in row and column 0..65 of its record, of
 * which at least one is 0 or 65. Cells: the neighbour's at the same place, or the tile's own
 * nearest. Posts: the same; those of rows and columns 1..65 are the tile's own matter. */
uint16_t image_border_cell(const struct image_neighbours *n, const struct lm_tile *tile, int row,
                           int column);
struct image_border_post image_border_post(const struct image_neighbours *n,
                                           const struct lm_tile *tile, int row, int column);

/* Fill in cells of rows and columns 0 and 65, and posts of row 0 and column 0. The base is lowered
 * where that gives room for lower posts and no own post loses a step; what does not fit then takes
 * the nearest code. The tile's checksum is left as it is. */
void image_border_fill(const struct image_neighbours *n, struct lm_tile *tile);

#endif
