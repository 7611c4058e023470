/* CAN socket: a CAN controller through Linux's SocketCAN, as struct lm_can.
 *
 * Tests:
 * - tests/unit/drivers/can/test_can_socket.c, with a socket of another family in place of the bus:
 *   failures to open, conversion of frames and times, filters against the kernel's matching rule,
 *   receiving, sending and their errors;
 * - tests/panel-vm/can_driver.c, on a kernel with AF_CAN: options, filters, time stamps, losses,
 *   answers, an interface that goes down, is removed and comes back, a minute at 80 % load.
 * NOT tested: real hardware. The kernel never returned ENOBUFS there, so a full queue is only
 * tested with the socket of the other family. */
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

/* Pause between two attempts to open an interface that is gone. */
#define DRV_CAN_SOCKET_RETRY_US 500000

struct drv_can_socket {
    int fd;                /* -1: closed; else for poll(): readable when a frame waits */
    uint64_t time_zero_us; /* time of CLOCK_MONOTONIC at which the firmware's clock is 0 */
    char error[160];       /* why the last call failed: place, cause and remedy */
    bool is_bus_off;       /* the controller has left the bus */

    char interface[IFNAMSIZ];
    struct can_filter filters[DRV_CAN_SOCKET_FILTERS];
    uint32_t filter_count;
    uint64_t retry_us; /* time of the next attempt to open, on CLOCK_MONOTONIC */
    bool has_report;   /* receive returns LM_ERR_IO once */
    struct lm_can_frame batch[DRV_CAN_SOCKET_BATCH];
    uint32_t batch_next, batch_count;
    struct can_frame queue[DRV_CAN_SOCKET_QUEUE]; /* a ring */
    uint32_t queue_first, queue_count;

    struct {
        uint32_t frames;
        uint32_t malformed;  /* not the size of a classic frame, or longer than 8 bytes */
        uint32_t overflowed; /* lost between interrupt and program, as the kernel counts them */
        uint32_t sent;       /* given to the kernel */
        uint32_t unsent;     /* dropped: the bus was down, or the queue full (the oldest first) */
        uint32_t down;       /* times that the interface went down */
        uint32_t gone;       /* times that it was removed, or the socket failed */
        uint32_t reopened;
        uint32_t bus_off, restarts;  /* reports of the controller, by kind */
        uint32_t overruns;           /* frames lost in the controller */
        uint32_t passive;            /* reports that the controller is error-passive */
        uint32_t no_ack, tx_timeout; /* frames that no node acknowledged, or not sent in time */
    } count;                         /* only ever grow; an open sets them to 0 */
};

/* Open `interface` ("can0"). Never waits. These pass:
 * - frames that one of the filters accepts (lm_bus_filters lists a profile's); without filters
 * none;
 * - the controller's reports of time-outs, overruns, bus-off, restart and missing acknowledgements.
 * The receive buffer is set to 4 MiB, because the default of 208 KiB is full after 35 ms of a busy
 * bus. Name and filters are copied.
 *
 * Returns LM_OK; or LM_ERR_IO, with the cause in s->error and s->fd = -1. After a failure *s may
 * still be used: its port tries to open the interface again every DRV_CAN_SOCKET_RETRY_US. */
int drv_can_socket_open(struct drv_can_socket *s, const char *interface,
                        const struct lm_can_filter *filters, uint32_t filter_count,
                        uint64_t time_zero_us);

/* Close the socket. Safe on one that is closed, or was never opened successfully. */
void drv_can_socket_close(struct drv_can_socket *s);

/* The socket as the firmware's bus; `s` must outlive it.
 *
 * receive returns
 * - 1: a frame; frames keep their order, and those that no classic controller sends are counted and
 *   skipped;
 * - 0: no frame waits;
 * - LM_ERR_IO, once for each event, with s->error set: the interface went down (it is used again as
 *   soon as it is up), the interface is gone (see DRV_CAN_SOCKET_RETRY_US), or the controller went
 *   bus-off.
 * A call makes at most one system call to receive, and one for each frame that it can send.
 *
 * send puts the frame into the queue; a full queue drops its oldest frame. A frame that the kernel
 * has no room for is offered again in the next call of either function. It returns
 * - LM_OK: the frame is in the queue or sent;
 * - LM_ERR_IO: the interface is down or gone. The queue is emptied, because old answers are useless
 *   once the bus is back. */
struct lm_can drv_can_socket_port(struct drv_can_socket *s);

/* A filter in the kernel's form: identifier, length of identifier, and no remote frames. */
struct can_filter drv_can_socket_filter(const struct lm_can_filter *filter);

/* Convert a frame; time_us is 0. False if it is no classic data, remote or error frame. */
bool drv_can_socket_convert(const struct can_frame *from, struct lm_can_frame *to);

/* Arrival on the monotonic clock of a frame that the real-time clock stamped `stamp_us`, given both
 * clocks now. The real-time clock may have been set in between, so the age is limited to 0..1 s. */
uint64_t drv_can_socket_arrival_us(uint64_t monotonic_us, uint64_t realtime_us, uint64_t stamp_us);

#endif
