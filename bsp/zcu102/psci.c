#include "psci.h"

enum { CPU_ON_32 = 0x84000003, SYSTEM_OFF = 0x84000008, SYSTEM_RESET = 0x84000009 };
#define CPU_ON (UINT64_C(0x40000000) | (uint32_t)CPU_ON_32) /* 64-bit arguments */

static int64_t call(uint64_t function, uint64_t a, uint64_t b, uint64_t c)
{
    register uint64_t x0 __asm__("x0") = function;
    register uint64_t x1 __asm__("x1") = a;
    register uint64_t x2 __asm__("x2") = b;
    register uint64_t x3 __asm__("x3") = c;
    __asm__ volatile("smc #0"
                     : "+r"(x0), "+r"(x1), "+r"(x2), "+r"(x3)
                     :
                     : "x4", "x5", "x6", "x7", "x8", "x9", "x10", "x11", "x12", "x13", "x14", "x15",
                       "x16", "x17", "memory");
    return (int64_t)x0;
}

/* Nothing more can be done when the firmware returns. */
static _Noreturn void stand_still(void)
{
    for (;;) {
        __asm__ volatile("wfi");
    }
}

_Noreturn void zcu102_power_off(void)
{
    call((uint32_t)SYSTEM_OFF, 0, 0, 0);
    stand_still();
}

_Noreturn void zcu102_reset(void)
{
    call((uint32_t)SYSTEM_RESET, 0, 0, 0);
    stand_still();
}

int64_t zcu102_core_on(uint64_t core, uint64_t entry, uint64_t context)
{
    return call(CPU_ON, core, entry, context);
}
