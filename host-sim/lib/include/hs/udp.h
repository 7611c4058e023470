/* UDP: datagrams from a port of this machine. */
#ifndef HS_UDP_H
#define HS_UDP_H

#include <netinet/in.h>
#include <stddef.h>
#include <stdint.h>

struct hs_udp {
    int socket;
    uint32_t lost; /* by the kernel, for want of room */
};

/* Listen on `port` at `bind_to` (NULL: loopback, or everywhere with a group), in the multicast
 * group `group` (NULL: none). Returns 0, or -1 with the error reported. */
int hs_udp_open(struct hs_udp *u, long port, const char *bind_to, const char *group);

/* Wait at most `wait_ms` for a datagram; a longer one than `room` is cut. `from` is its sender, and
 * may be NULL. Returns 1 and its length, 0 when none came, or -1 with the error reported. */
int hs_udp_next(struct hs_udp *u, int wait_ms, uint8_t *bytes, size_t room, size_t *length,
                struct sockaddr_in *from);

/* Send a datagram from that port. What the network refuses is lost, as datagrams are. */
void hs_udp_send(const struct hs_udp *u, const struct sockaddr_in *to, const void *bytes,
                 size_t length);

void hs_udp_close(struct hs_udp *u);

#endif
