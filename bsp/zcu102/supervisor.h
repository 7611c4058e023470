/* Supervisor: checks from the timer interrupt that the unit is alive by the rule of lm/liveness.h.
 * If it is not during a period, the board restarts, and its BIT page shows the cause. While it is,
 * the supervisor feeds the hardware's watchdog, which in turn supervises the interrupt. */
#ifndef ZCU102_SUPERVISOR_H
#define ZCU102_SUPERVISOR_H

#include "drv/can_zynqmp.h"
#include "drv/watchdog_cadence.h"
#include "lm/liveness.h"
#include "lm/unit.h"
#include "restart.h"

enum { ZCU102_SUPERVISION_US = 500000, ZCU102_WATCHDOG_MS = 2000 };

struct zcu102_supervisor {
    const struct drv_watchdog *watchdog;
    uint64_t next_us;
    struct lm_liveness last;
};

/* Liveness so far. The bus counts as polled if nothing waits in its ring. A frame that was drawn
 * counts as shown, because the display controller does not report it. */
struct lm_liveness zcu102_life_of(const struct lm_unit *unit, uint32_t steps,
                                  const struct drv_can *can, const struct lm_liveness *last);

/* Check the unit and feed the watchdog. Called by the timer interrupt. Returns ZCU102_POWER_ON if
 * the unit is alive or no check is due, else the cause to restart for. */
enum zcu102_cause zcu102_supervise(struct zcu102_supervisor *s, uint64_t now_us,
                                   const struct lm_liveness *now);

#endif
