/* System watchdog of Zynq UltraScale+ (Cadence). Registers, keys and sequences: UG1085, chapter
 * 14, and UG1087, module SWDT. It resets the board if it is not fed for `timeout_ms`.
 *
 * Its writes are tested on registers in memory (tests/unit/drivers/test_zynqmp_devices.c). NOT
 * tested: the reset, which QEMU's model of this board does not have. */
#ifndef DRV_WATCHDOG_CADENCE_H
#define DRV_WATCHDOG_CADENCE_H

#include <stdbool.h>

#include "drv/registers.h"

struct drv_watchdog {
    drv_registers base;
};

/* Start the watchdog. The time-out is rounded up to units of 4096 * 4096 clocks. False, and nothing
 * is started, iff that is not 1..4096 units: 168 ms to 687 s at 100 MHz. */
bool drv_watchdog_start(struct drv_watchdog *w, drv_registers base, uint32_t clock_hz,
                        uint32_t timeout_ms);

/* Feed the watchdog: restart its count. */
void drv_watchdog_feed(const struct drv_watchdog *w);

#endif
