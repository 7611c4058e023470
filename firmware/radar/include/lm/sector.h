/* Sector: a real-beam or Doppler-sharpened picture, swept line by line, out and back. Either the
 * whole sector (NORM) or a window around the cursor that the display shows enlarged (EXP, DBS).
 *
 * Order of the calls: lm_sector_start once, then for each line lm_sector_begin where
 * lm_sector_is_at_edge, lm_sector_sample_ahead until it says true, and lm_sector_draw_line. The
 * order of the stages behind them is in lm/line.h. No call fails; all run in bounded time.
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
#include "lm/line.h"
#include "lm/radar.h"
#include "lm/receiver.h"
#include "lm/slant.h"
#include "lm/tone.h"
#include "lm/weather.h"

enum {
    LM_SECTOR_LINES_MAX = 512,  /* lines of a sweep over a window, at most */
    LM_SECTOR_LINES_PER_S = 512 /* lines drawn in a second of a window, at most */
};

/* Position, attitude and velocity of the aircraft when a line is drawn. */
struct lm_platform {
    struct lm_position position;
    int32_t height_m_q10; /* metres * 1024 above mean sea level */
    fx_bam_t heading;     /* of the nose: the middle of the sector */
    fx_bam_t track;       /* of the velocity over the ground */
    uint32_t speed_mm_s;  /* 0 where it is not known: nothing is sharpened then */
    uint64_t time_us;     /* where movers are */
};

/* What to show. The caller keeps the indices within the radar table and the field within the mode's
 * fov_last. */
struct lm_sector_command {
    uint8_t mode, fov; /* enum lm_sector_mode, enum lm_fov */
    uint8_t range_index,
        azimuth_index;         /* indices into the radar table; azimuth counts in NORM alone */
    struct lm_position centre; /* of the window; not read in NORM */
    struct lm_beam_setting {
        bool is_tilt_manual, is_pencil; /* not automatic; not spoiled into a fan */
        int32_t tilt;                   /* manual: signed BAM */
    } beam;
};

/* State of a sector. lm_sector_start sets the command; the geometry is computed by lm_sector_begin.
 * The caller owns it, may set the four borrowed pointers after the start, and may change
 * command.centre at an edge; all else is read-only to others. */
struct lm_sector {
    const struct lm_radar *radar;             /* borrowed */
    const struct lm_environment *environment; /* borrowed; NULL: fair weather, sea state 3 */
    const struct lm_target_set *targets;      /* borrowed; NULL: none */
    struct lm_chips *chips; /* borrowed; NULL: every signature is a point, as in NORM */
    struct lm_sector_command command;

    bool is_begun; /* the geometry below is that of the running sweep */
    bool is_leftward;
    uint32_t line;               /* next to be drawn, 0 at the left edge */
    uint32_t sweep;              /* sweeps begun, from the epoch given: the epoch of the noise */
    struct lm_platform platform; /* as it was when the sweep began; in NORM its place follows */
    struct lm_geo_origin origin; /* platform.place, as of the sample taken last */
    fx_bam_t up;    /* azimuth from north of the sector's middle: follows the nose in NORM */
    int32_t left;   /* the sweep's left edge from the middle, signed BAM */
    fx_bam_t width; /* of a line */
    uint32_t lines;
    uint32_t half_m;           /* window: half its side on the ground; 0 in NORM */
    uint32_t edge_m_q8;        /* slant range where bin 0 begins, metres * 256 */
    uint32_t ground_edge_m_q8; /* ground range where cell 0 begins */
    int32_t tilt;              /* of the beam's axis in this sweep, signed BAM */

    uint8_t lod; /* of the database */
    struct lm_range_grid grid;
    struct lm_slant slant;
    struct lm_antenna_pattern pattern;
    struct lm_antenna_fan fan;
    struct lm_class_lut class_lut;
    struct lm_texture texture;
    struct lm_azimuth_average average; /* of the sample that is being taken */
    struct lm_beam beam;
    bool has_taps;          /* at the next line */
    struct lm_sector_taps { /* of the even and the odd line that was aimed at last */
        bool is_kept;       /* not sharpened, so that one like it may use it */
        int32_t azimuth;
        struct lm_beam_taps taps;
    } taps[2];
    struct lm_receiver receiver;
    struct lm_weather weather;
    struct lm_target_candidates candidates;

    struct lm_foreground foreground;     /* its grid has no cells: the line begins at the antenna */
    lm_horizon_q40_t foreground_horizon; /* behind it, */
    uint32_t foreground_part;            /* in this part of the sector, */
    bool has_foreground;                 /* once it was traced */

    uint32_t samples;                   /* taken so far: only grows */
    uint32_t power_q24[LM_CELLS_ROOM];  /* of the line drawn last, behind beam and pulse */
    int32_t level_db_q8[LM_CELLS_ROOM]; /* and behind the receiver: what the tone is made of */
};

/* Start a sector: forget sweep, samples and geometry, and take the command. `epoch` numbers the
 * first sweep's noise: the same one draws the same. Sets environment, targets and chips to NULL;
 * the caller sets them next. */
void lm_sector_start(struct lm_sector *s, const struct lm_radar *radar,
                     const struct lm_sector_command *command, uint32_t epoch);

/* Change tilt and shape of the beam at once; in the middle of a sweep its later samples have it. */
void lm_sector_set_beam(struct lm_sector *s, const struct lm_beam_setting *setting);

/* True when the next line begins a sweep: the moment to change command.centre. */
static inline bool lm_sector_is_at_edge(const struct lm_sector *s)
{
    return !s->is_begun;
}

/* True when the sweep is over a window, seen from where it began. After lm_sector_begin. */
static inline bool lm_sector_is_window(const struct lm_sector *s)
{
    return s->half_m != 0;
}

/* Begin a sweep: compute its geometry for where `platform` is now. The database must be open. Cost:
 * about 200 k instructions where height or window have changed. */
void lm_sector_begin(struct lm_sector *s, struct lm_tile_cache *tiles,
                     const struct lm_platform *platform);

/* Time from a line to the next, microseconds. After lm_sector_begin. */
uint32_t lm_sector_line_us(const struct lm_sector *s);

/* Left edge of line `line`, and so the right edge of the one before: signed BAM from the sector's
 * middle, right positive. `line` is 0..lines. */
int32_t lm_sector_edge_bam(const struct lm_sector *s, uint32_t line);

/* Take samples that the next line needs. `*azimuths` is how many azimuths may still be traced;
 * those that were traced are subtracted, and at 0 the call returns. True when the line has all
 * samples; false: call again. At an edge it begins the sweep itself. The first line of a window
 * needs all LM_BEAM_TAPS samples, which is more than one line has time for. Cost: about 11 k
 * instructions a traced azimuth (docs/benchmarks.md). */
bool lm_sector_sample_ahead(struct lm_sector *s, struct lm_tile_cache *tiles,
                            const struct lm_platform *platform, uint32_t *azimuths,
                            struct lm_line *line);

/* Draw the next line into line->grey[0 .. slant.cells - 1], ask for the tiles of a line some way
 * ahead, and move on. Returns the number of the line that was drawn. Samples that
 * lm_sector_sample_ahead has not taken are taken here, LM_BEAM_TAPS at most. Cost without them:
 * about 5 k instructions for 256 cells. */
uint32_t lm_sector_draw_line(struct lm_sector *s, struct lm_tile_cache *tiles,
                             const struct lm_platform *platform, const struct lm_tone *tone,
                             struct lm_line *line);

#endif
