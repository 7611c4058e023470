/* One line from the map to levels: the stages that sector and patch have in common. */
#ifndef LM_LINE_H
#define LM_LINE_H

#include "lm/aspect.h"
#include "lm/scan_line.h"
#include "lm/speckle.h"
#include "lm/target_line.h"

/* Specific targets that a line may meet. */
struct lm_line_targets {
    const struct lm_targets_near *near; /* borrowed: chosen for this sweep or patch */
    struct lm_target_line where;
};

/* What the stages of a line read and do not change. What is pointed to is borrowed. */
struct lm_line_setup {
    const struct lm_range_grid *grid;
    const struct lm_legend *legend;
    const struct lm_texture *texture;
    struct lm_raster raster; /* of the texture */
    uint8_t level;           /* of the database */
};

/* What the stages hand on. Kept by the caller, so that a bench or a test can look at each. */
struct lm_line {
    struct lm_scan_line ground;
    struct lm_sight sight;
    uint8_t grey[LM_CELLS_ROOM];
};

/* Trace the grid's cells along the path: line->ground, and line->sight with texture and sea in its
 * levels. Returns the horizon behind the last cell. */
lm_horizon_q40_t lm_line_trace(struct lm_line *line, struct lm_tile_cache *tiles,
                               const struct lm_line_setup *setup, const struct lm_ground_path *path,
                               lm_horizon_q40_t horizon);

/* Add what targets return. Behind speckle, which belongs to the clutter: what a target
 * returns is its own, and a chip brings its cells' speckle along. */
void lm_line_add_targets(struct lm_line *line, const struct lm_range_grid *grid,
                         const struct lm_line_targets *targets);

#endif
