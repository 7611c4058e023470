/* Registers of a device: 32-bit words at offsets from a base address. On the machine itself the
 * base is a physical address mapped as device memory; in a unit test it is an array. */
#ifndef DRV_REGISTERS_H
#define DRV_REGISTERS_H

#include <stdbool.h>
#include <stdint.h>

typedef volatile uint32_t *drv_registers;

/* Offsets are in bytes, multiples of 4. */
static inline uint32_t drv_read(drv_registers base, uint32_t offset)
{
    return base[offset / 4];
}

static inline void drv_write(drv_registers base, uint32_t offset, uint32_t value)
{
    base[offset / 4] = value;
}

/* Read a register until its bits under `mask` are `value`. True if they are; false after `polls`
 * reads, at least 1. Waits actively and without a clock: `polls` is a limit for a device that does
 * not answer, and no timing. */
static inline bool drv_wait_for(drv_registers base, uint32_t offset, uint32_t mask, uint32_t value,
                                uint32_t polls)
{
    while ((drv_read(base, offset) & mask) != value) {
        if (--polls == 0) {
            return false;
        }
    }
    return true;
}

#endif
