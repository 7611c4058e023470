/* Buttons that become presses (lm/keys.h).
 *
 * Invariant: bits of `down` and `spent` are those of buttons.
 *
 * Proved, for any state that keeps it, each button, any style and any time: it is kept; no access
 * outside an object, no shift too wide; a press that is handed out is of a button that is down; the
 * loop over buttons ends.
 *
 * Assumed: the button is one of 1..LM_BUTTONS. commands.c refuses others before. */
#include "firmware/page/keys.c"

#include "prove.h"

struct lm_keys nondet_keys(void);

static bool is_kept(const struct lm_keys *k)
{
    return (k->down | k->spent) >> LM_BUTTONS == 0;
}

static uint8_t a_button(void)
{
    const uint8_t button = nondet_u8();
    ASSUME(button >= 1 && button <= LM_BUTTONS);
    return button;
}

void prove_down(void)
{
    struct lm_keys k = nondet_keys();
    const uint8_t button = a_button();
    ASSUME(is_kept(&k));
    lm_keys_down(&k, button, (enum lm_key_style)nondet_u32(), nondet_u64());
    PROVE(is_kept(&k) && (k.down >> (button - 1) & 1) != 0 && (k.spent >> (button - 1) & 1) == 0);
}

void prove_up(void)
{
    struct lm_keys k = nondet_keys();
    const uint8_t button = a_button();
    ASSUME(is_kept(&k));
    lm_keys_up(&k, button, nondet_u64());
    PROVE(is_kept(&k) && (k.down >> (button - 1) & 1) == 0);
}

void prove_held(void)
{
    struct lm_keys k = nondet_keys();
    struct lm_press press;
    ASSUME(is_kept(&k));
    if (lm_keys_held(&k, nondet_u64(), &press)) {
        PROVE(press.button >= 1 && press.button <= LM_BUTTONS &&
              (k.down >> (press.button - 1) & 1) != 0);
    }
    PROVE(is_kept(&k));
}
