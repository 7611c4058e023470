#include "lm/keys.h"

static uint32_t bit_of(uint8_t button)
{
    return 1u << (button - 1);
}

bool lm_keys_down(struct lm_keys *k, uint8_t button, enum lm_key_style style, uint64_t now_us)
{
    k->down |= bit_of(button);
    k->spent &= ~bit_of(button);
    k->key[button - 1] = (struct lm_key){
        .down_us = now_us,
        .next_us = now_us + (style == LM_KEY_HAS_LONG ? LM_KEY_LONG_US : LM_KEY_REPEAT_AFTER_US),
        .style = style,
    };
    return style != LM_KEY_HAS_LONG;
}

bool lm_keys_up(struct lm_keys *k, uint8_t button, uint64_t now_us)
{
    const struct lm_key *key = &k->key[button - 1];
    const bool was_open = (k->down & ~k->spent & bit_of(button)) != 0;
    k->down &= ~bit_of(button);
    k->spent &= ~bit_of(button);
    return was_open && key->style == LM_KEY_HAS_LONG && now_us - key->down_us < LM_KEY_LONG_US;
}

/* True, and *press, if a press of a held button is due. Marks a button that is stuck. */
static bool act(struct lm_keys *k, uint8_t button, uint64_t now_us, struct lm_press *press)
{
    struct lm_key *key = &k->key[button - 1];
    if (now_us - key->down_us >= LM_KEY_STUCK_US) {
        k->spent |= bit_of(button);
        k->count.stuck++;
        return false;
    }
    if (key->style == LM_KEY_ONCE || now_us < key->next_us) {
        return false;
    }
    *press = (struct lm_press){button, key->style == LM_KEY_HAS_LONG};
    key->next_us = press->is_long ? UINT64_MAX : now_us + LM_KEY_REPEAT_EVERY_US;
    return true;
}

bool lm_keys_held(struct lm_keys *k, uint64_t now_us, struct lm_press *press)
{
    for (uint8_t button = 1; button <= LM_BUTTONS && (k->down & ~k->spent) != 0; button++) {
        if ((k->down & ~k->spent & bit_of(button)) && act(k, button, now_us, press)) {
            return true;
        }
    }
    return false;
}
