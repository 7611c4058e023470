/* What stands along one azimuth line: a cell of the map, its elevation and its noise for every
 * range cell. docs/DESIGN.md, "What stands there". */
#ifndef LM_SCAN_LINE_H
#define LM_SCAN_LINE_H

#include <stdint.h>

#include "lm/config.h"
#include "lm/geo.h"
#include "lm/tile_cache.h"

enum { LM_CELL_NONE = 0x00F0 }; /* no data: class 15, reflectivity code 0 */

/* The stages work in whole groups of LM_LANES, as many numbers as a wide vector holds; what they
 * write behind the last cell means nothing. */
enum { LM_LANES = 8, LM_CELLS_ROOM = LM_CELLS_MAX + LM_LANES };

struct lm_scan_line {
    uint32_t cell[LM_CELLS_ROOM];         /* as in the tile record, or LM_CELL_NONE */
    uint32_t noise[LM_CELLS_ROOM];        /* a hash of the noise cell and the epoch: lm/speckle.h */
    int32_t elevation_q14[LM_CELLS_ROOM]; /* terrain, metres * 16384; 0 where there is no data */
};

/* How a line samples the map. */
struct lm_sampling {
    uint8_t level;       /* of the database */
    uint8_t noise_shift; /* a noise cell is 2^noise_shift BAM, less than a tile of the level */
    uint32_t epoch;      /* of the look: another one gives other noise */
};

/* The level whose cell is the largest not longer than cell_mm (level 0 when all are), and the noise
 * cell, the largest power of two not longer than cell_mm / sqrt 2 and shorter than a tile. */
struct lm_sampling lm_sampling_for(const struct lm_db *db, uint32_t cell_mm, uint32_t epoch);

/* Fill the first `cells` (1..LM_CELLS_MAX) entries along the path. Tiles that are not resident are
 * answered by an ancestor and asked for (tile_cache.h counts them). Places differ from the path's
 * by at most 2^-10 of a cell of the tile that answers. Noise cells are counted from the equator and
 * from Greenwich, with a sign. Cost: see docs/benchmarks.md; some 150 instructions for each tile
 * that is crossed. */
void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles,
                      const struct lm_sampling *sampling, const struct lm_ground_path *path,
                      uint32_t cells);

/* Ask for the tiles that lm_scan_line_run would use, without reading a cell. */
void lm_scan_line_prefetch(struct lm_tile_cache *tiles, const struct lm_sampling *sampling,
                           const struct lm_ground_path *path, uint32_t cells);

/* Elevation at one place from whatever is resident, metres * 1024; `otherwise_q10` where nothing
 * is. */
int32_t lm_scan_elevation(struct lm_tile_cache *tiles, uint8_t level, struct lm_place place,
                          int32_t otherwise_q10);

#endif
