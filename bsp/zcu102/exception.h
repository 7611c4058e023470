/* Exceptions: state for the vectors (vectors.S), and the core's own interrupt mask. */
#ifndef ZCU102_EXCEPTION_H
#define ZCU102_EXCEPTION_H

#include "drv/irq_gic400.h"
#include "drv/uart_cadence.h"

/* Registers of an interrupted program, as the vectors store them. */
struct zcu102_frame {
    uint64_t x[31], pc, pstate;
};

/* Core: what an exception handler needs; TPIDR_EL1 points to it. */
struct zcu102_core {
    struct drv_irq *irq;
    struct drv_uart *console;
    uint64_t interrupted_pc; /* program counter at the last interrupt */
};

/* Give `core` to the vectors and unmask interrupts. It stays borrowed for ever. */
void zcu102_take_interrupts(struct zcu102_core *core);

/* Mask interrupts for a short time, to read what they change before a wait; and unmask them. */
void zcu102_mask_interrupts(void);
void zcu102_unmask_interrupts(void);

/* Deepest use of the main stack so far, which start.S fills with a pattern, and its size; in
 * bytes. */
uint32_t zcu102_stack_used(void);
uint32_t zcu102_stack_size(void);

#endif
