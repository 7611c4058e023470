/* Check of a SocketCAN interface: what the kernel tells of it over netlink. Nothing is sent on the
 * bus. */
#ifndef PANEL_CHECK_BUS_H
#define PANEL_CHECK_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What the kernel tells of an interface. */
struct bus_link {
    bool is_can, is_up;
    bool has_controller; /* false: virtual, or it tells nothing */
    uint32_t bits_per_s; /* 0: not set */
    uint32_t restart_ms; /* 0: it stays off the bus for ever once it is */
    uint32_t state;      /* enum can_state of linux/can/netlink.h */
};

/* Read the answer to RTM_GETLINK. False if it is none. Any bytes are safe. */
bool bus_link_read(struct bus_link *link, const uint8_t *answer, size_t size);

/* Report what is wrong with the interface that an option names, with the remedy; true if nothing
 * is, or the name is empty. */
bool check_bus(const char *option, const char *interface);

#endif
