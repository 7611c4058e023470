/* Exchange of pages with another display (lm/swap.h). */
#ifndef LM_UNIT_SWAP_H
#define LM_UNIT_SWAP_H

#include "lm/unit.h"

/* Begin as `node` with the board's partner. Node 0, or one number for both: there is no partner,
 * and nothing is heard or said. */
void lm_swap_init(struct lm_unit *u, uint8_t node);

/* SWAP was pressed: ask the partner. No effect while an exchange is going on. */
void lm_swap_ask(struct lm_unit *u, uint64_t now_us);

/* Take any frame; only those of the partner have an effect. Any contents are safe. */
void lm_swap_take(struct lm_unit *u, const struct lm_can_frame *frame);

/* End what has waited for too long, and offer up to LM_SWAP_FRAMES_A_STEP frames. Never waits: what
 * the bus does not take now is offered in the next step. */
void lm_swap_send(struct lm_unit *u, uint64_t now_us);

#endif
