/* The SocketCAN driver against a real kernel, from inside: what tests/unit/drivers cannot have on a
 * build machine without AF_CAN. Results are TAP.
 *
 *   can_driver LOG [SECONDS]
 *
 * Needs root, `ip` and the modules vcan and can_raw; makes an interface vcan9 of its own and
 * removes it at the end. LOG is candump -L text that is replayed at 80 % of a bus of 1 Mbit/s for
 * SECONDS (3). With two CAN cards can0 and can1 on one bus, both up, the queue to send is filled
 * too. */
#include "drv/can_log.h"
#include "drv/can_socket.h"
#include "lm/bus.h"
#include "lm/bus_filters.h"
#include "lm/canas_control.h"
#include "lm/canas_service.h"

#include <errno.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { FRAMES_MAX = 40000, LOAD_FRAMES_A_SECOND = 6400, MS = 1000 };

#define BUS "vcan9"

static int number, failures;

static void result(bool is_right, const char *sentence)
{
    printf("%sok %d - %s\n", is_right ? "" : "not ", ++number, sentence);
    fflush(stdout);
    failures += !is_right;
}

static void skipped(const char *sentence, const char *reason)
{
    printf("ok %d - %s # SKIP\n# skipped: %s\n", ++number, sentence, reason);
}

static void ip(const char *what)
{
    char command[160];
    snprintf(command, sizeof command, "ip link %s >/dev/null 2>&1", what);
    if (system(command) != 0) {
        printf("# failed: %s\n", command);
    }
}

static void begin_bus(void)
{
    ip("add " BUS " type vcan");
    ip("set " BUS " up");
}

static void end_bus(void)
{
    ip("del " BUS);
}

static uint64_t now_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

/* As landmass opens it: the filters of canas17. */
static int open_canas17(struct drv_can_socket *s, const char *interface)
{
    struct lm_can_filter filters[LM_BUS_FILTERS_MAX];
    const uint32_t count = lm_bus_filters(&lm_bus_canas17, filters);
    return drv_can_socket_open(s, interface, filters, count, 0);
}

/* Somebody else on the bus: hears everything, reports of errors too. */
static int open_other(const char *interface)
{
    const int fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK, CAN_RAW), bytes = 32 << 20;
    const can_err_mask_t all = CAN_ERR_MASK;
    struct sockaddr_can address = {.can_family = AF_CAN};
    address.can_ifindex = (int)if_nametoindex(interface);
    setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &all, sizeof all);
    setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes);
    return fd >= 0 && bind(fd, (struct sockaddr *)&address, sizeof address) == 0 ? fd : -1;
}

static bool put(int other, canid_t id, uint8_t code)
{
    const struct can_frame f = {.can_id = id, .can_dlc = 8, .data = {9, LM_CANAS_FLOAT, 0, code}};
    return write(other, &f, sizeof f) == (ssize_t)sizeof f;
}

/* Frames until none waits; how many. `errors`: how often the driver reported one. */
static int take_all(struct drv_can_socket *s, struct lm_can_frame *frames, int most, int *errors)
{
    const struct lm_can port = drv_can_socket_port(s);
    struct lm_can_frame frame;
    int count = 0, status;
    while ((status = port.receive(port.ctx, &frame)) == 1) {
        if (count < most) {
            frames[count] = frame;
        }
        count++;
    }
    *errors += status < 0;
    return count;
}

static struct lm_can_frame heard[FRAMES_MAX];

/* Until `count` frames came or a second has passed. */
static int take_some(struct drv_can_socket *s, int count, int *errors)
{
    const uint64_t until_us = now_us() + 1000 * MS;
    int got = 0;
    while (got < count && now_us() < until_us) {
        got += take_all(s, heard + got, FRAMES_MAX - got, errors);
        usleep(2 * MS);
    }
    return got;
}

/* ---- receiving ---- */

