/* Watches that the unit lives by the rule of lm/liveness.h, from the timer interrupt. Where it is
 * broken in a period, the board restarts and says on its BIT page why. While all is well the
 * hardware's watchdog is fed, which in turn watches the interrupt. */
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

/* What has happened so far. The bus counts as asked when nothing waits in its ring; a picture that
 * was drawn counts as shown, for the display controller does not tell. */
struct lm_liveness zcu102_life_of(const struct lm_unit *unit, uint32_t steps,
                                  const struct drv_can *can, const struct lm_liveness *last);

/* From the timer interrupt: ZCU102_POWER_ON when all is well or it is not time to look, else the
 * cause to restart for. */
enum zcu102_cause zcu102_supervise(struct zcu102_supervisor *s, uint64_t now_us,
                                   const struct lm_liveness *now);

#endif
