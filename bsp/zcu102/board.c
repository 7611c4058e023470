#include "board.h"

#include "addresses.h"
#include "console.h"
#include "fx/mem.h"
#include "sections.h"
#include "slots.h"

static ZCU102_BULK struct lm_tile tile_pool[ZCU102_TILES];
static ZCU102_BULK uint8_t plane[ZCU102_WIDTH_PX * ZCU102_HEIGHT_PX];
static ZCU102_SHARED uint32_t scanned[DRV_DISPLAY_BUFFERS][ZCU102_WIDTH_PX * ZCU102_HEIGHT_PX];
static ZCU102_SHARED struct drv_display_scan scans[DRV_DISPLAY_BUFFERS];
static ZCU102_SHARED uint8_t flash_piece[DRV_FLASH_PIECE];

static drv_registers device(uint32_t address)
{
    return (drv_registers)(uintptr_t)address;
}

uint64_t zcu102_now_us(const void *timer)
{
    return drv_timer_us(timer);
}

static void tick(void *board)
{
    struct zcu102 *z = board;
    z->tick_us += ZCU102_STEP_US;
    drv_timer_alarm(&z->timer, z->tick_us);
    if (!z->is_supervised) {
        return;
    }
    const struct lm_liveness life =
        zcu102_life_of(&z->unit, z->steps, &z->can, &z->supervisor.last);
    const enum zcu102_cause cause =
        zcu102_supervise(&z->supervisor, drv_timer_us(&z->timer), &life);
    if (cause != ZCU102_POWER_ON) {
        zcu102_restart(cause, z->core.interrupted_pc, 0, 0);
    }
}

static int get_byte(void *uart)
{
    return drv_uart_get(uart);
}

static void open_console(struct zcu102 *z)
{
    drv_timer_init(&z->timer);
    drv_uart_init(&z->console, device(UART0_BASE), UART_CLOCK_HZ, ZCU102_BAUD);
    drv_irq_init(&z->irq, device(GICD_BASE), device(GICC_BASE));
    z->core = (struct zcu102_core){.irq = &z->irq, .console = &z->console};
    drv_irq_attach(&z->irq, UART0_LINE, drv_uart_interrupt, &z->console);
    drv_irq_attach(&z->irq, DRV_TIMER_LINE, tick, z);
    zcu102_take_interrupts(&z->core);
    z->last_restart = zcu102_last_restart();
    zcu102_print(&z->console, "\nlandmass on ZCU102, started after ");
    zcu102_print(&z->console, zcu102_cause_words(z->last_restart.cause));
    zcu102_print(&z->console, "\n");
}

static void complain_if(struct zcu102 *z, int status, const char *device_name)
{
    if (status != LM_OK) {
        zcu102_print(&z->console, device_name);
        zcu102_print(&z->console, ": does not answer\n");
    }
}

static void open_devices(struct zcu102 *z)
{
    drv_uart_init(&z->bezel_line, device(UART1_BASE), UART_CLOCK_HZ, ZCU102_LINE_BAUD);
    drv_irq_attach(&z->irq, UART1_LINE, drv_uart_interrupt, &z->bezel_line);
    drv_bezel_serial_init(&z->bezel, get_byte, &z->bezel_line);

    const struct drv_can_config can = {.base = device(CAN0_BASE),
                                       .clock_hz = CAN_CLOCK_HZ,
                                       .bit_rate = ZCU102_BUS_BIT_RATE,
                                       .now_us = zcu102_now_us,
                                       .clock = &z->timer};
    complain_if(z, drv_can_open(&z->can, &can), "bus");
    drv_irq_attach(&z->irq, CAN0_LINE, drv_can_interrupt, &z->can);

    const struct drv_flash_config flash = {.base = device(QSPI_BASE),
                                           .piece = flash_piece,
                                           .now_us = zcu102_now_us,
                                           .clock = &z->timer};
    complain_if(z, drv_flash_open(&z->flash, &flash), "flash");
    zcu102_choose_slot(z, tile_pool, sizeof tile_pool);

    for (uint32_t i = 0; i < DRV_DISPLAY_BUFFERS; i++) {
        scans[i].pixels = scanned[i];
    }
    const struct drv_display_config display = {.dp = device(DP_BASE),
                                               .dma = device(DPDMA_BASE),
                                               .lanes = ZCU102_DISPLAY_LANES,
                                               .now_us = zcu102_now_us,
                                               .clock = &z->timer,
                                               .width_px = ZCU102_WIDTH_PX,
                                               .height_px = ZCU102_HEIGHT_PX,
                                               .scans = scans};
    complain_if(z, drv_display_open(&z->display, &display), "display");
    drv_watchdog_start(&z->watchdog, device(SWDT_BASE), SWDT_CLOCK_HZ, ZCU102_WATCHDOG_MS);
}

void zcu102_open(struct zcu102 *z)
{
    open_console(z);
    open_devices(z);
    z->supervisor.watchdog = &z->watchdog;
    zcu102_tell_slots(z);
    z->lent = (struct lm_board){.flash = &z->slots.port,
                                .can = &z->can.port,
                                .controls = &z->controls,
                                .display = &z->display.port,
                                .tile_pool = tile_pool,
                                .tile_pool_bytes = sizeof tile_pool,
                                .plane = plane,
                                .glass_step_px = LM_GLASS_STEP_PX,
                                .flash_poll_limit = ZCU102_FLASH_POLLS};
    if (z->last_restart.cause != ZCU102_POWER_ON) {
        z->lent.restart = zcu102_cause_words(z->last_restart.cause);
    }
}

int zcu102_start(struct zcu102 *z)
{
    zcu102_recording_begin(&z->recording, &z->bezel_line, &z->console, &z->lent);
    const int status = lm_unit_init(&z->unit, &z->lent);
    if (status == LM_OK) {
        drv_timer_init(&z->timer);
        z->supervisor.next_us = ZCU102_SUPERVISION_US;
        z->is_supervised = true;
        drv_timer_alarm(&z->timer, z->tick_us);
    }
    return status;
}

/* Interrupts are held off between the look and the wait, or the tick could come in between; a
 * pending one ends the wait all the same. */
static void wait_until(const struct zcu102 *z, uint64_t time_us)
{
    zcu102_mask_interrupts();
    while (drv_timer_us(&z->timer) < time_us) {
        drv_timer_wait();
        zcu102_unmask_interrupts();
        zcu102_mask_interrupts();
    }
    zcu102_unmask_interrupts();
}

void zcu102_step(struct zcu102 *z)
{
    wait_until(z, z->step_us);
    drv_can_deliver(&z->can, z->step_us);
    zcu102_recording_step(&z->recording, z->step_us);
    lm_unit_step(&z->unit, z->step_us);
    z->steps++;
    z->step_us += ZCU102_STEP_US;
    while (drv_timer_us(&z->timer) > z->step_us + ZCU102_LATE_US) {
        z->step_us += ZCU102_STEP_US;
        z->steps_left_out++;
    }
}
