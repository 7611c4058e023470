/* The horizon behind a run-up, a line that is not shown itself: the highest look over it, and
 * nothing of what lm/aspect.h works out for a line that is. docs/DESIGN.md, "What the radar sees of
 * it". */
#ifndef LM_HORIZON_H
#define LM_HORIZON_H

#include "lm/aspect.h"

/* What lm_aspect_run returns for such a line when it starts with LM_HORIZON_OPEN. Cost: 3
 * instructions a cell on a machine with vectors of eight. */
lm_horizon_q40_t lm_horizon_behind(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line);

#endif
