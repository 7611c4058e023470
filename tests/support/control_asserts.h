/* Assertions on what an operator did. */
#ifndef CONTROL_ASSERTS_H
#define CONTROL_ASSERTS_H

#include "check.h"
#include "lm/controls.h"

/* The same kind, and the same in the member that belongs to it. For the kinds that hands send. */
static inline void assert_same_control(const struct lm_control *c, struct lm_control expected)
{
    assert_int_equal(c->kind, expected.kind);
    switch (expected.kind) {
    case LM_CONTROL_DOWN:
    case LM_CONTROL_UP:
        assert_int_equal(c->button, expected.button);
        break;
    case LM_CONTROL_KNOB:
        assert_int_equal(c->knob, expected.knob);
        break;
    case LM_CONTROL_SLEW:
        assert_int_equal(c->slew.x, expected.slew.x);
        assert_int_equal(c->slew.y, expected.slew.y);
        break;
    case LM_CONTROL_DESIGNATE:
    case LM_CONTROL_DROP:
        break;
    default:
        fail_msg("kind %d is none of a hand", (int)expected.kind);
    }
}

#endif
