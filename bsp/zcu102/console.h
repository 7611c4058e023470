/* Words and numbers on the console UART. */
#ifndef ZCU102_CONSOLE_H
#define ZCU102_CONSOLE_H

#include "drv/uart_cadence.h"

/* A line feed goes out as carriage return and line feed. */
void zcu102_say(struct drv_uart *u, const char *words);
void zcu102_say_number(struct drv_uart *u, uint64_t value);
void zcu102_say_hex(struct drv_uart *u, uint64_t value, uint32_t digits);

/* "name value" on a line of its own: what the tests read. */
void zcu102_say_value(struct drv_uart *u, const char *name, uint64_t value);

#endif
