/* Budget of towns: how much the cells of structures must lose at each level, so that a town's mean
 * power is that of the class table.
 *
 * The table's gamma of a structure is the mean over a built-up area, walls and corners included.
 * The display unit makes these from heights and borders (docs/EQUATIONS.md, "Illumination"). A
 * line's rises add up to what flat ground would show, and most of them lie on fronts; how many, and
 * how many of them are leading edges, differs from level to level. The law is therefore applied to
 * the tiles themselves, and the gain is what is missing. */
#ifndef BUILD_TOWNS_H
#define BUILD_TOWNS_H

#include "build/exact_sum.h"
#include "hs/class_table.h"
#include "image/grid.h"
#include "lm/db.h"

#include <stdint.h>

/* Sums over the built-up area of an image, by level. Zero at first. */
struct build_towns {
    struct build_sum area[LM_DB_LODS_MAX];
    struct build_sum structure_power[LM_DB_LODS_MAX]; /* times area; flat ground of 0 dB has 1 */
    struct build_sum other_power[LM_DB_LODS_MAX];
    struct build_sum table_power, table_count; /* of the table's gammas, over cells of structures */
};

/* What the budget sees of a tile. */
struct build_towns_tile {
    const uint16_t (*cells)[LM_TILE_CELLS];   /* as in its record, row 0 southernmost */
    const int32_t (*posts_q6)[LM_TILE_POSTS]; /* metres x 64 */
    const float (*built)[LM_TILE_CELLS];      /* share of each cell that is built-up */
};

/* Mark cells whose surroundings, some 150 m wide and inside the tile, are built-up: the share of
 * structures there where it is 15 % or more, else 0. */
void build_towns_mark(const uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS],
                      const struct lm_classes *classes, double cell_m,
                      float built[LM_TILE_CELLS][LM_TILE_CELLS]);

/* Add a tile of a level, looked at along its rows and columns from four sides. */
void build_towns_add(struct build_towns *t, int level, const struct build_towns_tile *tile,
                     const struct lm_classes *classes, double north_m, double east_m);

/* Add what another part of the image has. */
void build_towns_join(struct build_towns *t, const struct build_towns *other);

/* Gain of structures at a level, dB; 0 where nothing is built-up. */
double build_towns_gain_db(const struct build_towns *t, int level);

#endif
