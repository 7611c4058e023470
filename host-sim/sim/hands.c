#include "sim/hands.h"

#include <string.h>

static void put(struct hands *h, struct lm_control control)
{
    if (h->head - h->tail == HANDS_QUEUE) {
        h->lost++;
        return;
    }
    h->queue[h->head++ % HANDS_QUEUE] = control;
}

static int next(void *ctx, struct lm_control *control)
{
    struct hands *h = ctx;
    h->is_scripted = h->script && h->script->next(h->script->ctx, control) == 1;
    if (h->is_scripted) {
        return 1;
    }
    if (h->tail == h->head) {
        return 0;
    }
    *control = h->queue[h->tail++ % HANDS_QUEUE];
    return 1;
}

/* The glass tells the hand; the script is told by its port. */
static void refused(void *ctx, enum lm_refusal reason)
{
    const struct hands *h = ctx;
    if (h->is_scripted && h->script->refused) {
        h->script->refused(h->script->ctx, reason);
    }
}

void hands_init(struct hands *h, const struct lm_controls *script)
{
    memset(h, 0, sizeof *h);
    h->script = script;
    h->port = (struct lm_controls){.ctx = h, .next = next, .refused = refused};
}

void hands_button(struct hands *h, int32_t button, bool is_down)
{
    const uint32_t bit = 1u << (button - 1);
    if (((h->down & bit) != 0) == is_down) {
        return; /* held by mouse and keyboard at once */
    }
    h->down ^= bit;
    put(h, lm_control_button(is_down, button));
}

void hands_arrow(struct hands *h, enum hands_arrow arrow, bool is_down)
{
    if (h->arrows[arrow] == is_down) {
        return;
    }
    h->arrows[arrow] = is_down;
    put(h, lm_control_slew(LM_FULL_DEFLECTION * (h->arrows[HANDS_RIGHT] - h->arrows[HANDS_LEFT]),
                           LM_FULL_DEFLECTION * (h->arrows[HANDS_UP] - h->arrows[HANDS_DOWN])));
}

void hands_turn_knob(struct hands *h, int32_t thousandths)
{
    const int32_t turned = h->knob + thousandths;
    h->knob = turned > LM_FULL_DEFLECTION    ? LM_FULL_DEFLECTION
              : turned < -LM_FULL_DEFLECTION ? -LM_FULL_DEFLECTION
                                             : turned;
    put(h, lm_control_knob(h->knob));
}

void hands_designate(struct hands *h)
{
    put(h, lm_control_designate());
}

void hands_drop(struct hands *h)
{
    put(h, lm_control_drop());
}

void hands_off(struct hands *h)
{
    for (int32_t button = 1; button <= LM_BUTTONS; button++) {
        if (h->down >> (button - 1) & 1) {
            hands_button(h, button, false);
        }
    }
    for (int arrow = 0; arrow < 4; arrow++) {
        hands_arrow(h, (enum hands_arrow)arrow, false);
    }
}
