#include "panel.h"

#include "drv/not_fitted.h"
#include "ended.h"
#include "hs/real_time.h"
#include "lm/bus_filters.h"
#include "lm/radar_record.h"
#include "lm/sensor.h"
#include "report.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>

/* A read at the start may take this long before it is given up: 100 polls of 50 ms. */
enum { START_PATIENCE_US = 50000, START_POLLS = 100 };

/* An image that comes in flight has just been read once, so that its tables answer at once. If its
 * medium hangs all the same, the loop waits with it until the watchdog bites: the flash's thread
 * still writes where the read was to go. */
enum { IMAGE_PATIENCE_US = 1000000000 };

static uint64_t monotonic_us(void)
{
    return (uint64_t)hs_clock_us(CLOCK_MONOTONIC);
}

uint64_t panel_now_us(const struct panel *p)
{
    return monotonic_us() - p->zero_us;
}

static const struct lm_flash *open_flash(struct panel *p)
{
    const struct lm_flash *slow = storage_open(&p->storage, p->config, false, &p->database);
    if (slow == NULL) {
        return &drv_no_flash;
    }
    slow = further_join(&p->further, p->config, slow, p->images, &p->database);
    const int cause = drv_flash_reader_start(&p->flash, slow);
    if (cause != 0) {
        report(REPORT_ERROR, "flash: no thread to read it: %s", strerror(cause));
        return &drv_no_flash;
    }
    p->flash.patience_us = START_PATIENCE_US;
    return &p->flash.port;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct panel *p = ctx;
    if (further_next(&p->further, control)) {
        p->flash.patience_us = IMAGE_PATIENCE_US;
        return 1;
    }
    return slots_told_next(&p->slots, control) || drv_control_ring_take(&p->bezel.ring, control) ||
           drv_control_ring_take(&p->hand.ring, control);
}

/* A database that cannot be used is no reason to stop: the glass shows DB FAIL. */
static void start_with_flash(struct panel *p, const struct lm_flash *flash)
{
    recording_begin(&p->recording, &p->board, panel_now_us(p));
    if (lm_unit_init(p->unit, &p->board) != LM_OK) {
        report(REPORT_ERROR, "%s: the memory for tiles is too small; raise the option tiles",
               p->storage.path);
        p->board.flash = &drv_no_flash;
        recording_begin(&p->recording, &p->board, panel_now_us(p));
        (void)lm_unit_init(p->unit, &p->board);
    } else if (p->unit->map.open_status == LM_ERR_VERSION) {
        report(REPORT_ERROR,
               "%s: an image of another version; `landmass-db convert` renews old ones",
               p->storage.path);
    } else if (p->unit->map.open_status == LM_ERR_SENSOR) {
        report(REPORT_ERROR,
               "%s: its reflectivity is of band %s, the radar's is %s; build it for "
               "this radar",
               p->storage.path, lm_sensor_word(p->unit->map.db.sensor),
               lm_sensor_word(p->unit->map.radar->sensor));
    } else if (!p->unit->map.is_usable && flash != &drv_no_flash) {
        report(REPORT_ERROR, "%s: not a database for this firmware; landmass-db verify tells why",
               p->storage.path);
    }
    further_report(&p->further, p->unit);
}

/* The table that the configuration names. A panel that was told its radar shows no other's picture:
 * without the table it has no database. */
static const struct lm_flash *choose_radar(struct panel *p, const struct lm_flash *flash)
{
    const char *path = p->config->radar;
    uint8_t record[LM_RADAR_RECORD_BYTES + 1];
    if (path[0] == '\0') {
        return flash;
    }
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        report(REPORT_ERROR, "%s: %s; landmass-radar record writes it", path, strerror(errno));
        return &drv_no_flash;
    }
    const size_t bytes = fread(record, 1, sizeof record, file);
    fclose(file);
    const int status = lm_radar_unpack(&p->radar, record, (uint32_t)bytes);
    if (status != LM_OK) {
        report(REPORT_ERROR, "%s: %s; write it again with landmass-radar record", path,
               status == LM_ERR_VERSION ? "a radar table of another version"
               : status == LM_ERR_TABLE ? "a radar table that breaks its contract"
                                        : "no radar table, or a damaged one");
        return &drv_no_flash;
    }
    report(REPORT_INFO, "%s: radar %s", path, p->radar.name);
    p->board.radar = &p->radar;
    return flash;
}

