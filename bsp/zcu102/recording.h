/* Recording of a flight on the serial line of the bezel: the lines of bsp/record, from a ring in
 * memory, sent by the UART's interrupt. A PC keeps them (record.sh). Nothing here waits: when the
 * ring is full the recording ends with a line that says so, and the unit flies on. */
#ifndef ZCU102_RECORDING_H
#define ZCU102_RECORDING_H

#include "drv/uart_cadence.h"
#include "record.h"

enum { ZCU102_RECORDING_RING = 1 << 16 };

/* All zero is a recording that is not begun. It must not move. */
struct zcu102_recording {
    struct recorder recorder;
    struct drv_uart *line, *console; /* borrowed */
    uint32_t lines_lost;
    bool is_on, is_over;
};

/* Begin, before lm_unit_init: the recorder's ports are put into *board. The image's own tables, or
 * the built-in ones, are those of *board. */
void zcu102_recording_begin(struct zcu102_recording *r, struct drv_uart *line,
                            struct drv_uart *console, struct lm_board *board);

/* Announce a step, before lm_unit_step. */
void zcu102_recording_step(struct zcu102_recording *r, uint64_t now_us);

#endif
