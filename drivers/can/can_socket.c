#include "drv/can_socket.h"

#include <errno.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { RECEIVE_BUFFER_BYTES = 4 << 20, SKIP_MAX = 16 };

static int fail(struct drv_can_socket *s, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static int fail(struct drv_can_socket *s, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(s->error, sizeof s->error, format, arguments);
    va_end(arguments);
    return LM_ERR_IO;
}

void drv_can_socket_filters(struct can_filter filters[DRV_CAN_SOCKET_FILTERS])
{
    for (size_t i = 0; i < LM_CANAS_FIELDS; i++) {
        const canid_t id = lm_canas_table[i].id;
        filters[2 * i] = (struct can_filter){
            .can_id = id,
            .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG,
        };
        /* Bits 16..28 are the channel; bits 11..15 must be clear. */
        filters[2 * i + 1] = (struct can_filter){
            .can_id = id | CAN_EFF_FLAG,
            .can_mask = 0xffffu | CAN_EFF_FLAG | CAN_RTR_FLAG,
        };
    }
}

bool drv_can_socket_convert(const struct can_frame *from, struct lm_can_frame *to)
{
    if (from->can_dlc > CAN_MAX_DLEN) {
        return false;
    }
    *to = (struct lm_can_frame){
        .is_error = (from->can_id & CAN_ERR_FLAG) != 0,
        .is_extended = (from->can_id & CAN_EFF_FLAG) != 0,
        .is_remote = (from->can_id & CAN_RTR_FLAG) != 0,
        .length = from->can_dlc,
    };
    to->id = from->can_id & (to->is_extended || to->is_error ? CAN_EFF_MASK : CAN_SFF_MASK);
    memcpy(to->data, from->data, from->can_dlc);
    return true;
}

uint64_t drv_can_socket_arrival_us(uint64_t monotonic_us, uint64_t realtime_us, uint64_t stamp_us)
{
    uint64_t age_us = realtime_us > stamp_us ? realtime_us - stamp_us : 0;
    age_us = age_us > 1000000 ? 1000000 : age_us;
    return age_us > monotonic_us ? 0 : monotonic_us - age_us;
}

static uint64_t clock_us(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

/* Only the filter is needed; without the others the bus works, only with less to tell. */
static int set_options(struct drv_can_socket *s)
{
    struct can_filter filters[DRV_CAN_SOCKET_FILTERS];
    drv_can_socket_filters(filters);
    if (setsockopt(s->fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters, sizeof filters) != 0) {
        return -1;
    }
    const can_err_mask_t errors =
        CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_ACK;
    (void)setsockopt(s->fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
    const int on = 1, bytes = RECEIVE_BUFFER_BYTES;
    (void)setsockopt(s->fd, SOL_SOCKET, SO_TIMESTAMP, &on, sizeof on);
    (void)setsockopt(s->fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    /* The first passes the system's limit but needs CAP_NET_ADMIN; the second is cut to the limit.
     */
    if (setsockopt(s->fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0) {
        (void)setsockopt(s->fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    }
    return 0;
}

static int open_on(struct drv_can_socket *s, const char *interface)
{
    const unsigned index = if_nametoindex(interface);
    if (index == 0) {
        return fail(s, "%s: no such interface; `ip link` lists those that exist", interface);
    }
    s->fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (s->fd < 0) {
        return fail(s, "%s: %s; does the kernel have CONFIG_CAN and CONFIG_CAN_RAW?", interface,
                    strerror(errno));
    }
    if (set_options(s) != 0) {
        return fail(s, "%s: the kernel refused the filter: %s", interface, strerror(errno));
    }
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = (int)index};
    if (bind(s->fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        return fail(s, "%s: %s; is it a CAN interface, and up (ip link set %s up)?", interface,
                    strerror(errno), interface);
    }
    return LM_OK;
}

int drv_can_socket_open(struct drv_can_socket *s, const char *interface, uint64_t time_zero_us)
{
    *s = (struct drv_can_socket){.fd = -1, .time_zero_us = time_zero_us};
    const int status = open_on(s, interface);
    if (status != LM_OK) {
        drv_can_socket_close(s);
    }
    return status;
}

void drv_can_socket_close(struct drv_can_socket *s)
{
    if (s->fd >= 0) {
        close(s->fd);
        s->fd = -1;
    }
}

/* The kernel's stamp and its count of lost frames travel beside the frame. */
static void read_ancillary(struct drv_can_socket *s, struct msghdr *message, uint64_t *stamp_us)
{
    for (struct cmsghdr *c = CMSG_FIRSTHDR(message); c != NULL; c = CMSG_NXTHDR(message, c)) {
        if (c->cmsg_level != SOL_SOCKET) {
            continue;
        }
        if (c->cmsg_type == SCM_TIMESTAMP) {
            struct timeval t;
            memcpy(&t, CMSG_DATA(c), sizeof t);
            *stamp_us = (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_usec;
        } else if (c->cmsg_type == SO_RXQ_OVFL) {
            memcpy(&s->count.overflowed, CMSG_DATA(c), sizeof s->count.overflowed);
        }
    }
}

static int explain(struct drv_can_socket *s, int cause)
{
    if (cause == EAGAIN || cause == EWOULDBLOCK || cause == EINTR) {
        return 0;
    }
    s->count.down++;
    return fail(s, "the bus is lost: %s; %s", strerror(cause),
                cause == ENETDOWN ? "set the interface up again (ip link)"
                                  : "close it and open it again");
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct drv_can_socket *s = ctx;
    for (int i = 0; i < SKIP_MAX; i++) {
        struct can_frame raw = {0};
        _Alignas(struct cmsghdr) char ancillary[128];
        struct iovec part = {.iov_base = &raw, .iov_len = sizeof raw};
        struct msghdr message = {.msg_iov = &part,
                                 .msg_iovlen = 1,
                                 .msg_control = ancillary,
                                 .msg_controllen = sizeof ancillary};
        const ssize_t size = recvmsg(s->fd, &message, MSG_DONTWAIT);
        if (size < 0) {
            return explain(s, errno);
        }
        const uint64_t realtime_us = clock_us(CLOCK_REALTIME);
        uint64_t stamp_us = realtime_us;
        read_ancillary(s, &message, &stamp_us);
        if (size != (ssize_t)CAN_MTU || (message.msg_flags & MSG_TRUNC) != 0 ||
            !drv_can_socket_convert(&raw, frame)) {
            s->count.malformed++;
            continue;
        }
        const uint64_t arrival_us =
            drv_can_socket_arrival_us(clock_us(CLOCK_MONOTONIC), realtime_us, stamp_us);
        frame->time_us = arrival_us > s->time_zero_us ? arrival_us - s->time_zero_us : 0;
        s->count.frames++;
        return 1;
    }
    return 0;
}

struct lm_can drv_can_socket_port(struct drv_can_socket *s)
{
    return (struct lm_can){.ctx = s, .receive = receive};
}
