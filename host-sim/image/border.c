#include "image/border.h"

#include "image/codes.h"
#include "image/grid.h"

enum { CELLS = LM_TILE_CELLS, LAST = LM_TILE_POINTS - 1 };

/* A point of a neighbour: the tile, row and column of its record, and whether the place lies in the
 * middle between this post and the next one to the east. */
struct spot {
    const struct lm_tile *tile;
    int row, column;
    bool is_between;
};

/* The neighbour's point at a point of this tile's border. In another zone columns are twice as wide
 * or half as wide: `in_column` says where in its column the place lies, in halves. */
static struct spot find_spot(const struct image_neighbours *n, const struct lm_tile *tile, int row,
                             int column, uint32_t in_column)
{
    const uint8_t shift = (uint8_t)(n->shift0 + tile->lod);
    const int64_t up = (int64_t)tile->row * CELLS + row - LM_TILE_BORDER;
    if (up < 0 || up >= (int64_t)image_rows_all(shift) * CELLS) {
        return (struct spot){0};
    }
    const uint32_t north_row = (uint32_t)(up / CELLS);
    const uint8_t zone = image_row_zone(shift, north_row);
    /* Half columns from Greenwich, modulo once round: shift + zone is 4 or more. */
    const int64_t halves = 2 * ((int64_t)tile->column * CELLS + column - LM_TILE_BORDER);
    const uint32_t longitude =
        (uint32_t)((uint64_t)(halves + (int64_t)in_column) << (shift + tile->zone - 1));
    const int cell_shift = shift + zone;
    const uint32_t across = longitude >> cell_shift;
    return (struct spot){
        .tile = n->find(n->ctx, tile->lod, north_row, across / CELLS),
        .row = (int)(up % CELLS) + LM_TILE_BORDER,
        .column = (int)(across % CELLS) + LM_TILE_BORDER,
        .is_between = (longitude & ((1u << cell_shift) - 1)) != 0,
    };
}

static int clamped(int value, int last)
{
    return value < LM_TILE_BORDER ? LM_TILE_BORDER : value > last ? last : value;
}

uint16_t image_border_cell(const struct image_neighbours *n, const struct lm_tile *tile, int row,
                           int column)
{
    const struct spot s = find_spot(n, tile, row, column, 1);
    return s.tile ? s.tile->points[s.row][s.column].cell
                  : tile->points[clamped(row, CELLS)][clamped(column, CELLS)].cell;
}

static int64_t record_post_q6(const struct lm_tile *tile, int row, int column)
{
    return image_post_q6(tile, row - LM_TILE_BORDER, column - LM_TILE_BORDER);
}

struct image_border_post image_border_post(const struct image_neighbours *n,
                                           const struct lm_tile *tile, int row, int column)
{
    const struct spot s = find_spot(n, tile, row, column, 0);
    if (!s.tile || s.tile->post_shift > LM_TILE_POST_SHIFT_MAX) {
        const int64_t own = record_post_q6(tile, clamped(row, LAST), clamped(column, LAST));
        return (struct image_border_post){own, false};
    }
    const int64_t west = record_post_q6(s.tile, s.row, s.column);
    const int64_t east = record_post_q6(s.tile, s.row, s.column + s.is_between);
    return (struct image_border_post){(west + east) / 2, !s.is_between};
}

/* The southern row and the western column, 131 points: number i. */
static void edge_point(int i, int *row, int *column)
{
    *row = i < LM_TILE_POINTS ? 0 : i - LM_TILE_POINTS + 1;
    *column = i < LM_TILE_POINTS ? i : 0;
}
enum { EDGE_POINTS = 2 * LM_TILE_POINTS - 1 };

static uint16_t highest_code(const struct lm_tile *tile)
{
    uint16_t highest = 0;
    for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
        const uint16_t p = tile->points[1 + i / LM_TILE_POSTS][1 + i % LM_TILE_POSTS].post;
        highest = p > highest ? p : highest;
    }
    return highest;
}

/* Lower the base by whole steps, as far as `low_q6` asks for and the own posts allow. */
static void lower_base(struct lm_tile *tile, int64_t low_q6)
{
    const int64_t step = (int64_t)1 << tile->post_shift;
    const int64_t asked =
        low_q6 < tile->base_m_q6 ? (tile->base_m_q6 - low_q6 + step - 1) / step : 0;
    const int64_t room = UINT16_MAX - highest_code(tile);
    const int64_t depth = (tile->base_m_q6 + (int64_t)IMAGE_ELEVATION_LIMIT_Q6) / step;
    int64_t steps = asked < room ? asked : room;
    steps = steps < depth ? steps : depth;
    tile->base_m_q6 -= (int32_t)(steps * step);
    for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
        struct lm_tile_point *p = &tile->points[1 + i / LM_TILE_POSTS][1 + i % LM_TILE_POSTS];
        p->post = (uint16_t)(p->post + steps);
    }
}

static uint16_t post_code(const struct lm_tile *tile, int64_t q6)
{
    const int64_t half = (1 << tile->post_shift) / 2;
    const int64_t code = (q6 - tile->base_m_q6 + half) >> tile->post_shift;
    return (uint16_t)(code < 0 ? 0 : code > UINT16_MAX ? UINT16_MAX : code);
}

void image_border_fill(const struct image_neighbours *n, struct lm_tile *tile)
{
    int64_t q6[EDGE_POINTS], low_q6 = tile->base_m_q6;
    int row, column;
    for (int i = 0; i < LM_TILE_POINTS; i++) {
        tile->points[0][i].cell = image_border_cell(n, tile, 0, i);
        tile->points[LAST][i].cell = image_border_cell(n, tile, LAST, i);
        tile->points[i][0].cell = image_border_cell(n, tile, i, 0);
        tile->points[i][LAST].cell = image_border_cell(n, tile, i, LAST);
    }
    for (int i = 0; i < EDGE_POINTS; i++) {
        edge_point(i, &row, &column);
        q6[i] = image_border_post(n, tile, row, column).q6;
        low_q6 = q6[i] < low_q6 ? q6[i] : low_q6;
    }
    lower_base(tile, low_q6);
    for (int i = 0; i < EDGE_POINTS; i++) {
        edge_point(i, &row, &column);
        tile->points[row][column].post = post_code(tile, q6[i]);
    }
}
