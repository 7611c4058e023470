/* Commands: keys, hand controls and direct commands of the operator, applied to the unit. */
#ifndef LM_UNIT_COMMANDS_H
#define LM_UNIT_COMMANDS_H

#include "lm/unit.h"

/* Carry out the effects (bits of enum lm_effect) of a press or command. */
void lm_apply_effects(struct lm_unit *u, uint32_t effects, uint64_t now_us);

/* Apply the presses that are due and at most 8 controls that wait. Refused controls are counted in
 * u->count.commands_refused. */
void lm_take_controls(struct lm_unit *u, uint64_t now_us);

/* Show and count that something cannot be done. */
void lm_refuse(struct lm_unit *u, enum lm_refusal reason, uint64_t now_us);

#endif
