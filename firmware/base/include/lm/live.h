/* Live target: a target that the exercise moves over the bus (docs/bus.md, "Live targets"), and
 * where it is between two of its messages.
 *
 * Between them it is dead-reckoned by the algorithms of DIS (IEEE 1278.1). Their three letters say
 *
 *     F, R    the body keeps its heading, or turns
 *     P, V    the velocity is steady, or has an acceleration
 *     W, B    the velocity keeps its direction, or turns with the body
 *
 * Source: docs/EQUATIONS.md, "Live targets". */
#ifndef LM_LIVE_H
#define LM_LIVE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/geo.h"

enum {
    LM_LIVE_MAX = 256,
    LM_LIVE_SPEED_MAX = 20000,   /* in 0.05 m/s */
    LM_LIVE_TURN_MAX = 6000,     /* in 0.01 deg/s */
    LM_LIVE_RECKONED_MS = 12000, /* it is not reckoned on for longer than this, either way */
    LM_LIVE_HEIGHT_MAX_Q6 = 1 << 20
};

/* Kinds; the number is that of the bus. */
enum lm_live_kind {
    LM_LIVE_UNKNOWN,
    LM_LIVE_PERSON,
    LM_LIVE_CAR,
    LM_LIVE_TRUCK,
    LM_LIVE_ARMOUR,
    LM_LIVE_TRAIN,
    LM_LIVE_LIGHT_AIRCRAFT,
    LM_LIVE_FIGHTER,
    LM_LIVE_LARGE_AIRCRAFT,
    LM_LIVE_HELICOPTER,
    LM_LIVE_MISSILE,
    LM_LIVE_BOAT,
    LM_LIVE_SMALL_SHIP,
    LM_LIVE_SHIP,
    LM_LIVE_LARGE_SHIP,
    LM_LIVE_STRUCTURE,
    LM_LIVE_REFLECTOR,
    LM_LIVE_BEACON,
    LM_LIVE_KINDS
};

/* Mean cross section of a kind, and its Swerling case. */
struct lm_live_echo {
    int8_t rcs_dbsm;
    uint8_t swerling;
};
extern const struct lm_live_echo lm_live_echoes[LM_LIVE_KINDS];

/* Dead reckoning; the number is that of DIS. */
enum lm_live_reckoning {
    LM_LIVE_OTHER, /* as FPW */
    LM_LIVE_STATIC,
    LM_LIVE_FPW,
    LM_LIVE_RPW,
    LM_LIVE_RVW,
    LM_LIVE_FVW,
    LM_LIVE_FPB,
    LM_LIVE_RPB,
    LM_LIVE_RVB,
    LM_LIVE_FVB,
    LM_LIVE_RECKONINGS
};

/* State as it was told last. Pairs are east, north. */
struct lm_live_target {
    uint64_t heard_us;  /* arrival of the message: it ages by this */
    uint64_t motion_us; /* clock of what moves, at which the numbers hold */
    struct lm_position position;
    int32_t height_m_q6;     /* above mean sea level, if has_height; else it stands on the ground */
    fx_bam_t heading;        /* of the body, from north */
    int16_t velocity[2];     /* in 0.05 m/s, together up to LM_LIVE_SPEED_MAX */
    int16_t acceleration[2]; /* in 0.01 m/s2 */
    int16_t turn;            /* in 0.01 deg/s, right positive, up to LM_LIVE_TURN_MAX */
    int16_t rcs_dbsm_q8;     /* mean cross section */
    uint8_t kind;            /* below LM_LIVE_KINDS */
    uint8_t reckoning;       /* below LM_LIVE_RECKONINGS */
    uint8_t signature;       /* of the image, counted from 1; 0: none; of a beacon, its reply */
    uint8_t node;            /* sender */
    bool is_there, has_height;
};

/* The live targets by their numbers. */
struct lm_live {
    struct lm_live_target target[LM_LIVE_MAX];
    uint32_t count;  /* of those that are there */
    uint32_t change; /* grows whenever one comes, changes or goes */
};

/* Where it is and how it moves at some time. */
struct lm_live_state {
    struct lm_position position;
    fx_bam_t heading, course; /* of the body; of the velocity */
    uint32_t speed_mm_s;      /* below 2^20 */
};

/* State at `motion_us` of the clock of what moves; before the message as well as after it. Within
 * 0.1 m of the law; 1.5 m where the velocity grows and turns
 * (tests/unit/firmware/base/test_live.c).
 * Cost: 800 instructions, 1,000 more for a velocity that turns. */
struct lm_live_state lm_live_at(const struct lm_live_target *t, uint64_t motion_us);

#endif
