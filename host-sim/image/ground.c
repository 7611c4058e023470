#include "image/ground.h"

#include "image/codes.h"

#include <math.h>

enum { CELLS = LM_TILE_CELLS, HALF = LM_TILE_CELLS / 2 };

/* Terrain of a tile at `north` and `east` quarters of a cell from its own south-west post. */
static double terrain_q6(const struct lm_tile *tile, int north, int east)
{
    const int r = north / 4, c = east / 4;
    const double v = north % 4 / 4.0, u = east % 4 / 4.0;
    const double south =
        (double)image_post_q6(tile, r, c) * (1 - u) + (double)image_post_q6(tile, r, c + 1) * u;
    const double beyond = (double)image_post_q6(tile, r + 1, c) * (1 - u) +
                          (double)image_post_q6(tile, r + 1, c + 1) * u;
    return south * (1 - v) + beyond * v;
}

static double middle_q6(const struct lm_tile *tile, int row, int column)
{
    return terrain_q6(tile, 4 * row + 2, 4 * column + 2);
}

void image_ground_init(struct image_ground *g, const struct lm_tile *tile)
{
    for (int r = 0; r < CELLS; r++) {
        for (int c = 0; c < CELLS; c++) {
            g->top_q6[r][c] = middle_q6(tile, r, c);
        }
    }
}

/* What stands out of a cell: the highest of the four tops below, each above the terrain at its own
 * place. A plane has none, however steep. */
static double crest_q6(const struct lm_tile *tile, const struct image_ground *below, int row,
                       int column, int fine_row, int fine_column)
{
    double crest = 0;
    for (int i = 0; i < 4; i++) {
        const int north = i / 2, east = i % 2;
        crest =
            fmax(crest, below->top_q6[fine_row + north][fine_column + east] -
                            terrain_q6(tile, 4 * row + 1 + 2 * north, 4 * column + 1 + 2 * east));
    }
    return crest;
}

void image_ground_take(struct image_ground *g, const struct lm_tile *tile,
                       const struct image_ground *below, int quarter,
                       const struct lm_classes *classes)
{
    const int row0 = quarter / 2 * HALF, column0 = quarter % 2 * HALF;
    const struct image_reduction halved = {classes, 2, HALF, IMAGE_VOTE_POWER};
    image_reduce(&halved, &below->cells[0][0], CELLS, &g->cells[row0][column0], CELLS);
    image_ground_take_tops(g, tile, below, quarter);
}

void image_ground_take_tops(struct image_ground *g, const struct lm_tile *tile,
                            const struct image_ground *below, int quarter)
{
    const int row0 = quarter / 2 * HALF, column0 = quarter % 2 * HALF;
    for (int r = 0; r < HALF; r++) {
        for (int c = 0; c < HALF; c++) {
            const int row = row0 + r, column = column0 + c;
            g->top_q6[row][column] =
                middle_q6(tile, row, column) + crest_q6(tile, below, row, column, 2 * r, 2 * c);
        }
    }
}

double image_ground_crest_m(const struct image_ground *g, const struct lm_tile *tile, int row,
                            int column)
{
    return (g->top_q6[row][column] - middle_q6(tile, row, column)) / 64;
}

void image_ground_encode(const struct image_ground *g, struct lm_tile *tile,
                         const uint16_t heights_dm[16])
{
    for (int r = 0; r < CELLS; r++) {
        for (int c = 0; c < CELLS; c++) {
            const uint16_t cell = g->cells[r][c];
            const uint8_t crest =
                image_height_code(heights_dm, 10 * image_ground_crest_m(g, tile, r, c));
            const bool has_crest =
                image_cell_class(cell) != LM_DB_CLASS_NONE && crest > image_cell_height(cell);
            tile->points[r + LM_TILE_BORDER][c + LM_TILE_BORDER].cell =
                has_crest ? image_cell(image_cell_gamma(cell), image_cell_class(cell), crest)
                          : cell;
        }
    }
}
