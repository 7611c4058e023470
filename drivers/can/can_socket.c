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

enum { RECEIVE_BUFFER_BYTES = 4 << 20, ANCILLARY_BYTES = 64 };

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

/* ---- filters ---- */

struct can_filter drv_can_socket_filter(const struct lm_can_filter *f)
{
    const canid_t any = f->is_extended ? CAN_EFF_MASK : CAN_SFF_MASK;
    return (struct can_filter){.can_id = (f->id & any) | (f->is_extended ? CAN_EFF_FLAG : 0),
                               .can_mask = (f->mask & any) | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

/* ---- frames and times ---- */

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

/* ---- opening ---- */

/* Only the filter is necessary. Without the other options the bus works, but is counted less. */
static int set_options(struct drv_can_socket *s)
{
    if (setsockopt(s->fd, SOL_CAN_RAW, CAN_RAW_FILTER, s->filters,
                   (socklen_t)(s->filter_count * sizeof *s->filters)) != 0) {
        return -1;
    }
    const can_err_mask_t errors =
        CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_ACK;
    (void)setsockopt(s->fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
    const int on = 1, bytes = RECEIVE_BUFFER_BYTES;
    (void)setsockopt(s->fd, SOL_SOCKET, SO_TIMESTAMP, &on, sizeof on);
    (void)setsockopt(s->fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    /* The first passes the system's limit but needs CAP_NET_ADMIN; the second is cut to the
     * limit. */
    if (setsockopt(s->fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0) {
        (void)setsockopt(s->fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    }
    return 0;
}

static int open_on(struct drv_can_socket *s)
{
    const unsigned index = if_nametoindex(s->interface);
    if (index == 0) {
        return fail(s, "%s: no such interface; `ip link` lists those that exist", s->interface);
    }
    s->fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (s->fd < 0) {
        return fail(s, "%s: %s; does the kernel have CONFIG_CAN and CONFIG_CAN_RAW?", s->interface,
                    strerror(errno));
    }
    if (set_options(s) != 0) {
        return fail(s, "%s: the kernel refused the filter: %s", s->interface, strerror(errno));
    }
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = (int)index};
    if (bind(s->fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        return fail(s, "%s: %s; is it a CAN interface?", s->interface, strerror(errno));
    }
    return LM_OK;
}

/* Open, or leave closed and look again later. */
static int try_to_open(struct drv_can_socket *s)
{
    const int status = open_on(s);
    if (status != LM_OK) {
        drv_can_socket_close(s);
        s->retry_us = clock_us(CLOCK_MONOTONIC) + DRV_CAN_SOCKET_RETRY_US;
    }
    return status;
}

int drv_can_socket_open(struct drv_can_socket *s, const char *interface,
                        const struct lm_can_filter *filters, uint32_t filter_count,
                        uint64_t time_zero_us)
{
    *s = (struct drv_can_socket){.fd = -1, .time_zero_us = time_zero_us};
    snprintf(s->interface, sizeof s->interface, "%s", interface);
    if (filter_count > DRV_CAN_SOCKET_FILTERS) {
        s->retry_us = UINT64_MAX;
        return fail(s, "%s: %u filters, of which the kernel takes %d", s->interface, filter_count,
                    DRV_CAN_SOCKET_FILTERS);
    }
    for (uint32_t i = 0; i < filter_count; i++) {
        s->filters[i] = drv_can_socket_filter(&filters[i]);
    }
    s->filter_count = filter_count;
    return try_to_open(s);
}

void drv_can_socket_close(struct drv_can_socket *s)
{
    if (s->fd >= 0) {
        close(s->fd);
        s->fd = -1;
    }
}

/* ---- when something happens to the bus ---- */

static void empty_queue(struct drv_can_socket *s)
{
    s->count.unsent += s->queue_count;
    s->queue_count = 0;
}

/* Handle errno. LM_OK if the call need only be repeated later. */
static int handle_failure(struct drv_can_socket *s, int cause)
{
    if (cause == EAGAIN || cause == EWOULDBLOCK || cause == EINTR || cause == ENOBUFS) {
        return LM_OK;
    }
    empty_queue(s);
    if (cause == ENETDOWN) {
        s->count.down++;
        return fail(s, "%s: %s; set it up again (ip link set %s up)", s->interface, strerror(cause),
                    s->interface);
    }
    s->count.gone++;
    drv_can_socket_close(s);
    s->retry_us = clock_us(CLOCK_MONOTONIC) + DRV_CAN_SOCKET_RETRY_US;
    return fail(s, "%s: the bus is lost: %s; it is looked for until it is back", s->interface,
                strerror(cause));
}

/* The controller's report: <linux/can/error.h>. */
static void handle_report(struct drv_can_socket *s, const struct lm_can_frame *report)
{
    const uint8_t controller = (report->id & CAN_ERR_CRTL) != 0 ? report->data[1] : 0;
    s->count.no_ack += (report->id & CAN_ERR_ACK) != 0;
    s->count.tx_timeout += (report->id & CAN_ERR_TX_TIMEOUT) != 0;
    s->count.overruns += (controller & CAN_ERR_CRTL_RX_OVERFLOW) != 0;
    s->count.passive += (controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0;
    if (report->id & CAN_ERR_RESTARTED) {
        s->count.restarts++;
        s->is_bus_off = false;
    }
    if (report->id & CAN_ERR_BUSOFF) {
        s->count.bus_off++;
        s->is_bus_off = true;
        s->has_report = true;
        fail(s,
             "%s: the controller is bus-off; wiring? bit rate? It comes back by itself with "
             "`ip link set %s type can restart-ms 100`",
             s->interface, s->interface);
    }
}

/* ---- receiving ---- */

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

static void add_to_batch(struct drv_can_socket *s, const struct can_frame *raw, uint64_t arrival_us)
{
    struct lm_can_frame *frame = &s->batch[s->batch_count];
    if (!drv_can_socket_convert(raw, frame)) {
        s->count.malformed++;
        return;
    }
    frame->time_us = arrival_us > s->time_zero_us ? arrival_us - s->time_zero_us : 0;
    if (frame->is_error) {
        handle_report(s, frame);
    } else {
        s->is_bus_off = false; /* a frame was received, so the controller is on the bus */
    }
    s->batch_count++;
}

/* Fill the empty batch with the frames that wait in the kernel. */
static int fetch(struct drv_can_socket *s)
{
    struct can_frame raw[DRV_CAN_SOCKET_BATCH];
    _Alignas(struct cmsghdr) char ancillary[DRV_CAN_SOCKET_BATCH][ANCILLARY_BYTES];
    struct iovec parts[DRV_CAN_SOCKET_BATCH];
    struct mmsghdr messages[DRV_CAN_SOCKET_BATCH];
    memset(messages, 0, sizeof messages);
    for (size_t i = 0; i < DRV_CAN_SOCKET_BATCH; i++) {
        parts[i] = (struct iovec){.iov_base = &raw[i], .iov_len = sizeof raw[i]};
        messages[i].msg_hdr = (struct msghdr){.msg_iov = &parts[i],
                                              .msg_iovlen = 1,
                                              .msg_control = ancillary[i],
                                              .msg_controllen = sizeof ancillary[i]};
    }
    s->batch_next = s->batch_count = 0;
    const int count = recvmmsg(s->fd, messages, DRV_CAN_SOCKET_BATCH, MSG_DONTWAIT, NULL);
    if (count < 0) {
        return handle_failure(s, errno);
    }
    const uint64_t realtime_us = clock_us(CLOCK_REALTIME), monotonic_us = clock_us(CLOCK_MONOTONIC);
    for (int i = 0; i < count; i++) {
        uint64_t stamp_us = realtime_us;
        read_ancillary(s, &messages[i].msg_hdr, &stamp_us);
        if (messages[i].msg_len != CAN_MTU || (messages[i].msg_hdr.msg_flags & MSG_TRUNC) != 0) {
            s->count.malformed++;
            continue;
        }
        add_to_batch(s, &raw[i], drv_can_socket_arrival_us(monotonic_us, realtime_us, stamp_us));
    }
    return LM_OK;
}

/* Send the frames that the kernel has room for. */
static int flush(struct drv_can_socket *s)
{
    while (s->queue_count > 0) {
        const struct can_frame *next = &s->queue[s->queue_first];
        if (send(s->fd, next, sizeof *next, MSG_DONTWAIT | MSG_NOSIGNAL) < 0) {
            return handle_failure(s, errno);
        }
        s->queue_first = (s->queue_first + 1) % DRV_CAN_SOCKET_QUEUE;
        s->queue_count--;
        s->count.sent++;
    }
    return LM_OK;
}

/* LM_OK when the socket is open, or could be opened again. LM_BUSY: it is not yet time to try. */
static int reopen(struct drv_can_socket *s)
{
    if (s->fd >= 0) {
        return LM_OK;
    }
    if (clock_us(CLOCK_MONOTONIC) < s->retry_us) {
        return LM_BUSY;
    }
    const int status = try_to_open(s);
    s->count.reopened += status == LM_OK;
    return status;
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct drv_can_socket *s = ctx;
    if (s->batch_next == s->batch_count) {
        int status = reopen(s);
        if (status == LM_OK) {
            status = flush(s);
        }
        if (status == LM_OK) {
            status = fetch(s);
        }
        if (status != LM_OK) {
            return status == LM_BUSY ? 0 : status;
        }
    }
    if (s->batch_next < s->batch_count) {
        *frame = s->batch[s->batch_next++];
        s->count.frames++;
        return 1;
    }
    const bool has_report = s->has_report;
    s->has_report = false;
    return has_report ? LM_ERR_IO : 0;
}

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct drv_can_socket *s = ctx;
    if (s->fd < 0) {
        s->count.unsent++;
        return LM_ERR_IO;
    }
    if (s->queue_count == DRV_CAN_SOCKET_QUEUE) {
        s->queue_first = (s->queue_first + 1) % DRV_CAN_SOCKET_QUEUE;
        s->queue_count--;
        s->count.unsent++;
    }
    struct can_frame *raw = &s->queue[(s->queue_first + s->queue_count) % DRV_CAN_SOCKET_QUEUE];
    *raw = (struct can_frame){
        .can_id = frame->id | (frame->is_extended ? CAN_EFF_FLAG : 0),
        .can_dlc = frame->length > CAN_MAX_DLEN ? CAN_MAX_DLEN : frame->length,
    };
    memcpy(raw->data, frame->data, raw->can_dlc);
    s->queue_count++;
    return flush(s);
}

struct lm_can drv_can_socket_port(struct drv_can_socket *s)
{
    return (struct lm_can){.ctx = s, .receive = receive, .send = send_frame};
}
