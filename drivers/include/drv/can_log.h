/* CAN log: a recording in the format of `candump -L` of can-utils, played back as struct lm_can:
 *
 *     (1436509052.249713) can0 40C#091E000040459E04
 *
 * - Seconds with six decimals; further ones are dropped.
 * - Interface.
 * - Identifier of 3 hexadecimal digits (11 bits) or 8 (29 bits; with bit 0x20000000 a report of the
 *   controller).
 * - '#' and 0..8 bytes; or "#R" and an optional length, for a remote frame.
 * - Optionally the direction, R or T.
 *
 * Empty lines are skipped. Any other line, such as CAN FD's "##", is reported, counted and skipped;
 * the lines after it are read. */
#ifndef DRV_CAN_LOG_H
#define DRV_CAN_LOG_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "drv/can_line.h"
#include "lm/port.h"

/* Receiver of a report on each line that cannot be read; lines count from 1. */
typedef void drv_can_log_report(void *ctx, uint32_t line, const char *cause);

struct drv_can_log {
    FILE *lines;                /* borrowed */
    drv_can_log_report *report; /* NULL: bad lines are only counted */
    void *report_ctx;

    uint64_t now_us;
    uint64_t origin_us; /* time of the log's first frame, on the log's clock */
    bool has_origin, is_over;
    bool has_next; /* `next` was read and waits for its time */
    struct lm_can_frame next;

    struct {
        uint32_t lines, frames, malformed;
        uint32_t backward; /* frames older than the one before; delivered with it */
    } count;
};

/* Begin at the present position of `lines`: a file, a pipe from a decompressor, or fmemopen(). It
 * stays the caller's and must stay open while the log is used. Nothing is read yet. */
void drv_can_log_init(struct drv_can_log *log, FILE *lines, drv_can_log_report *report, void *ctx);

/* Set the time: receive delivers frames up to and including it. 0 is the time of the first
 * frame. */
void drv_can_log_set_now(struct drv_can_log *log, uint64_t now_us);

/* Leave out the frames of the first `skip_us` of the log; time 0 is then so long behind the first
 * frame. Call it before receive. Returns LM_OK, or LM_ERR_IO when reading failed. The log is over
 * if it ends before. */
int drv_can_log_skip(struct drv_can_log *log, uint64_t skip_us);

/* The log as the firmware's bus; `log` must outlive it. Time stamps never go back. receive returns
 * - 1: a frame;
 * - 0: the next frame is not due, or the log is over;
 * - LM_ERR_IO: reading failed. It is returned once; then the log is over. */
struct lm_can drv_can_log_port(struct drv_can_log *log);

/* True if the last frame was delivered and receive has met the end of the log. */
bool drv_can_log_is_over(const struct drv_can_log *log);

/* Write a frame as a line of such a log. `interface` has no blanks. A frame is no controller's
 * report and no remote frame. Returns LM_OK, or LM_ERR_IO when writing failed. */
int drv_can_log_write(FILE *out, const char *interface, uint64_t time_us,
                      const struct lm_can_frame *frame);

#endif
