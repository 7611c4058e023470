#include "drv/timer_generic.h"

enum { ENABLE = 1 };

static uint64_t counter(void)
{
    uint64_t ticks;
    __asm__ volatile("isb\n\tmrs %0, cntpct_el0" : "=r"(ticks) : : "memory");
    return ticks;
}

void drv_timer_init(struct drv_timer *t)
{
    __asm__ volatile("mrs %0, cntfrq_el0" : "=r"(t->hz));
    t->zero_ticks = counter();
}

/* In whole seconds and their rest: the product of ticks and a million would overflow after days. */
uint64_t drv_timer_us(const struct drv_timer *t)
{
    const uint64_t ticks = counter() - t->zero_ticks;
    return ticks / t->hz * 1000000u + ticks % t->hz * 1000000u / t->hz;
}

/* Rounded up, so that the time has come when the alarm does. */
void drv_timer_alarm(const struct drv_timer *t, uint64_t time_us)
{
    const uint64_t ticks =
        time_us / 1000000u * t->hz + (time_us % 1000000u * t->hz + 999999u) / 1000000u;
    __asm__ volatile("msr cntp_cval_el0, %0\n\tmsr cntp_ctl_el0, %1\n\tisb"
                     :
                     : "r"(t->zero_ticks + ticks), "r"((uint64_t)ENABLE)
                     : "memory");
}

void drv_timer_stop(void)
{
    __asm__ volatile("msr cntp_ctl_el0, %0\n\tisb" : : "r"((uint64_t)0) : "memory");
}

void drv_timer_wait(void)
{
    __asm__ volatile("dsb sy\n\twfi" : : : "memory");
}
