/* The loop of the panel, and what makes the process a real-time one. */
#include "panel.h"

#include "lm/bit.h"
#include "report.h"

#include <errno.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>

enum {
    STACK_USED_BYTES = 128 << 10,
    TELL_US = 1000000,
    ALIVE_PICTURES = 15, /* half a second of them */
    /* The fault lamp calls somebody to the equipment. The edge of the map and a sender of weather
     * that has gone quiet are no work for him, and the glass says them. */
    LAMP_FAULTS = LM_FLAGS_FAULT & ~(LM_FLAG_OFF_MAP | LM_FLAG_WEATHER | LM_FLAG_BELOW |
                                     LM_FLAG_MAGNETIC | LM_FLAG_EXERCISE)
};

/* Touch the stack that the loop may need, so that its pages are there and locked. */
static void touch_stack(void)
{
    volatile char bytes[STACK_USED_BYTES];
    for (size_t i = 0; i < sizeof bytes; i += 1024) {
        bytes[i] = 0;
    }
}

static void become_realtime(const struct config *c)
{
    if (c->locks_memory != 0) {
        touch_stack();
        if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
            report(REPORT_WARNING, "memory: not locked: %s; LimitMEMLOCK= or CAP_IPC_LOCK",
                   strerror(errno));
        }
    }
    const struct sched_param priority = {.sched_priority = (int)c->priority};
    if (c->priority != 0 &&
        sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority) != 0) {
        report(REPORT_WARNING, "priority: not real-time: %s; LimitRTPRIO= or CAP_SYS_NICE",
               strerror(errno));
    }
}

static void report_counters(const struct panel *p)
{
    const struct lm_unit *u = p->unit;
    report(REPORT_INFO, "frames %u, lines %u (%u dropped), steps %u, longest %u us, latest %u us",
           u->count.frames, u->count.lines, u->count.lines_dropped, p->count.steps,
           p->count.step_max_us, p->count.late_max_us);
    const struct drv_can_socket *bus = &p->bus.socket;
    report(REPORT_INFO,
           "bus: %u frames, %u overflowed, %u malformed; down %u, gone %u, bus-off %u; "
           "%u sent, %u unsent",
           u->count.bus_frames, bus->count.overflowed, bus->count.malformed, bus->count.down,
           bus->count.gone, bus->count.bus_off, bus->count.sent, bus->count.unsent);
    const struct lm_sender_counts senders = lm_sender_counts(u);
    report(REPORT_INFO, "senders: %u frames stuck, %u of rivals, %u disagree, %u not on the list",
           senders.stuck, senders.rivals, senders.disagreements, senders.refused);
    const struct lm_live_bus *live = &u->live;
    report(REPORT_INFO,
           "live targets: %u there, %u sets, %u torn, %u refused, %u of rivals, %u aged out; %u "
           "times one was left out",
           live->live.count, live->count.sets, live->count.torn, live->count.refused,
           live->count.rivals, live->count.aged, u->picture.targets_left_out);
    report(REPORT_INFO, "flash: %u tiles, %u bytes, %u read again, %u failed, %u corrupt",
           u->map.tiles.count.tiles_read, (unsigned)u->map.tiles.count.bytes_read,
           atomic_load(&p->flash.count.again), atomic_load(&p->flash.count.failed),
           lm_unit_map_corrupt_records(&u->map));
    report(REPORT_INFO, "glass: %u pictures, %u seen; DRM busy %u, lost %u, late %u, errors %u",
           p->glass.count.pictures, glass_renders(&p->glass), p->glass.drm.count.busy,
           p->glass.drm.count.lost, p->glass.drm.count.late, p->glass.drm.count.errors);
    report(REPORT_INFO, "keys: %u edges, %u errors, %u stuck, %u missed", p->bezel.gpio.count.edges,
           p->bezel.gpio.count.errors, p->unit->keys.count.stuck, p->bezel.missed);
    if (p->hand.usb != NULL) {
        const struct drv_usb_counts c = drv_usb_counts(p->hand.usb);
        report(REPORT_INFO,
               "hand controller: attached %u, gone %u, refused %u, %u reports, "
               "%u empty, %u errors",
               c.attached, c.detached, c.refused, c.reports, c.empty, c.errors);
    }
    recording_report(&p->recording);
    report(REPORT_INFO, "watchdog: fed %u times, hungry %u times", p->watchdog.count.fed,
           p->watchdog.count.refused);
}

/* False when it is time to stop. */
static bool take_signals(struct panel *p)
{
    struct signalfd_siginfo signal;
    while (read(p->signals, &signal, sizeof signal) == (ssize_t)sizeof signal) {
        if (signal.ssi_signo != SIGUSR1) {
            report(REPORT_NOTICE, "stopping: signal %u", signal.ssi_signo);
            return false;
        }
        report_counters(p);
    }
    return true;
}

/* The words of the flags, as the glass says them. */
static void name_flags(uint32_t flags, char *text, size_t size)
{
    size_t length = 0;
    text[0] = '\0';
    for (uint32_t i = 0; i < LM_FLAGS && length < size; i++) {
        if ((flags >> i & 1) != 0) {
            length += (size_t)snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "",
                                       lm_flag_word(i));
        }
    }
}

