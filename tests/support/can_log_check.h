/* A log of CAN frames, of any bytes, read to its end. */
#ifndef CAN_LOG_CHECK_H
#define CAN_LOG_CHECK_H

#include "drv/can_log.h"

#include <stdio.h>

/* Read the `size` bytes of a log, at least one. Returns what is wrong with the frames or the
 * counters, or NULL; *log keeps the counters. */
static inline const char *can_log_check(char *text, size_t size, struct drv_can_log *log)
{
    FILE *file = fmemopen(text, size, "r");
    if (!file) {
        return "the log cannot be opened";
    }
    drv_can_log_init(log, file, NULL, NULL);
    drv_can_log_set_now(log, UINT64_MAX);
    const struct lm_can port = drv_can_log_port(log);
    const char *wrong = NULL;
    struct lm_can_frame frame;
    uint64_t last_us = 0;
    while (port.receive(port.ctx, &frame) == 1) {
        if (frame.length > 8 || frame.id > 0x1fffffff) {
            wrong = "no frame has this length or identifier";
        } else if (!frame.is_extended && !frame.is_error && frame.id > 0x7ff) {
            wrong = "no frame of 11 bits has this identifier";
        } else if (frame.time_us < last_us) {
            wrong = "time goes back";
        }
        last_us = frame.time_us;
    }
    if (!drv_can_log_is_over(log)) {
        wrong = "the log has not come to its end";
    } else if (log->count.frames + log->count.malformed > log->count.lines) {
        wrong = "more lines are counted than there are";
    }
    fclose(file);
    return wrong;
}

#endif
