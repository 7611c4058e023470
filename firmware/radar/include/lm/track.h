/* Track: the antenna stays on one thing, and measures it: a fixed target or place (FTT), a mover
 * (GMTT), or the ground straight ahead (air-to-ground ranging).
 *
 *     OFF --begin--> SEARCHING --it returns--> HELD --no return--> COASTING
 *      ^                 |                      ^                     |
 *      |                 | nothing returns      '------- returns -----|
 *      '-----------------'<--------------- too long without a return -'
 *
 * What returns and what does not is the radar equation's business, and that of gimbals, terrain and
 * Doppler: enum lm_track_loss. Source: docs/EQUATIONS.md, "Tracks". */
#ifndef LM_TRACK_H
#define LM_TRACK_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/foreground.h"
#include "lm/sector.h"

/* Kinds; the number is that of the bus. */
enum lm_track_kind {
    LM_TRACK_NONE,
    LM_TRACK_FIXED,  /* FTT: a target that stands still, or a place on the ground */
    LM_TRACK_MOVER,  /* GMTT: a target that the mode's gates let through */
    LM_TRACK_RANGING /* AGR: the ground that the nose points at */
};

/* States; the number is that of the bus. */
enum lm_track_state { LM_TRACK_OFF, LM_TRACK_SEARCHING, LM_TRACK_HELD, LM_TRACK_COASTING };

/* Why nothing returns; the number is that of the bus. */
enum lm_track_loss {
    LM_TRACK_SOUND,   /* it returns */
    LM_TRACK_SILENT,  /* the radar does not send */
    LM_TRACK_NO_NAV,  /* the aircraft's own position is not good */
    LM_TRACK_LIMITS,  /* beyond the antenna's limits, or 300 km */
    LM_TRACK_SHADOW,  /* terrain hides it */
    LM_TRACK_WEAK,    /* too weak against noise and clutter */
    LM_TRACK_NOTCH,   /* its closing speed is outside the gates */
    LM_TRACK_NOTHING, /* there is no such target, or no ground */
    LM_TRACK_LOSSES
};

/* Times. UNSOURCED: a track is tried for two seconds and coasts for four. */
enum {
    LM_TRACK_STEP_US = 50000, /* between two measurements */
    LM_TRACK_SEARCH_US = 2000000,
    LM_TRACK_COAST_US = 4000000,
    LM_TRACK_HOLD_DB_Q8 = LM_DB_Q8(3) /* a track that is held needs so much less */
};

/* What a track sees, and with what. Borrowed for the call. */
struct lm_track_scene {
    const struct lm_radar *radar;
    struct lm_tile_cache *tiles;
    const struct lm_target_set *targets;
    const struct lm_environment *environment;
    const struct lm_malfunctions *malfunctions;
    struct lm_platform platform; /* time_us: movers are where they are then */
    int32_t pitch;               /* of the nose, signed BAM; ranging looks there */
    uint8_t mode, fov, range_index;
    bool is_sending, is_nav_good;
    struct lm_scan_line *line; /* work space */
};

/* Measured values. */
struct lm_track_seen {
    struct lm_position position;
    int32_t elevation_m_q10; /* above mean sea level */
    fx_bam_t bearing;        /* from the antenna, from north */
    int32_t angle;           /* above the horizon, signed BAM, as the beam is bent by the air */
    uint32_t ground_m_q8;    /* range along the ground */
    uint32_t slant_m_q8;     /* straight from the antenna */
    int32_t range_rate_mm_s; /* of the slant range, in level flight; negative: it comes nearer */
    uint32_t speed_mm_s;     /* over the ground */
    fx_bam_t course;         /* of that speed, from north */
    int32_t signal_db_q8;    /* over noise and clutter; meaningless while coasting */
};

/* State; the caller owns it. All zero: no track was ever begun. */
struct lm_track {
    uint8_t kind;   /* enum lm_track_kind; of the last one while it is off */
    uint8_t state;  /* enum lm_track_state */
    uint8_t loss;   /* enum lm_track_loss: why it does not return now, or was dropped */
    uint8_t number; /* counts tracks begun, modulo 256 */
    bool has_target, is_live;
    uint16_t index; /* of the target */
    struct {
        struct lm_position place; /* designated */
        uint32_t gate_m;          /* a target lies within this */
        uint16_t next;            /* target to look at next: of the image, then the live ones */
        bool has_best, is_best_live;
        uint16_t best;
        uint32_t best_m_q8;
    } search;
    uint64_t next_us, returned_us, ended_us; /* of the unit's clock */
    uint64_t motion_us;                      /* platform.time_us of `seen` */
    struct lm_track_seen seen;               /* valid while held or coasting */
    struct lm_foreground foreground;         /* work space */
    struct lm_class_lut class_lut;
};

/* Begin a track at a place, which is not read for ranging. A target that is tracked lies within
 * `gate_m` of it. */
void lm_track_begin(struct lm_track *t, enum lm_track_kind kind, struct lm_position place,
                    uint32_t gate_m, uint64_t now_us);

/* End the track, for a reason or none (LM_TRACK_SOUND). */
void lm_track_end(struct lm_track *t, enum lm_track_loss loss, uint64_t now_us);

/* Measure what is due. Call in each step of the unit while the map is usable. Cost: some 20,000
 * instructions every LM_TRACK_STEP_US; the same in each step of a search. */
void lm_track_step(struct lm_track *t, const struct lm_track_scene *scene, uint64_t now_us);

/* Least signal of a track that begins: Albersheim's equation for one false alarm in a million and
 * nine detections of ten, for noise of 2^looks_log2 looks (0..LM_LOOKS_LOG2_MAX). */
int32_t lm_track_needs_db_q8(uint32_t looks_log2);

#endif
