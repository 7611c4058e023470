/* Board ZCU102: its devices, and the unit that runs on them. */
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
#include "lm/slot_flash.h"
#include "lm/unit.h"
#include "recording.h"
#include "restart.h"
#include "supervisor.h"

enum {
    ZCU102_WIDTH_PX = 768,
    ZCU102_HEIGHT_PX = 768,
    ZCU102_DISPLAY_LANES = 2,
    ZCU102_TILES = 384,
    ZCU102_STEP_US = 2000,   /* at the fastest scale a line is due every 2 ms */
    ZCU102_LATE_US = 100000, /* steps that are later than this are skipped */
    ZCU102_BAUD = 115200,
    ZCU102_LINE_BAUD = 2000000, /* the bezel's, and of what is recorded */
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
    struct lm_slot_flash slots;
    struct lm_controls controls; /* the bezel's, behind what is known of the slots */
    bool are_slots_told;
    struct drv_display display;
    struct drv_watchdog watchdog;
    struct zcu102_supervisor supervisor;
    struct zcu102_restart last_restart;
    struct zcu102_recording recording;

    struct lm_board lent; /* the unit's ports; a test may replace one before zcu102_start */
    struct lm_unit unit;

    uint64_t tick_us; /* time of the next timer interrupt */
    uint64_t step_us; /* time of the unit's next step */
    volatile uint32_t steps;
    volatile bool is_supervised;
    uint32_t steps_left_out;
};

/* Initialise *z, which is zero and must not move, and every device. A device that does not answer
 * is reported on the console, and the unit runs without it. */
void zcu102_open(struct zcu102 *z);

/* Start the unit, whose time begins at 0. Returns the result of lm_unit_init. */
int zcu102_start(struct zcu102 *z);

/* Wait until the unit's next step is due, and do it. The unit's clock advances by ZCU102_STEP_US,
 * and each step sees the bus as of its own time. So a step that runs late because of a long one
 * before it has the same result. */
void zcu102_step(struct zcu102 *z);

/* Microseconds since zcu102_open; after zcu102_start, since that. `timer` is the struct
 * drv_timer. */
uint64_t zcu102_now_us(const void *timer);

#endif
