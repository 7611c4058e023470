/* Run-ups, lines that are not shown themselves: the highest look over one, and nothing of what
 * lm/aspect.h works out for a line that is. docs/EQUATIONS.md, "Illumination". */
#ifndef LM_HORIZON_H
#define LM_HORIZON_H

#include "lm/aspect.h"

/* What lm_aspect_run returns for such a line when it starts with LM_HORIZON_OPEN. Cost: 3
 * instructions a cell on a machine with vectors of eight. */
lm_horizon_q40_t lm_horizon_behind(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line);

/* Coarse cells from a sixteenth of the way up to where a window or a patch begins, for what throws
 * shadows into it. */
enum { LM_RUNUP_CELLS = 128 };
struct lm_runup {
    uint32_t start_q8, cell_q8; /* ground range where the first begins, and of each; metres * 256 */
    uint8_t level;              /* of the database */
    struct lm_range_grid grid;
};

/* Up to ground range `end_q8`, of a metre or more, for a line that goes on in `behind`.
 * Cost: that of lm_range_grid_set. */
void lm_runup_set(struct lm_runup *r, const struct lm_db *db, const struct lm_aspect_config *config,
                  uint32_t end_q8, const struct lm_range_grid *behind);

/* The horizon behind it along a path of LM_RUNUP_CELLS cells; `line` is used for work. */
lm_horizon_q40_t lm_runup_trace(const struct lm_runup *r, const struct lm_legend *legend,
                                struct lm_tile_cache *tiles, const struct lm_ground_path *path,
                                struct lm_scan_line *line);

#endif
