/* Order of the stages of one line, from the map to grey, for both kinds of picture.
 *
 *     stage                        sector (lm_sector_...)       patch (lm_sar_...)
 *     ---------------------------- ---------------------------- -----------------------------
 *     ground before the picture    lm_foreground_horizon               lm_foreground_horizon
 *     tiles to cells               lm_line_trace                lm_line_trace
 *     shadow, slope, edges         lm_line_trace                lm_line_trace
 *     texture and sea state        lm_line_trace                lm_line_trace
 *     layover                      -                            lm_layover_run
 *     chips of targets             with the points below        lm_target_patch_shade, _add
 *     rain                         with the receiver below      lm_patch_rain_run
 *     receiver noise               with the receiver below      lm_speckle_floor_run
 *     speckle                      lm_speckle_run               lm_speckle_run, _floor_run
 *     points of targets            lm_line_add_targets          lm_target_patch_add_scatterers
 *     elevation pattern            lm_antenna_pattern_apply             -
 *     ground range to slant range  lm_slant_run                 -
 *     azimuth                      lm_beam_sum                  lm_defocus_run
 *     pulse, noise, rain, jammers  lm_receiver_run              -
 *     level to grey                lm_tone_run                  lm_tone_run
 *
 * Down to the slant range a sector's stages work on one azimuth (a sample); from lm_beam_sum on
 * they work on a line of the display. A patch's targets come behind its speckle because what a
 * target returns is its own; its chips come before because their pixels replace the ground's.
 *
 * lm_line_trace and lm_line_add_targets hold what is the same in both; lm/sector.h and lm/sar.h
 * string the rest together. */
#ifndef LM_LINE_H
#define LM_LINE_H

#include "lm/illumination.h"
#include "lm/scan_line.h"
#include "lm/speckle.h"
#include "lm/target_line.h"

/* Targets that a line may meet. */
struct lm_line_targets {
    const struct lm_target_candidates *candidates; /* borrowed: chosen for this sweep or patch */
    struct lm_target_line where;
};

/* Input of the stages that lm_line_trace runs; none of them changes it. Pointers are borrowed. */
struct lm_line_setup {
    const struct lm_range_grid *grid;
    const struct lm_class_lut *class_lut;
    const struct lm_texture *texture;
    struct lm_noise_key noise_key; /* of the texture */
    uint8_t lod;                   /* of the database */
};

/* Work space of a line, and its result. The caller owns it, so that a bench or a test can look at
 * each stage. One is enough for all lines; nothing in it outlives the next call. */
struct lm_line {
    struct lm_scan_line ground;  /* cells and elevations, from the map */
    struct lm_lit_line lit;      /* horizon, and levels as the stages change them in place */
    uint8_t grey[LM_CELLS_ROOM]; /* result: 0..255 for each cell of the display line */
};

/* Trace the grid's cells along `path`: fill line->ground, and line->sight with texture and sea
 * state in its levels. `horizon` is that of the ground before the first cell. Returns the horizon
 * behind the last cell. Cells whose tile is not resident are read from a coarser one, and the tile
 * is asked for. */
lm_horizon_q40_t lm_line_trace(struct lm_line *line, struct lm_tile_cache *tiles,
                               const struct lm_line_setup *setup, const struct lm_ground_path *path,
                               lm_horizon_q40_t horizon);

/* Add to line->sight.level_q8 what targets return, except for those behind the horizon. Call it
 * after speckle: an echo of a target has its own fluctuation, and a chip brings its pixels'
 * speckle. */
void lm_line_add_targets(struct lm_line *line, const struct lm_range_grid *grid,
                         const struct lm_line_targets *targets);

#endif
