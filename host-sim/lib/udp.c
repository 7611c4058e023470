#include "hs/udp.h"

#include "hs/error.h"

#include <arpa/inet.h>
#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { ROOM_BYTES = 4 << 20 };

static int join(int socket, const char *group)
{
    struct ip_mreq request = {.imr_interface.s_addr = htonl(INADDR_ANY)};
    (void)inet_pton(AF_INET, group, &request.imr_multiaddr);
    return setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request);
}

int hs_udp_open(struct hs_udp *u, long port, const char *bind_to, const char *group)
{
    const int on = 1, room = ROOM_BYTES;
    const char *address = bind_to != NULL ? bind_to : group != NULL ? "0.0.0.0" : "127.0.0.1";
    struct sockaddr_in here = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    char place[80];
    snprintf(place, sizeof place, "UDP port %ld at %s", port, address);
    (void)inet_pton(AF_INET, address, &here.sin_addr);
    *u = (struct hs_udp){.socket = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
    if (u->socket < 0) {
        return hs_error(place, NULL, "cannot be opened: %s", strerror(errno));
    }
    /* Others of this machine may listen to the same exercise. What fails here is no loss. */
    (void)setsockopt(u->socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    (void)setsockopt(u->socket, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    (void)setsockopt(u->socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    if (bind(u->socket, (const struct sockaddr *)&here, sizeof here) != 0 ||
        (group != NULL && join(u->socket, group) != 0)) {
        const int cause = errno;
        hs_udp_close(u);
        return hs_error(place, "choose another port, or an address of this machine",
                        "cannot be listened to: %s", strerror(cause));
    }
    return 0;
}

/* The kernel counts what it lost in a message beside the datagram. */
static void note_lost(struct hs_udp *u, struct msghdr *message)
{
    for (struct cmsghdr *c = CMSG_FIRSTHDR(message); c != NULL; c = CMSG_NXTHDR(message, c)) {
        if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
            memcpy(&u->lost, CMSG_DATA(c), sizeof u->lost);
        }
    }
}

int hs_udp_next(struct hs_udp *u, int wait_ms, uint8_t *bytes, size_t room, size_t *length,
                struct sockaddr_in *from)
{
    struct pollfd waiting = {.fd = u->socket, .events = POLLIN};
    if (poll(&waiting, 1, wait_ms) <= 0) {
        return 0; /* none, or a signal */
    }
    union {
        char bytes[64];
        struct cmsghdr aligned;
    } beside;
    struct iovec part = {bytes, room};
    struct msghdr message = {.msg_name = from,
                             .msg_namelen = from ? sizeof *from : 0,
                             .msg_iov = &part,
                             .msg_iovlen = 1,
                             .msg_control = &beside,
                             .msg_controllen = sizeof beside};
    const ssize_t got = recvmsg(u->socket, &message, MSG_DONTWAIT);
    if (got < 0) {
        return errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED
                   ? 0
                   : hs_error("UDP", NULL, "cannot be received from: %s", strerror(errno));
    }
    note_lost(u, &message);
    *length = (size_t)got;
    return 1;
}

void hs_udp_send(const struct hs_udp *u, const struct sockaddr_in *to, const void *bytes,
                 size_t length)
{
    (void)sendto(u->socket, bytes, length, MSG_DONTWAIT, (const struct sockaddr *)to, sizeof *to);
}

void hs_udp_close(struct hs_udp *u)
{
    if (u->socket >= 0) {
        close(u->socket);
        u->socket = -1;
    }
}
