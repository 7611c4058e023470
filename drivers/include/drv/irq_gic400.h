/* Interrupt controller GIC-400 of Zynq UltraScale+ (UG1085, chapter 13). Registers: Arm Generic
 * Interrupt Controller Architecture Specification 2.0 (IHI 0048B), chapter 4. */
#ifndef DRV_IRQ_GIC400_H
#define DRV_IRQ_GIC400_H

#include <stdbool.h>

#include "drv/registers.h"

enum { DRV_IRQ_HANDLERS = 8, DRV_IRQ_LINES = 192 };

typedef void drv_irq_handler(void *ctx);

struct drv_irq {
    drv_registers distributor, core;
    uint32_t handler_count;
    struct {
        uint32_t line;
        drv_irq_handler *handle;
        void *ctx;
    } handlers[DRV_IRQ_HANDLERS];
    struct {
        uint32_t taken, spurious;
        uint32_t strange; /* interrupts of a line without handler; the line is then disabled */
    } count;
};

/* Disable all lines, clear pending interrupts and set equal priorities. The core's own interrupt
 * mask is not changed. */
void drv_irq_init(struct drv_irq *q, drv_registers distributor, drv_registers core);

/* Let the calling core take interrupts of its own lines (0..31). Each further core calls it
 * itself. */
void drv_irq_init_core(const struct drv_irq *q);

/* Call `handle(ctx)` in interrupt context, on core 0, when `line` (0..DRV_IRQ_LINES - 1,
 * level-sensitive) is raised. `ctx` stays borrowed. False, and nothing is changed, iff there are
 * DRV_IRQ_HANDLERS handlers already, or there is no such line. */
bool drv_irq_attach(struct drv_irq *q, uint32_t line, drv_irq_handler *handle, void *ctx);

/* Enable one of the calling core's own lines without a handler, to end a wait for interrupt. */
void drv_irq_enable(const struct drv_irq *q, uint32_t line);

/* Take the pending interrupt. Called by the core's exception vector. */
void drv_irq_dispatch(struct drv_irq *q);

#endif
