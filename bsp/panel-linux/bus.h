/* The panel's avionics bus: a SocketCAN interface that may be missing at the start, go down, be
 * removed and come back. */
#ifndef PANEL_BUS_H
#define PANEL_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "drv/can_socket.h"
#include "lm/port.h"

struct bus {
    const char *interface; /* borrowed; empty: no bus */
    uint64_t zero_us;
    struct drv_can_socket socket;
    struct lm_can driver; /* the open socket's */
    struct lm_can port;   /* the firmware's */
    bool is_failed;       /* the driver reported an error since it was opened */
    bool was_up;          /* as it was reported last */
    uint64_t retry_us;

    struct {
        uint32_t polls; /* times that the firmware asked for frames */
        uint32_t opens;
    } count;
};

/* Never fails: a bus that is not there is reported and tried again twice a second. `zero_us` is
 * where the firmware's clock has its 0. */
void bus_open(struct bus *b, const char *interface, uint64_t zero_us);
void bus_close(struct bus *b);

/* At every step, before the firmware's. */
void bus_service(struct bus *b, uint64_t now_us);

/* For poll(): readable when a frame waits; -1: there is no bus. */
int bus_fd(const struct bus *b);

#endif