/* What an interface is heard by: the first profile NULL where the unit chooses, the second where
 * there is one. False if it shall not be heard at all: a panel that was told its tables takes no
 * frame for what it is not. */
static bool choose_tables(const struct lm_bus_profile *profile, const char *path,
                          struct bus_table *table, const struct lm_bus_profile *heard[2])
{
    uint32_t id;
    heard[0] = profile;
    heard[1] = NULL;
    if (path[0] == '\0') {
        return true;
    }
    if (bus_table_load(table, path) != 0) {
        return false;
    }
    heard[profile != NULL] = &table->profile;
    if (heard[1] != NULL && lm_bus_profiles_clash(heard[0], heard[1], &id)) {
        report(REPORT_ERROR, "%s: it and %s both take frame %X; hear them on two interfaces", path,
               profile->name, id);
        return false;
    }
    return true;
}

/* The board's part of what choose_tables found. */
static void lend_tables(struct lm_board *board, const struct lm_bus_profile *const first[2],
                        const struct lm_bus_profile *const second[2])
{
    const struct lm_board_table all[] = {{first[1], 0}, {second[0], 1}, {second[1], 1}};
    uint32_t count = 0;
    board->bus_profile = first[0];
    for (uint32_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        if (all[i].profile != NULL) {
            board->tables[count++] = all[i];
        }
    }
}

/* Choose what both interfaces are heard by, start the unit, and open them behind it: only it knows
 * then which table the database has. */
static void start_with_buses(struct panel *p)
{
    const struct config *c = p->config;
    const struct lm_bus_profile *first[2], *second[2] = {NULL, NULL};
    const bool has_first = choose_tables(c->can_profile, c->can_table, &p->table, first);
    bool has_second =
        c->can_2[0] != '\0' && choose_tables(c->can_2_profile, c->can_2_table, &p->table_2, second);
    if (has_second && second[0] == NULL) {
        second[0] = &lm_bus_canas17;
    }
    lend_tables(&p->board, first, second);
    p->board.can_2 = c->can_2[0] != '\0' ? &p->bus_2.port : NULL;
    start_with_flash(p, p->board.flash);
    first[0] = p->unit->bus.profile;
    bus_open(&p->bus, has_first ? c->can : "", first[0], first[1], p->zero_us);
    if (c->can_partner != 0 && (c->can_node == 0 || c->can_node == c->can_partner)) {
        report(REPORT_ERROR, "can.partner: needs can.node, a number of its own: SWAP does nothing");
    }
    report(REPORT_INFO, "bus: %s: table %s%s%s", c->can, first[0]->name, first[1] ? ", " : "",
           first[1] ? first[1]->name : "");
    if (c->can_2[0] != '\0') {
        bus_open(&p->bus_2, has_second ? c->can_2 : "", second[0], second[1], p->zero_us);
    }
}

