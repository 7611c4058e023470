#include "peer.h"

#include "addresses.h"
#include "psci.h"
#include "sections.h"

enum { STACK_BYTES = 16384 };

/* What core1.S reads, with the caches still off. */
struct core1 {
    uint64_t table, stack_top;
    void (*function)(struct peer *p);
    struct peer *argument;
};

void core1_start(void);

static ZCU102_BULK uint8_t stack[STACK_BYTES];
static ZCU102_SHARED struct core1 start;

/* Interrupts are masked and only end the wait. */
static void sleep_until(const struct drv_timer *timer, uint64_t time_us)
{
    while (drv_timer_us(timer) < time_us) {
        drv_timer_alarm(timer, time_us);
        drv_timer_wait();
    }
    drv_timer_stop();
}

static void run(struct peer *p)
{
    static struct drv_can can;
    const struct drv_timer *timer = &p->board->timer;
    const struct drv_can_config config = {.base = (drv_registers)CAN1_BASE,
                                          .clock_hz = CAN_CLOCK_HZ,
                                          .bit_rate = ZCU102_BUS_BIT_RATE,
                                          .now_us = zcu102_now_us,
                                          .clock = timer};
    drv_irq_init_core(&p->board->irq);
    drv_irq_enable(&p->board->irq, DRV_TIMER_LINE);
    drv_can_open(&can, &config);
    for (uint32_t i = 0; i < p->count; i++) {
        sleep_until(timer, p->frames[i].time_us);
        if (can.port.send(can.port.ctx, &p->frames[i]) == LM_OK) {
            p->sent++;
        } else {
            p->refused++;
        }
    }
}

bool peer_start(struct peer *p)
{
    uint64_t table;
    __asm__ volatile("mrs %0, ttbr0_el1" : "=r"(table));
    start = (struct core1){table, (uint64_t)(uintptr_t)(stack + STACK_BYTES), run, p};
    return zcu102_core_on(1, (uint64_t)(uintptr_t)core1_start, (uint64_t)(uintptr_t)&start) == 0;
}
