/* Sector: a real-beam or Doppler-sharpened picture, swept line by line, out and back. It is the
 * whole sector (NORM), or a window around the cursor that the display shows enlarged (EXP, DBS).
 *
 * Order of the calls:
 * - lm_sector_start once;
 * - if lm_sector_is_at_edge: lm_sector_begin (lm_sector_sample_ahead calls it if nobody else has);
 * - for each line: lm_sector_sample_ahead until it returns true, then lm_sector_draw_line.
 *
 * No call fails; all run in bounded time. lm/line.h has the order of the stages.
 *
 *     NORM                                   window (EXP, DBS)
 *
 *     line 0         up        lines - 1        .---------.
 *        \           ^           /               \ +---+ /     lines and ranges that hold the
 *         \          |          /                 \| + |/      square around command.centre
 *          \         |         /                   +---+
 *           \        |        /                     \_/        edge_m_q8
 *            \       |       /                       :
 *      left   \      |      /                        :
 *    (negative)\     |     /                         :
 *                 antenna                         antenna
 *
 * Source: docs/EQUATIONS.md, "Real beam" and "Doppler beam sharpening". */
#ifndef LM_SECTOR_H
#define LM_SECTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/antenna.h"
#include "lm/azimuth_average.h"
#include "lm/beam.h"
#include "lm/foreground.h"
#include "lm/grain.h"
#include "lm/line.h"
#include "lm/malfunction.h"
#include "lm/radar.h"
#include "lm/receiver.h"
#include "lm/sector_floor.h"
#include "lm/slant.h"
#include "lm/tone.h"
#include "lm/weather.h"

enum {
    LM_SECTOR_LINES_MAX = 512,  /* most lines of a sweep over a window */
    LM_SECTOR_LINES_PER_S = 512 /* most lines of a window drawn in a second */
};

/* Position, attitude and velocity of the aircraft when a line is drawn. */
struct lm_platform {
    struct lm_position position;
    int32_t height_m_q10; /* above mean sea level */
    fx_bam_t heading;     /* direction of the nose: the middle of the sector */
    fx_bam_t track;       /* direction of the velocity over the ground */
    uint32_t speed_mm_s;  /* over the ground; 0 if unknown: nothing is sharpened then */
    uint64_t time_us;     /* movers are where they are at this time */
};

/* Command of a sector: what it displays. The caller keeps the indices within the radar table and
 * the field of view within the mode's fov_last. */
struct lm_sector_command {
    uint8_t mode, fov;         /* enum lm_sector_mode, enum lm_fov */
    uint8_t range_index;       /* range scale, index into the radar table */
    uint8_t azimuth_index;     /* width of the sector, index into the radar table; NORM only */
    struct lm_position centre; /* of the window; not read in NORM */
    struct lm_beam_setting {
        bool is_tilt_manual; /* false: AUTO tilt */
        bool is_pencil;      /* false: the beam is spoiled into a fan */
        int32_t tilt;        /* manual tilt, signed BAM, up positive */
    } beam;
};

/* State of a sector. lm_sector_start sets the command; the geometry is computed by lm_sector_begin.
 * The caller owns it. It may set environment, targets, chips and malfunctions after the start, and
 * change is_shared and command.centre at an edge; all else is read-only to others. */
struct lm_sector {
    const struct lm_radar *radar;             /* borrowed */
    const struct lm_environment *environment; /* borrowed; NULL: fair weather, sea state 3 */
    const struct lm_target_set *targets;      /* borrowed; NULL: none */
    struct lm_chips *chips; /* borrowed; NULL: every signature is drawn as a point, as in NORM */
    const struct lm_malfunctions *malfunctions; /* borrowed; NULL: none */
    bool is_shared; /* other displays draw the same: no sweep depends on heights of earlier ones */
    struct lm_sector_command command;

    bool is_begun;      /* true if the geometry below is that of the running sweep */
    bool is_asked_for;  /* the tiles of a whole sweep were requested since the start */
    uint32_t asked_bam; /* of the sweep, from its left: what of it was requested */
    bool is_leftward;
    uint32_t line;               /* next line to draw, 0 at the left edge */
    uint32_t sweep;              /* the epoch given plus the sweeps completed: epoch of the noise */
    struct lm_platform platform; /* at the start of the sweep; in NORM its position follows */
    struct lm_geo_origin origin; /* at platform.position of the sample taken last */
    fx_bam_t look_off;           /* the antenna looks so much farther right than it says */
    fx_bam_t up;                 /* middle of the sector, from north; follows the nose in NORM */
    int32_t left;                /* left edge of the sweep from the middle, signed BAM */
    fx_bam_t width;              /* of a line */
    uint32_t lines;
    uint32_t half_m;           /* half the side of the window on the ground; 0 in NORM */
    uint32_t edge_m_q8;        /* slant range where bin 0 begins */
    uint32_t ground_edge_m_q8; /* ground range where cell 0 begins */
    int32_t tilt;              /* of the beam's axis in this sweep, signed BAM */

