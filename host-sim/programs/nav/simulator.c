#include "simulator.h"

#include "drv/can_socket.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/real_time.h"
#include "hs/report.h"
#include "hs/udp.h"
#include "nav/bridge.h"

#include <arpa/inet.h>
#include <errno.h>
#include <math.h>
#include <string.h>

enum { STEP_MS = 2, BATCH = 64, XPLANE_PORT = 49000, ASK_AGAIN_US = 5000000 };

struct flight {
    const struct command *command;
    struct nav_bridge *bridge;
    struct hs_udp udp;
    FILE *log; /* NULL: an interface */
    bool has_file;
    struct hs_atomic_file file;
    struct drv_can_socket can;
    uint64_t other_address, lost_frames;
    int64_t begun_us, asked_us;
    enum nav_bridge_mood mood;
    uint8_t bytes[NAV_TOLD_BYTES + 1]; /* one more, so that a longer datagram is seen to be one */
};

/* ---- where the frames go ---- */

static int open_output(struct flight *f)
{
    const struct command *c = f->command;
    if (c->can) {
        return drv_can_socket_open(&f->can, c->can, NULL, 0, 0) == LM_OK
                   ? 0
                   : hs_error("--can", "ip link set NAME up type can bitrate 1000000", "%s",
                              f->can.error);
    }
    f->log = stdout;
    if (c->out_path) {
        if (hs_atomic_open(&f->file, c->out_path) != 0) {
            return -1;
        }
        f->has_file = true;
        f->log = f->file.stream;
    }
    return 0;
}

static int put(void *context, const struct canas_frame *frame, int64_t time_us)
{
    struct flight *f = context;
    if (!f->log) {
        const struct lm_can port = drv_can_socket_port(&f->can);
        struct lm_can_frame sent = {.id = frame->id, .length = frame->length};
        memcpy(sent.data, frame->data, sizeof sent.data);
        f->lost_frames += port.send(port.ctx, &sent) != LM_OK;
        return 0;
    }
    char line[CANAS_LINE_MAX];
    size_t length = canas_candump_line(line, frame, time_us, f->command->send.interface);
    line[length++] = '\n';
    return fwrite(line, 1, length, f->log) == length ? 0 : -1;
}

static int flush_output(struct flight *f)
{
    struct lm_can_frame heard;
    if (f->log) {
        return f->has_file ? 0 : fflush(f->log);
    }
    const struct lm_can port = drv_can_socket_port(&f->can); /* sends what waited for room */
    for (int i = 0; i < BATCH && port.receive(port.ctx, &heard) == LM_OK; i++) {
    }
    return 0;
}

static int close_output(struct flight *f, bool is_well)
{
    if (!f->log) {
        drv_can_socket_close(&f->can);
        return 0;
    }
    if (f->has_file && is_well && nav_bridge_counts(f->bridge)->frames > 0) {
        return hs_atomic_commit(&f->file); /* reports what could not be written */
    }
    if (f->has_file) {
        hs_atomic_abort(&f->file);
    }
    return 0;
}

/* ---- what comes ---- */

static void ask(struct flight *f, bool stop)
{
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(XPLANE_PORT)};
    uint8_t bytes[NAV_TOLD_BYTES];
    size_t length;
    (void)inet_pton(AF_INET, f->command->ask, &to.sin_addr);
    for (int i = 0; (length = nav_xplane_ask(i, stop, bytes)) > 0; i++) {
        hs_udp_send(&f->udp, &to, bytes, length);
    }
}

static bool is_heard(const struct command *c, const struct sockaddr_in *from)
{
    struct in_addr wanted;
    const char *address = c->from ? c->from : c->ask;
    return !address ||
           (inet_pton(AF_INET, address, &wanted) == 1 && wanted.s_addr == from->sin_addr.s_addr);
}

static int receive(struct flight *f, int64_t ahead_us)
{
    for (int i = 0; i < BATCH; i++) {
        struct sockaddr_in from = {0};
        size_t length;
        const int status =
            hs_udp_next(&f->udp, i == 0 ? STEP_MS : 0, f->bytes, sizeof f->bytes, &length, &from);
        if (status != 1) {
            return status;
        }
        if (!is_heard(f->command, &from)) {
            f->other_address++;
            continue;
        }
        /* X-Plane answers from more than one port. */
        const uint64_t port = f->command->ask ? 0 : ntohs(from.sin_port);
        nav_bridge_take(f->bridge, f->bytes, length,
                        (uint64_t)ntohl(from.sin_addr.s_addr) << 16 | port,
                        hs_clock_us(CLOCK_MONOTONIC) + ahead_us);
    }
    return 0;
}

static void tell_mood(struct flight *f, int64_t now_us)
{
    static const char *const words[NAV_BRIDGE_MOODS] = {"waiting for the simulator", "flying",
                                                        "paused: the aircraft stands",
                                                        "no datagrams: the bus is silent"};
    const enum nav_bridge_mood mood = nav_bridge_mood(f->bridge);
    if (mood != f->mood && !f->command->is_quiet) {
        fprintf(stderr, "%.2f s: %s\n", (double)(now_us - f->begun_us) * 1e-6, words[mood]);
    }
    f->mood = mood;
}

