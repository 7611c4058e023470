/* SAR patch: a synthetic-aperture picture of a square of ground, drawn once.
 *
 * Its lines are rays from the antenna, as shadows are: line k keeps its direction from the first
 * cell of the foreground to the last of the patch. One dwell tells directions apart, so that a line
 * is as wide as a cell at the centre, narrower before it and wider behind it. The square needs more
 * lines than cells, because they are close together at its near edge.
 *
 * Order of the calls:
 * - lm_sar_start;
 * - while tiles are read: lm_sar_prefetch for some lines, and lm_sar_prefetch_targets;
 * - for each line: lm_sar_sample_ahead until it returns true, then lm_sar_draw_line;
 * - the patch is done when s->line is s->lines.
 *
 * Only lm_sar_start fails; every call runs in bounded time. lm/line.h has the order of the stages.
 *
 *     \ +------------------+ /   far end
 *      \|                  |/    what the glass shows: cells x cells
 *       \                  /     lines run from near to far; line 0 is at the left
 *       |\                /|
 *       +-\--------------/-+
 *          \  overscan  /        with layover, cells before the patch and behind its far end from
 *           \          /         where power is displaced: traced and not displayed
 *           \----------/
 *            \ fore-  /          from 1/16 of the way on: casts shadows into the patch;
 *             \ground/           traced along every LM_SAR_FOREGROUND_LINES-th line
 *              \    /
 *              antenna           not to scale
 *
 * Source: docs/EQUATIONS.md, "Synthetic aperture". */
#ifndef LM_SAR_H
#define LM_SAR_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/defocus.h"
#include "lm/detail_patch.h"
#include "lm/foreground.h"
#include "lm/grain.h"
#include "lm/layover.h"
#include "lm/line.h"
#include "lm/patch_floor.h"
#include "lm/patch_rain.h"
#include "lm/radar.h"
#include "lm/refusal.h"
#include "lm/sar_command.h"
#include "lm/side_lobes.h"
#include "lm/target_patch.h"
#include "lm/tone.h"

enum {
    LM_SAR_OVERSCAN_MAX = 48,     /* cells that are traced before the patch, or behind it */
    LM_SAR_FOREGROUND_LINES = 16, /* lines from one traced foreground to the next */

    /* Lines sampled ahead of the line that is drawn. Defocus smears the lines before their own, a
     * strong cell has side lobes on those, and it gives them once all around it are sampled. */
    LM_SAR_AHEAD = 2 * LM_RESPONSE_REACH + LM_DEFOCUS_REACH,
    /* Lines kept: those ahead, and those behind that defocus needs; and more, because a power of
     * two makes a place in the ring cheap. */
    LM_SAR_RING = 32
};

/* Side lobes of lines near the patch's ends reach beyond it. These places must be free: at most
 * LM_SAR_AHEAD lines ahead are sampled, and LM_DEFOCUS_REACH behind are needed. */
_Static_assert((int)LM_SAR_RING > LM_SAR_AHEAD + (int)LM_RESPONSE_REACH,
               "no place before line 0 is in use");
_Static_assert(LM_SAR_RING > 2 * ((int)LM_DEFOCUS_REACH + (int)LM_RESPONSE_REACH),
               "no place behind the last line is in use");
_Static_assert((int)LM_SIDE_LOBES_LINES > (int)LM_SAR_AHEAD, "strong cells of all lines ahead");

/* Shortest time between two lines. A patch whose dwell is shorter than all its lines together takes
 * as long as the lines. */
enum { LM_SAR_LINE_MIN_US = 500 };

/* Flight of the aircraft while it makes a patch. It decides dwell and limits. */
struct lm_sar_flight {
    uint32_t speed_mm_s;    /* over the ground */
    fx_bam_t track;         /* direction of that velocity */
    fx_bam_t bearing;       /* of the patch, from the aircraft */
    fx_bam_t heading;       /* direction of the nose */
    uint32_t lateral_mm_s2; /* lateral acceleration; what motion compensation leaves of it blurs */
};

/* Relief of a patch: what layover needs to know of the terrain before it is traced. High ground
 * behind the far edge is displaced into the patch, and low ground before the near edge. */
struct lm_sar_relief {
    int32_t reference_m_q10;  /* elevation of the patch's flat ground, z0 */
    uint32_t near_fall_m_q10; /* how far the ground at the near edge lies below z0 at most */
    uint32_t far_rise_m_q10;  /* how far that at the far edge lies above z0 at most */
};