    uint8_t lod; /* LOD that the map is read from */
    struct lm_scan_blend blend;
    struct lm_range_grid grid;
    struct lm_slant slant;
    struct lm_antenna_pattern pattern;
    struct lm_antenna_fan fan;
    struct lm_class_lut class_lut;
    struct lm_class_gain class_gain;
    struct lm_sea sea;
    struct lm_azimuth_average average; /* of the sample that is being traced */
    struct lm_beam beam;
    bool has_taps;          /* true once the next line's taps are set */
    struct lm_sector_taps { /* taps of the last even and of the last odd line */
        bool is_kept;       /* true if not sharpened: a later line may shift and use them */
        int32_t azimuth;    /* of that line, signed BAM from the sector's middle */
        uint32_t ratio_q8;  /* sharpening used */
        uint32_t looks_q8;  /* of the ground's speckle: 256 or more */
        struct lm_beam_taps taps;
    } taps[2];
    struct lm_grain_stretch grain; /* of the next line */
    struct lm_sector_floor floor;  /* of the lines so far, from sweep to sweep */
    struct lm_receiver receiver;
    struct lm_weather weather;
    struct lm_target_candidates candidates;
    struct lm_target_candidates live; /* of the sample taken last */

    struct lm_foreground foreground;     /* no cells in its grid: the line begins at the antenna */
    lm_horizon_q40_t foreground_horizon; /* horizon behind the foreground last traced */
    uint32_t foreground_part;            /* part of the sector that it was traced in */
    bool has_foreground;                 /* true once it was traced */

    uint32_t samples; /* number of the next one: those taken since the start, or if is_shared by
                         sweep and azimuth; changes with each */
    uint32_t power_q24[LM_CELLS_ROOM];  /* line drawn last, behind beam, pulse and speckle */
    int16_t level_db_q8[LM_CELLS_ROOM]; /* line drawn last, behind the receiver */
};

/* Begin the sweep under way again, because the map has changed: nothing of it is kept. */
void lm_sector_begin_again(struct lm_sector *s);

/* Start a sector: forget sweep, samples and geometry, and take the command. `epoch` numbers the
 * first sweep's noise; the same epoch draws the same noise. Sets environment, targets and chips to
 * NULL; the caller sets them next. `radar` is borrowed as long as *s is used. */
void lm_sector_start(struct lm_sector *s, const struct lm_radar *radar,
                     const struct lm_sector_command *command, uint32_t epoch);

/* Change tilt and shape of the beam at once. In the middle of a sweep, its later samples have them.
 */
void lm_sector_set_beam(struct lm_sector *s, const struct lm_beam_setting *setting);

/* True if the next line begins a sweep: the moment to change command.centre. */
static inline bool lm_sector_is_at_edge(const struct lm_sector *s)
{
    return !s->is_begun;
}

/* True if the sweep is over a window, which is seen from where the sweep began. Valid after
 * lm_sector_begin. */
static inline bool lm_sector_is_window(const struct lm_sector *s)
{
    return s->half_m != 0;
}

/* Begin a sweep: compute its geometry for the present position of `platform`. The database must be
 * open. Cost: about 200 k instructions if height or window have changed, 30 k otherwise. */
void lm_sector_begin(struct lm_sector *s, struct lm_tile_cache *tiles,
                     const struct lm_platform *platform);

/* Sweep that a display joins which did not draw the one before it. */
struct lm_sector_turn {
    uint32_t sweep;   /* its number: odd ones go to the left */
    uint32_t skipped; /* lines of it that are over already, below s->lines */
    uint64_t time_us; /* movers are where they are at this time */
};

/* Make the sweep that has just begun that of `turn`. All that is drawn from its second line-to-be
 * on depends on `turn`, the platform and what it finds in the map; but for samples that it shares
 * with the sweep before it, if that one was drawn. */
void lm_sector_join(struct lm_sector *s, const struct lm_sector_turn *turn);

/* Time between two lines. Valid after lm_sector_begin. */
uint32_t lm_sector_line_us(const struct lm_sector *s);

/* Left edge of line `line`, which is the right edge of the line before: signed BAM from the
 * sector's middle, right positive. `line` is 0..lines. */
int32_t lm_sector_edge_bam(const struct lm_sector *s, uint32_t line);

/* Take samples that the next line needs. At an edge it begins the sweep by itself.
 *
 * - *azimuths is the number of azimuths that may still be traced. Those traced are subtracted; at 0
 *   the call returns.
 * - True if the line has all samples; false: call again. The first line of a window needs all
 *   LM_BEAM_TAPS samples, more than the time of one line allows.
 *
 * Cost: about 11 k instructions for each azimuth traced (docs/benchmarks.md). */
bool lm_sector_sample_ahead(struct lm_sector *s, struct lm_tile_cache *tiles,
                            const struct lm_platform *platform, uint32_t *azimuths,
                            struct lm_line *line);

/* Request tiles of a picture that has begun, along a ray of the sweep in each call, until those of
 * the whole sweep were requested: where nothing is in memory yet, the beam would come to its right
 * before the flash does. It waits while 16 requests wait. Call once a step. Cost: some 2,000
 * instructions; a comparison when all were requested. */
void lm_sector_prefetch(struct lm_sector *s, struct lm_tile_cache *tiles);

/* Draw the next line into line->grey[0 .. slant.cells - 1], request the tiles of a line ahead, and
 * move on. Returns the number of the line that was drawn. Samples that lm_sector_sample_ahead has
 * not taken are taken here, LM_BEAM_TAPS at most. Cost without them: about 5 k instructions for 256
 * cells. */
uint32_t lm_sector_draw_line(struct lm_sector *s, struct lm_tile_cache *tiles,
                             const struct lm_platform *platform, const struct lm_tone *tone,
                             struct lm_line *line);

#endif
