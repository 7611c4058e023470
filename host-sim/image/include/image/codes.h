/* Codes of an image's cells and posts: packing, unpacking, and the reduction of four cells to one
 * of the next coarser level (docs/FORMATS.md, 1.6). */
#ifndef IMAGE_CODES_H
#define IMAGE_CODES_H

#include "lm/db.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    IMAGE_CELL_NONE = LM_DB_CLASS_NONE << 4, /* a cell without data */
    IMAGE_ELEVATION_LIMIT_Q6 = 1 << 20       /* 16,384 m; no place on Earth comes near */
};

/* Nearest code of a constant-gamma coefficient in dB; ends of the scale for what lies beyond them.
 */
uint8_t image_gamma_code(double gamma_db);
double image_gamma_db(uint8_t code);

/* The code whose height is nearest to `height_dm`, the lower one of two as near. */
uint8_t image_height_code(const uint16_t table_dm[16], double height_dm);

/* The heights of codes 0..15 as text, metres, each with a space before it. 160 bytes are enough. */
void image_heights_text(const uint16_t table_dm[16], char *text, size_t room);

/* The same as the array "heights_m" of the report (hs/report.h). */
void image_heights_report(const uint16_t table_dm[16]);

static inline uint16_t image_cell(uint8_t gamma_code, uint8_t class_number, uint8_t height_code)
{
    return (uint16_t)(gamma_code << 8 | class_number << 4 | height_code);
}
static inline uint8_t image_cell_gamma(uint16_t cell)
{
    return (uint8_t)(cell >> 8);
}
static inline uint8_t image_cell_class(uint16_t cell)
{
    return cell >> 4 & 15;
}
static inline uint8_t image_cell_height(uint16_t cell)
{
    return cell & 15;
}

/* How several cells agree on the class of one.
 *
 * The commonest wins: of equals the lower number, and "no data" only when all are. Classes that
 * differ in nothing but their facing count together, and then the commonest of them is taken. By
 * power, structures win before that where they return more than IMAGE_BUILT_SHARE of the cell's
 * power: a town is mostly streets and yards, but what the radar sees of it are its buildings. */
enum image_vote { IMAGE_VOTE_COUNT, IMAGE_VOTE_POWER };
#define IMAGE_BUILT_SHARE 0.25

struct image_reduction {
    const struct lm_classes *classes;
    int factor; /* so many cells both ways become one */
    int side;   /* of the result, in cells */
    enum image_vote vote;
};

/* Make fewer cells: reflectivity is the mean in power of the cells with data, class as they agree,
 * height the mean of the cells of that class, in all its facings. Strides in cells. `fine` and
 * `coarse` may be the same array. */
void image_reduce(const struct image_reduction *how, const uint16_t *fine, size_t fine_stride,
                  uint16_t *coarse, size_t coarse_stride);

/* The tile's own cells, into its record and out of it. */
void image_cells_encode(uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS], struct lm_tile *tile);
void image_cells_decode(const struct lm_tile *tile, uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS]);

/* Elevations of the 65 x 65 posts at corners of own cells, metres x 64, into base, post_shift and
 * posts of `tile`. The step is
 * the smallest that spans them, and the base a multiple of it: sea level stays exactly 0.
 * Elevations must be within IMAGE_ELEVATION_LIMIT_Q6. */
void image_posts_encode(const int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS], struct lm_tile *tile);

/* The posts of a tile, metres x 64. */
void image_posts_decode(const struct lm_tile *tile, int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS]);

/* Smooth the posts of a tile from those of the tiles below it, below[2 * north + east] or NULL:
 * each becomes the mean of the nine around it, weighted 1, 2, 1 both ways. Posts on the tile's own
 * edges, which neighbours share, and posts of which not all nine are there stay as they are. */
void image_posts_smooth(const int32_t (*const below[4])[LM_TILE_POSTS],
                        int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS]);

/* One cell of a tile. Row 0 and column 0 are its own southernmost and westernmost; -1 and 64 are
 * the border's. */
static inline uint16_t image_tile_cell(const struct lm_tile *tile, int row, int column)
{
    return tile->points[row + LM_TILE_BORDER][column + LM_TILE_BORDER].cell;
}

/* One post of a tile, metres x 64: that at the south-west corner of the same cell. */
static inline int64_t image_post_q6(const struct lm_tile *tile, int row, int column)
{
    const uint16_t post = tile->points[row + LM_TILE_BORDER][column + LM_TILE_BORDER].post;
    return tile->base_m_q6 + ((int64_t)post << tile->post_shift);
}

#endif
