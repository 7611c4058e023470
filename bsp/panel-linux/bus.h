/* The panel's avionics bus: the SocketCAN driver, which mends itself, with its state in words for
 * the log. */
#ifndef PANEL_BUS_H
#define PANEL_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "drv/can_socket.h"
#include "lm/bus_profile.h"
#include "lm/port.h"

struct bus {
    struct drv_can_socket socket;
    struct lm_can driver; /* the socket's, or one that is not fitted */
    struct lm_can port;   /* the firmware's */
    bool is_lost;         /* reported, and no frame came since */
    uint32_t polls;       /* times that the firmware asked for frames */
};

/* Never fails: an interface that is not there is reported, and looked for from then on. An empty
 * name: no bus. `zero_us` is where the firmware's clock has its 0; *b must not move. */
void bus_open(struct bus *b, const char *interface, const struct lm_bus_profile *profile,
              uint64_t zero_us);
void bus_close(struct bus *b);

/* For poll(): readable when a frame waits; -1: there is none now. */
int bus_fd(const struct bus *b);

#endif
