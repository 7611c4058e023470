/* Tile fit: brings a tile of one image of several to what they have in common. Readers add the gain
 * of a class at an LOD (lod_gain_db_q8) to its cells, and take it from the view of all images
 * (lm/images.h). Where the tile's image has another gain, the difference goes into the cells.
 *
 * The tile has passed lm_tile_check. */
#ifndef LM_TILE_FIT_H
#define LM_TILE_FIT_H

#include "lm/db.h"

/* A fit under way. All members are private. */
struct lm_tile_fit {
    struct lm_tile *tile;         /* borrowed */
    int16_t codes[LM_DB_CLASSES]; /* to add to the reflectivity codes of a class */
    uint32_t row;                 /* rows done */
};

/* Begin with a tile that is of LOD `own_lod` of its image, whose classes are `own`, and of LOD
 * `lod` of the view, whose classes are `view`. Returns LM_BUSY: call lm_tile_fit_run; or LM_OK:
 * nothing is to be done. Cost: 300 instructions. */
int lm_tile_fit_begin(struct lm_tile_fit *f, struct lm_tile *tile, const struct lm_classes *own,
                      uint8_t own_lod, const struct lm_classes *view, uint8_t lod);

/* Do one of 6 parts. LM_BUSY: call again; LM_OK: the tile fits, to 1/4 dB. Reflectivities end at
 * those of codes 0 and 255. Cost: some 8,000 instructions. */
int lm_tile_fit_run(struct lm_tile_fit *f);

#endif
