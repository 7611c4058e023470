/* A link over a local socket, to try a load without a cable and a panel. */
#ifndef WIRE_SOCKET_H
#define WIRE_SOCKET_H

#include "wire/link.h"

struct wire_socket {
    int listening, fd; /* -1: none */
    struct wire_link link;
};

/* The PC's end: 0 or an errno. */
int wire_socket_connect(struct wire_socket *s, const char *path);

/* The panel's end: makes the socket, in the place of one that is there. A PC that is gone is an
 * ENODEV, once; then the next one is waited for. *s must not move. */
int wire_socket_listen(struct wire_socket *s, const char *path);

/* A socket that is connected already, which is then closed with it. */
void wire_socket_lend(struct wire_socket *s, int fd);

void wire_socket_close(struct wire_socket *s);

#endif
