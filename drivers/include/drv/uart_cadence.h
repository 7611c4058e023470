/* The UART of Zynq devices (Cadence). Registers and bits: Zynq UltraScale+ Device TRM UG1085,
 * chapter 21, and register reference UG1087, module UART. Sending waits for room in the transmit
 * FIFO of 64 bytes; receiving is by interrupt into a ring.
 *
 * QEMU's model has no bit rate: what is written has gone out at once. */
#ifndef DRV_UART_CADENCE_H
#define DRV_UART_CADENCE_H

#include <stdbool.h>

#include "drv/registers.h"

enum { DRV_UART_RING = 256 }; /* a power of two */

struct drv_uart {
    drv_registers base;
    uint8_t ring[DRV_UART_RING];
    volatile uint32_t head, tail; /* written by the interrupt, by the reader */
    struct {
        uint32_t overflowed; /* bytes lost because the ring or the FIFO was full */
        uint32_t damaged;    /* framing or parity error, or a break */
    } count;
};

/* 8 data bits, no parity, one stop bit at `baud` from a reference clock of `clock_hz`; the rate is
 * met within 1 % for 9600..921600 baud at 100 MHz. Interrupts of the receiver are enabled; what was
 * received before is dropped. */
void drv_uart_init(struct drv_uart *u, drv_registers base, uint32_t clock_hz, uint32_t baud);

/* Wait for room, and send. */
void drv_uart_put(struct drv_uart *u, char c);

/* Wait until the last bit has left. */
void drv_uart_drain(struct drv_uart *u);

/* The next byte received, or -1. */
int drv_uart_get(struct drv_uart *u);

/* The interrupt handler. */
void drv_uart_interrupt(void *uart);

#endif