static void options_are_taken(struct drv_can_socket *s)
{
    int bytes = 0, overflow = 0, stamp = 0;
    socklen_t size = sizeof(int);
    getsockopt(s->fd, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
    getsockopt(s->fd, SOL_SOCKET, SO_RXQ_OVFL, &overflow, &size);
    getsockopt(s->fd, SOL_SOCKET, SO_TIMESTAMP, &stamp, &size);
    printf("# receive buffer %d bytes\n", bytes);
    result(bytes >= 8 << 20 && overflow && stamp,
           "the kernel takes the buffer, the count of losses and the stamps");
}

/* Whether the firmware makes anything of an identifier. */
static bool is_wanted(canid_t id)
{
    const struct can_frame raw = {.can_id = id, .can_dlc = 8, .data = {9, LM_CANAS_FLOAT}};
    struct lm_can_frame frame;
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&bus, &lm_bus_canas17);
    drv_can_socket_convert(&raw, &frame);
    lm_bus_take(&bus, &frame, events);
    const uint32_t *o = bus.count.outcome;
    const bool is_control =
        id > LM_CONTROL_ID + LM_CONTROL_ITEM_STEP && id < LM_CONTROL_ID + LM_CONTROL_ITEMS;
    return id == LM_CANAS_REQUEST_ID || id == LM_BUS_SWAP_ID || is_control ||
           !(o[LM_BUS_NOT_DATA] || o[LM_BUS_FOREIGN] || o[LM_BUS_OTHER_CHANNEL] ||
             o[LM_BUS_SERVICE] || o[LM_BUS_UNUSED]);
}

static void filters_are_the_decoders(struct drv_can_socket *s, int other)
{
    int wrong = 0, errors = 0;
    for (canid_t id = 0; id <= CAN_SFF_MASK; id++) {
        const canid_t tries[] = {id,
                                 id | CAN_RTR_FLAG,
                                 0x10000 | id | CAN_EFF_FLAG,
                                 0x30000 | id | CAN_EFF_FLAG,
                                 0x40000 | id | CAN_EFF_FLAG,
                                 0x1f000 | id | CAN_EFF_FLAG,
                                 0x10000 | id | CAN_EFF_FLAG | CAN_RTR_FLAG};
        for (size_t i = 0; i < sizeof tries / sizeof *tries; i++) {
            put(other, tries[i], 0);
            const int count = take_all(s, heard, 1, &errors);
            wrong += count != is_wanted(tries[i]);
        }
    }
    printf("# %d of %d identifiers are filtered otherwise than they are decoded\n", wrong,
           7 * 2048);
    result(wrong == 0 && errors == 0, "the kernel's filter passes what the decoder takes, no more");
}

static void frames_have_their_own_times(struct drv_can_socket *s, int other)
{
    uint64_t sent_us[20], worst_us = 0;
    int errors = 0;
    for (int i = 0; i < 20; i++) {
        sent_us[i] = now_us();
        put(other, 0x40c, (uint8_t)i);
        usleep(10 * MS);
    }
    const int count = take_all(s, heard, 20, &errors);
    bool is_right = count == 20;
    for (int i = 0; i < 20 && is_right; i++) {
        const uint64_t t = heard[i].time_us;
        const uint64_t off = t > sent_us[i] ? t - sent_us[i] : sent_us[i] - t;
        worst_us = off > worst_us ? off : worst_us;
        is_right = heard[i].data[3] == i;
    }
    printf("# worst difference %llu us, the oldest read 200 ms late\n",
           (unsigned long long)worst_us);
    result(is_right && worst_us < 5 * MS, "frames read late have the times at which they came");
}

static void losses_are_counted(struct drv_can_socket *s, int other)
{
    enum { BURST = 30000 };
    const uint32_t before = s->count.overflowed;
    int errors = 0;
    for (int i = 0; i < BURST; i++) {
        put(other, 0x40c, (uint8_t)i);
    }
    int got = take_all(s, heard, 0, &errors);
    put(other, 0x40c, 0);
    got += take_some(s, 1, &errors);
    const int lost = (int)(s->count.overflowed - before);
    printf("# %d frames at once: %d kept, %d lost and counted\n", BURST + 1, got, lost);
    result(lost > 0 && got > 5000 && got + lost == BURST + 1,
           "a burst of 5,000 frames is kept; beyond that, every lost frame is counted");
}

/* ---- sending ---- */

