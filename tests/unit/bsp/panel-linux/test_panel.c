/* The whole panel, without devices and with a bus and a flash: what it does in its loop, and what
 * it must not do there. The kernel's side of each device is tested in the virtual machine. */
#include "check.h"
#include "lm/bit.h"
#include "lm/radar_record.h"
#include "panel.h"
#include "shown.h"
#include "support.h"
#include "unit_rig.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

/* Every allocation of the program comes by here, those of the libraries too. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t members, size_t size);
extern void *__libc_realloc(void *old, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
static _Thread_local volatile uint32_t allocations; /* of this thread; volatile, because compilers
                                                      know that malloc changes nothing else */

void *malloc(size_t size)
{
    allocations++;
    return __libc_malloc(size);
}

void *calloc(size_t nmemb, size_t size)
{
    allocations++;
    return __libc_calloc(nmemb, size);
}

void *realloc(void *ptr, size_t size)
{
    allocations++;
    return __libc_realloc(ptr, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    allocations++;
    return __libc_memalign(alignment, size);
}

int posix_memalign(void **memptr, size_t alignment, size_t size)
{
    allocations++;
    *memptr = __libc_memalign(alignment, size);
    return *memptr == NULL;
}

static struct config nothing_fitted(void)
{
    struct config c;
    config_defaults(&c);
    c.can[0] = '\0';
    c.record[0] = c.faults[0] = '\0';
    c.glass = CONFIG_GLASS_NONE;
    c.stick.choice = CONFIG_STICK_NONE;
    c.priority = 0;
    c.locks_memory = 0;
    c.glass_picture = (struct config_size){WIDTH, HEIGHT};
    c.database_trust = 1; /* any */
    c.database_serial[0] = '\0';
    c.slot_a[0] = c.slot_b[0] = '\0';
    snprintf(c.database, sizeof c.database, "/nowhere/database.lmdb");
    return c;
}

/* A panel in flight: the rig's country in a file, its bus in the place of the panel's. */
struct flight {
    struct rig *rig;
    struct config config;
    struct panel panel;
    struct lm_can counted;
    struct shown *shown; /* where the pictures are noted; NULL: nowhere */
    bool is_switched_off;
};

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct flight *f = ctx;
    f->panel.bus.polls++;
    return f->rig->board.can.receive(f->rig->board.can.ctx, frame);
}

static void path_in_build(char *path, size_t size, const char *name)
{
    snprintf(path, size, "%s/tmp/%s", support_build_dir(), name);
}

/* The usual flight is recorded. */
static struct flight *take_off(void)
{
    struct flight *f = calloc(1, sizeof *f);
    f->rig = make_rig();
    f->config = nothing_fitted();
    path_in_build(f->config.record, sizeof f->config.record, "panel-recordings");
    support_run("rm -rf %s", f->config.record);
    support_run("mkdir -p %s/tmp", support_build_dir());
    snprintf(f->config.database, sizeof f->config.database, "%s/tmp/panel-test.lmdb",
             support_build_dir());
    assert_int_equal(tiny_image_write(&f->rig->image, f->config.database), 0);
    assert_int_equal(panel_open(&f->panel, &f->config), 0);
    f->panel.bus.port.ctx = f;
    f->panel.bus.port.receive = receive;
    return f;
}

static void switch_off(struct flight *f)
{
    if (!f->is_switched_off) {
        panel_close(&f->panel);
        f->is_switched_off = true;
    }
}

static void land(struct flight *f)
{
    switch_off(f);
    unlink(f->config.database);
    free_rig(f->rig);
    free(f);
}

/* As fast as it goes; the flash's thread gets the processor now and then. */
static void fly(struct flight *f, double seconds)
{
    struct rig *r = f->rig;
    const struct timespec rest = {.tv_nsec = 20000};
    for (const uint64_t end = r->now_us + (uint64_t)(seconds * 1e6); r->now_us < end;
         r->now_us += PANEL_TICK_US) {
        r->bus.now_us = r->now_us;
        const uint32_t before = f->panel.glass.count.pictures;
        panel_step(&f->panel, r->now_us);
        if (f->shown && f->panel.glass.count.pictures != before) {
            shown_note(f->shown, f->panel.glass.picture.pixels, WIDTH * HEIGHT);
        }
        nanosleep(&rest, NULL);
    }
}

