/* Asking the host to look at the display. */
#ifndef LOOK_H
#define LOOK_H

#include "drv/display_dp.h"
#include "drv/uart_cadence.h"

/* Print "LOOK name checksum", the checksum being that of golden_glass_checksum over what the
 * firmware drew, and wait until the host has answered with a byte. */
void look(struct drv_uart *console, const struct drv_display *display, const char *name);

/* Copy the picture that is shown, 0x00RRGGBB a pixel, and show one. */
void look_keep(const struct drv_display *display, uint32_t *pixels);
void look_show(struct drv_display *display, const uint32_t *pixels);

/* CRC-32C of what is shown: row by row, each pixel as four bytes, the lowest first. */
uint32_t look_checksum(const struct drv_display *display);

#endif