static void own_frames_are_seen_by_others_only(struct drv_can_socket *s, int other)
{
    const struct lm_can port = drv_can_socket_port(s);
    struct can_frame raw;
    int errors = 0;
    while (read(other, &raw, sizeof raw) > 0) {
    }
    const struct lm_can_frame f = {.id = 0x40c, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}};
    const int status = port.send(port.ctx, &f);
    const bool is_seen = read(other, &raw, sizeof raw) == (ssize_t)sizeof raw &&
                         raw.can_id == 0x40c && memcmp(raw.data, f.data, 8) == 0;
    result(status == LM_OK && is_seen && take_all(s, heard, 1, &errors) == 0,
           "a frame that is sent is seen by others, and not heard by itself");
}

static void identification_is_answered(struct drv_can_socket *s, int other)
{
    const struct lm_can port = drv_can_socket_port(s);
    struct lm_canas_service service;
    struct can_frame raw, ids = {.can_id = LM_CANAS_REQUEST_ID, .can_dlc = 4};
    uint64_t worst_us = 0;
    int answers = 0, errors = 0;
    lm_canas_service_init(&service, 20, 1, 1);
    for (int i = 0; i < 20; i++) {
        while (read(other, &raw, sizeof raw) > 0) {
        }
        const uint64_t asked_us = now_us();
        (void)!write(other, &ids, sizeof ids);
        bool is_answered = false;
        for (int step = 0; step < 100 && !is_answered; step++) {
            const int count = take_all(s, heard, FRAMES_MAX, &errors);
            for (int k = 0; k < count; k++) {
                lm_canas_service_take(&service, &heard[k]);
            }
            lm_canas_service_answer(&service, &port, 0, now_us());
            while (read(other, &raw, sizeof raw) > 0) {
                is_answered |= raw.can_id == LM_CANAS_RESPONSE_ID && raw.data[0] == 20;
            }
            usleep(2 * MS);
        }
        const uint64_t took_us = now_us() - asked_us;
        worst_us = took_us > worst_us ? took_us : worst_us;
        answers += is_answered;
    }
    printf("# slowest answer %llu us\n", (unsigned long long)worst_us);
    result(answers == 20 && worst_us < 100 * MS, "identification is answered within 100 ms");
}

static void a_burst_goes_through_a_card(void)
{
    static const char *const sentence =
        "frames sent at once through a card arrive in order; what it has no room for is counted";
    enum { BURST = 2000 };
    struct drv_can_socket s;
    const int other = open_other("can1");
    if (other < 0 || open_canas17(&s, "can0") != LM_OK) {
        skipped(sentence, "no cards can0 and can1");
        return;
    }
    const struct lm_can port = drv_can_socket_port(&s);
    uint32_t failed = 0;
    for (uint32_t i = 0; i < BURST; i++) {
        const struct lm_can_frame f = {
            .id = 0x40c, .length = 4, .data = {(uint8_t)(i >> 8), (uint8_t)i}};
        failed += port.send(port.ctx, &f) != LM_OK;
    }
    int errors = 0;
    const uint64_t until_us = now_us() + 2000 * MS;
    while (s.queue_count > 0 && now_us() < until_us) {
        take_all(&s, heard, 0, &errors);
        usleep(MS);
    }
    usleep(200 * MS);
    struct can_frame raw;
    uint32_t arrived = 0;
    int last = -1;
    bool is_ordered = true;
    while (read(other, &raw, sizeof raw) > 0) {
        const int n = raw.data[0] << 8 | raw.data[1];
        is_ordered = is_ordered && n > last;
        last = n;
        arrived++;
    }
    printf("# %d offered: %u sent, %u arrived, %u dropped\n", BURST, s.count.sent, arrived,
           s.count.unsent);
    result(failed == 0 && errors == 0 && s.count.sent + s.count.unsent == BURST &&
               arrived == s.count.sent && is_ordered && last == BURST - 1,
           sentence);
    drv_can_socket_close(&s);
    close(other);
}

/* ---- what happens to a bus ---- */

