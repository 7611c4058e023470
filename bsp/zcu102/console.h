/* Console: words and numbers on the console UART. Each call waits until the UART takes the
 * bytes. */
#ifndef ZCU102_CONSOLE_H
#define ZCU102_CONSOLE_H

#include "drv/uart_cadence.h"

/* Print a text. A line feed is sent as carriage return and line feed. */
void zcu102_print(struct drv_uart *u, const char *words);

/* Print a number in decimal, or in `digits` hexadecimal digits. */
void zcu102_print_number(struct drv_uart *u, uint64_t value);
void zcu102_print_hex(struct drv_uart *u, uint64_t value, uint32_t digits);

/* Print a line "name value", which the tests read. */
void zcu102_print_value(struct drv_uart *u, const char *name, uint64_t value);

#endif
