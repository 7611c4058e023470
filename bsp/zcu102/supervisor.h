/* Watches that the unit lives, from the timer interrupt: in each period its step must have ended,
 * a picture must have been shown, and the bus must have been asked. Otherwise the board restarts
 * and says on its BIT page why. While all is well the hardware's watchdog is fed, which in turn
 * watches the interrupt. */
#ifndef ZCU102_SUPERVISOR_H
#define ZCU102_SUPERVISOR_H

#include "drv/can_zynqmp.h"
#include "drv/watchdog_cadence.h"
#include "lm/unit.h"
#include "restart.h"

enum { ZCU102_SUPERVISION_US = 500000, ZCU102_WATCHDOG_MS = 2000 };

struct zcu102_beats {
    uint32_t steps, frames, bus;
};

struct zcu102_supervisor {
    const struct drv_watchdog *watchdog;
    uint64_t next_us;
    struct zcu102_beats last;
};

/* What has happened so far, as counters. The bus counts as asked when nothing waits in its ring. */
struct zcu102_beats zcu102_beats_of(const struct lm_unit *unit, uint32_t steps,
                                    const struct drv_can *can, const struct zcu102_beats *last);

/* From the timer interrupt: ZCU102_POWER_ON when all is well or it is not time to look, else the
 * cause to restart for. */
enum zcu102_cause zcu102_supervise(struct zcu102_supervisor *s, uint64_t now_us,
                                   const struct zcu102_beats *now);

#endif
