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
    BUS_SILENT,
    BUS_DOWN,
    BUS_FLOOD,
    BUS_ERRORS,
    NO_POSITION,
    NO_HEIGHT,
    NO_HEADING,
    NO_SPEED,
    NO_ATTITUDE,
    BAD_VALUES,
    STUCK_CODE,
    RIVAL,
    JUMP_NEAR,
    JUMP_FAR,
    NO_SURFACE,
    SCREEN_FAILS,
    SHOWING_FAILS,
    KEY_STUCK,
    KEY_STORM,
    BAD_CONTROLS,
    STARVED,
    STOPPED,
    LEAP,
    RESTART,
    KINDS
};

/* Faults that a rig can have. Between faults_begin and faults_end it flies by faults_step alone. */
struct faults {
    struct rig *r; /* borrowed; its flash, bus and keys are taken over */
    struct hs_rng rng;
    uint32_t standing; /* bits of enum kind */
    uint32_t draw;     /* of the fault that began last: what it pleases */
    uint32_t bus_id;   /* of the quantity that it concerns */
    uint64_t leapt_us; /* what the clock has leapt */
    uint32_t junk;     /* frames still to come in this step */
    int32_t button;    /* that is held down */
    bool has_rival;    /* the rival's frame comes next */
    struct lm_can_frame rival;
    struct lm_can can; /* as the rig has them */
    struct lm_flash flash;
    struct lm_controls controls;
};

/* Take over a rig that is in flight. The generator is copied. */
void faults_open(struct faults *f, struct rig *r, const struct hs_rng *rng);

void faults_begin(struct faults *f, enum kind kind);
bool faults_stand(const struct faults *f, enum kind kind);
void faults_end(struct faults *f); /* all of them */

/* One step of the unit. */
void faults_step(struct faults *f);

#endif