/* Set-up of a patch: its surroundings at its start. */
struct lm_sar_setup {
    const struct lm_sar_flight *flight;  /* NULL: commanded geometry, no limits; read at once */
    const struct lm_target_set *targets; /* borrowed; NULL: none */
    struct lm_chips *chips;              /* borrowed; NULL: every signature is drawn as a point */
    struct lm_sar_relief relief;
    uint32_t epoch; /* chooses the random draws: noise, targets */
    uint8_t sea_state;
    const struct lm_environment *environment; /* rain, jammers, wind; NULL: none; read at once */
    uint64_t time_us;                         /* movers are where they are at this time */
    int32_t noise_rise_db_q8;                 /* by malfunctions */
};

/* Whether a patch has the detail of its tiles. */
enum lm_sar_detail {
    LM_SAR_DETAIL_NONE, /* its cells are not shorter than the map's: they show all that is known */
    LM_SAR_DETAIL_WANTED,
    LM_SAR_DETAIL_LOADING,
    LM_SAR_DETAIL_READY
};

/* State of a patch. Set up by lm_sar_start; the caller owns it, and all fields are read-only to
 * others. */
struct lm_sar {
    const struct lm_radar *radar; /* borrowed */
    struct lm_sar_command command;
    uint32_t lines;                           /* number of lines: even, radar->sar.cells or more */
    uint64_t line_us;                         /* time between two lines */
    uint32_t dwell_ms;                        /* below 2^17; a longer dwell counts as that */
    struct lm_ground_patch ground;            /* the traced cells */
    struct lm_ground_patch foreground_ground; /* terrain before them */
    struct lm_range_grid grid;
    struct lm_foreground foreground;
    uint8_t lod;     /* LOD that the patch is read from */
    bool has_crests; /* between its cells */
    struct lm_scan_blend blend;
    struct lm_class_lut class_lut;
    struct lm_class_gain class_gain;
    struct lm_sea sea;
    const struct lm_target_set *targets; /* borrowed; NULL: none */
    struct lm_chips *chips;              /* borrowed; NULL: none */
    uint64_t time_us;                    /* of the movers' positions */
    uint32_t epoch;                      /* of the targets' fluctuation */
    struct lm_grain_place grain;   /* of cell 0 of line 0: depends on centre and command too */
    struct lm_grain_curve speckle; /* of the table's looks */
    struct lm_patch_floor floor;   /* of the lines sampled so far */
    int32_t across_mm_s;           /* velocity to the right of the line of sight */
    int32_t floor_db_q8;           /* noise with that of jammers, dB of gamma */
    struct lm_patch_rain rain;
    struct lm_sar_relief relief;
    uint32_t lean_q16; /* displacement by layover over height; 0: there is none */
    uint32_t overscan; /* cells that are traced before the patch */
    uint32_t traced;   /* cells that are traced in all */
    struct lm_layover layover;
    uint32_t defocus_lines_q8; /* width of the defocus; 256: none */
    struct lm_patch_geometry geometry;
    struct lm_target_candidates candidates;

    uint32_t second_foreground; /* number of the second of the two traced foregrounds; 0: none */
    lm_horizon_q40_t foregrounds[2]; /* horizon behind each of the two */
    lm_horizon_q40_t horizon;        /* horizon at the start of the line traced last */
    uint32_t line;                   /* next line to draw; `lines`: done */
    uint32_t sampled;                /* lines in the ring */
    uint32_t lobes_added;            /* lines whose strong cells have given their side lobes */
    uint32_t summed;                 /* lines that have the scatterers added */
    bool has_target_patch;           /* true once the targets' scatterers were computed */
    uint32_t hidden_known;           /* scatterers tested for being hidden, before line 0 */
    uint32_t shaded_known;           /* and then, for the shadows of other targets */
    int32_t shadow_db_q8;            /* level of a shadow on the line sampled last, dB of gamma */
    struct lm_side_lobes side_lobes; /* of the ground */
    struct lm_target_patch target_patch; /* targets, from the first line on */
    enum lm_sar_detail detail_state;
    struct lm_detail_reader detail_reader;
    struct lm_detail_patch detail; /* drawn once detail_state is LM_SAR_DETAIL_READY */
    int16_t ring_db_q8[LM_SAR_RING][LM_CELLS_ROOM]; /* levels of line n at n % LM_SAR_RING */
    /* Its rows, and the first ones again: the lines around one are side by side here. */
    int16_t *ring_rows[LM_SAR_RING + LM_SIDE_LOBES_CELLS - 1];
    uint64_t power_q32[LM_CELLS_ROOM];   /* work space */
    int16_t laid_db_q8[LM_LAYOVER_ROOM]; /* work space */
};

