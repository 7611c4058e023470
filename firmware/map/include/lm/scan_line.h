/* Scan line: the map's cell and the terrain's elevation for every cell of a range line.
 * Law: docs/EQUATIONS.md, "Ground in a cell".
 *
 *     antenna                                                       far
 *        o----|-----|-----|-----|-----|- path, in cells of the line -->
 *             cell[0]                       gamma code, class, height code
 *             elevation_m_q14[0]            terrain
 *
 * Example: the ground along a path (lm/geo.h), from tiles that are resident.
 *
 *     static struct lm_scan_line line;
 *     const uint8_t lod = lm_scan_lod(cache.db, cell_mm);
 *     lm_scan_line_run(&line, &cache, lod, NULL, &path, 512);
 *
 * No function waits for the flash, and none fails. Pointers are borrowed for the call. */
#ifndef LM_SCAN_LINE_H
#define LM_SCAN_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/geo.h"
#include "lm/lanes.h"
#include "lm/tile_cache.h"

/* A cell without data: class 15, reflectivity code 0, height code 0. */
enum { LM_CELL_NONE = 0x00F0 };

/* Tiles that a line may cross. Its cells are no longer than those of the LOD that is read, but for
 * an eighth: LM_CELLS_MAX of them cross 10 rows and 20 columns, zones and turns included. */
enum { LM_SCAN_RUNS_MAX = 64 };

/* Cells of a line that lie in one tile of the LOD. */
struct lm_scan_run {
    uint32_t row, column;
    uint32_t end; /* first cell behind them */
};

struct lm_scan_line {
    /* Lower half: as in struct lm_tile_point, or LM_CELL_NONE. Upper half: what to add to its
     * reflectivity, 1/256 dB, signed; 0 unless blended. */
    uint32_t cell[LM_CELLS_ROOM];
    int32_t elevation_m_q14[LM_CELLS_ROOM]; /* above mean sea level; 0 where there is no data */
    uint8_t coarsest_lod;                   /* of the tiles that answered with data */
    uint16_t coarse_cells;                  /* cells in runs that an ancestor answered with data */
    uint32_t run_count;
    struct lm_scan_run run[LM_SCAN_RUNS_MAX]; /* in their order; told if the caller asks for them */
};

/* LOD for a line whose cells are cell_mm long: the LOD whose cell is the largest that is not longer
 * by more than an eighth, so that a line steps over few cells of the map and no crest. 0 if all are
 * longer. */
uint8_t lm_scan_lod(const struct lm_db *db, uint32_t cell_mm);

/* Blend: how a line is read whose cells are shorter than the map's. Prepared once a picture. Law:
 * docs/EQUATIONS.md, "Finer than the map". */
struct lm_scan_blend {
    bool is_on, is_stepped;                       /* of tiles of the finest LOD */
    uint32_t natural, crowned, flat, grown_shift; /* with is_stepped, as in struct lm_k_blend */
    uint32_t trees, cell_mm;                      /* what other LODs are blended by */
    bool tells_runs; /* which tiles the line crosses is told, be is_on or not; false at first */
};

/* Prepare the blend for lines whose cells are cell_mm long, below 2^30. It is on if they are
 * shorter than 2/3 of the map's cell: that of the finest LOD, or where the map has no tile of it,
 * of the one that answers. Crowns are drawn if cells are shorter than 3.5 m, half a crown, and the
 * map's are not. What has grown is read by its nearest texel if they are 3/2 of one or longer. `db`
 * is borrowed for the call. Cost: 150 instructions. */
void lm_scan_blend_set(struct lm_scan_blend *b, const struct lm_db *db, uint32_t cell_mm);

/* Read the first `cells` (1..LM_CELLS_MAX) entries along the path.
 *
 * - A tile that is not resident is requested. Its nearest resident ancestor answers for it; where
 *   there is none, the cells are LM_CELL_NONE. lm/tile_cache.h counts both.
 * - Points lie within 2^-10 of a cell of the path's, in lines of 1024 cells within 2^-9. The cell
 * is one of the tile that answers.
 * - If `blend` is on, tiles of the LOD itself are blended: lm_k_tile_blend says what `line` gets.
 *   So are ancestors of cells as much longer than the line's, where the map has nothing finer; not
 *   those that answer for a tile which is late. `blend` may be NULL; one that is on needs the
 *   finest LOD.
 *
 * `tiles` is changed: its clock, requests and counts. Cost: see docs/benchmarks.md; some 75
 * instructions for each tile that the line crosses. */
void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles, uint8_t lod,
                      const struct lm_scan_blend *blend, const struct lm_ground_path *path,
                      uint32_t cells);

/* Request the tiles that lm_scan_line_run would use, without reading a cell. */
void lm_scan_line_prefetch(struct lm_tile_cache *tiles, uint8_t lod,
                           const struct lm_ground_path *path, uint32_t cells);

/* Elevation at one position, in metres * 1024, from the resident tile or its nearest resident
 * ancestor. fallback_m_q10 if neither is resident. A tile that is missing is requested. */
int32_t lm_scan_elevation(struct lm_tile_cache *tiles, uint8_t lod, struct lm_position position,
                          int32_t fallback_m_q10);

/* The cell there, as in struct lm_scan_line; LM_CELL_NONE if no tile is resident. */
uint16_t lm_scan_cell(struct lm_tile_cache *tiles, uint8_t lod, struct lm_position position);

#endif