static void reports_are_counted(struct drv_can_socket *s, int other)
{
    int errors = 0;
    put(other, CAN_ERR_FLAG | CAN_ERR_BUSOFF, 0);
    take_some(s, 1, &errors);
    const bool is_off = s->is_bus_off && s->count.bus_off == 1;
    take_all(s, heard, 1, &errors);
    put(other, CAN_ERR_FLAG | CAN_ERR_RESTARTED, 0);
    take_some(s, 1, &errors);
    result(is_off && errors == 1 && !s->is_bus_off && s->count.restarts == 1,
           "bus-off is reported once, counted, and over with the restart");
}

static void down_and_up(struct drv_can_socket *s, int other)
{
    const struct lm_can port = drv_can_socket_port(s);
    const struct lm_can_frame f = {.id = 0x81, .length = 8};
    int errors = 0;
    ip("set " BUS " down");
    for (int i = 0; i < 20; i++) {
        take_all(s, heard, 1, &errors);
        usleep(2 * MS);
    }
    const int told = errors;
    const uint32_t unsent = s->count.unsent;
    const bool is_refused = port.send(port.ctx, &f) == LM_ERR_IO && s->count.unsent == unsent + 1;
    printf("# %s\n", s->error);
    ip("set " BUS " up");
    take_all(s, heard, 1, &errors);
    struct can_frame raw;
    while (read(other, &raw, sizeof raw) > 0 || errno == ENETDOWN) {
        errno = 0; /* the other one is told, too, before it may send again */
    }
    put(other, 0x40c, 77);
    const int got = take_some(s, 1, &errors);
    result(told == 1 && is_refused && got == 1 && heard[0].data[3] == 77 && s->count.gone == 0,
           "an interface that goes down is told once, refuses to send, and is heard again when up");
}

static void removed_and_back(struct drv_can_socket *s)
{
    int errors = 0, got = 0;
    end_bus();
    for (int i = 0; i < 50; i++) {
        take_all(s, heard, 1, &errors);
        usleep(2 * MS);
    }
    const bool is_gone = s->fd < 0 && s->count.gone >= 1 && errors >= 1 && errors <= 4;
    printf("# %s\n", s->error);
    begin_bus();
    const int other = open_other(BUS);
    for (int i = 0; i < 20 && got == 0; i++) {
        usleep(100 * MS);
        put(other, 0x40c, 78);
        got = take_all(s, heard, FRAMES_MAX, &errors);
    }
    result(is_gone && got >= 1 && heard[0].data[3] == 78 && s->count.reopened == 1,
           "an interface that was removed is heard again soon after it is back");
    close(other);
}

static void missing_at_start(void)
{
    struct drv_can_socket s;
    int errors = 0, got = 0;
    end_bus();
    const int status = open_canas17(&s, BUS);
    begin_bus();
    const int other = open_other(BUS);
    for (int i = 0; i < 20 && got == 0; i++) {
        usleep(100 * MS);
        take_all(&s, heard, FRAMES_MAX, &errors);
        put(other, 0x40c, 79);
        got = take_all(&s, heard, FRAMES_MAX, &errors);
    }
    result(status == LM_ERR_IO && got >= 1 && s.count.reopened == 1,
           "an interface that is missing at the start is found when it comes");
    drv_can_socket_close(&s);
    close(other);
}

/* ---- load ---- */

struct log {
    struct can_frame frame[FRAMES_MAX];
    int count, wanted;
};

static bool read_log(const char *path, struct log *log)
{
    FILE *in = fopen(path, "r");
    char line[256];
    struct lm_can_frame f;
    while (in != NULL && log->count < FRAMES_MAX && fgets(line, sizeof line, in) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        if (drv_can_log_parse(line, &f) != NULL || f.is_error) {
            continue;
        }
        struct can_frame *raw = &log->frame[log->count++];
        *raw = (struct can_frame){.can_id = f.id | (f.is_extended ? CAN_EFF_FLAG : 0) |
                                            (f.is_remote ? CAN_RTR_FLAG : 0),
                                  .can_dlc = f.length};
        memcpy(raw->data, f.data, 8);
        log->wanted += is_wanted(raw->can_id);
    }
    if (in != NULL) {
        fclose(in);
    }
    return log->wanted > 0;
}

