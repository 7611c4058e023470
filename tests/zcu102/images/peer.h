/* Somebody else on the bus: the second core, with the second CAN controller, sends frames at their
 * times. */
#ifndef PEER_H
#define PEER_H

#include "board.h"

struct peer {
    struct zcu102 *board; /* borrowed: its clock and its interrupt controller */
    const struct lm_can_frame *frames;
    uint32_t count;
    volatile uint32_t sent, refused; /* refused: the controller's FIFO was full */
};

/* Start the core; `p` must outlive the program. False when the boot firmware refuses. */
bool peer_start(struct peer *p);

#endif
