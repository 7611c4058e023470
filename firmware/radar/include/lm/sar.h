/* SAR patch: a synthetic-aperture picture of cells x cells, drawn once. Its lines are parallel to
 * the line of sight, and its cell is the same in range and across.
 *
 * Order of the calls: lm_sar_start, then lm_sar_prefetch for some lines and lm_sar_prefetch_targets
 * while tiles are read, then for each line lm_sar_sample_ahead until it says true, and
 * lm_sar_draw_line until s->line is radar->sar.cells. The order of the stages behind them is in
 * lm/line.h. Only lm_sar_start fails; every call runs in bounded time.
 *
 * Source: docs/EQUATIONS.md, "Synthetic aperture". */
#ifndef LM_SAR_H
#define LM_SAR_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/defocus.h"
#include "lm/foreground.h"
#include "lm/layover.h"
#include "lm/line.h"
#include "lm/patch_rain.h"
#include "lm/radar.h"
#include "lm/sar_command.h"
#include "lm/target_patch.h"
#include "lm/tone.h"

enum {
    LM_SAR_GUARD = 4,             /* cells before the patch that are traced and not shown */
    LM_SAR_FOREGROUND_LINES = 16, /* lines from one run-up that is traced to the next */

    /* A point is spread over lines before its own, and those are smeared: lines are sampled so many
     * before they are drawn, and kept as long as a smear needs them. */
    LM_SAR_AHEAD = LM_RESPONSE_REACH + LM_DEFOCUS_REACH,
    LM_SAR_RING = LM_SAR_AHEAD + LM_DEFOCUS_REACH + 1
};

/* Shortest time from a line to the next. A patch whose dwell is shorter than all its lines together
 * takes as long as the lines. */
enum { LM_SAR_LINE_MIN_US = 500 };

/* Flight of the aircraft while it makes a patch. Dwell and limits depend on it. */
struct lm_sar_flight {
    uint32_t speed_mm_s;    /* over the ground */
    fx_bam_t track;         /* of that velocity */
    fx_bam_t bearing;       /* of the patch, from the aircraft */
    fx_bam_t heading;       /* of the nose */
    uint32_t lateral_mm_s2; /* how hard it turns: what motion compensation leaves of it blurs */
};

/* Surroundings of a patch at its start. */
struct lm_sar_setup {
    const struct lm_sar_flight *flight;  /* NULL for a commanded place in the air; read at once */
    const struct lm_target_set *targets; /* borrowed; NULL: none */
    struct lm_chips *chips;              /* borrowed; NULL: every signature is a point */
    int32_t reference_m_q10;             /* elevation of the patch, metres * 1024 */
    uint32_t epoch;                      /* of noise and of what fluctuates */
    uint8_t sea_state;
    const struct lm_environment *environment; /* rain and jammers; NULL: none; read at once */
    uint64_t time_us;                         /* movers are where they are then */
};

/* State of a patch. Set up by lm_sar_start; the caller owns it, and all fields are read-only to
 * others. */
struct lm_sar {
    const struct lm_radar *radar; /* borrowed */
    struct lm_sar_command command;
    uint64_t line_us;  /* from line to line: the dwell's share */
    uint32_t dwell_ms; /* below 2^17 */
    struct lm_ground_patch ground,
        foreground_ground; /* with the guard cells; what lies before them */
    struct lm_range_grid grid;
    struct lm_foreground foreground;
    uint8_t lod; /* of the database */
    struct lm_class_lut class_lut;
    struct lm_texture texture;
    const struct lm_target_set *targets; /* borrowed; NULL: none */
    struct lm_chips *chips;              /* borrowed; NULL: none */
    uint64_t time_us;                    /* of the targets' places */
    uint32_t epoch;                      /* of what fluctuates */
    uint32_t noise_epoch;                /* the same for this patch alone */
    int32_t across_mm_s;                 /* velocity to the right of the line of sight */
    int32_t floor_db_q8;                 /* of noise, jammers' included; dB of gamma */
    struct lm_patch_rain rain;
    struct lm_layover layover;
    uint32_t defocus_lines_q8; /* width of the smear, lines * 256; 256: none */
    struct lm_patch_geometry geometry;
    struct lm_target_candidates candidates;

