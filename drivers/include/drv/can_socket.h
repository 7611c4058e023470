/* A CAN controller through Linux's SocketCAN, as struct lm_can.
 *
 * What is tested where (tests/unit/drivers/test_can_socket.c): the failures to open, the conversion
 * of frames and times, the filters against the kernel's matching rule, and receiving and its errors
 * over a socket of another family that stands in for the bus. NOT tested here, because the kernel
 * of the build machine has no AF_CAN: that a real interface is opened, that the kernel accepts each
 * option, the counts of lost frames, and what a bus going down looks like. */
#ifndef DRV_CAN_SOCKET_H
#define DRV_CAN_SOCKET_H

#include <linux/can.h>
#include <net/if.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lm/canas.h"
#include "lm/port.h"

struct drv_can_socket {
    int fd;                /* -1: closed */
    uint64_t time_zero_us; /* of CLOCK_MONOTONIC, where the firmware's clock has its 0 */
    char error[160];       /* why the last call failed: place, cause, remedy */

    struct {
        uint32_t frames;
        uint32_t malformed;  /* not the size of a classic frame, or longer than 8 bytes */
        uint32_t down;       /* times that the interface went down or away */
        uint32_t overflowed; /* lost between interrupt and program, as the kernel counts them */
    } count;
};

/* Open `interface` ("can0") without ever waiting on it: only identifiers of lm_canas_table pass
 * (channel 0 and the redundancy channels), and the controller's reports of time-outs, overruns,
 * bus-off, restart and missing acknowledgements. The receive buffer is asked to hold 4 MiB, because
 * the default of 208 KiB is full after 35 ms of a busy bus. LM_OK, or LM_ERR_IO with s->error
 * saying why and s->fd = -1. */
int drv_can_socket_open(struct drv_can_socket *s, const char *interface, uint64_t time_zero_us);

/* Safe on one that is closed, or was never opened successfully. */
void drv_can_socket_close(struct drv_can_socket *s);

/* The socket as the firmware's bus; `s` must outlive it. receive answers 1, 0 when none waits, or
 * LM_ERR_IO with s->error filled: the interface went down (it may come up again by itself: ask
 * again later) or is gone (close, and open again from time to time). Frames that are not what a
 * classic controller sends are counted and skipped, at most 16 in one call. */
struct lm_can drv_can_socket_port(struct drv_can_socket *s);

enum { DRV_CAN_SOCKET_FILTERS = 2 * LM_CANAS_FIELDS };

/* One filter for each row's identifier, 11 bits and no remote frames, and one for its redundancy
 * channels. */
void drv_can_socket_filters(struct can_filter filters[DRV_CAN_SOCKET_FILTERS]);

/* False for what is no classic data, remote or error frame. time_us stays 0. */
bool drv_can_socket_convert(const struct can_frame *from, struct lm_can_frame *to);

/* When a frame stamped `stamp_us` by the real-time clock came, on the monotonic clock, given both
 * clocks now. A real-time clock that was set in between would give any answer, so that the age is
 * held to 0..1 s. */
uint64_t drv_can_socket_arrival_us(uint64_t monotonic_us, uint64_t realtime_us, uint64_t stamp_us);

#endif
