/* Faults of what a display unit lives on: flash, bus, screen, keys, clock. */
#ifndef FAULTS_H
#define FAULTS_H

#include "hs/rng.h"
#include "unit_rig.h"

enum kind {
    READS_FAIL,
    READS_FAIL_SOME,
    READS_LATE,
    READS_NEVER,
    READS_TORN,
    READS_FLIP,
    READS_REFUSED,
    READS_ELSEWHERE,
    BUS_SILENT,
    BUS_DOWN,
    BUS_FLOOD,
    BUS_ERRORS,
    FRAMES_LOST,
    FRAMES_OLD,
    FRAMES_AHEAD,
    SENDS_BUSY,
    SENDS_FAIL,
    QUESTIONS,
    NO_POSITION,
    NO_HEIGHT,
    NO_HEADING,
    NO_SPEED,
    NO_ATTITUDE,
    BAD_VALUES,
    STUCK_CODE,
    RIVAL,
    NO_WEATHER,
    NO_EXERCISE,
    NO_TARGETS,
    EXERCISE_LEAPS,
    JUMP_NEAR,
    JUMP_FAR,
    NO_SURFACE,
    SCREEN_FAILS,
    SHOWING_FAILS,
    SURFACE_LOST,
    KEY_STUCK,
    KEY_STORM,
    KEY_CHATTERS,
    STICK_HELD,
    BAD_CONTROLS,
    BAD_IMAGE,
    STARVED,
    STOPPED,
    LEAP,
    RESTART,
    KINDS
};

enum { FAULTS_TOLD = 16 };

/* A pixel that nothing draws: what is left in a surface that was lost. */
#define FAULTS_GARBAGE 0x00a1b2c3u

/* Faults that a rig can have. Between faults_begin and faults_end it flies by faults_step alone.
 * Its bus also tells an exercise: a clock, rain and a ship. */
struct faults {
    struct rig *r; /* borrowed; its flash, bus and keys are taken over */
    struct hs_rng rng;
    uint64_t standing;                     /* bits of enum kind */
    uint32_t draw;                         /* of the fault that began last: what it pleases */
    uint32_t bus_id;                       /* of the quantity that it concerns */
    uint64_t leapt_us;                     /* what the clock has leapt */
    uint32_t junk;                         /* frames still to come in this step */
    int32_t button;                        /* that is held down */
    struct lm_can_frame told[FAULTS_TOLD]; /* of the exercise, in this second */
    uint32_t told_count, told_next;
    uint64_t told_s; /* the second that is told next */
    bool is_down;    /* the key that chatters */
    bool has_rival;  /* the rival's frame comes next */
    struct lm_can_frame rival;
    struct lm_can can; /* as the rig has them */
    struct lm_flash flash;
    struct lm_controls controls;
};

/* Take over a rig before it flies. */
void faults_open(struct faults *f, struct rig *r);

/* Go on where another one was, on the same rig. The generator is copied. */
void faults_go_on(struct faults *f, const struct faults *from, const struct hs_rng *rng);

void faults_begin(struct faults *f, enum kind kind);
bool faults_stand(const struct faults *f, enum kind kind);
void faults_end(struct faults *f); /* all of them */

/* One step of the unit. */
void faults_step(struct faults *f);

#endif
