#include "drv/irq_gic400.h"

enum {
    GICD_CTLR = 0x000,
    GICD_ISENABLER = 0x100, /* one bit a line */
    GICD_ICENABLER = 0x180,
    GICD_ICPENDR = 0x280,
    GICD_IPRIORITYR = 0x400, /* one byte a line */
    GICD_ITARGETSR = 0x800,

    GICC_CTLR = 0x00,
    GICC_PMR = 0x04,
    GICC_IAR = 0x0C,
    GICC_EOIR = 0x10,

    PRIVATE_LINES = 32,
    FIRST_SPECIAL = 1020,
    LINE_MASK = 0x3FF
};

static uint32_t bit_word(uint32_t line)
{
    return line / 32 * 4;
}

void drv_irq_init(struct drv_irq *q, drv_registers distributor, drv_registers core)
{
    *q = (struct drv_irq){.distributor = distributor, .core = core};
    drv_write(distributor, GICD_CTLR, 0);
    for (uint32_t line = 0; line < DRV_IRQ_LINES; line += 32) {
        drv_write(distributor, GICD_ICENABLER + bit_word(line), UINT32_MAX);
        drv_write(distributor, GICD_ICPENDR + bit_word(line), UINT32_MAX);
    }
    for (uint32_t line = 0; line < DRV_IRQ_LINES; line += 4) {
        drv_write(distributor, GICD_IPRIORITYR + line, 0x80808080u);
        if (line >= PRIVATE_LINES) {
            drv_write(distributor, GICD_ITARGETSR + line, 0x01010101u);
        }
    }
    drv_write(distributor, GICD_CTLR, 1);
    drv_irq_init_core(q);
}

void drv_irq_init_core(const struct drv_irq *q)
{
    drv_write(q->core, GICC_PMR, 0xF0);
    drv_write(q->core, GICC_CTLR, 1);
}

void drv_irq_enable(const struct drv_irq *q, uint32_t line)
{
    drv_write(q->distributor, GICD_ISENABLER + bit_word(line), 1u << line % 32);
}

bool drv_irq_attach(struct drv_irq *q, uint32_t line, drv_irq_handler *handle, void *ctx)
{
    if (q->handler_count == DRV_IRQ_HANDLERS || line >= DRV_IRQ_LINES) {
        return false;
    }
    q->handlers[q->handler_count].line = line;
    q->handlers[q->handler_count].handle = handle;
    q->handlers[q->handler_count].ctx = ctx;
    q->handler_count++;
    drv_irq_enable(q, line);
    return true;
}

void drv_irq_dispatch(struct drv_irq *q)
{
    const uint32_t acknowledge = drv_read(q->core, GICC_IAR), line = acknowledge & LINE_MASK;
    if (line >= FIRST_SPECIAL) {
        q->count.spurious++;
        return;
    }
    uint32_t i = 0;
    while (i < q->handler_count && q->handlers[i].line != line) {
        i++;
    }
    if (i < q->handler_count) {
        q->count.taken++;
        q->handlers[i].handle(q->handlers[i].ctx);
    } else {
        q->count.strange++;
        drv_write(q->distributor, GICD_ICENABLER + bit_word(line), 1u << line % 32);
    }
    drv_write(q->core, GICC_EOIR, acknowledge);
}
