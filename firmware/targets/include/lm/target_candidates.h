/* Target candidates: the targets that one sweep or patch may meet, with their state at its time.
 * They are selected once, and each line then looks at few targets. */
#ifndef LM_TARGET_CANDIDATES_H
#define LM_TARGET_CANDIDATES_H

#include "lm/live.h"
#include "lm/mover.h"
#include "lm/signature.h"
#include "lm/tile_cache.h"

enum {
    LM_TARGET_CANDIDATES_MAX = 32, /* most candidates of one sweep or patch */
    LM_TARGET_DRIFT_M = 1024,      /* way of the antenna after which they are selected again */
    LM_TARGET_EXTENT_M = 512       /* more than any scatterer's distance from its target's origin */
};

/* Targets of the images, as they were read, and those that the bus moves. */
struct lm_target_set {
    const struct lm_target *items;         /* borrowed; checked records */
    uint32_t count;                        /* up to 65535 */
    const struct lm_signature *signatures; /* borrowed; checked records, or 0 aspects: a lost one */
    uint32_t signature_count;
    uint32_t live_signature0, live_signatures; /* first and number of those that live ones name */
    const struct lm_live *live;                /* borrowed; NULL: none */
};

/* True if any of the set is a live one. */
static inline bool lm_target_set_is_live(const struct lm_target_set *set)
{
    return set->live && set->live->count != 0;
}

/* True if there is any target at present. */
static inline bool lm_target_set_has_any(const struct lm_target_set *set)
{
    return set->count != 0 || lm_target_set_is_live(set);
}

/* What a target returns, if it has no scatterers: a copy of its record's members. */
struct lm_target_body {
    uint32_t id;
    int32_t mean_rcs_dbsm_q8;
    uint8_t swerling, signature;
    uint16_t flags;
};

/* Signature of a target of the set; NULL if it has none or if it was lost. Owned by the set. */
const struct lm_signature *lm_target_signature(const struct lm_target_set *set,
                                               const struct lm_target_body *body);

/* Query for candidates: position, reach and time of a sweep or patch. */
struct lm_target_query {
    struct lm_position position; /* antenna of a sweep, centre of a patch */
    uint32_t reach_m;            /* range of a sweep, half diagonal of a patch; up to 250 km */
    uint64_t time_us;            /* of the unit's clock: movers are where they are then */
    struct lm_tile_cache *tiles; /* borrowed for the call: terrain below targets whose elevation is
                                    above ground; NULL: that terrain is at 0 */
    uint8_t lod;                 /* LOD that the terrain is read from */
    uint32_t displaced_q16;      /* of a patch: metres that it displaces by for each mm/s; else 0 */
};

struct lm_chip_slot;

/* Candidates of a sweep or patch. The caller owns them; the set must outlive them. */
struct lm_target_candidates {
    struct lm_target_set set;    /* the set that they were selected from */
    bool is_chosen;              /* true once they were selected */
    struct lm_position position; /* of the query */
    uint64_t time_us;            /* of the query */
    uint32_t count;
    uint32_t left_out; /* targets in reach beyond LM_TARGET_CANDIDATES_MAX */
    struct lm_target_candidate {
        uint16_t index; /* in the set; of a live target, its number */
        bool is_mover;
        uint8_t scatterer_count; /* 0 of a live target */
        struct lm_target_body body;
        uint32_t distance_m_q8;        /* approximate, from the query's position */
        int32_t north_m_q8, east_m_q8; /* approximate, from the query's position */
        uint32_t slack_m_q8; /* radius of a circle about there that holds the whole target, up to 88
                                degrees N or S */
        struct lm_mover_state state;
        int32_t elevation_m_q6;          /* of the origin above mean sea level */
        const struct lm_chip_slot *chip; /* borrowed from lm/chips.h; NULL: it has none */
        fx_bam_t chip_turn;              /* angle by which the chip is turned; see lm/signature.h */
    } candidate[LM_TARGET_CANDIDATES_MAX];
};

/* Select the targets of the image up to reach_m + LM_TARGET_DRIFT_M away: the first
 * LM_TARGET_CANDIDATES_MAX of them in the order of the image. They have no chips yet
 * (lm_chips_choose). Cost: about 600 instructions a target, 800 more for a mover, 300 more for one
 * above ground. */
void lm_target_candidates_select(struct lm_target_candidates *candidates,
                                 const struct lm_target_set *set,
                                 const struct lm_target_query *query);

/* State of one target at the query's time, of the image or the live one of that number, wherever it
 * is; neither distance, place nor chip. False, and *candidate unchanged, if it is not there. Cost:
 * about 2,500 instructions. */
bool lm_target_candidate_of(struct lm_target_candidate *candidate, const struct lm_target_set *set,
                            bool is_live, uint32_t index, const struct lm_target_query *query);

/* Add the live targets within the query's reach: as far as there is room those with the greatest
 * cross section, in whole dB, and of equal ones the lowest numbers. The others are counted in
 * left_out. Cost: 80 instructions for each that is there, about 1,500 for each that is added, and
 * 3,000 where there are more. */
void lm_target_candidates_add_live(struct lm_target_candidates *candidates,
                                   const struct lm_target_query *query);

/* What a line needs to know to find the live targets that appear on it. */
struct lm_live_line {
    fx_bam_t azimuth, width;       /* of the line, as in lm/target_line.h */
    uint32_t begin_m_q8, end_m_q8; /* of its cells */
    bool is_doppler;
    bool is_of_beacons;  /* none but beacons appear on it */
    uint32_t speed_mm_s; /* of the antenna over the ground */
    fx_bam_t track, beam;
};

/* Select the live targets that the line may show: those that appear within its width, by a plane
 * around the antenna. The query's position is the antenna's now; its time is that of the sweep.
 * Of more than LM_TARGET_CANDIDATES_MAX the strongest, as above. Cost: 90 instructions for each
 * live target, about 1,500 for each selected, and 3,000 where there are more. */
void lm_target_candidates_of_line(struct lm_target_candidates *candidates,
                                  const struct lm_target_set *set,
                                  const struct lm_target_query *query,
                                  const struct lm_live_line *line);

/* Select again, unless that was done for the same time within LM_TARGET_DRIFT_M of the query's
 * position. True if it was done now. */
bool lm_target_candidates_refresh(struct lm_target_candidates *candidates,
                                  const struct lm_target_set *set,
                                  const struct lm_target_query *query);

#endif