static int fly(struct flight *f)
{
    /* UTC that is never set: it follows the monotonic clock from here on. */
    const int64_t ahead_us = hs_clock_us(CLOCK_REALTIME) - hs_clock_us(CLOCK_MONOTONIC);
    int64_t now_us = f->begun_us = hs_clock_us(CLOCK_MONOTONIC) + ahead_us;
    const int64_t until_us =
        f->command->seconds > 0 ? now_us + llround(f->command->seconds * 1e6) : INT64_MAX;
    f->asked_us = now_us - ASK_AGAIN_US;
    while (!hs_is_interrupted() && now_us < until_us) {
        if (f->command->ask && now_us - f->asked_us >= ASK_AGAIN_US) {
            ask(f, false); /* again and again: it may have been started after this program */
            f->asked_us = now_us;
        }
        if (receive(f, ahead_us) < 0) {
            return -1;
        }
        now_us = hs_clock_us(CLOCK_MONOTONIC) + ahead_us;
        if (nav_bridge_step(f->bridge, now_us) != 0 || flush_output(f) != 0) {
            return hs_error(f->has_file ? f->command->out_path : "standard output",
                            "free some space, or read to the end", "cannot be written: %s",
                            strerror(errno));
        }
        tell_mood(f, now_us);
    }
    if (f->command->ask) {
        ask(f, true);
    }
    return 0;
}

/* ---- what was met ---- */

static void report_json(const struct flight *f, const struct nav_bridge_counts *n)
{
    hs_report_count("datagrams", n->datagrams);
    hs_report_count("used", n->used);
    hs_report_object("left_out");
    hs_report_count("foreign", n->fault[NAV_TOLD_FOREIGN]);
    hs_report_count("malformed", n->fault[NAV_TOLD_MALFORMED]);
    hs_report_count("out_of_range", n->fault[NAV_TOLD_RANGE]);
    hs_report_count("incomplete", n->fault[NAV_TOLD_INCOMPLETE]);
    hs_report_count("out_of_order", n->disordered);
    hs_report_count("other_sender", n->other_sender + f->other_address);
    hs_report_count("lost_by_the_kernel", f->udp.lost);
    hs_report_close();
    hs_report_count("senders", n->senders);
    hs_report_count("silences", n->silences);
    hs_report_count("pauses", n->pauses);
    hs_report_real("longest_wait_s", n->longest_wait_s);
    hs_report_count("frames", n->frames);
    hs_report_count("frames_lost", f->lost_frames + n->frames_without_room);
    hs_report_count("skipped_ticks", n->skipped_ticks);
}

typedef unsigned long long count;

static void report(const struct flight *f, const struct nav_bridge_counts *n)
{
    fprintf(stderr,
            "datagrams: %llu, %llu of them used, at most %.3f s apart, from %llu sender%s\n",
            (count)n->datagrams, (count)n->used, n->longest_wait_s, (count)n->senders,
            n->senders == 1 ? "" : "s");
    fprintf(stderr,
            "left out: %llu of another kind, %llu malformed, %llu out of range, %llu incomplete, "
            "%llu out of order, %llu of another sender, %llu lost by the kernel\n",
            (count)n->fault[NAV_TOLD_FOREIGN], (count)n->fault[NAV_TOLD_MALFORMED],
            (count)n->fault[NAV_TOLD_RANGE], (count)n->fault[NAV_TOLD_INCOMPLETE],
            (count)n->disordered, (count)(n->other_sender + f->other_address), (count)f->udp.lost);
    fprintf(stderr,
            "bus: %llu frames, %llu lost, %llu silences, %llu pauses, %llu minor frames late\n",
            (count)n->frames, (count)(f->lost_frames + n->frames_without_room), (count)n->silences,
            (count)n->pauses, (count)n->skipped_ticks);
}

static int judge(const struct flight *f, const struct nav_bridge_counts *n)
{
    if (n->used > 0) {
        return 0;
    }
    if (n->fault[NAV_TOLD_INCOMPLETE] > 0) {
        return hs_error("X-Plane",
                        "tick rows 17, 20 and 21 of its data output, network, or use --ask",
                        "told neither position, attitude and velocity in one datagram");
    }
    return hs_error(f->command->xplane_port ? "--xplane" : "--flightgear",
                    "see docs/nav.md for how to start the simulator",
                    n->datagrams + f->other_address > 0 ? "none of the datagrams could be used"
                                                        : "no datagram came");
}

int nav_fly_simulator(const struct command *c)
{
    static struct flight f;
    const struct nav_bridge_settings settings = {
        .is_xplane = c->xplane_port > 0,
        .send = c->send,
        .datum = c->datum == NAV_DATUM_BY_RECORD ? NAV_DATUM_SEA_LEVEL : c->datum,
        .height_offset_m = c->height_offset_m};
    f = (struct flight){.command = c, .mood = NAV_BRIDGE_MOODS};
    hs_catch_interrupts();
    const char *bind_to = c->bind ? c->bind : c->ask ? "0.0.0.0" : NULL;
    if (hs_udp_open(&f.udp, settings.is_xplane ? c->xplane_port : c->flightgear_port, bind_to,
                    NULL) != 0) {
        return -1;
    }
    int result = open_output(&f);
    if (result == 0) {
        f.bridge = nav_bridge_new(&settings, put, &f);
        result = f.bridge ? fly(&f) : -1;
    }
    if (f.bridge) {
        const struct nav_bridge_counts *n = nav_bridge_counts(f.bridge);
        report_json(&f, n);
        if (!c->is_quiet) {
            report(&f, n);
        }
        result = result == 0 ? judge(&f, n) : result;
        if (close_output(&f, result == 0) != 0) {
            result = -1;
        }
    }
    nav_bridge_free(f.bridge);
    hs_udp_close(&f.udp);
    return result;
}
