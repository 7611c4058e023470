/* A SAR patch: parallel lines along the line of sight, constant cell both ways. */
#ifndef LM_SAR_H
#define LM_SAR_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/controls.h"
#include "lm/line.h"
#include "lm/radar.h"
#include "lm/tone.h"

enum {
    LM_SAR_GUARD = 4,      /* cells before the patch that are traced and not shown */
    LM_SAR_RUNUP = 128,    /* coarse cells between the antenna and the patch */
    LM_SAR_RUNUP_LINES = 8 /* lines that share a run-up */
};

/* A patch that is being drawn. Set up by lm_sar_start. */
struct lm_sar {
    const struct lm_radar *radar; /* borrowed */
    struct lm_sar_command command;
    struct lm_ground_patch ground;
    struct lm_range_grid grid, runup_grid;
    struct lm_sampling sampling, runup_sampling;
    struct lm_texture texture;
    const struct lm_target_set *targets; /* borrowed; NULL: none, as after lm_sar_start */
    struct lm_targets_near near;
    uint32_t epoch;           /* of noise and of what fluctuates */
    lm_horizon_q40_t horizon; /* where the lines of this run-up start */
    uint32_t line;            /* next to be drawn; command done when it is radar->sar_cells */
};

/* LM_OK, or LM_ERR_RANGE for a cell, range or height outside the limits, with *s unchanged.
 * `reference_q10` is the elevation of the patch, metres * 1024; `epoch` that of its noise. The
 * command's geometry must be complete (is_from_ownship already resolved by the caller). */
int lm_sar_start(struct lm_sar *s, const struct lm_radar *radar, const struct lm_db *db,
                 const struct lm_sar_command *command, int32_t reference_q10, uint32_t epoch);

/* Ask for the tiles of line `line` and of its run-up. */
void lm_sar_prefetch(const struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t line);

/* Draw the next line: its sar_cells greys are line->grey[LM_SAR_GUARD ..]. Call while s->line <
 * sar_cells. */
void lm_sar_draw_line(struct lm_sar *s, struct lm_tile_cache *tiles, const struct lm_tone *tone,
                      struct lm_line *line);

#endif
