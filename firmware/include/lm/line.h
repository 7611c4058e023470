/* One azimuth line from the map to grey: the stages in their order. */
#ifndef LM_LINE_H
#define LM_LINE_H

#include "lm/aspect.h"
#include "lm/scan_line.h"
#include "lm/speckle.h"
#include "lm/target_line.h"
#include "lm/tone.h"

/* Specific targets that a line may meet. */
struct lm_line_targets {
    const struct lm_target *items;      /* borrowed */
    const struct lm_targets_near *near; /* borrowed: chosen for this sweep or patch */
    struct lm_target_line where;
};

/* What the stages of a line read and do not change. All borrowed. */
struct lm_line_setup {
    const struct lm_range_grid *grid;
    const struct lm_aspect_config *aspect;
    const struct lm_speckle_config *speckle;
    const struct lm_tone *tone;
    const struct lm_line_targets *targets; /* NULL: none */
    struct lm_sampling sampling;
};

/* What the stages hand on. Kept by the caller, so that a bench or a test can look at each. */
struct lm_line {
    struct lm_scan_line ground;
    struct lm_sight sight;
    uint8_t grey[LM_CELLS_ROOM];
};

/* Draw the grid's cells along the path. Returns the horizon behind the last cell. */
lm_horizon_q40_t lm_line_render(struct lm_line *line, struct lm_tile_cache *tiles,
                                const struct lm_line_setup *setup,
                                const struct lm_ground_path *path, lm_horizon_q40_t horizon);

#endif