static struct tiny_cell flat_soil(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    (void)place;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

/* A patch around the cursor, away from the nose: it needs tiles that the sector did not. */
static void look_closely(struct flight *f)
{
    drv_control_ring_put(&f->panel.hand.ring,
                         (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 10});
    drv_control_ring_put(&f->panel.hand.ring, lm_control_slew(LM_FULL_DEFLECTION, 0));
    fly(f, 0.3);
    drv_control_ring_put(&f->panel.hand.ring, lm_control_slew(0, 0));
    drv_control_ring_put(&f->panel.hand.ring, lm_control_designate());
    fly(f, 0.1);
    assert_int_equal(f->panel.unit->page.picture, LM_PICTURE_PATCH);
}

TEST(a_panel_without_any_device_draws_its_page_and_says_what_is_missing)
{
    const struct config c = nothing_fitted();
    struct panel p;
    assert_int_equal(panel_open(&p, &c), 0);
    for (uint64_t now = 0; now < 3000000; now += PANEL_TICK_US) {
        panel_step(&p, now);
    }
    assert_int_equal(p.unit->flags, LM_FLAG_DB | LM_FLAG_BUS | LM_FLAG_NAV_DEAD);
    assert_in_range(p.glass.count.pictures, 88, 91);
    uint32_t lit = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        lit += p.glass.picture.pixels[i] != 0;
    }
    assert_in_range(lit, 1000, WIDTH * HEIGHT / 4); /* labels and warnings, no land */
    panel_close(&p);
}

TEST(from_the_first_step_on_the_loop_allocates_nothing)
{
    struct flight *f = take_off();
    const uint32_t before = allocations;
    fly(f, 10);
    look_closely(f);
    fly(f, 10);
    assert_int_equal(allocations, before);
    assert_int_equal(f->panel.unit->flags & (LM_FLAG_DB | LM_FLAG_BUS | LM_FLAG_NAV_DEAD), 0);
    assert_in_range(f->panel.unit->count.frames, 610, 620);
    assert_true(f->panel.unit->map.tiles.count.tiles_read > 10);
    assert_true(lit_pixels(f->rig) == 0); /* the rig's own unit has not run: this was the panel's */
    void *volatile one = malloc(1);       /* volatile: or the compiler would see through it */
    assert_int_equal(allocations, before + 1);
    free(one);
    land(f);
}

TEST(what_a_panel_recorded_is_shown_again_bit_for_bit)
{
    static struct shown shown;
    struct flight *f = take_off();
    char path[200];
    f->shown = &shown;
    fly(f, 3);
    look_closely(f);
    fly(f, 3);
    assert_null(f->panel.recording.trouble);
    assert_int_equal(f->panel.recording.count.lines_lost, 0);
    struct drv_flash_file flash;
    assert_int_equal(drv_flash_file_open(&flash, f->config.database), 0);
    switch_off(f); /* the recording is whole now */
    snprintf(path, sizeof path, "%s/flight-00001-000.log", f->config.record);
    const struct shown_again a = show_again(path, &flash.port, NULL, &shown);
    assert_string_equal(a.error, "");
    assert_int_equal(a.pictures, shown.count);
    assert_true(a.pictures > 180);
    assert_int_equal(a.wrong, 0);
    assert_int_equal(a.departures + a.checks_failed, 0);
    assert_true(a.has_ended && a.checks >= 6);
    drv_flash_file_close(&flash);
    land(f);
}

static bool is_on_bit_page(const struct flight *f, const char *words)
{
    for (uint32_t row = 0; row < LM_BIT_ROWS; row++) {
        if (strstr(lm_bit_row(f->panel.unit, row).words, words) != NULL) {
            return true;
        }
    }
    return false;
}

