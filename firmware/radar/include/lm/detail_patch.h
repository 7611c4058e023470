/* Detail in a patch: the rectangles and lines of the tiles (lm/detail.h), drawn into the cells of
 * each line before it is illuminated. Walls, fronts, roofs and shadows then follow from the
 * heights, as they do from the map's own cells. Law: docs/EQUATIONS.md, "Detail".
 *
 *     map's cells           with detail                    u, v: coordinates in half sides
 *      ..SSS...              ........
 *      .SSSSS..    ->        ..####..  S  goes to `under`      |u| <= 1 and |v| <= 1: inside
 *      ..SSSS..              ..####..  #  a rectangle
 *
 * Order of the calls: lm_detail_patch_clear; lm_detail_patch_add for each record;
 * lm_detail_patch_close; then lm_detail_patch_draw for each line, in any order. No call fails:
 * what does not fit is left out and counted. */
#ifndef LM_DETAIL_PATCH_H
#define LM_DETAIL_PATCH_H

#include "lm/detail_reader.h"
#include "lm/geo.h"
#include "lm/scan_line.h"
#include "lm/target_patch.h"

enum {
    LM_DETAIL_SHAPES_MAX = 1536, /* of a patch: a town of 400 m2 a house at cells of 3 m */
    LM_DETAIL_ENTRIES_MAX = 4096,
    LM_DETAIL_BLOCK_LINES = 8,
    LM_DETAIL_BLOCKS = LM_PATCH_LINES_MAX / LM_DETAIL_BLOCK_LINES,
    LM_DETAIL_LAYERS = 3,
    LM_DETAIL_CELLS_A_LINE = 2 * LM_CELLS_MAX /* bounds the cost of a line */
};

/* Item in the coordinates of a patch, which count from the middle of cell 0 of line 0. */
struct lm_detail_shape {
    int32_t line_q8, cell_q8; /* middle */
    int32_t elevation_m_q14;  /* of the terrain there: a building stands level on it */
    /* Change of u (along the length) and v (along the width), in half sides, a line and a cell. */
    int32_t u_line_q16, u_cell_q16, v_line_q16, v_cell_q16;
    uint32_t height_codes; /* a nibble for each eighth of |v|; of a surface the classes it covers */
    uint8_t gamma_code, class_number;
    uint8_t kind;                  /* enum lm_detail_kind */
    uint8_t layer;                 /* surfaces lie in 0 and 1, what stands in 2 */
    uint16_t first_line, end_line; /* lines that it may touch */
};

/* Tile with detail: its cells of structures show `under`. */
struct lm_detail_tile {
    uint32_t row, column;
    uint16_t under;
};

/* Detail of a patch. The caller owns it; all fields are read-only to others. */
struct lm_detail_patch {
    uint32_t tile_count, shape_count;
    uint32_t left_out;   /* items for which there was no room, of all patches: only grows */
    uint16_t structures; /* bit n: class n is of the kind structure */
    struct lm_detail_tile tile[LM_DETAIL_TILES_MAX];
    struct lm_detail_shape shape[LM_DETAIL_SHAPES_MAX];
    /* Shapes of each block of lines: entry[first[b]] .. entry[first[b + 1] - 1]. */
    uint16_t first[LM_DETAIL_BLOCKS + 1], entry[LM_DETAIL_ENTRIES_MAX];
};

/* Begin a patch. `left_out` stays: the owner zeroes it once. */
void lm_detail_patch_clear(struct lm_detail_patch *p, const struct lm_db *db);

/* Add the items of the record that the reader has at hand, on the terrain of its tile. `lobe` is
 * the half-power width of a line's glint. Cost: some 5,000 instructions, and 400 an item. */
void lm_detail_patch_add(struct lm_detail_patch *p, const struct lm_detail_reader *r,
                         struct lm_tile_cache *tiles, const struct lm_patch_geometry *g,
                         fx_bam_t lobe);

/* Sort the shapes by lines, and in each block of lines by layers: items of different tiles may lie
 * on each other. Cost: some 30 instructions a shape. */
void lm_detail_patch_close(struct lm_detail_patch *p);

/* Draw the detail of line `line` into its cells, which were read by a scan that tells its runs.
 * Cost: 3 instructions a cell, 13 for a shape that the line's block holds, 100 for one that the
 * line meets, and 5 for a cell that is drawn, at most LM_DETAIL_CELLS_A_LINE of them; four cells of
 * a surface cost and count as one. */
void lm_detail_patch_draw(const struct lm_detail_patch *p, uint32_t line,
                          struct lm_scan_line *ground, uint32_t cells);

#endif
