/* Button timing: buttons that go down and up become presses: short, long and repeated.
 *
 *   style     acts
 *   once      when it goes down
 *   repeats   when it goes down, again after 0.5 s, then ten times a second
 *   has long  when it is released within 0.8 s; or once, as a long press, when held for 0.8 s
 *
 * A button that has been down for 15 s is stuck: it is counted and ignored until it is released. A
 * second "down" without an "up" between them (the "up" was lost) is a new press. An "up" of a
 * button that is not down has no effect. */
#ifndef LM_KEYS_H
#define LM_KEYS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/controls.h"

enum {
    LM_KEY_REPEAT_AFTER_US = 500000,
    LM_KEY_REPEAT_EVERY_US = 100000,
    LM_KEY_LONG_US = 800000,
    LM_KEY_STUCK_US = 15000000
};

enum lm_key_style { LM_KEY_ONCE, LM_KEY_REPEATS, LM_KEY_HAS_LONG };

/* State of all buttons; the caller owns it. All zero: no button is held. */
struct lm_keys {
    uint32_t down;  /* bit n - 1: button n is held */
    uint32_t spent; /* bit n - 1: button n is ignored until it is released */
    struct lm_key {
        uint64_t down_us;        /* time when it went down */
        uint64_t next_us;        /* time when it acts again, if it repeats */
        enum lm_key_style style; /* style when it went down */
    } key[LM_BUTTONS];
    struct {
        uint32_t stuck; /* presses that lasted LM_KEY_STUCK_US */
    } count;            /* only ever grow */
};

struct lm_press {
    uint8_t button; /* 1..LM_BUTTONS */
    bool is_long;
};

/* Report that a button, 1..LM_BUTTONS, went down, with the style that it has now. `now_us` never
 * goes back. Returns true if it acts at once, as a short press. */
bool lm_keys_down(struct lm_keys *k, uint8_t button, enum lm_key_style style, uint64_t now_us);

/* Report that a button, 1..LM_BUTTONS, was released. Returns true if it acts now, as a short press:
 * its style is LM_KEY_HAS_LONG and it was not held long. */
bool lm_keys_up(struct lm_keys *k, uint8_t button, uint64_t now_us);

/* Take the next press that is due because a button is held. Returns true and *press, or false if
 * none is due. Missed repeats are dropped, so LM_BUTTONS calls always suffice. */
bool lm_keys_held(struct lm_keys *k, uint64_t now_us, struct lm_press *press);

#endif
