#include "drv/watchdog_cadence.h"

/* A write without its key is ignored. */
enum {
    MODE = 0x00,
    CONTROL = 0x04,
    RESTART = 0x08,

    MODE_KEY = 0xABC << 12,
    MODE_WDEN = 1 << 0,
    MODE_RSTEN = 1 << 1,
    MODE_RSTLN = 3 << 4, /* the longest reset pulse */
    CONTROL_KEY = 0x248 << 14,
    CONTROL_CRV_SHIFT = 2, /* the count starts from this * 4096 + 4095 */
    CONTROL_CLKSEL_4096 = 3,
    RESTART_KEY = 0x1999,

    CRV_MAX = 4095
};

bool drv_watchdog_start(struct drv_watchdog *w, drv_registers base, uint32_t clock_hz,
                        uint32_t timeout_ms)
{
    const uint64_t unit_clocks = UINT64_C(4096) * 4096;
    const uint64_t clocks = (uint64_t)clock_hz * timeout_ms / 1000;
    const uint64_t units = (clocks + unit_clocks - 1) / unit_clocks;
    if (units < 1 || units > CRV_MAX + 1) {
        return false;
    }
    w->base = base;
    drv_write(base, MODE, MODE_KEY); /* off while the count changes */
    drv_write(base, CONTROL,
              CONTROL_KEY | (uint32_t)(units - 1) << CONTROL_CRV_SHIFT | CONTROL_CLKSEL_4096);
    drv_write(base, MODE, MODE_KEY | MODE_WDEN | MODE_RSTEN | MODE_RSTLN);
    drv_watchdog_feed(w);
    return true;
}

void drv_watchdog_feed(const struct drv_watchdog *w)
{
    drv_write(w->base, RESTART, RESTART_KEY);
}
