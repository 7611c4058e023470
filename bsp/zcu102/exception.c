#include "exception.h"

#include "console.h"
#include "restart.h"

#include <stddef.h>

void zcu102_interrupt(const struct zcu102_frame *frame);
_Noreturn void zcu102_exception(uint64_t kind, const struct zcu102_frame *frame);

#define PAINT UINT64_C(0x5ac1a57a5ac1a57a) /* of start.S */

extern const uint64_t __stack_bottom[], __stack_top[];

static struct zcu102_core *this_core(void)
{
    struct zcu102_core *core;
    __asm__ volatile("mrs %0, tpidr_el1" : "=r"(core));
    return core;
}

void zcu102_take_interrupts(struct zcu102_core *core)
{
    __asm__ volatile("msr tpidr_el1, %0\n\tisb" : : "r"(core) : "memory");
    zcu102_unmask_interrupts();
}

void zcu102_mask_interrupts(void)
{
    __asm__ volatile("msr daifset, #2" : : : "memory");
}

void zcu102_unmask_interrupts(void)
{
    __asm__ volatile("msr daifclr, #2" : : : "memory");
}

uint32_t zcu102_stack_size(void)
{
    return (uint32_t)((uintptr_t)__stack_top - (uintptr_t)__stack_bottom);
}

uint32_t zcu102_stack_used(void)
{
    const uint32_t words = zcu102_stack_size() / (uint32_t)sizeof __stack_bottom[0];
    uint32_t untouched = 0;
    while (untouched < words && __stack_bottom[untouched] == PAINT) {
        untouched++;
    }
    return (words - untouched) * (uint32_t)sizeof __stack_bottom[0];
}

void zcu102_interrupt(const struct zcu102_frame *frame)
{
    struct zcu102_core *core = this_core();
    core->interrupted_pc = frame->pc;
    drv_irq_dispatch(core->irq);
}

/* The exception class of the syndrome in words (DDI 0487, ESR_EL1). */
static const char *class_words(uint64_t syndrome)
{
    switch (syndrome >> 26 & 0x3F) {
    case 0x00:
        return "unknown instruction";
    case 0x0E:
        return "illegal state";
    case 0x21:
        return "instruction abort";
    case 0x22:
        return "program counter not aligned";
    case 0x25:
        return "data abort";
    case 0x26:
        return "stack pointer not aligned";
    case 0x2F:
        return "system error";
    case 0x3C:
        return "breakpoint instruction";
    default:
        return "other class";
    }
}

static const char *abort_words(uint64_t syndrome)
{
    switch (syndrome >> 2 & 0xF) {
    case 1:
        return ", not mapped";
    case 2:
        return ", access flag";
    case 3:
        return ", not permitted";
    default:
        return "";
    }
}

static void report(struct drv_uart *u, uint64_t kind, const struct zcu102_frame *frame,
                   uint64_t syndrome, uint64_t address)
{
    static const char *const kinds[] = {"exception",
                                        "interrupt",
                                        "fast interrupt",
                                        "system error",
                                        "exception in exception",
                                        "interrupt in exception",
                                        "fast interrupt in exception",
                                        "system error in exception",
                                        "from a lower level"};
    const uint64_t class = syndrome >> 26 & 0x3F;
    const bool is_abort = class == 0x21 || class == 0x25;
    zcu102_print(u, "\n*** ");
    zcu102_print(u, kinds[kind < sizeof kinds / sizeof kinds[0] ? kind : 0]);
    zcu102_print(u, ": ");
    zcu102_print(u, class_words(syndrome));
    zcu102_print(u, is_abort ? abort_words(syndrome) : "");
    zcu102_print(u, class == 0x25 && (syndrome >> 6 & 1) ? ", on writing" : "");
    zcu102_print(u, "\npc ");
    zcu102_print_hex(u, frame->pc, 16);
    zcu102_print(u, " address ");
    zcu102_print_hex(u, address, 16);
    zcu102_print(u, " esr ");
    zcu102_print_hex(u, syndrome, 8);
    zcu102_print(u, " pstate ");
    zcu102_print_hex(u, frame->pstate, 8);
    for (uint32_t i = 0; i < 31; i++) {
        zcu102_print(u, i % 4 == 0 ? "\nx" : "  x");
        zcu102_print_number(u, i);
        zcu102_print(u, " ");
        zcu102_print_hex(u, frame->x[i], 16);
    }
    zcu102_print(u, "\nstack used ");
    zcu102_print_number(u, zcu102_stack_used());
    zcu102_print(u, " of ");
    zcu102_print_number(u, zcu102_stack_size());
    zcu102_print(u, "\n");
    drv_uart_drain(u);
}

_Noreturn void zcu102_exception(uint64_t kind, const struct zcu102_frame *frame)
{
    uint64_t syndrome, address;
    __asm__ volatile("mrs %0, esr_el1\n\tmrs %1, far_el1" : "=r"(syndrome), "=r"(address));
    const struct zcu102_core *core = this_core();
    if (core != NULL) {
        report(core->console, kind, frame, syndrome, address);
    }
    zcu102_restart(ZCU102_EXCEPTION, frame->pc, syndrome, address);
}
