/* Controls: acts of the operator, from a key, a hand controller or a script.
 *
 * Drivers, the bench and scripts send them through struct lm_controls (lm/port.h):
 *
 *     drv_control_ring_put(ring, lm_control_button(true, 7));       button 7 goes down
 *     drv_control_ring_put(ring, (struct lm_control){.kind = LM_CONTROL_GAIN, .gain_db = 6});
 *
 * The unit alone knows what a key means. It checks every control and refuses bad ones. */
#ifndef LM_CONTROLS_H
#define LM_CONTROLS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/environment.h"
#include "lm/geo.h"
#include "lm/sar_command.h"

/* Rockers of the display: pairs of keys for more and less. A knob with detents is a rocker whose
 * driver sends down and up at each detent. */
enum lm_rocker { LM_ROCKER_GAIN, LM_ROCKER_SYM, LM_ROCKER_BRT, LM_ROCKER_CON, LM_ROCKERS };

/* Buttons are numbered from 1: the option select buttons (OSB) clockwise from the top left, then
 * the two keys of each rocker.
 *
 *            1  2  3  4  5
 *        20 +-------------+ 6
 *           |             |       21, 22  more and less of LM_ROCKER_GAIN
 *           |             |       23, 24  of LM_ROCKER_SYM
 *        16 +-------------+ 10    25..28  of LM_ROCKER_BRT and LM_ROCKER_CON
 *           15 14 13 12 11                                                    */
enum { LM_OSBS = 20, LM_BUTTONS = LM_OSBS + 2 * LM_ROCKERS };

/* Number of a rocker's key for more or less, LM_OSBS + 1..LM_BUTTONS. */
static inline int32_t lm_rocker_button(enum lm_rocker rocker, bool is_more)
{
    return LM_OSBS + 1 + 2 * (int32_t)rocker + !is_more;
}

/* Full deflection of the cursor control and of the range knob. Deflections have no unit. */
enum { LM_FULL_DEFLECTION = 1000 };

/* Kind of a control. The member of struct lm_control that it uses is named beside it. A kind
 * without a name there uses no member. */
enum lm_control_kind {
    /* Direct commands, for scripts, tests and an instructor's station. */
    LM_CONTROL_SECTOR,      /* sector: draw a sector of this mode and field of view */
    LM_CONTROL_SAR,         /* sar: draw a patch */
    LM_CONTROL_ENVIRONMENT, /* environment: rain, jammers, sea state; replaces the one before */
    LM_CONTROL_STEERPOINT,  /* steerpoint: steer to a position, or to the bus's steerpoint again */
    LM_CONTROL_CURSOR,      /* cursor: put the cursor at a place; ends snowplow */
    LM_CONTROL_RANGE,       /* range_nm: select a range scale */
    LM_CONTROL_AZIMUTH,     /* azimuth_index: select a width of the sector */
    LM_CONTROL_GAIN,        /* gain_db: set the gain */
    LM_CONTROL_FREEZE,      /* is_frozen: hold the picture, or release it */

    /* Acts of hands. lm/keys.h says when a button that is held acts again. */
    LM_CONTROL_DOWN,      /* button: has just been pressed */
    LM_CONTROL_UP,        /* button: has just been released */
    LM_CONTROL_KNOB,      /* knob: the range knob was turned to this deflection */
    LM_CONTROL_SLEW,      /* slew: the cursor control was moved to this deflection */
    LM_CONTROL_DESIGNATE, /* target management switch up */
    LM_CONTROL_DROP,      /* target management switch down */
    LM_CONTROL_TRACK,     /* target management switch right: track what is at the cursor */
    LM_CONTROL_RANGING,   /* range the ground straight ahead, or end that */

    /* No act of anybody's: what the board says of its database and of images beside it. */
    LM_CONTROL_SLOTS, /* slots: replaces what it said before */
    LM_CONTROL_IMAGE  /* image: has come to its place in the flash, or goes */
};
enum { LM_CONTROL_KINDS = LM_CONTROL_IMAGE + 1 };

/* How far a load of a database is. */
enum lm_load { LM_LOAD_NONE, LM_LOAD_RUNS, LM_LOAD_DONE, LM_LOAD_FAILED, LM_LOADS };

/* The two slots of the database (docs/slots.md), for the BIT page. All zero: nothing is known. */
struct lm_slots_state {
    int32_t flown;   /* 1 slot A, 2 slot B; 0: neither */
    int32_t damaged; /* bits 0 and 1: slot A, slot B */
    int32_t cut_off; /* likewise: a load has not come to its end */
    int32_t load;    /* enum lm_load */
    int32_t percent; /* of a load that runs: 0..100 */
};

/* An image beside the database. */
struct lm_image_change {
    int32_t place;    /* 2..LM_IMAGES_MAX, as people count them; where no other is, if it comes */
    uint32_t crc;     /* of a replay alone, which knows it by this */
    uint64_t bytes;   /* of its flash; 0: it goes */
    bool is_unsigned; /* the board does not know who made it: LM_FLAG_UNSIGNED while it is there */
};

/* One act of the operator. Only the member that belongs to `kind` means anything.
 *
 * Indices and numbers are wide enough to carry a sender's mistake. The unit checks each one when it
 * applies the control. If one is out of its range, it refuses the whole control, changes nothing,
 * and counts it (commands_refused). */
struct lm_control {
    enum lm_control_kind kind;
    union {
        struct {
            int32_t mode; /* enum lm_sector_mode */
            int32_t fov;  /* enum lm_fov; one that the mode has */
        } sector;
        struct lm_sar_command sar; /* limits: lm_sar_start */
        struct lm_environment environment;
        struct {
            bool is_set; /* true: steer to `position`; false: to the steerpoint of the bus */
            struct lm_position position; /* latitude -90..90 degrees, also when is_set is false */
        } steerpoint;
        struct lm_position cursor; /* latitude -90..90 degrees */
        int32_t range_nm;          /* a range scale of the table that mode and field of view have */
        int32_t azimuth_index;     /* 0..LM_AZIMUTHS - 1 */
        int32_t gain_db;           /* added to the gain of the radar table: -30..30 */
        bool is_frozen;
        int32_t button; /* 1..LM_BUTTONS */
        int32_t knob;   /* -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION */
        struct {
            int32_t x, y; /* right and up, -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION; the unit
                             holds them until the next slew */
        } slew;
        struct lm_slots_state slots;
        struct lm_image_change image;
    };
};

/* A button that goes down or up; `button` is 1..LM_BUTTONS. */
static inline struct lm_control lm_control_button(bool is_down, int32_t button)
{
    return (struct lm_control){.kind = is_down ? LM_CONTROL_DOWN : LM_CONTROL_UP, .button = button};
}

/* The range knob at a deflection, -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION. */
static inline struct lm_control lm_control_knob(int32_t deflection)
{
    return (struct lm_control){.kind = LM_CONTROL_KNOB, .knob = deflection};
}

/* The cursor control at a deflection to the right and up, each within LM_FULL_DEFLECTION. */
static inline struct lm_control lm_control_slew(int32_t x, int32_t y)
{
    return (struct lm_control){.kind = LM_CONTROL_SLEW, .slew = {x, y}};
}

/* Target management switch up: designate. */
static inline struct lm_control lm_control_designate(void)
{
    return (struct lm_control){.kind = LM_CONTROL_DESIGNATE};
}

/* Target management switch down: drop. */
static inline struct lm_control lm_control_drop(void)
{
    return (struct lm_control){.kind = LM_CONTROL_DROP};
}

#endif
