/* UART of Zynq devices (Cadence). Registers and bits: Zynq UltraScale+ Device TRM UG1085, chapter
 * 21, and register reference UG1087, module UART. drv_uart_put waits for room in the transmit FIFO
 * of 64 bytes. drv_uart_queue never waits: the interrupt refills the FIFO from a ring that is lent.
 * Receiving is by interrupt into a ring.
 *
 * QEMU's model has no bit rate: a byte that is written is sent at once. */
#ifndef DRV_UART_CADENCE_H
#define DRV_UART_CADENCE_H

#include <stdbool.h>

#include "drv/registers.h"

enum { DRV_UART_RING = 256 }; /* a power of two */

struct drv_uart {
    drv_registers base;
    uint8_t ring[DRV_UART_RING];
    volatile uint32_t head; /* bytes put in; written by the interrupt */
    volatile uint32_t tail; /* bytes taken out; written by the reader */
    struct {
        uint8_t *bytes;         /* borrowed */
        uint32_t size;          /* a power of two; 0: drv_uart_queue has no room */
        volatile uint32_t head; /* bytes put in */
        volatile uint32_t tail; /* bytes sent; while is_active, written by the interrupt */
        volatile bool is_active;
    } out;
    struct {
        uint32_t overflowed; /* bytes lost because the ring or the FIFO was full */
        uint32_t damaged;    /* bytes with a framing or parity error, or a break */
    } count;
};

/* Set 8 data bits, no parity and one stop bit at `baud`, from a reference clock of `clock_hz`. The
 * rate is met within 1 % for 9600..921600 baud and exactly for 2,000,000 baud at 100 MHz. Enables
 * the receiver's interrupts and drops what was received before. */
void drv_uart_init(struct drv_uart *u, drv_registers base, uint32_t clock_hz, uint32_t baud);

/* Wait for room in the FIFO, and send. */
void drv_uart_put(struct drv_uart *u, char c);

/* Lend memory for bytes that wait to be sent: a power of two of them. Before drv_uart_queue. */
void drv_uart_lend(struct drv_uart *u, uint8_t *bytes, uint32_t size);

/* Room for bytes that wait. */
uint32_t drv_uart_room(const struct drv_uart *u);

/* Send these bytes behind those that wait, without waiting. False, and none is taken, if there is
 * no room for all. Not beside drv_uart_put on the same line. */
bool drv_uart_queue(struct drv_uart *u, const void *bytes, uint32_t count);

/* Wait until the last bit is sent. */
void drv_uart_drain(struct drv_uart *u);

/* The next byte received, or -1. */
int drv_uart_get(struct drv_uart *u);

/* Interrupt handler; `uart` is the struct drv_uart. */
void drv_uart_interrupt(void *uart);

#endif