/* Once a second at most: what the glass says, to the journal and to systemd. */
static void report_flags(struct panel *p, uint64_t now_us)
{
    const uint32_t flags = p->unit->flags;
    const char *const trouble = p->recording.trouble;
    const bool is_told = flags == p->flags_told && trouble == p->trouble_told;
    if (now_us < p->tell_us || (is_told && p->count.steps > 1)) {
        return;
    }
    const char *const slot = p->storage.trouble;
    char words[128], status[192];
    name_flags(flags, words, sizeof words);
    snprintf(status, sizeof status, "STATUS=%s%s%s%s%s", words[0] != '\0' ? words : "no fault",
             slot != NULL ? "; " : "", slot != NULL ? slot : "", trouble != NULL ? "; " : "",
             trouble != NULL ? trouble : "");
    drv_watchdog_notify(&p->watchdog, status);
    report(REPORT_NOTICE, "the glass says: %s", words[0] != '\0' ? words : "no fault");
    p->flags_told = flags;
    p->trouble_told = trouble;
    p->tell_us = now_us + TELL_US;
}

static void show_lamps(struct panel *p)
{
    const struct lm_unit *u = p->unit;
    const struct bezel_lamps lamps = {
        .is_lit = {[CONFIG_LED_ALIVE] = (glass_renders(&p->glass) / ALIVE_PICTURES & 1) != 0,
                   [CONFIG_LED_FAULT] = (u->flags & LAMP_FAULTS) != 0 ||
                                        bezel_is_stuck(&p->bezel) || !glass_is_lit(&p->glass),
                   [CONFIG_LED_NIGHT] = u->page.palette.is_night},
        .is_night = u->page.palette.is_night,
    };
    bezel_show(&p->bezel, &lamps);
}

void panel_step(struct panel *p, uint64_t now_us)
{
    bezel_service(&p->bezel, now_us);
    slots_told_service(&p->slots, now_us);
    glass_service(&p->glass, now_us);
    recording_step(&p->recording, now_us);
    lm_unit_step(p->unit, now_us);
    p->flash.patience_us = 0;
    further_settle(&p->further, p->unit);
    settings_file_keep(&p->settings, p->unit, now_us);
    faults_file_keep(&p->faults, &p->unit->faults, now_us);
    p->count.steps++;
    show_lamps(p);
    report_flags(p, now_us);
    const struct lm_liveness life = {.steps = p->count.steps,
                                     .frames = p->unit->count.frames,
                                     .bus = p->bus.polls,
                                     .shown = glass_renders(&p->glass)};
    (void)drv_watchdog_service(&p->watchdog, life, now_us);
}

static struct timespec duration(uint64_t us)
{
    return (struct timespec){.tv_sec = (time_t)(us / 1000000),
                             .tv_nsec = (long)(us % 1000000) * 1000};
}

/* Sleep until the next step is due, or a device has something; but never less than PANEL_STEP_US
 * after the last one, so that a device that cries all the time cannot take the processor. */
static void wait_for_work(const struct panel *p, uint64_t stepped_us)
{
    struct pollfd wake[] = {
        {.fd = p->signals, .events = POLLIN},
        {.fd = bus_fd(&p->bus), .events = POLLIN},
        {.fd = bus_fd(&p->bus_2), .events = POLLIN},
        {.fd = bezel_fd(&p->bezel), .events = POLLIN},
        {.fd = glass_fd(&p->glass), .events = POLLIN},
    };
    const uint64_t asked_us = panel_now_us(p), due_us = stepped_us + PANEL_TICK_US;
    if (asked_us < due_us) {
        const struct timespec rest = duration(due_us - asked_us);
        (void)ppoll(wake, sizeof wake / sizeof wake[0], &rest, NULL);
    }
    const uint64_t now_us = panel_now_us(p);
    if (now_us < stepped_us + PANEL_STEP_US) {
        const struct timespec rest = duration(stepped_us + PANEL_STEP_US - now_us);
        (void)nanosleep(&rest, NULL);
    }
}

static uint32_t larger(uint32_t a, uint64_t b)
{
    return b > a ? (b > UINT32_MAX ? UINT32_MAX : (uint32_t)b) : a;
}

void panel_run(struct panel *p)
{
    become_realtime(p->config);
    drv_watchdog_notify(&p->watchdog, "READY=1");
    uint64_t stepped_us = panel_now_us(p);
    while (take_signals(p)) {
        const uint64_t now_us = panel_now_us(p);
        if (now_us > stepped_us + PANEL_TICK_US) {
            p->count.late_max_us =
                larger(p->count.late_max_us, now_us - stepped_us - PANEL_TICK_US);
        }
        panel_step(p, now_us);
        stepped_us = now_us;
        p->count.step_max_us = larger(p->count.step_max_us, panel_now_us(p) - now_us);
        wait_for_work(p, stepped_us);
    }
}