/* Judge whether a patch can be made. Returns LM_REFUSED_NOT, or the first of these that holds:
 * - LM_REFUSED_CELL: cell_mm is outside the table's cell_min_mm..cell_max_mm;
 * - LM_REFUSED_POLE: lm_geo_is_polar(centre);
 * - LM_REFUSED_FAR: range_m is above 250,000;
 * - LM_REFUSED_NEAR: range_m is below 1,000, the patch would begin nearer than 16
 *   LM_RANGE_MIN_M, or the patch would need more than LM_PATCH_LINES_MAX lines;
 * - LM_REFUSED_HEIGHT: height_m_q6 is more than 30 km above or below mean sea level;
 * - LM_REFUSED_SQUINT: in flight (setup->flight), the squint is below the table's squint_min, ahead
 *   or astern;
 * - LM_REFUSED_GIMBAL: in flight, the bearing is off the nose by more than the antenna's
 *   azimuth_limit;
 * - LM_REFUSED_DWELL: in flight, the dwell is longer than the table's dwell_max_ms.
 * Cost: some 200 instructions. */
enum lm_refusal lm_sar_judge(const struct lm_radar *radar, const struct lm_sar_command *command,
                             const struct lm_sar_setup *setup);

/* Start a patch. The command's geometry must be complete: the caller resolves is_from_ownship.
 * Returns LM_OK, or LM_ERR_RANGE with *s unchanged iff lm_sar_judge refuses it.
 *
 * A patch of commanded geometry (flight NULL) has none of the last three limits. Its dwell is that
 * of an aircraft that passes at the table's reference speed, with the patch abeam to the right.
 * `radar`, and targets and chips of the set-up, are borrowed as long as *s is used. Cost: a little
 * more than lm_sar_set_relief. */
int lm_sar_start(struct lm_sar *s, const struct lm_radar *radar, const struct lm_db *db,
                 const struct lm_sar_command *command, const struct lm_sar_setup *setup);

/* Read the relief of a patch, whose command is complete, from the tiles at hand, and request the
 * finest tiles that it uses. Cost: some 15 k instructions, without layover 500. */
struct lm_sar_relief lm_sar_relief_of(struct lm_tile_cache *tiles, const struct lm_radar *radar,
                                      const struct lm_sar_command *command);

/* Change the patch's relief and restart it. Called when a finer tile arrives after lm_sar_start.
 * Dwell and limits are not recomputed. Cost: about 60 k instructions. */
void lm_sar_set_relief(struct lm_sar *s, const struct lm_db *db,
                       const struct lm_sar_relief *relief);

/* Time until the last line is due. */
uint64_t lm_sar_time_to_go_us(const struct lm_sar *s);

/* Request the tiles of line `line` (0..lines - 1) and of the foreground before it. */
void lm_sar_prefetch(const struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t line);

/* Select the targets that the patch may show, and request their chips. */
void lm_sar_prefetch_targets(struct lm_sar *s, struct lm_tile_cache *tiles);

/* Read the detail of the patch's tiles, when these are resident. True once nothing is missing;
 * false: call again in a later step. Detail that arrives after the first line was sampled would
 * change the picture half-way: with `is_late` what has arrived is all that is drawn, and the answer
 * is true. Cost: one record a call, see lm_detail_patch_add. */
bool lm_sar_load_detail(struct lm_sar *s, struct lm_tile_cache *tiles, bool is_late);

/* Take samples that the next line needs, at most `at_most` of them. True if the line has all of
 * them; false: call again. The first line needs LM_SAR_AHEAD + 1 samples, more than the time of one
 * line allows. Cost: about 9 k instructions a sample of 256 cells. */
bool lm_sar_sample_ahead(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t at_most,
                         struct lm_line *line);

/* Draw the next line and move on. Call it while s->line < s->lines.
 *
 * - Result: levels (dB * 256), valid until the next call, and line->grey. In both the
 *   first cell of the display has the index 0.
 * - line->ground belongs to the line sampled last, up to LM_SAR_AHEAD lines further on.
 * - Samples that lm_sar_sample_ahead has not taken are taken here.
 *
 * Cost without them: about 640 instructions for 256 cells without defocus. */
const int16_t *lm_sar_draw_line(struct lm_sar *s, struct lm_tile_cache *tiles,
                                const struct lm_tone *tone, struct lm_line *line);

/* Sample line `number`: the stages from the map to noise and speckle, without scatterers and
 * without defocus. Part of lm_sar_draw_line; public for tests. Result:
 * - line->ground: the cells of the line, from index `overscan` on;
 * - level_db_q8: the levels;
 * - s->horizon: the horizon that the line started with. */
void lm_sar_sample_line(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t number,
                        struct lm_line *line, int16_t *level_db_q8);

/* Restart the patch from its first line. Samples and targets are taken again. */
void lm_sar_restart(struct lm_sar *s);

#endif
