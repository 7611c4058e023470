/* Bus of the panel: the SocketCAN driver, which reopens its interface by itself, and reports of its
 * state for the log. */
#ifndef PANEL_BUS_H
#define PANEL_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "drv/can_socket.h"
#include "lm/bus_profile.h"
#include "lm/port.h"

struct bus {
    struct drv_can_socket socket;
    struct lm_can driver; /* the socket's port, or one that is not fitted */
    struct lm_can port;   /* port for the firmware */
    bool is_lost;         /* a loss was reported, and no frame came since */
    uint32_t polls;       /* times that the firmware asked for frames */
};

/* Open the interface; an empty name means no bus. Never fails: an interface that is missing is
 * reported and looked for from then on. What is heard is what
 * the profile takes, and `beside`, which may be NULL. `zero_us` is the time of CLOCK_MONOTONIC at
 * which the firmware's clock is 0. *b must not move until bus_close. */
void bus_open(struct bus *b, const char *interface, const struct lm_bus_profile *profile,
              const struct lm_bus_profile *beside, uint64_t zero_us);
void bus_close(struct bus *b);

/* File descriptor for poll(): readable when a frame waits; -1: the bus is not open now. */
int bus_fd(const struct bus *b);

#endif
