/* Which targets a sweep or a patch may meet, and where each of them is at its time. Chosen once for
 * it, so that a line looks at few. */
#ifndef LM_TARGET_CANDIDATES_H
#define LM_TARGET_CANDIDATES_H

#include "lm/mover.h"
#include "lm/signature.h"
#include "lm/tile_cache.h"

enum {
    LM_TARGET_CANDIDATES_MAX = 32, /* that one sweep or patch takes up */
    LM_TARGET_DRIFT_M = 1024,      /* the antenna's way until they are chosen again */
    LM_TARGET_EXTENT_M = 512       /* more than any scatterer is away from its target's origin */
};

/* The targets of an image, as they were read. */
struct lm_target_set {
    const struct lm_target *items;         /* borrowed, checked */
    uint32_t count;                        /* up to 65535 */
    const struct lm_signature *signatures; /* borrowed, checked; of no aspects: a lost one */
    uint32_t signature_count;
};

/* The signature of a target, or NULL when it has none or that was lost. */
const struct lm_signature *lm_target_signature(const struct lm_target_set *set,
                                               const struct lm_target *t);

/* From where and when they are looked at. */
struct lm_target_query {
    struct lm_position position; /* the antenna of a sweep, the centre of a patch */
    uint32_t reach_m;            /* the range, half the diagonal; up to 250 km */
    uint64_t time_us;            /* of the sweep or patch: movers are where they are then */
    struct lm_tile_cache *tiles; /* the ground below targets that stand on it; NULL: it is at 0 */
    uint8_t lod;                 /* of the database, that the ground is taken from */
};

struct lm_chip_slot;

struct lm_target_candidates {
    struct lm_target_set set;    /* they are of */
    bool is_chosen;              /* false: not yet */
    struct lm_position position; /* from where */
    uint64_t time_us;
    uint32_t count;
    uint32_t left_out; /* in reach, but there was no room */
    struct lm_target_candidate {
        uint16_t index; /* in the set */
        bool is_mover;
        uint32_t distance_m_q8;        /* from the place that was given, metres * 256, */
        int32_t north_m_q8, east_m_q8; /* and which way: all of it rough, */
        uint32_t
            slack_m_q8; /* but its whole lies within so much of there, up to 88 degrees N or S */
        struct lm_mover_state state;
        int32_t elevation_m_q6;          /* of the origin above mean sea level, metres * 64 */
        const struct lm_chip_slot *chip; /* of lm/chips.h; borrowed; NULL: it has none */
        fx_bam_t chip_turn;              /* how far that is to be turned: lm/signature.h */
    } candidate[LM_TARGET_CANDIDATES_MAX];
};

/* Choose the targets not farther than reach_m + LM_TARGET_DRIFT_M: the first
 * LM_TARGET_CANDIDATES_MAX of them, in their order in the image. Cost: about 600 instructions a
 * target, 800 more for a mover, 300 for one above the ground. */
void lm_target_candidates_select(struct lm_target_candidates *candidates,
                                 const struct lm_target_set *set,
                                 const struct lm_target_query *query);

/* Choose anew unless that was done for the same time from within LM_TARGET_DRIFT_M of the place.
 * Whether it was done. */
bool lm_target_candidates_refresh(struct lm_target_candidates *candidates,
                                  const struct lm_target_set *set,
                                  const struct lm_target_query *query);

#endif
