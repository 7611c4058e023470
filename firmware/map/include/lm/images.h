/* Images: several images of one flash as one map: a world, a theatre, a training area. At each
 * place the finest that has data there answers.
 *
 *     training area   5 m             |#####|
 *     theatre        10 m        |###############|
 *     world          90 m    |############################|
 *     answers                 www ttttt aaaaa ttt wwwwwwwww
 *
 * The grid of all images is the same, because it hangs on the size of a cell alone. Hence a tile of
 * a level has the same place in each that has cells of that size. The view is what readers take for
 * the image: its LODs go from the finest cell of all to the coarsest. lm/tile_cache.h reads a tile
 * from the first image that has it, fits it to the view's gains (lm/tile_fit.h), and fills its gaps
 * from those behind.
 *
 * Cells name their class by its number, so images have the same classes, or are refused. */
#ifndef LM_IMAGES_H
#define LM_IMAGES_H

#include "lm/db.h"
#include "lm/geo.h"

/* May `other` be shown together with `first`? LM_OK; LM_ERR_SENSOR: its reflectivity is of another
 * band; LM_ERR_TABLE: it has other classes or heights of height codes, or a radar table of its own
 * that is not the first's. Colours, reflectivities and what host tools alone use may differ. */
int lm_images_judge(const struct lm_db *first, const struct lm_db *other);

/* Set LODs, vector detail and class gains of the view, which is a copy of the first image, to those
 * of all `count` images, 1..LM_IMAGES_MAX, which are sorted: the finest first. Cells that are more
 * than 2^15 times as long as the finest are left out. */
void lm_images_view(struct lm_db *view, const struct lm_db *images, uint32_t count);

/* Turn the view to a place: pictures of what is within `reach_m` of it, at most 2^22 m, begin with
 * the finest LOD of the images that have tiles there. */
void lm_images_look(struct lm_db *view, const struct lm_db *images, uint32_t count,
                    struct lm_position place, uint32_t reach_m);

/* The finest image that has tiles at a place, or the coarsest: 0..count - 1. */
uint32_t lm_images_at(const struct lm_db *images, uint32_t count, struct lm_position place);

#endif
