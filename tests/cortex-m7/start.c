/* How the microcontroller starts: its vectors, and what is told when it faults. */
#include "host.h"

int main(void);
_Noreturn void reset(void);

/* QEMU has loaded .data and cleared .bss. */
_Noreturn void reset(void)
{
    host_exit(main());
}

static _Noreturn void fault(void)
{
    host_say("a fault\n");
    host_exit(2);
}

extern char __stack_top[];

struct vectors {
    const void *stack;
    void (*handlers[15])(void);
};

extern const struct vectors vectors;
__attribute__((section(".vectors"), used))
const struct vectors vectors = {__stack_top, {reset, fault, fault, fault, fault, fault}};
