/* What the vectors call (vectors.S), and the core's own interrupt mask. */
#ifndef ZCU102_EXCEPTION_H
#define ZCU102_EXCEPTION_H

#include "drv/irq_gic400.h"
#include "drv/uart_cadence.h"

/* As the vectors lay it out. */
struct zcu102_frame {
    uint64_t x[31], pc, pstate;
};

/* What an exception finds its way by: TPIDR_EL1 points to it. */
struct zcu102_core {
    struct drv_irq *irq;
    struct drv_uart *console;
    uint64_t interrupted_pc; /* where the last interrupt found the program */
};

/* Make `core` known to the vectors and take interrupts from now on; it must outlive the program. */
void zcu102_take_interrupts(struct zcu102_core *core);

/* Hold interrupts off, to look at what they change before waiting; never for long. */
void zcu102_mask_interrupts(void);
void zcu102_unmask_interrupts(void);

/* The deepest use of the main stack so far, in bytes (start.S paints it), and its size. */
uint32_t zcu102_stack_used(void);
uint32_t zcu102_stack_size(void);

#endif
