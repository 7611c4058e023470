#include "console.h"

void zcu102_print(struct drv_uart *u, const char *words)
{
    for (; *words; words++) {
        if (*words == '\n') {
            drv_uart_put(u, '\r');
        }
        drv_uart_put(u, *words);
    }
}

void zcu102_print_number(struct drv_uart *u, uint64_t value)
{
    char digits[20]; /* of 2^64 */
    uint32_t count = 0;
    do {
        digits[count++] = (char)('0' + value % 10);
        value /= 10;
    } while (value > 0);
    while (count > 0) {
        drv_uart_put(u, digits[--count]);
    }
}

void zcu102_print_hex(struct drv_uart *u, uint64_t value, uint32_t digits)
{
    while (digits > 0) {
        digits--;
        drv_uart_put(u, "0123456789abcdef"[value >> 4 * digits & 15]);
    }
}

void zcu102_print_value(struct drv_uart *u, const char *name, uint64_t value)
{
    zcu102_print(u, name);
    zcu102_print(u, " ");
    zcu102_print_number(u, value);
    zcu102_print(u, "\n");
}
