/* The interrupt controller GIC-400 of Zynq UltraScale+ (UG1085, chapter 13). Registers: Arm Generic
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
        uint32_t strange; /* of a line without handler, which is disabled then */
    } count;
};

/* All lines off, none pending, equal priority. The core's own interrupt mask is not touched. */
void drv_irq_init(struct drv_irq *q, drv_registers distributor, drv_registers core);

/* Let a second core take interrupts of its own lines (0..31): what each core must do itself. */
void drv_irq_init_core(const struct drv_irq *q);

/* Call `handle(ctx)` in interrupt context when `line` (0..DRV_IRQ_LINES - 1, level-sensitive) is
 * raised, on core 0. False when there are DRV_IRQ_HANDLERS already, or no such line. */
bool drv_irq_attach(struct drv_irq *q, uint32_t line, drv_irq_handler *handle, void *ctx);

/* Enable one of the calling core's own lines, without a handler: it ends a wait for interrupt. */
void drv_irq_enable(const struct drv_irq *q, uint32_t line);

/* Take the interrupt that waits: from the core's exception vector. */
void drv_irq_dispatch(struct drv_irq *q);

#endif
