/* A line of a CAN log (drv/can_log.h), which needs no C library. */
#ifndef DRV_CAN_LINE_H
#define DRV_CAN_LINE_H

#include "lm/port.h"

/* Parse one line without its line feed. Returns NULL and *frame, with time_us on the log's clock;
 * or the cause, in static memory, with *frame unspecified. */
const char *drv_can_log_parse(const char *line, struct lm_can_frame *frame);

#endif
