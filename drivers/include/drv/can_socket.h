/* A CAN controller through Linux's SocketCAN, as struct lm_can.
 *
 * What is tested where: tests/unit/drivers/can/test_can_socket.c has the failures to open, the
 * conversion of frames and times, the filters against the kernel's matching rule, and receiving,
 * sending and their errors over a socket of another family that stands in for the bus. The real
 * thing, on a kernel that has AF_CAN, is tests/panel-vm/can_driver.c: options, filters, stamps,
 * losses, answers, an interface that goes down, goes away and comes back, a minute at 80 % load.
 * Not tried on real silicon; and no kernel there said ENOBUFS, so that a full queue is only tested
 * over the stand-in.
 */
#ifndef DRV_CAN_SOCKET_H
#define DRV_CAN_SOCKET_H

#include <linux/can.h>
#include <net/if.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lm/port.h"

enum {
    DRV_CAN_SOCKET_BATCH = 64,   /* frames taken from the kernel at a time */
    DRV_CAN_SOCKET_QUEUE = 16,   /* frames that may wait to be sent */
    DRV_CAN_SOCKET_FILTERS = 512 /* the kernel's limit, CAN_RAW_FILTER_MAX */
};

/* How long an interface that is gone is left alone before it is looked for again. */
#define DRV_CAN_SOCKET_RETRY_US 500000

struct drv_can_socket {
    int fd;                /* -1: closed; otherwise may be waited on with poll() */
    uint64_t time_zero_us; /* of CLOCK_MONOTONIC, where the firmware's clock has its 0 */
    char error[160];       /* why the last call failed: place, cause, remedy */
    bool is_bus_off;       /* the controller has left the bus */

    char interface[IFNAMSIZ];
    struct can_filter filters[DRV_CAN_SOCKET_FILTERS];
    uint32_t filter_count;
    uint64_t retry_us; /* CLOCK_MONOTONIC; when to look for it again */
    bool has_report;   /* receive is to answer LM_ERR_IO once */
    struct lm_can_frame batch[DRV_CAN_SOCKET_BATCH];
    uint32_t batch_next, batch_count;
    struct can_frame queue[DRV_CAN_SOCKET_QUEUE]; /* a ring */
    uint32_t queue_first, queue_count;

    struct {
        uint32_t frames;
        uint32_t malformed;  /* not the size of a classic frame, or longer than 8 bytes */
        uint32_t overflowed; /* lost between interrupt and program, as the kernel counts them */
        uint32_t sent;       /* given to the kernel */
        uint32_t unsent; /* dropped: the queue was full, the older ones first, or the bus down */
        uint32_t down;   /* times that the interface went down */
        uint32_t gone;   /* times that it was removed, or the socket failed */
        uint32_t reopened;
        uint32_t bus_off, restarts;  /* reports of the controller, by kind */
        uint32_t overruns;           /* frames lost in the controller */
        uint32_t passive;            /* it sees so many errors that it no longer objects */
        uint32_t no_ack, tx_timeout; /* nobody hears what is sent */
    } count;                         /* only ever grow, but for an open */
};

/* Open `interface` ("can0") without ever waiting on it: only frames that one of the filters
 * lets through pass (lm_bus_filters lists a profile's; without any filter none does), and the
 * controller's reports of time-outs, overruns, bus-off, restart and missing acknowledgements. The
 * receive buffer is asked to hold 4 MiB, because the default of 208 KiB is full after 35 ms of a
 * busy bus. The filters are copied.
 *
 * LM_OK, or LM_ERR_IO with s->error saying why and s->fd = -1. After a failure *s may be used all
 * the same: its port looks for the interface again every DRV_CAN_SOCKET_RETRY_US. */
int drv_can_socket_open(struct drv_can_socket *s, const char *interface,
                        const struct lm_can_filter *filters, uint32_t filter_count,
                        uint64_t time_zero_us);

/* Safe on one that is closed, or was never opened successfully. */
void drv_can_socket_close(struct drv_can_socket *s);

/* The socket as the firmware's bus; `s` must outlive it.
 *
 * receive answers 1, or 0 when none waits, or LM_ERR_IO with s->error filled, once for each thing
 * that happens: the interface went down (it is heard again as soon as it is up), is gone (it is
 * looked for, see above), or the controller went bus-off. What is received keeps its order; frames
 * that are not what a classic controller sends are counted and skipped. One call makes at most one
 * system call to receive and one for each frame that it can send.
 *
 * send takes every frame into the queue; the oldest one that waits is dropped when it is full.
 * What the kernel has no room for is offered again in the next call of either function. LM_OK, or
 * LM_ERR_IO when the interface is down or gone, and then the queue is emptied: an answer of before
 * is of no use afterwards. */
struct lm_can drv_can_socket_port(struct drv_can_socket *s);

/* A filter as the kernel has it: identifier, length of identifier and no remote frames. */
struct can_filter drv_can_socket_filter(const struct lm_can_filter *filter);

/* False for what is no classic data, remote or error frame. time_us stays 0. */
bool drv_can_socket_convert(const struct can_frame *from, struct lm_can_frame *to);

/* When a frame stamped `stamp_us` by the real-time clock came, on the monotonic clock, given both
 * clocks now. A real-time clock that was set in between would give any answer, so that the age is
 * held to 0..1 s. */
uint64_t drv_can_socket_arrival_us(uint64_t monotonic_us, uint64_t realtime_us, uint64_t stamp_us);

#endif
