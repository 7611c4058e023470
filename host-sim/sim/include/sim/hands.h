/* Operator's controls at the bench: what the operator does in the window, queued for the unit
 * behind what the script does. */
#ifndef SIM_HANDS_H
#define SIM_HANDS_H

#include "lm/controls.h"
#include "lm/port.h"

#include <stdbool.h>
#include <stdint.h>

enum { HANDS_QUEUE = 64 };

/* All zero is an operator who does nothing. */
struct hands {
    const struct lm_controls *script; /* borrowed; NULL: none */
    struct lm_control queue[HANDS_QUEUE];
    uint32_t head, tail;
    uint32_t down;    /* bit n - 1: button n is held by mouse or keyboard */
    bool arrows[4];   /* left, right, up, down */
    int32_t knob;     /* thousandths */
    uint32_t lost;    /* controls that found the queue full */
    bool is_scripted; /* the control handed out last came from the script */
    struct lm_controls port;
};

/* `script` is asked first, and borrowed; the port's ctx is *h, which must not move. */
void hands_init(struct hands *h, const struct lm_controls *script);

/* Press or release button 1..LM_BUTTONS. What it is already has no effect. */
void hands_button(struct hands *h, int32_t button, bool is_down);
enum hands_arrow { HANDS_LEFT, HANDS_RIGHT, HANDS_UP, HANDS_DOWN };
/* Press or release an arrow key: the cursor is slewed at full deflection while one is held. */
void hands_arrow(struct hands *h, enum hands_arrow arrow, bool is_down);
/* Turn the range knob by thousandths of full deflection; it stops at either end. */
void hands_turn_knob(struct hands *h, int32_t thousandths);
/* Target management switch: up, or down. */
void hands_designate(struct hands *h);
void hands_drop(struct hands *h);

/* Let go of everything: the window lost the keyboard. */
void hands_off(struct hands *h);

#endif
