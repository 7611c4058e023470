/* Controls: what an operator does, whatever he does it with (a key, a hand controller, a script).
 * Drivers, bench and scripts send them through struct lm_controls (lm/port.h); the unit alone knows
 * what a key means. */
#ifndef LM_CONTROLS_H
#define LM_CONTROLS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/environment.h"
#include "lm/geo.h"
#include "lm/sar_command.h"

/* Buttons are numbered from 1: the option select buttons (OSB) clockwise from the top left, then
 * the two halves of each rocker. A knob with detents is a rocker whose driver sends down and up at
 * each detent. */
enum lm_rocker { LM_ROCKER_GAIN, LM_ROCKER_SYM, LM_ROCKER_BRT, LM_ROCKER_CON, LM_ROCKERS };
enum { LM_OSBS = 20, LM_BUTTONS = LM_OSBS + 2 * LM_ROCKERS };

static inline int32_t lm_rocker_button(enum lm_rocker rocker, bool is_more)
{
    return LM_OSBS + 1 + 2 * (int32_t)rocker + !is_more;
}

/* Full deflection of the cursor control and of the range knob. */
enum { LM_FULL_DEFLECTION = 1000 };

/* What a control does. Each kind has one member of struct lm_control, named beside it; a kind
 * without one needs no more than itself. */
enum lm_control_kind {
    /* Direct commands, for scripts, tests and an instructor's station. */
    LM_CONTROL_SECTOR,      /* sector: draw a sector of this mode and field of view */
    LM_CONTROL_SAR,         /* sar: draw a patch */
    LM_CONTROL_ENVIRONMENT, /* environment: rain, jammers, sea state; replaces the one before */
    LM_CONTROL_STEERPOINT,  /* steerpoint: steer to a place, or as the bus says again */
    LM_CONTROL_RANGE,       /* range_nm: select a range scale */
    LM_CONTROL_AZIMUTH,     /* azimuth_index: select a width of the sector */
    LM_CONTROL_GAIN,        /* gain_db: set the gain */
    LM_CONTROL_FREEZE,      /* is_frozen: hold the picture, or go on */

    /* What hands do. lm/keys.h says when a button that is held acts again. */
    LM_CONTROL_DOWN,      /* button: has just been pressed */
    LM_CONTROL_UP,        /* button: has just been let go */
    LM_CONTROL_KNOB,      /* knob: the range knob was turned to this deflection */
    LM_CONTROL_SLEW,      /* slew: the cursor control was moved to this deflection */
    LM_CONTROL_DESIGNATE, /* target management switch up */
    LM_CONTROL_DROP       /* target management switch down */
};

/* One act of the operator. Only the member that belongs to `kind` means anything. Indices and
 * numbers are as wide as a sender may get them wrong: the unit checks each one where it is applied,
 * refuses the whole control when one is out of its range, and counts it (commands_refused). */
struct lm_control {
    enum lm_control_kind kind;
    union {
        struct {
            int32_t mode; /* enum lm_sector_mode */
            int32_t fov;  /* field of view, enum lm_fov: as far as the mode has it */
        } sector;
        struct lm_sar_command sar; /* limits: lm_sar_start */
        struct lm_environment environment;
        struct {
            bool is_set; /* true: steer to `place`, whatever the bus says; false: as the
                            bus says */
            struct lm_position position; /* latitude -90..90 degrees, also when is_set is false */
        } steerpoint;
        int32_t range_nm;      /* of a scale of the radar table that mode and field of view have */
        int32_t azimuth_index; /* 0..LM_AZIMUTHS - 1 */
        int32_t gain_db;       /* brighter than the radar table says: -30..30 */
        bool is_frozen;
        int32_t button; /* 1..LM_BUTTONS */
        int32_t knob;   /* -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION */
        struct {
            int32_t x, y; /* to the right and up, -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION; holds
                             until the next one */
        } slew;
    };
};

/* The controls of hands, as drivers send them:
 *
 *     drv_control_ring_put(ring, lm_control_button(true, 7)); */
static inline struct lm_control lm_control_button(bool is_down, int32_t button)
{
    return (struct lm_control){.kind = is_down ? LM_CONTROL_DOWN : LM_CONTROL_UP, .button = button};
}

static inline struct lm_control lm_control_knob(int32_t deflection)
{
    return (struct lm_control){.kind = LM_CONTROL_KNOB, .knob = deflection};
}

static inline struct lm_control lm_control_slew(int32_t x, int32_t y)
{
    return (struct lm_control){.kind = LM_CONTROL_SLEW, .slew = {x, y}};
}

static inline struct lm_control lm_control_designate(void)
{
    return (struct lm_control){.kind = LM_CONTROL_DESIGNATE};
}

static inline struct lm_control lm_control_drop(void)
{
    return (struct lm_control){.kind = LM_CONTROL_DROP};
}

#endif
