/* Line: the stages from the map to grey, in the order in which a sector and a patch run them.
 *
 *     stage                        sector (lm_sector_...)       patch (lm_sar_...)
 *     ---------------------------- ---------------------------- -----------------------------
 *     foreground                   lm_foreground_horizon        lm_foreground_horizon
 *     tiles to cells               lm_line_trace                lm_line_trace
 *     detail                       -                            lm_line_trace
 *     crests between cells         -                            lm_line_trace
 *     shadow, slope, edges         lm_line_trace                lm_line_trace
 *     class gain, sea              lm_line_trace                lm_line_trace
 *     shadows of targets           with the scatterers below    lm_target_patch_shade
 *     layover                      -                            lm_layover_run
 *     targets                      lm_line_add_targets          -
 *     chips of targets             with the scatterers above    lm_target_patch_add_chips
 *     rain                         with the receiver below      lm_patch_rain_run
 *     receiver noise               with the receiver below      lm_patch_floor_run
 *     speckle                      behind the pulse, below      lm_grain_floor_run
 *     side lobes of the ground     -                            lm_side_lobes_find, _add
 *     scatterers of targets        kept apart, joined below     lm_target_patch_add_scatterers
 *     elevation pattern            lm_antenna_pattern_apply     -
 *     ground range to slant range  lm_slant_run                 -
 *     azimuth                      lm_beam_sum                  lm_defocus_run
 *     pulse                        lm_receiver_pulse            -
 *     floor                        lm_sector_floor_run          -
 *     speckle, scatterers          lm_k_fade, lm_receiver_join  -
 *     noise, rain, jammers         lm_receiver_run              -
 *     level to grey                lm_tone_run                  lm_tone_run
 *
 * A sector's stages work on one azimuth (a sample) down to the slant range, and on a line of the
 * display from lm_beam_sum on. A patch's scatterers come after its speckle, because the echo of a
 * target has its own fluctuation. Its chips come before: like clutter, they are mean powers.
 *
 * This header holds the stages that both pictures share. lm/sector.h and lm/sar.h call the rest. */
#ifndef LM_LINE_H
#define LM_LINE_H

#include <stdbool.h>

#include "lm/class_gain.h"
#include "lm/detail_patch.h"
#include "lm/illumination.h"
#include "lm/scan_line.h"
#include "lm/sea.h"
#include "lm/target_line.h"

/* Targets that a line may meet, and the line's own geometry. */
struct lm_line_targets {
    const struct lm_target_candidates *candidates; /* borrowed; selected for this sweep or patch */
    const struct lm_target_candidates *live;       /* borrowed; selected for this line */
    struct lm_target_line where;
};

/* Set-up of the stages that lm_line_trace runs. No stage changes it. Pointers are borrowed for the
 * call. */
struct lm_line_setup {
    const struct lm_range_grid *grid;
    const struct lm_class_lut *class_lut;
    const struct lm_class_gain *class_gain;
    const struct lm_sea *sea;
    const struct lm_scan_blend *blend;    /* for the cells of the grid; NULL: off */
    uint8_t lod;                          /* LOD that the map is read from */
    bool has_crests;                      /* those between cells count: lm/crests.h */
    const struct lm_detail_patch *detail; /* drawn into the cells; NULL: none */
    uint32_t number;                      /* of the line in the patch that has the detail */
};

/* Work space and result of a line. The caller owns it, and a bench or a test can then read each
 * stage. One serves all lines; its content is valid until the next call that takes it. */
struct lm_line {
    struct lm_scan_line ground;  /* cells and elevations, read from the map */
    struct lm_lit_line lit;      /* horizon, and levels that the stages change in place */
    struct lm_lit_line steady;   /* of a sector: the same horizon, and levels of scatterers */
    uint8_t grey[LM_CELLS_ROOM]; /* result: 0..255 for each cell of the display line */
};

/* Trace the grid's cells along `path`: fill line->ground, and line->lit with the class gain in its
 * levels. `horizon` is that of the ground before the first cell. Returns the horizon behind
 * the last cell. A cell whose tile is not resident is read from a coarser tile, and its own tile is
 * requested. Cost: docs/benchmarks.md. */
lm_horizon_q40_t lm_line_trace(struct lm_line *line, struct lm_tile_cache *tiles,
                               const struct lm_line_setup *setup, const struct lm_ground_path *path,
                               lm_horizon_q40_t horizon);

/* Find the returns of targets that the line's horizon does not hide. Chips go into
 * line->lit.level_db_q8: like the ground they are means, and take its speckle. Scatterers fluctuate
 * by themselves: line->steady gets their levels, with LM_LEVEL_SHADOW where there is none. False,
 * with line->steady of no meaning, if the line meets no target. Cost: that of lm_target_line_add.
 */
bool lm_line_add_targets(struct lm_line *line, const struct lm_range_grid *grid,
                         const struct lm_line_targets *targets);

#endif