static int start_unit(struct panel *p, const struct lm_flash *flash)
{
    const size_t pixels = (size_t)p->glass.port.width_px * p->glass.port.height_px;
    p->board = (struct lm_board){
        .flash = flash,
        .can = &p->bus.port,
        .bus_nodes = p->config->can_nodes.is_list ? p->config->can_nodes.bits : NULL,
        .bus_node = (uint8_t)p->config->can_node,
        .bus_partner = (uint8_t)p->config->can_partner,
        .is_heading_magnetic = p->config->can_heading != 0,
        .tells_reports = p->config->can_reports != 0,
        .obeys_controls = p->config->can_controls != 0,
        .is_database_unsigned = p->database.is_unsigned,
        .controls = &p->controls,
        .display = &p->glass.port,
        .tile_pool_bytes = p->config->tiles * sizeof(struct lm_tile),
        .noise_seed = p->config->seed,
        .options = {.is_sector_whole = p->config->glass_sector != 0,
                    .has_heading = p->config->glass_heading != 0,
                    .has_strobe = p->config->glass_strobe != 0,
                    .has_borders = p->config->glass_borders != 0},
        .settings = settings_file_read(&p->settings, p->config->settings),
        .flash_poll_limit = START_POLLS};
    memcpy(p->board.images, p->images, sizeof p->board.images);
    p->board.tile_pool = calloc(1, p->board.tile_pool_bytes);
    p->board.plane = calloc(1, pixels);
    p->unit = calloc(1, sizeof *p->unit);
    if (p->board.tile_pool == NULL || p->board.plane == NULL || p->unit == NULL) {
        report(REPORT_ERROR, "start: out of memory");
        return -1;
    }
    p->board.flash = choose_radar(p, flash);
    start_with_buses(p);
    p->flash.patience_us = 0;
    return 0;
}

/* Blocked before any thread is started, so that none of them is interrupted. */
static int open_signals(void)
{
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGTERM);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGHUP);
    sigaddset(&set, SIGUSR1);
    sigaddset(&set, SIGPIPE);
    sigprocmask(SIG_BLOCK, &set, NULL);
    sigdelset(&set, SIGPIPE); /* a closed socket or pipe is an errno */
    return signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

static void open_watchdog(struct panel *p)
{
    const char *device = p->config->watchdog[0] != '\0' ? p->config->watchdog : NULL;
    if (drv_watchdog_open(&p->watchdog, device, p->config->watchdog_s, panel_now_us(p)) != LM_OK) {
        report(REPORT_ERROR, "watchdog: %s", p->watchdog.error);
    }
    p->board.restart = p->watchdog.has_bitten ? "WATCHDOG" : ended_cause();
}

static void open_recording(struct panel *p)
{
    struct recording_limits limits = recording_usual;
    limits.bytes = (uint64_t)p->config->record_size_mib << 20;
    recording_open(&p->recording, p->config->record, &limits);
}

int panel_open(struct panel *p, const struct config *config)
{
    memset(p, 0, sizeof *p);
    p->config = config;
    p->bezel.gpio.fd = p->bezel.backlight_fd = -1;
    p->bus.socket.fd = p->bus_2.socket.fd = -1;
    p->zero_us = monotonic_us();
    p->signals = open_signals();
    p->controls = (struct lm_controls){.ctx = p, .next = next_control};
    const struct lm_flash *flash = open_flash(p);
    slots_told_open(&p->slots, &p->storage, config->slot_progress);
    bezel_open(&p->bezel, config, panel_now_us(p));
    hand_open(&p->hand, config);
    open_recording(p);
    int status = glass_open(&p->glass, config, panel_now_us(p));
    if (status == 0) {
        status = start_unit(p, flash);
    } else {
        report(REPORT_ERROR, "start: out of memory");
    }
    open_watchdog(p); /* last: until the loop runs, nobody feeds it */
    if (status == 0) {
        recording_start(&p->recording, p->board.restart);
        settings_file_start(&p->settings);
        faults_file_start(&p->faults, config->faults);
        further_start(&p->further);
    }
    if (status != 0) {
        panel_close(p);
    }
    return status;
}

void panel_close(struct panel *p)
{
    drv_watchdog_notify(&p->watchdog, "STOPPING=1");
    recording_close(&p->recording);
    settings_file_close(&p->settings);
    faults_file_close(&p->faults);
    hand_close(&p->hand);
    bezel_close(&p->bezel);
    glass_close(&p->glass);
    bus_close(&p->bus);
    bus_close(&p->bus_2);
    further_stop(&p->further);
    drv_flash_reader_stop(&p->flash);
    further_close(&p->further);
    storage_close(&p->storage);
    if (p->signals >= 0) {
        close(p->signals);
    }
    free(p->board.tile_pool);
    free(p->board.plane);
    free(p->unit);
    drv_watchdog_close(&p->watchdog);
}
