/* Horizon of the foreground: the terrain between the antenna and a window or patch.
 *
 * Only its highest tangent of elevation is computed, because these cells throw shadows and are not
 * displayed. lm_illuminate starts from it. Law: docs/EQUATIONS.md, "Horizon at the start of a
 * line".
 *
 *     antenna                 LM_FOREGROUND_CELLS coarse cells           displayed cells
 *        o        |-------|-------|-------|--   --|-------|-------|---|---|---|---|
 *        |        |                                               |
 *        0       1/16 of the way                                end_m_q8           */
#ifndef LM_FOREGROUND_H
#define LM_FOREGROUND_H

#include "lm/illumination.h"

/* Horizon behind the last cell of a line that starts with LM_HORIZON_OPEN. Equal to the result of
 * lm_illuminate, without levels. LM_HORIZON_OPEN if all cells of the grid are too near.
 * Cost: 3 instructions a cell on a machine with vectors of eight. */
lm_horizon_q40_t lm_foreground_line_horizon(const struct lm_range_grid *grid,
                                            const struct lm_class_lut *class_lut,
                                            const struct lm_scan_line *line);

/* Foreground of the lines of a window or patch, prepared once for all of them. */
enum { LM_FOREGROUND_CELLS = 128 };
struct lm_foreground {
    uint32_t start_m_q8; /* ground range where the first cell begins */
    uint32_t cell_m_q8;  /* length of a cell */
    uint8_t lod;         /* that its cells are read from */
    struct lm_range_grid grid;
};

/* Prepare the foreground up to ground range end_m_q8, a metre or more. Antenna and reference
 * elevation are those of `behind`, the grid that follows. All pointers are borrowed for the call.
 * Cost: that of lm_range_grid_set. */
void lm_foreground_set(struct lm_foreground *f, const struct lm_db *db,
                       const struct lm_illumination_config *config, uint32_t end_m_q8,
                       const struct lm_range_grid *behind);

/* Trace the foreground along a path of LM_FOREGROUND_CELLS cells, and return the horizon behind it.
 * Tiles that are not resident are requested. `line` is work space and overwritten. All pointers are
 * borrowed for the call. Cost: that of lm_scan_line_run and lm_foreground_line_horizon. */
lm_horizon_q40_t lm_foreground_horizon(const struct lm_foreground *f,
                                       const struct lm_class_lut *class_lut,
                                       struct lm_tile_cache *tiles,
                                       const struct lm_ground_path *path,
                                       struct lm_scan_line *line);

#endif
