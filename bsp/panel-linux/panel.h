/* Panel: the cockpit panel as a board: every device behind the firmware's ports, and the loop
 * around lm_unit_step. */
#ifndef PANEL_H
#define PANEL_H

#include "bezel.h"
#include "bus.h"
#include "bus/table_text.h"
#include "config.h"
#include "database.h"
#include "display.h"
#include "drv/flash_reader.h"
#include "drv/watchdog.h"
#include "faults_file.h"
#include "further.h"
#include "hand_controller.h"
#include "lm/unit.h"
#include "recording.h"
#include "settings_file.h"
#include "slots_told.h"
#include "storage.h"

enum {
    PANEL_TICK_US = 2000, /* time between steps: at the fastest scale a line is due every 2 ms */
    PANEL_STEP_US = 500   /* least time between steps, however often a device wakes the loop */
};

struct panel {
    const struct config *config; /* borrowed */
    uint64_t zero_us;            /* time of CLOCK_MONOTONIC at which the panel's clock is 0 */
    struct storage storage;
    struct further further;
    struct lm_flash_part images[LM_IMAGES_MAX]; /* of the flash; none: it has one */
    struct slots_told slots;
    struct drv_flash_reader flash;
    struct database database;
    struct bus bus, bus_2;
    struct glass glass;
    struct bezel bezel;
    struct hand hand;
    struct lm_controls controls;
    struct drv_watchdog watchdog;
    int signals;                     /* file descriptor of signalfd */
    struct lm_radar radar;           /* of the configuration, where it names one */
    struct bus_table table, table_2; /* likewise */
    struct lm_board board;
    struct recording recording;
    struct settings_file settings;
    struct faults_file faults;
    struct lm_unit *unit;     /* owned */
    uint32_t flags_told;      /* enum lm_flag, as reported last */
    const char *trouble_told; /* of the recording, likewise */
    uint64_t tell_us;         /* time of the next report */

    struct {
        uint32_t steps;
        uint32_t step_max_us; /* longest step */
        uint32_t late_max_us; /* longest time that a step began after it was due */
    } count;
};

/* Open every device that the config names, and start the firmware. A device that is missing is
 * reported, shown on the glass if there is one, and looked for again. The config stays borrowed
 * until panel_close. Returns 0; or -1 if there is no memory, with the cause reported and nothing
 * open. */
int panel_open(struct panel *p, const struct config *config);

/* Make the process real-time as the config says, then step until SIGTERM, SIGINT or SIGHUP comes.
 * SIGUSR1 reports the counters. From here on nothing is allocated by this thread. */
void panel_run(struct panel *p);

/* Do one step at `now_us` of the panel's clock. panel_run repeats this, and waits between steps. */
void panel_step(struct panel *p, uint64_t now_us);

/* Time of the panel's clock. */
uint64_t panel_now_us(const struct panel *p);

/* Close every device and free the unit. */
void panel_close(struct panel *p);

#endif
