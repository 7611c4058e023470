#include "console.h"

void zcu102_say(struct drv_uart *u, const char *words)
{
    for (; *words; words++) {
        if (*words == '\n') {
            drv_uart_put(u, '\r');
        }
        drv_uart_put(u, *words);
    }
}

void zcu102_say_number(struct drv_uart *u, uint64_t value)
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

void zcu102_say_hex(struct drv_uart *u, uint64_t value, uint32_t digits)
{
    while (digits > 0) {
        digits--;
        drv_uart_put(u, "0123456789abcdef"[value >> 4 * digits & 15]);
    }
}

void zcu102_say_value(struct drv_uart *u, const char *name, uint64_t value)
{
    zcu102_say(u, name);
    zcu102_say(u, " ");
    zcu102_say_number(u, value);
    zcu102_say(u, "\n");
}
