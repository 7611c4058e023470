/* Does, one after the other, what the board must not let pass; each ends in a report and a restart,
 * and the number of restarts says what comes next. */
#include "board.h"
#include "console.h"
#include "psci.h"

int main(void);

static void touch(volatile uint64_t address, bool is_write)
{
    volatile uint32_t *word = (volatile uint32_t *)(uintptr_t)address;
    if (is_write) {
        *word = 1;
    } else {
        (void)*word;
    }
}

static void run_variable(void)
{
    static uint32_t ret = 0xD65F03C0; /* the instruction ret */
    void (*function)(void) = (void (*)(void))(uintptr_t)&ret;
    function();
}

/* More than the stack's pages hold, written from the top down as calls would. */
static void outgrow_stack(void)
{
    volatile uint8_t bytes[32768];
    for (uint32_t i = sizeof bytes; i > 0; i--) {
        bytes[i - 1] = (uint8_t)i;
    }
}

static void fail_in_interrupt(void *ctx)
{
    (void)ctx;
    touch(8, false);
}

static void cause_interrupt(struct zcu102 *z)
{
    z->irq.handlers[1].handle = fail_in_interrupt; /* the timer's, board.c */
    drv_timer_alarm(&z->timer, 0);
    for (;;) {
        drv_timer_wait();
    }
}

int main(void)
{
    static struct zcu102 z;
    extern const char __text_start[];
    zcu102_open(&z);
    zcu102_print_value(&z.console, "restarts", z.last_restart.count);
    switch (z.last_restart.count) {
    case 0:
        touch(8, false);
        break;
    case 1:
        touch((uint64_t)(uintptr_t)__text_start, true);
        break;
    case 2:
        run_variable();
        break;
    case 3:
        outgrow_stack();
        break;
    case 4:
        touch(0x30000000, false);
        break;
    case 5:
        __asm__ volatile(".inst 0");
        break;
    case 6:
        cause_interrupt(&z);
        break;
    default:
        zcu102_print(&z.console, "all done\n");
        zcu102_power_off();
    }
    zcu102_print(&z.console, "nothing happened\n");
    zcu102_power_off();
}
