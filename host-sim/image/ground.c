#include "image/ground.h"

#include "image/codes.h"

#include <math.h>

enum { CELLS = LM_TILE_CELLS, HALF = LM_TILE_CELLS / 2 };

/* Posts at the corners of a cell. */
struct corners {
    double south_west, south_east, north_west, north_east;
};

static struct corners corners_of(const struct lm_tile *tile, int row, int column)
{
    return (struct corners){(double)image_post_q6(tile, row, column),
                            (double)image_post_q6(tile, row, column + 1),
                            (double)image_post_q6(tile, row + 1, column),
                            (double)image_post_q6(tile, row + 1, column + 1)};
}

/* Terrain at a place of the cell. Products of posts and places are exact. */
static double terrain_q6(struct corners at, struct image_place place)
{
    const double v = place.north_q16 / 65536.0, u = place.east_q16 / 65536.0;
    const double south = at.south_west * (1 - u) + at.south_east * u;
    const double north = at.north_west * (1 - u) + at.north_east * u;
    return south * (1 - v) + north * v;
}

static const struct image_place middle = {32768, 32768};

void image_ground_init(struct image_ground *g, const struct lm_tile *tile)
{
    for (int r = 0; r < CELLS; r++) {
        for (int c = 0; c < CELLS; c++) {
            g->top[r][c] = (struct image_top){terrain_q6(corners_of(tile, r, c), middle), middle};
        }
    }
}

/* How far a top stands out of the terrain at its own place. */
static double excess_q6(struct corners at, const struct image_top *top)
{
    return top->q6 - terrain_q6(at, top->place);
}

/* The top of a cell: of the four below, the one that stands out most. A cell out of which none
 * stands has the terrain's own, in its middle. */
static struct image_top highest(const struct lm_tile *tile, int row, int column,
                                const struct image_ground *below, int fine_row, int fine_column)
{
    const struct corners at = corners_of(tile, row, column);
    struct image_top best = {terrain_q6(at, middle), middle};
    double most_q6 = 0;
    for (int i = 0; i < 4; i++) {
        const int north = i / 2, east = i % 2;
        struct image_top top = below->top[fine_row + north][fine_column + east];
        top.place.north_q16 = (uint16_t)((top.place.north_q16 + 65536 * north) / 2);
        top.place.east_q16 = (uint16_t)((top.place.east_q16 + 65536 * east) / 2);
        const double out_q6 = excess_q6(at, &top);
        if (out_q6 > most_q6) {
            most_q6 = out_q6;
            best = top;
        }
    }
    return best;
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
            g->top[row][column] = highest(tile, row, column, below, 2 * r, 2 * c);
        }
    }
}

double image_ground_crest_m(const struct image_ground *g, const struct lm_tile *tile, int row,
                            int column)
{
    const struct image_top *top = &g->top[row][column];
    const struct corners at = corners_of(tile, row, column);
    const double out_q6 = fmax(excess_q6(at, top), 0);
    const double above_q6 = terrain_q6(at, top->place) - terrain_q6(at, middle);
    return (out_q6 + fmin(out_q6 / 2, fmax(above_q6, 0))) / 64;
}

void image_ground_encode(const struct image_ground *g, struct lm_tile *tile,
                         const uint16_t heights_dm[16])
{
    for (int r = 0; r < CELLS; r++) {
        for (int c = 0; c < CELLS; c++) {
            const uint16_t cell = g->cells[r][c];
            const double crest_m = image_ground_crest_m(g, tile, r, c);
            const uint8_t crest = image_height_code(heights_dm, 10 * crest_m);
            const bool has_crest =
                image_cell_class(cell) != LM_DB_CLASS_NONE && crest > image_cell_height(cell);
            tile->points[r + LM_TILE_BORDER][c + LM_TILE_BORDER].cell =
                has_crest ? image_cell(image_cell_gamma(cell), image_cell_class(cell), crest)
                          : cell;
        }
    }
}
