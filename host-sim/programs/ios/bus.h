/* The bus of landmass-ios: a SocketCAN interface, a recorded log in real time, or none, where pages
 * tell each other. What goes over it is put into the feed that all pages read. */
#ifndef IOS_BUS_H
#define IOS_BUS_H

#include "drv/can_log.h"
#include "drv/can_socket.h"
#include "hs/atomic_file.h"
#include "ios/feed.h"
#include "options.h"

enum { BUS_QUEUE = 4096 }; /* frames of pages that wait: half a second of a full bus of 1 Mbit/s */

struct bus {
    const struct command *command; /* borrowed */
    const char *name;              /* of the interface, in lines */
    struct ios_feed feed;
    struct drv_can_socket socket;
    FILE *log_file; /* NULL: none */
    struct drv_can_log log;
    struct hs_atomic_file out;
    bool has_out;
    int64_t begun_us; /* CLOCK_MONOTONIC */
    struct lm_can_frame queue[BUS_QUEUE];
    uint32_t head, tail; /* put at head % BUS_QUEUE, taken at tail % BUS_QUEUE */
    struct {
        uint64_t heard, sent, failed, down;
    } count;
};

/* Returns 0, or -1 with the error reported. Close it whatever is returned. */
int bus_open(struct bus *b, const struct command *c);

/* Hear what is due, and send what waits. Call it every few milliseconds. */
void bus_step(struct bus *b);

/* A frame of a page: to the bus, and to all pages. False: it was not taken, because too many wait.
 */
bool bus_send(struct bus *b, const struct lm_can_frame *frame);

/* Returns 0, or -1 with the error reported: the log could not be written. */
int bus_close(struct bus *b, bool is_well);

#endif