TEST(how_far_a_load_is_stands_on_the_bit_page_and_in_the_recording)
{
    enum { BIT_KEY = 12 };
    static struct shown shown;
    struct slot_teller loader;
    struct flight *f = take_off();
    char path[200];
    path_in_build(path, sizeof path, "panel-load");
    unlink(path);
    f->shown = &shown;
    f->panel.slots.progress = path;
    drv_control_ring_put(&f->panel.hand.ring, lm_control_button(true, BIT_KEY));
    fly(f, 0.2);
    drv_control_ring_put(&f->panel.hand.ring, lm_control_button(false, BIT_KEY));
    fly(f, 1);
    assert_false(is_on_bit_page(f, "LOAD"));
    slot_teller_open(&loader, path);
    slot_teller_run(&loader, 42);
    fly(f, 1);
    assert_true(is_on_bit_page(f, "  LOAD 42"));
    slot_teller_run(&loader, 43);
    fly(f, 1);
    assert_true(is_on_bit_page(f, "  LOAD 43"));
    slot_teller_end(&loader, LM_LOAD_FAILED);
    fly(f, 1);
    assert_true(is_on_bit_page(f, "  LOAD FAIL"));
    slot_teller_open(&loader, path);
    slot_teller_end(&loader, LM_LOAD_DONE);
    fly(f, 1);
    assert_true(is_on_bit_page(f, "  LOADED"));
    unlink(path);
    fly(f, 1);
    assert_false(is_on_bit_page(f, "LOAD"));
    struct drv_flash_file flash;
    assert_int_equal(drv_flash_file_open(&flash, f->config.database), 0);
    switch_off(f);
    snprintf(path, sizeof path, "%s/flight-00001-000.log", f->config.record);
    const struct shown_again a = show_again(path, &flash.port, NULL, &shown);
    assert_string_equal(a.error, "");
    assert_true(a.pictures == shown.count && a.pictures > 150);
    assert_int_equal(a.wrong + a.departures + a.checks_failed, 0);
    drv_flash_file_close(&flash);
    land(f);
}

TEST(a_database_that_is_lost_in_flight_is_said_and_outlived)
{
    struct flight *f = take_off();
    fly(f, 1);
    assert_int_equal(truncate(f->config.database, 0), 0);
    look_closely(f);
    fly(f, 1);
    assert_true((f->panel.unit->flags & LM_FLAG_TILE) != 0);
    assert_true(atomic_load(&f->panel.flash.count.failed) > 0);
    const uint32_t frames = f->panel.unit->count.frames;
    fly(f, 1);
    assert_in_range(f->panel.unit->count.frames, frames + 28, frames + 32);
    land(f);
}

/* A country without coarser levels: 121 tiles at its coarsest level, of which 120 fit. */
TEST(a_database_with_more_coarse_tiles_than_fit_is_flown)
{
    struct config c = nothing_fitted();
    struct panel p;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    spec.level_count = 1;
    spec.rows = spec.columns = 11;
    spec.shift0 = 11;
    spec.cell = flat_soil;
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    snprintf(c.database, sizeof c.database, "%s/tmp/panel-large.lmdb", support_build_dir());
    assert_int_equal(tiny_image_write(&image, c.database), 0);
    c.tiles = 120;
    assert_int_equal(panel_open(&p, &c), 0);
    for (uint64_t now = 0; now < 100000; now += PANEL_TICK_US) {
        panel_step(&p, now);
    }
    assert_true((p.unit->flags & LM_FLAG_DB) == 0);
    panel_close(&p);
    unlink(c.database);
    tiny_image_free(&image);
}

/* Open a panel over the rig's country whose option radar names a file of these bytes; NULL: a file
 * that is not there. */
