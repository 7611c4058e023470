/* Asking the host to look at the display. */
#ifndef LOOK_H
#define LOOK_H

#include "drv/display_dp.h"
#include "drv/uart_cadence.h"

/* Print "LOOK name checksum", the checksum being that of golden_glass_checksum over what the
 * firmware drew, and wait until the host has answered with a byte. */
void look(struct drv_uart *console, const struct drv_display *display, const char *name);

/* CRC-32C of what is drawn: row by row, each pixel as four bytes, the lowest first. */
uint32_t look_checksum(const struct drv_display *display);

#endif
