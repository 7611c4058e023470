/* What an operator can do, whatever he does it with: a key, a script or a hand controller. GPIO,
 * USB and the bench all speak in these, and the core alone knows what a key means. */
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

enum lm_control_kind {
    /* Direct commands, for scripts, tests and an instructor's station. */
    LM_CONTROL_SECTOR,      /* value: enum lm_sector_mode; value_y: enum lm_field */
    LM_CONTROL_SAR,         /* a patch: see `sar` */
    LM_CONTROL_ENVIRONMENT, /* rain, jammers, sea: see `environment` */
    LM_CONTROL_STEERPOINT,  /* value: 1 steer to `place`, whatever the bus says; 0: as the bus says
                             */
    LM_CONTROL_RANGE,       /* value: 0..LM_RANGES - 1 */
    LM_CONTROL_AZIMUTH,     /* value: 0..LM_AZIMUTHS - 1 */
    LM_CONTROL_GAIN,        /* value: decibels brighter than the table says, -30..30 */
    LM_CONTROL_FREEZE,      /* value: 1 on, 0 off */

    /* What hands do. lm/keys.h says when a button that is held acts again. */
    LM_CONTROL_DOWN,      /* value: the button, 1..LM_BUTTONS, that has just been pressed */
    LM_CONTROL_UP,        /* value: the button that was let go */
    LM_CONTROL_KNOB,      /* value: range knob, -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION */
    LM_CONTROL_SLEW,      /* value, value_y: cursor to the right and up, up to full deflection each;
                             holds until the next one */
    LM_CONTROL_DESIGNATE, /* target management switch up */
    LM_CONTROL_DROP       /* target management switch down */
};

struct lm_control {
    enum lm_control_kind kind;
    int32_t value, value_y;
    struct lm_sar_command sar;
    struct lm_environment environment;
    struct lm_place place;
};

#endif