/* Send the log again and again at a steady rate; how many frames went out is written to `tell`. */
static void send_load(const struct log *log, double seconds, int tell)
{
    const int other = open_other(BUS);
    const uint64_t start_us = now_us();
    const uint32_t total = (uint32_t)(seconds * LOAD_FRAMES_A_SECOND);
    uint32_t sent = 0;
    while (sent < total) {
        const uint64_t due = (now_us() - start_us) * LOAD_FRAMES_A_SECOND / 1000000;
        while (sent < due && sent < total) {
            if (write(other, &log->frame[sent % (uint32_t)log->count], sizeof(struct can_frame)) >
                0) {
                sent++;
            }
        }
        usleep(MS);
    }
    (void)!write(tell, &sent, sizeof sent);
    _exit(0);
}

/* The next frame of the log that the display takes. */
static const struct can_frame *next_wanted(const struct log *log, uint32_t *place)
{
    const struct can_frame *f;
    do {
        f = &log->frame[(*place)++ % (uint32_t)log->count];
    } while (!is_wanted(f->can_id));
    return f;
}

static void the_load_is_heard_whole(const struct log *log, double seconds)
{
    struct drv_can_socket s;
    int told[2], errors = 0, wrong = 0;
    uint32_t sent = 0, place = 0, got = 0, values = 0;
    open_canas17(&s, BUS);
    const struct lm_can port = drv_can_socket_port(&s);
    (void)!pipe(told);
    const pid_t child = fork();
    if (child == 0) {
        send_load(log, seconds, told[1]);
    }
    struct lm_bus bus, expected;
    lm_bus_init(&bus, &lm_bus_canas17);
    lm_bus_init(&expected, &lm_bus_canas17);
    for (int quiet = 0; quiet < 250; quiet++) {
        struct lm_can_frame frame, wanted;
        struct lm_bus_event events[LM_BUS_EVENTS], right[LM_BUS_EVENTS];
        int status;
        while ((status = port.receive(port.ctx, &frame)) == 1) {
            drv_can_socket_convert(next_wanted(log, &place), &wanted);
            wanted.time_us = frame.time_us;
            const uint32_t count = lm_bus_take(&bus, &frame, events);
            wrong += frame.id != wanted.id || memcmp(frame.data, wanted.data, 8) != 0 ||
                     lm_bus_take(&expected, &wanted, right) != count ||
                     (count == 1 && events[0].value != right[0].value);
            values += count;
            got++;
            quiet = 0;
        }
        errors += status < 0;
        usleep(2 * MS);
    }
    waitpid(child, NULL, 0);
    (void)!read(told[0], &sent, sizeof sent);
    uint32_t due = 0, at = 0;
    while (at < sent) {
        due += is_wanted(log->frame[at++ % (uint32_t)log->count].can_id);
    }
    printf("# %u frames at %d a second, %u of them taken: %u heard, %u values, %d wrong, %u lost\n",
           sent, LOAD_FRAMES_A_SECOND, due, got, values, wrong, s.count.overflowed);
    result(sent > 0 && got == due && wrong == 0 && errors == 0 && s.count.overflowed == 0 &&
               values > got / 2,
           "at 80 % load every frame comes, in order, and means what it meant");
    drv_can_socket_close(&s);
}

int main(int argc, char **argv)
{
    static struct log log;
    struct drv_can_socket s;
    if (argc < 2 || argc > 3 || !read_log(argv[1], &log)) {
        fprintf(stderr, "usage: can_driver LOG [SECONDS]; the log must have frames of canas17\n");
        return 2;
    }
    begin_bus();
    const int other = open_other(BUS);
    if (open_canas17(&s, BUS) != LM_OK || other < 0) {
        printf("Bail out! %s\n", s.error);
        return 1;
    }
    options_are_taken(&s);
    filters_are_the_decoders(&s, other);
    frames_have_their_own_times(&s, other);
    losses_are_counted(&s, other);
    own_frames_are_seen_by_others_only(&s, other);
    identification_is_answered(&s, other);
    reports_are_counted(&s, other);
    down_and_up(&s, other);
    close(other);
    removed_and_back(&s);
    drv_can_socket_close(&s);
    missing_at_start();
    the_load_is_heard_whole(&log, argc == 3 ? atof(argv[2]) : 3);
    a_burst_goes_through_a_card();
    end_bus();
    printf("1..%d\n", number);
    return failures > 0;
}
