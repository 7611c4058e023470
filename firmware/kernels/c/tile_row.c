#include "../tile_row.h"

void lm_k_tile_row(struct lm_tile_point *points, const struct lm_tile_point *south,
                   const struct lm_k_strips *strips)
{
    put_points(points, south, strips, 0, 0);
}
