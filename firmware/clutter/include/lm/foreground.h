/* Run-ups, lines that are not shown themselves: the highest look over one, and nothing of what
 * lm/aspect.h works out for a line that is. docs/EQUATIONS.md, "Illumination". */
#ifndef LM_FOREGROUND_H
#define LM_FOREGROUND_H

#include "lm/illumination.h"

/* What lm_illuminate returns for such a line when it starts with LM_HORIZON_OPEN. Cost: 3
 * instructions a cell on a machine with vectors of eight. */
lm_horizon_q40_t lm_foreground_line_horizon(const struct lm_range_grid *grid,
                                            const struct lm_class_lut *class_lut,
                                            const struct lm_scan_line *line);

/* Coarse cells from a sixteenth of the way up to where a window or a patch begins, for what throws
 * shadows into it. */
enum { LM_FOREGROUND_CELLS = 128 };
struct lm_foreground {
    uint32_t start_m_q8,
        cell_m_q8; /* ground range where the first begins, and of each; metres * 256 */
    uint8_t lod;   /* of the database */
    struct lm_range_grid grid;
};

/* Up to ground range `end_m_q8`, of a metre or more, for a line that goes on in `behind`.
 * Cost: that of lm_range_grid_set. */
void lm_foreground_set(struct lm_foreground *f, const struct lm_db *db,
                       const struct lm_illumination_config *config, uint32_t end_m_q8,
                       const struct lm_range_grid *behind);

/* The horizon behind it along a path of LM_FOREGROUND_CELLS cells; `line` is used for work. */
lm_horizon_q40_t lm_foreground_horizon(const struct lm_foreground *f,
                                       const struct lm_class_lut *class_lut,
                                       struct lm_tile_cache *tiles,
                                       const struct lm_ground_path *path,
                                       struct lm_scan_line *line);

#endif
