/* Generic timer of a 64-bit Arm core (DDI 0487, chapter D11): a counter that all cores share, and
 * the EL1 physical timer, whose interrupt is the core's own line 30. */
#ifndef DRV_TIMER_GENERIC_H
#define DRV_TIMER_GENERIC_H

#include <stdint.h>

enum { DRV_TIMER_LINE = 30 };

struct drv_timer {
    uint64_t zero_ticks; /* the counter at time 0 */
    uint64_t hz;
};

/* Set time 0 to now. */
void drv_timer_init(struct drv_timer *t);

/* Microseconds since drv_timer_init; never goes back. Safe in interrupts and on any core. */
uint64_t drv_timer_us(const struct drv_timer *t);

/* Raise the calling core's timer interrupt at `time_us`, or at once if that is past. It is level-
 * sensitive: it stays raised until the alarm is set again or stopped. */
void drv_timer_alarm(const struct drv_timer *t, uint64_t time_us);

/* Stop the calling core's alarm. */
void drv_timer_stop(void);

/* Wait until an interrupt is pending for this core, whether or not the core takes interrupts
 * now. */
void drv_timer_wait(void);

#endif
