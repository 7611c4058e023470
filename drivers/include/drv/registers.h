/* A device's registers: 32-bit words at offsets from a base address. On the machine itself the base
 * is a physical address mapped as device memory; in a unit test it is an array. */
#ifndef DRV_REGISTERS_H
#define DRV_REGISTERS_H

#include <stdint.h>

typedef volatile uint32_t *drv_registers;

static inline uint32_t drv_read(drv_registers base, uint32_t offset)
{
    return base[offset / 4];
}

static inline void drv_write(drv_registers base, uint32_t offset, uint32_t value)
{
    base[offset / 4] = value;
}

#endif
