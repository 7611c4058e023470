/* Tile fill: where a tile has no data, it takes what a tile of another image has there, which is
 * the same tile or an ancestor of it.
 *
 *     tile          source, one generation up        filled
 *     +--------+    +----+----+                      +--------+
 *     |aaaa    |    | b  | b  |                      |aaaabbbb|
 *     |aa      |    +----+----+                      |aabbbbbb|
 *     |        |    | c  | c  |                      |cccccccc|
 *     +--------+    +----+----+                      +--------+
 *
 * - A cell of class LM_DB_CLASS_NONE takes what lies there in the source: the cell of its place, or
 *   in a coarser source what the four around it are blended to (lm_k_tile_blend), to the nearest
 *   codes. Squares as large as a cell of the source would show beside it. What its class gains at
 *   the source's LOD, and not at the tile's, is added. All others stay.
 * - A post stays if it is the corner of a cell that stays. Others take the source's elevation, as
 *   its readers would blend it there: hence between a cell that stays and one that does not, the
 *   terrain goes from one to the other within one cell.
 * - The tile's base is lowered and its steps are widened as far as the source's elevations need.
 *   Steps that stay lose nothing.
 *
 * Both tiles have passed lm_tile_check, or have been filled. */
#ifndef LM_TILE_FILL_H
#define LM_TILE_FILL_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/db.h"

/* A fill under way. All members are private. */
struct lm_tile_fill {
    struct lm_tile *tile;              /* borrowed */
    const struct lm_tile *source;      /* borrowed */
    const struct lm_classes *classes;  /* borrowed */
    uint32_t natural;                  /* bit k: class k is */
    int32_t more_db_q8[LM_DB_CLASSES]; /* gain of classes at the source's LOD less the tile's */
    uint32_t generations;              /* that the source is coarser */
    int32_t row0, column0; /* of the tile's own first cell in the source, in cells of the tile */
    uint32_t row;          /* rows done, of both passes */
    int32_t least_m_q6, most_m_q6; /* of all posts */
    int32_t base_m_q6;             /* of before */
    uint8_t post_shift;            /* of before */
};

/* True if a cell of the tile or of its border has no data. Cost: 4 instructions a point. */
bool lm_tile_has_gaps(const struct lm_tile *tile);

/* Begin. `generations` are 0..15: the source is the tile (row >> generations, column >>
 * generations). Both have these classes and heights of codes. */
void lm_tile_fill_begin(struct lm_tile_fill *f, struct lm_tile *tile, const struct lm_tile *source,
                        uint32_t generations, const struct lm_classes *classes);

/* Do one of 132 parts at most: a row, or three that are whole. Returns LM_BUSY: call again; or
 * LM_OK: the tile is filled. Between the two its posts mean nothing. Cost: some 4,000 instructions;
 * 15,000 of one that is dear. */
int lm_tile_fill_run(struct lm_tile_fill *f);

/* True if the next part writes a row, for which a coarser source is blended. */
static inline bool lm_tile_fill_is_dear(const struct lm_tile_fill *f)
{
    return f->row >= LM_TILE_POINTS && f->generations > 0;
}

#endif
