/* What stands along one azimuth line: a cell of the map and its elevation for every range cell.
 * docs/EQUATIONS.md, "Ground in a cell". */
#ifndef LM_SCAN_LINE_H
#define LM_SCAN_LINE_H

#include <stdint.h>

#include "lm/geo.h"
#include "lm/lanes.h"
#include "lm/tile_cache.h"

enum { LM_CELL_NONE = 0x00F0 }; /* no data: class 15, reflectivity code 0 */

struct lm_scan_line {
    uint32_t cell[LM_CELLS_ROOM];           /* as in the tile record, or LM_CELL_NONE */
    int32_t elevation_m_q14[LM_CELLS_ROOM]; /* terrain, metres * 16384; 0 where there is no data */
};

/* The level that a line of cells of cell_mm reads: the one whose cell is the largest not longer
 * than that (level 0 when all are). */
uint8_t lm_scan_lod(const struct lm_db *db, uint32_t cell_mm);

/* Fill the first `cells` (1..LM_CELLS_MAX) entries along the path. Tiles that are not resident are
 * answered by an ancestor and asked for (tile_cache.h counts them). Places differ from the path's
 * by at most 2^-10 of a cell of the tile that answers, 2^-9 in lines of 1024. Cost: see
 * docs/benchmarks.md; some 75 instructions for each tile that is crossed. */
void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles, uint8_t lod,
                      const struct lm_ground_path *path, uint32_t cells);

/* Ask for the tiles that lm_scan_line_run would use, without reading a cell. */
void lm_scan_line_prefetch(struct lm_tile_cache *tiles, uint8_t lod,
                           const struct lm_ground_path *path, uint32_t cells);

/* Elevation at one place from whatever is resident, metres * 1024; `fallback_m_q10` where nothing
 * is. */
int32_t lm_scan_elevation(struct lm_tile_cache *tiles, uint8_t lod, struct lm_position position,
                          int32_t fallback_m_q10);

#endif
