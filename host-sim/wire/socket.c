#include "wire/socket.h"

#include "hs/real_time.h"

#include <errno.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

static int64_t now_ms(void)
{
    return hs_clock_us(CLOCK_MONOTONIC) / 1000;
}

/* Wait for an event, until `end_ms`; 0: for ever. */
static int wait_for(int fd, short event, int64_t end_ms)
{
    struct pollfd p = {.fd = fd, .events = event};
    while (!hs_is_interrupted()) {
        const int64_t left = end_ms == 0 ? INT32_MAX : end_ms - now_ms();
        if (left <= 0) {
            return ETIMEDOUT;
        }
        const int count = poll(&p, 1, left < INT32_MAX ? (int)left : -1);
        if (count > 0) {
            return 0;
        }
        if (count < 0 && errno != EINTR) {
            return errno;
        }
    }
    return EINTR;
}

static int accept_one(struct wire_socket *s)
{
    const int cause = wait_for(s->listening, POLLIN, 0);
    if (cause != 0) {
        return cause;
    }
    s->fd = accept(s->listening, NULL, NULL);
    return s->fd < 0 ? errno : 0;
}

static int gone(struct wire_socket *s)
{
    if (s->listening >= 0) {
        close(s->fd);
        s->fd = -1;
    }
    return ENODEV;
}

static int move(struct wire_socket *s, uint8_t *at, uint32_t length, uint32_t timeout_ms,
                bool is_sending)
{
    const int64_t end_ms = timeout_ms == 0 ? 0 : now_ms() + timeout_ms;
    while (length > 0) {
        const int cause = wait_for(s->fd, is_sending ? POLLOUT : POLLIN, end_ms);
        if (cause != 0) {
            return cause;
        }
        const ssize_t count = is_sending ? send(s->fd, at, length, MSG_NOSIGNAL | MSG_DONTWAIT)
                                         : recv(s->fd, at, length, MSG_DONTWAIT);
        if (count > 0) {
            at += count;
            length -= (uint32_t)count;
        } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
            return gone(s);
        }
    }
    return 0;
}

static int socket_send(void *ctx, const void *from, uint32_t length, uint32_t timeout_ms)
{
    struct wire_socket *s = ctx;
    return s->fd < 0 ? ENODEV : move(s, (uint8_t *)(uintptr_t)from, length, timeout_ms, true);
}

static int socket_receive(void *ctx, void *to, uint32_t length, uint32_t timeout_ms)
{
    struct wire_socket *s = ctx;
    if (s->fd < 0) {
        const int cause = s->listening < 0 ? ENODEV : accept_one(s);
        if (cause != 0) {
            return cause;
        }
    }
    return move(s, to, length, timeout_ms, false);
}

void wire_socket_lend(struct wire_socket *s, int fd)
{
    *s = (struct wire_socket){.listening = -1, .fd = fd, .link = {s, socket_send, socket_receive}};
}

static int name(struct sockaddr_un *to, const char *path)
{
    *to = (struct sockaddr_un){.sun_family = AF_UNIX};
    return snprintf(to->sun_path, sizeof to->sun_path, "%s", path) < (int)sizeof to->sun_path
               ? 0
               : ENAMETOOLONG;
}

int wire_socket_connect(struct wire_socket *s, const char *path)
{
    struct sockaddr_un to;
    wire_socket_lend(s, -1);
    const int cause = name(&to, path);
    if (cause != 0) {
        return cause;
    }
    s->fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    return s->fd >= 0 && connect(s->fd, (const struct sockaddr *)&to, sizeof to) == 0 ? 0 : errno;
}

int wire_socket_listen(struct wire_socket *s, const char *path)
{
    struct sockaddr_un to;
    struct stat about;
    wire_socket_lend(s, -1);
    const int cause = name(&to, path);
    if (cause != 0) {
        return cause;
    }
    if (lstat(path, &about) == 0 && S_ISSOCK(about.st_mode)) {
        (void)unlink(path); /* of one that was killed */
    }
    s->listening = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    return s->listening >= 0 && bind(s->listening, (const struct sockaddr *)&to, sizeof to) == 0 &&
                   listen(s->listening, 1) == 0
               ? 0
               : errno;
}

void wire_socket_close(struct wire_socket *s)
{
    if (s->fd >= 0) {
        close(s->fd);
    }
    if (s->listening >= 0) {
        close(s->listening);
    }
    s->fd = s->listening = -1;
}
