/* A recorded bus, as `candump -L` of can-utils writes it, played back as struct lm_can:
 *
 *     (1436509052.249713) can0 40C#091E000040459E04
 *
 * seconds with six decimals (more are dropped), interface, identifier of 3 hexadecimal digits (11
 * bits) or 8 (29 bits, or with bit 0x20000000 a report of the controller), '#', 0..8 bytes; "#R"
 * and perhaps a length for a remote frame; perhaps a last word R or T, the direction. Empty lines
 * are skipped. Any other line, CAN FD's "##" among them, is reported, counted and skipped: it loses
 * nothing but itself. */
#ifndef DRV_CAN_LOG_H
#define DRV_CAN_LOG_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "lm/port.h"

/* Told of each line that cannot be read; lines count from 1. */
typedef void drv_can_log_report(void *ctx, uint32_t line, const char *cause);

struct drv_can_log {
    FILE *lines;                /* borrowed */
    drv_can_log_report *report; /* NULL: only counted */
    void *report_ctx;

    uint64_t now_us;
    uint64_t origin_us; /* the log's clock at its first frame */
    bool has_origin, is_over;
    bool has_next; /* `next` was read and waits for its time */
    struct lm_can_frame next;

    struct {
        uint32_t lines, frames, malformed;
        uint32_t backward; /* frames older than the one before, delivered together with it */
    } count;
};

/* Begin at the present place of `lines`, which stays the caller's and must stay open: a file, a
 * pipe from a decompressor, or fmemopen(). Nothing is read yet. */
void drv_can_log_init(struct drv_can_log *log, FILE *lines, drv_can_log_report *report, void *ctx);

/* What time it is on the bench: receive delivers frames up to and including this. 0 is the time of
 * the first frame. */
void drv_can_log_set_now(struct drv_can_log *log, uint64_t now_us);

/* The log as the firmware's bus; `log` must outlive it. receive answers 1, 0 when the next frame is
 * not due or the log is over, or LM_ERR_IO when reading fails (once; then the log is over). Time
 * stamps never go back. */
struct lm_can drv_can_log_port(struct drv_can_log *log);

/* Has the last frame been delivered? True only after receive has met the end. */
bool drv_can_log_is_over(const struct drv_can_log *log);

/* Read one line, without its line feed. NULL and *frame (time_us on the log's own clock), or the
 * cause why not, with *frame unspecified. */
const char *drv_can_log_parse(const char *line, struct lm_can_frame *frame);

#endif
