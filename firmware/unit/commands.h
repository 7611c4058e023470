/* What the operator wants: keys, hand controls and direct commands, obeyed. */
#ifndef LM_UNIT_COMMANDS_H
#define LM_UNIT_COMMANDS_H

#include "lm/unit.h"

/* Do what a press asked for (enum lm_effect). */
void lm_apply_effects(struct lm_unit *u, uint32_t effects, uint64_t now_us);

/* Take keys and commands that wait. Refused ones are counted. */
void lm_take_controls(struct lm_unit *u, uint64_t now_us);

#endif
