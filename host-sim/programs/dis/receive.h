/* Receiver: datagrams from a UDP port. */
#ifndef DIS_RECEIVE_H
#define DIS_RECEIVE_H

#include <stddef.h>
#include <stdint.h>

struct receiver {
    int socket;
    uint32_t lost; /* by the kernel, for want of room */
};

/* Listen on `port` at `bind` (NULL: loopback, or everywhere with a group), in the multicast group
 * `group` (NULL: none). Returns 0, or -1 with the error reported. */
int receiver_open(struct receiver *r, long port, const char *bind_to, const char *group);

/* Wait at most `wait_ms` for a datagram. Returns 1 and its length, 0 when none came, or -1 with the
 * error reported. */
int receiver_next(struct receiver *r, int wait_ms, uint8_t *bytes, size_t room, size_t *length);

void receiver_close(struct receiver *r);

#endif
