/* A SAR patch: parallel lines along the line of sight, constant cell both ways. */
#ifndef LM_SAR_H
#define LM_SAR_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/defocus.h"
#include "lm/horizon.h"
#include "lm/layover.h"
#include "lm/line.h"
#include "lm/patch_rain.h"
#include "lm/radar.h"
#include "lm/sar_command.h"
#include "lm/target_patch.h"
#include "lm/tone.h"

enum {
    LM_SAR_GUARD = 4,        /* cells before the patch that are traced and not shown */
    LM_SAR_RUNUP_LINES = 16, /* lines from one run-up that is traced to the next */

    /* A point is spread over lines before its own, and those are smeared: lines are sampled so many
     * before they are drawn, and kept as long as a smear needs them. */
    LM_SAR_AHEAD = LM_RESPONSE_REACH + LM_DEFOCUS_REACH,
    LM_SAR_RING = LM_SAR_AHEAD + LM_DEFOCUS_REACH + 1
};

/* No line is drawn faster: a dwell shorter than that of all lines takes as long as they do. */
enum { LM_SAR_LINE_MIN_US = 500 };

/* How the aircraft flies while it makes a patch: what the dwell and the limits depend on. */
struct lm_sar_flight {
    uint32_t speed_mm_s;    /* over the ground */
    fx_bam_t track;         /* of that velocity */
    fx_bam_t bearing;       /* of the patch, from the aircraft */
    fx_bam_t heading;       /* of the nose */
    uint32_t lateral_mm_s2; /* how hard it turns: what motion compensation leaves of it blurs */
};

/* What a patch finds when it begins. */
struct lm_sar_scene {
    const struct lm_sar_flight *flight;  /* NULL for a commanded place in the air; read at once */
    const struct lm_target_set *targets; /* borrowed; NULL: none */
    struct lm_chips *chips;              /* borrowed; NULL: every signature is a point */
    int32_t reference_q10;               /* elevation of the patch, metres * 1024 */
    uint32_t epoch;                      /* of noise and of what fluctuates */
    uint8_t sea_state;
    const struct lm_environment *environment; /* rain and jammers; NULL: none; read at once */
    uint64_t time_us;                         /* movers are where they are then */
};

/* A patch that is being drawn. Set up by lm_sar_start. */
struct lm_sar {
    const struct lm_radar *radar; /* borrowed */
    struct lm_sar_command command;
    uint64_t line_us;                            /* from line to line: the dwell's share */
    uint32_t dwell_ms;                           /* below 2^17 */
    struct lm_ground_patch ground, runup_ground; /* with the guard cells; what lies before them */
    struct lm_range_grid grid;
    struct lm_runup runup;
    uint8_t level; /* of the database */
    struct lm_legend legend;
    struct lm_texture texture;
    const struct lm_target_set *targets; /* borrowed; NULL: none */
    struct lm_chips *chips;              /* borrowed; NULL: none */
    uint64_t time_us;                    /* of the targets' places */
    uint32_t epoch;                      /* of what fluctuates */
    uint32_t noise_epoch;                /* the same for this patch alone */
    int32_t across_mm_s;                 /* velocity to the right of the line of sight */
    int32_t floor_q8;                    /* of noise, jammers' included; dB of gamma */
    struct lm_patch_rain rain;
    struct lm_layover layover;
    uint32_t defocus_q8; /* width of the smear, lines * 256; 256: none */
    struct lm_patch_geometry geometry;
    struct lm_targets_near near;

    uint32_t second_runup;         /* number of the second of two that were traced; 0: none was */
    lm_horizon_q40_t runups[2];    /* the horizons behind them */
    lm_horizon_q40_t horizon;      /* where the line traced last started */
    uint32_t line;                 /* next to be drawn; done when it is radar->sar.cells */
    uint32_t sampled, summed;      /* lines that are in the ring, and that have the points */
    bool has_points;               /* the targets' were found, */
    uint32_t judged;               /* and so many of them looked at, whether they are hidden */
    struct lm_patch_points points; /* of the targets, from the first line on */
    int32_t ring_q8[LM_SAR_RING][LM_CELLS_ROOM]; /* levels of line n at n % LM_SAR_RING */
    uint64_t power_q32[LM_CELLS_ROOM];           /* scratch */
};

/* LM_OK, or LM_ERR_RANGE with *s unchanged: a cell, range or height outside the limits; and seen
 * from an aircraft in flight a squint below the table's, a bearing beyond the antenna's limit off
 * the nose, or a dwell beyond the table's. A commanded place in the air knows none of these three
 * limits; its dwell is that of an aircraft that flies by at the table's reference speed, the patch
 * abeam to the right. The command's geometry must be complete (is_from_ownship already resolved by
 * the caller). */
int lm_sar_start(struct lm_sar *s, const struct lm_radar *radar, const struct lm_db *db,
                 const struct lm_sar_command *command, const struct lm_sar_scene *scene);

/* Take another elevation for that of the patch, which begins anew: when the tile that knows it came
 * after the start. Dwell and limits stay as they were. Cost: about 60 k instructions. */
void lm_sar_set_reference(struct lm_sar *s, const struct lm_db *db, int32_t reference_q10);

/* Dwell that is left, microseconds. */
uint64_t lm_sar_time_to_go_us(const struct lm_sar *s);

/* Ask for the tiles of line `line` and of its run-up. */
void lm_sar_prefetch(const struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t line);

/* Choose the targets that the patch may show, and want their chips. */
void lm_sar_prefetch_targets(struct lm_sar *s, struct lm_tile_cache *tiles);

/* Take samples that the next line needs, at most `at_most` of them: the first line needs
 * LM_SAR_AHEAD + 1, which is more than the time of one line. True when it has all. */
bool lm_sar_sample_ahead(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t at_most,
                         struct lm_line *line);

/* Draw the next line: line->grey has its greys, its cells from [LM_SAR_GUARD] on, and so have the
 * levels that it returns, good until the next call; line->ground is that of the line sampled last,
 * up to LM_SAR_AHEAD lines on, which the first line brings at once. Call while s->line <
 * radar->sar.cells. */
const int32_t *lm_sar_draw_line(struct lm_sar *s, struct lm_tile_cache *tiles,
                                const struct lm_tone *tone, struct lm_line *line);

/* One stage of that: line `number` from the map to noise and speckle, without targets and smear, in
 * line->ground, and its levels from level_q8[LM_SAR_GUARD] on. s->horizon is where it started. */
void lm_sar_sample_line(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t number,
                        struct lm_line *line, int32_t *level_q8);

/* Begin the patch again from its first line. */
void lm_sar_restart(struct lm_sar *s);

#endif