    uint32_t second_foreground;      /* number of the second of two that were traced; 0: none was */
    lm_horizon_q40_t foregrounds[2]; /* the horizons behind them */
    lm_horizon_q40_t horizon;        /* where the line traced last started */
    uint32_t line;                   /* next to be drawn; done when it is radar->sar.cells */
    uint32_t sampled, summed;        /* lines that are in the ring, and that have the points */
    bool has_target_patch;           /* the targets' were found, */
    uint32_t hidden_known;           /* and so many of them looked at, whether they are hidden */
    struct lm_target_patch target_patch;            /* of the targets, from the first line on */
    int32_t ring_db_q8[LM_SAR_RING][LM_CELLS_ROOM]; /* levels of line n at n % LM_SAR_RING */
    uint64_t power_q32[LM_CELLS_ROOM];              /* scratch */
};

/* Start a patch. The command's geometry must be complete: the caller resolves is_from_ownship.
 * Returns LM_OK, or LM_ERR_RANGE with *s unchanged when
 * - cell_mm is outside the table's cell_min_mm..cell_max_mm;
 * - range_m is outside 1,000..250,000, or the patch would begin nearer than 16 LM_RANGE_MIN_M;
 * - height_m_q6 is more than 30 km above or below mean sea level;
 * - in flight (scene->flight), the squint is below the table's squint_min;
 * - in flight, the bearing is off the nose by more than the antenna's azimuth_limit;
 * - in flight, the dwell is longer than the table's dwell_max_ms.
 * A commanded place in the air has none of the last three limits. Its dwell is that of an aircraft
 * that passes at the table's reference speed, with the patch abeam to the right. Cost: a little
 * more than lm_sar_set_reference. */
int lm_sar_start(struct lm_sar *s, const struct lm_radar *radar, const struct lm_db *db,
                 const struct lm_sar_command *command, const struct lm_sar_setup *setup);

/* Change the patch's reference elevation (metres * 1024) and restart it. Called when a finer tile
 * arrives after lm_sar_start. Dwell and limits are not recomputed. Cost: about 60 k instructions.
 */
void lm_sar_set_reference(struct lm_sar *s, const struct lm_db *db, int32_t reference_m_q10);

/* Time until the last line is due, microseconds. */
uint64_t lm_sar_time_to_go_us(const struct lm_sar *s);

/* Ask for the tiles of line `line` (0..radar->sar.cells - 1) and of the ground before it. */
void lm_sar_prefetch(const struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t line);

/* Select the targets that the patch may show, and ask for their chips. */
void lm_sar_prefetch_targets(struct lm_sar *s, struct lm_tile_cache *tiles);

/* Take samples that the next line needs, at most `at_most` of them. True when the line has all;
 * false: call again. The first line needs LM_SAR_AHEAD + 1 samples, which is more than one line has
 * time for. Cost: about 9 k instructions a sample of 256 cells. */
bool lm_sar_sample_ahead(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t at_most,
                         struct lm_line *line);

/* Draw the next line and move on. Call while s->line < radar->sar.cells. The first cell of the
 * display stands at index LM_SAR_GUARD of line->grey and of the levels (dB * 256) that are
 * returned; the levels are valid until the next call. line->ground belongs to the line sampled
 * last, which is up to LM_SAR_AHEAD lines further on. Samples that lm_sar_sample_ahead has not
 * taken are taken here. Cost without them: about 640 instructions for 256 cells without defocus. */
const int32_t *lm_sar_draw_line(struct lm_sar *s, struct lm_tile_cache *tiles,
                                const struct lm_tone *tone, struct lm_line *line);

/* Sample line `number`: the stages from the map to noise and speckle, without points of targets and
 * without defocus. Leaves its cells in line->ground, its levels (dB * 256) from
 * level_db_q8[LM_SAR_GUARD] on, and in s->horizon the horizon that it started with. For tests; part
 * of lm_sar_draw_line. */
void lm_sar_sample_line(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t number,
                        struct lm_line *line, int32_t *level_db_q8);

/* Restart the patch from its first line; samples and targets are taken again. */
void lm_sar_restart(struct lm_sar *s);

#endif
