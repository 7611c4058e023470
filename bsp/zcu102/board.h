/* The board: its devices, and the unit that runs on them. */
#ifndef ZCU102_BOARD_H
#define ZCU102_BOARD_H

#include "drv/bezel_serial.h"
#include "drv/can_zynqmp.h"
#include "drv/display_dp.h"
#include "drv/flash_gqspi.h"
#include "drv/irq_gic400.h"
#include "drv/timer_generic.h"
#include "drv/uart_cadence.h"
#include "drv/watchdog_cadence.h"
#include "exception.h"
#include "lm/unit.h"
#include "restart.h"
#include "supervisor.h"

enum {
    ZCU102_WIDTH_PX = 768,
    ZCU102_HEIGHT_PX = 768,
    ZCU102_DISPLAY_LANES = 2,
    ZCU102_TILES = 384,
    ZCU102_STEP_US = 2000,   /* as often as a line is due at the fastest scale */
    ZCU102_LATE_US = 100000, /* steps later than that are left out */
    ZCU102_BAUD = 115200,
    ZCU102_BUS_BIT_RATE = 1000000
};

struct zcu102 {
    struct drv_timer timer;
    struct drv_irq irq;
    struct drv_uart console, bezel_line;
    struct drv_bezel_serial bezel;
    struct zcu102_core core;
    struct drv_can can;
    struct drv_flash flash;
    struct drv_display display;
    struct drv_watchdog watchdog;
    struct zcu102_supervisor supervisor;
    struct zcu102_restart last_restart;

    struct lm_board lent; /* a test may exchange a port before zcu102_start */
    struct lm_unit unit;

    uint64_t tick_us; /* of the next timer interrupt */
    uint64_t step_us; /* the time that the unit's next step is for */
    volatile uint32_t steps;
    volatile bool is_supervised;
    uint32_t steps_left_out;
};

/* Bring up every device; the rest of *z is ready for zcu102_start. A device that does not answer is
 * said on the console, and the unit shows what it shows without it. */
void zcu102_open(struct zcu102 *z);

/* Start the unit, whose time begins at 0. lm_unit_init's answer. */
int zcu102_start(struct zcu102 *z);

/* Wait until the unit's next step is due, and do it. The unit's clock goes in steps of
 * ZCU102_STEP_US, and each step sees the bus as it was at its own time: a step that waited for a
 * long one before it comes later and not different. */
void zcu102_step(struct zcu102 *z);

/* Microseconds since zcu102_open, and from zcu102_start on since then. */
uint64_t zcu102_now_us(const void *timer);

#endif