static void open_with_radar(struct panel *p, struct config *c, const uint8_t *record, size_t bytes)
{
    struct rig *r = make_rig();
    *c = nothing_fitted();
    support_run("mkdir -p %s/tmp", support_build_dir());
    snprintf(c->database, sizeof c->database, "%s/tmp/panel-radar.lmdb", support_build_dir());
    snprintf(c->radar, sizeof c->radar, "%s/tmp/panel.radar", support_build_dir());
    assert_int_equal(tiny_image_write(&r->image, c->database), 0);
    unlink(c->radar);
    if (record) {
        FILE *file = fopen(c->radar, "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(record, 1, bytes, file), bytes);
        fclose(file);
    }
    assert_int_equal(panel_open(p, c), 0);
    free_rig(r);
}

static void close_with_radar(struct panel *p, const struct config *c)
{
    panel_close(p);
    unlink(c->database);
    unlink(c->radar);
}

TEST(a_radar_of_the_configuration_is_the_one_that_flies)
{
    struct panel p;
    struct config c;
    struct lm_radar radar = lm_radar_default;
    uint8_t record[LM_RADAR_RECORD_BYTES];
    strcpy(radar.name, "PANEL");
    lm_radar_pack(&radar, record);
    open_with_radar(&p, &c, record, sizeof record);
    assert_true(p.unit->map.is_usable);
    assert_int_equal(p.unit->map.radar_origin, LM_RADAR_OF_BOARD);
    assert_string_equal(p.unit->map.radar->name, "PANEL");
    close_with_radar(&p, &c);
}

TEST(a_radar_that_cannot_be_read_leaves_no_picture_of_another)
{
    uint8_t record[LM_RADAR_RECORD_BYTES + 1] = {0};
    lm_radar_pack(&lm_radar_default, record);
    const struct {
        const uint8_t *bytes;
        size_t count;
    } files[] = {{NULL, 0},
                 {record, 0},
                 {record, LM_RADAR_RECORD_BYTES - 1},
                 {record, LM_RADAR_RECORD_BYTES + 1},
                 {record + 1, LM_RADAR_RECORD_BYTES}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        struct panel p;
        struct config c;
        open_with_radar(&p, &c, files[i].bytes, files[i].count);
        panel_step(&p, 0);
        assert_true((p.unit->flags & LM_FLAG_DB) != 0);
        close_with_radar(&p, &c);
    }
}

TEST(the_hand_controllers_ring_reaches_the_page)
{
    struct flight *f = take_off();
    fly(f, 0.5);
    drv_control_ring_put(&f->panel.hand.ring, lm_control_button(true, 12));
    drv_control_ring_put(&f->panel.hand.ring, lm_control_button(false, 12));
    fly(f, 0.5);
    assert_int_equal(f->panel.unit->page.format, LM_FORMAT_BIT);
    land(f);
}

static void *stop_soon(void *unused)
{
    (void)unused;
    const struct timespec rest = {.tv_nsec = 400000000};
    nanosleep(&rest, NULL);
    kill(getpid(), SIGUSR1);
    nanosleep(&rest, NULL);
    kill(getpid(), SIGTERM);
    return NULL;
}

/* In real time, with systemd's socket at the other end. */
TEST(it_tells_systemd_that_it_is_ready_alive_and_stopping_and_stops_when_told)
{
    struct sockaddr_un at = {.sun_family = AF_UNIX};
    snprintf(at.sun_path, sizeof at.sun_path, "/tmp/landmass-panel-%d", (int)getpid());
    const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    assert_int_equal(bind(fd, (const struct sockaddr *)&at, sizeof at), 0);
    setenv("NOTIFY_SOCKET", at.sun_path, 1);
    setenv("WATCHDOG_USEC", "200000", 1);

    const struct config c = nothing_fitted();
    struct panel p;
    pthread_t other;
    assert_int_equal(panel_open(&p, &c), 0);
    assert_int_equal(pthread_create(&other, NULL, stop_soon, NULL), 0);
    const uint32_t before = allocations;
    panel_run(&p);
    assert_int_equal(allocations, before);
    pthread_join(other, NULL);
    panel_close(&p);
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");

    char message[600];
    uint32_t ready = 0, fed = 0, stopping = 0;
    for (ssize_t size; (size = recv(fd, message, sizeof message - 1, 0)) > 0;) {
        message[size] = '\0';
        ready += strcmp(message, "READY=1") == 0;
        stopping += strcmp(message, "STOPPING=1") == 0;
        if (strcmp(message, "WATCHDOG=1") == 0) {
            assert_int_equal(ready, 1);
            assert_int_equal(stopping, 0);
            fed++;
        }
    }
    assert_int_equal(ready, 1);
    assert_int_equal(stopping, 1);
    assert_in_range(fed, 1, 9); /* 0.8 s, every 0.1 s at most; a busy machine may be late */
    close(fd);
    unlink(at.sun_path);
}
