/* Button timing: from buttons that go down and up to presses, short, long and repeated.
 *
 *   once      acts when it goes down.
 *   repeats   acts when it goes down, again after 0.5 s, then ten times a second.
 *   has long  acts when it is let go within 0.8 s; held that long it acts once, as a long press.
 *
 * A button that has been down for 15 s is stuck: it is counted and means nothing until it is let
 * go. A second "down" without an "up" between (the "up" was lost) is a new press; an "up" of a
 * button that is not down is nothing. */
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

/* All zero is a panel that nobody touches. */
struct lm_keys {
    uint32_t down;  /* bit n - 1: button n is held */
    uint32_t spent; /* bit n - 1: button n means nothing more until it is let go */
    struct lm_key {
        uint64_t down_us;        /* when it went down */
        uint64_t next_us;        /* when it acts again, if it repeats */
        enum lm_key_style style; /* as it was when the button went down */
    } key[LM_BUTTONS];
    struct {
        uint32_t stuck; /* presses that lasted LM_KEY_STUCK_US */
    } count;            /* only ever grow */
};

struct lm_press {
    uint8_t button; /* 1..LM_BUTTONS */
    bool is_long;
};

/* A button, 1..LM_BUTTONS, went down. `style` is how it behaves now; `now_us` never goes back.
 * Returns true when it acts at once, as a short press. */
bool lm_keys_down(struct lm_keys *k, uint8_t button, enum lm_key_style style, uint64_t now_us);

/* A button, 1..LM_BUTTONS, was let go. Returns true when it acts now, as a short press: one that
 * may be held long and was not. */
bool lm_keys_up(struct lm_keys *k, uint8_t button, uint64_t now_us);

/* The next press that holding a button has brought about by now: true and *press, or false when
 * there is none. Repeats that were missed are not made up for, so that LM_BUTTONS calls always
 * suffice. */
bool lm_keys_held(struct lm_keys *k, uint64_t now_us, struct lm_press *press);

#endif
