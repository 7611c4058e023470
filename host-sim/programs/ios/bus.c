#include "bus.h"

#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/real_time.h"

#include <errno.h>
#include <string.h>

enum { HEARD_A_STEP = 4096, KERNEL_WAITS = 8 };

static int open_socket(struct bus *b)
{
    static const struct lm_can_filter all[] = {{0, 0, false}, {0, 0, true}};
    const uint32_t count = sizeof all / sizeof all[0];
    b->name = b->command->can;
    return drv_can_socket_open(&b->socket, b->name, all, count, 0) == LM_OK
               ? 0
               : hs_error("--can", "ip link set NAME up type can bitrate 1000000", "%s",
                          b->socket.error);
}

static void report_line(void *context, uint32_t line, const char *cause)
{
    const struct bus *b = context;
    char place[300];
    snprintf(place, sizeof place, "%.250s line %u", b->command->log_path, line);
    (void)hs_warn(place, NULL, "%s", cause);
}

static int open_log(struct bus *b)
{
    b->name = "log";
    b->log_file = hs_input_open(b->command->log_path, "r");
    if (b->log_file == NULL) {
        return hs_error(b->command->log_path, NULL, "cannot be opened: %s", strerror(errno));
    }
    drv_can_log_init(&b->log, b->log_file, report_line, b);
    return 0;
}

int bus_open(struct bus *b, const struct command *c)
{
    b->command = c;
    b->name = "loop";
    b->socket.fd = -1;
    b->begun_us = hs_clock_us(CLOCK_MONOTONIC);
    if (ios_feed_open(&b->feed, IOS_FEED_BYTES) != 0 || (c->can != NULL && open_socket(b) != 0) ||
        (c->log_path != NULL && open_log(b) != 0)) {
        return -1;
    }
    b->has_out = c->out_path != NULL && hs_atomic_open(&b->out, c->out_path) == 0;
    return c->out_path == NULL || b->has_out ? 0 : -1;
}

/* All that goes over the bus passes here. */
static void carry(struct bus *b, const struct lm_can_frame *frame)
{
    const uint64_t now_us = (uint64_t)hs_clock_us(CLOCK_REALTIME);
    ios_feed_put(&b->feed, b->name, now_us, frame);
    if (b->has_out && !frame->is_error && !frame->is_remote) {
        (void)drv_can_log_write(b->out.stream, b->name, now_us, frame); /* told by the commit */
    }
}

static void hear(struct bus *b, struct lm_can port)
{
    struct lm_can_frame frame;
    for (int i = 0; i < HEARD_A_STEP; i++) {
        const int status = port.receive(port.ctx, &frame);
        b->count.down += status < 0;
        if (status != 1) {
            return;
        }
        b->count.heard++;
        carry(b, &frame);
    }
}

/* Frames that the interface has no room for yet stay here. */
static void send_waiting(struct bus *b)
{
    const struct lm_can port = drv_can_socket_port(&b->socket);
    while (b->tail != b->head && b->socket.queue_count < KERNEL_WAITS) {
        if (port.send(port.ctx, &b->queue[b->tail++ % BUS_QUEUE]) == LM_OK) {
            b->count.sent++;
        } else {
            b->count.failed++;
        }
    }
}

void bus_step(struct bus *b)
{
    if (b->command->can != NULL) {
        hear(b, drv_can_socket_port(&b->socket));
        send_waiting(b);
    } else if (b->log_file != NULL) {
        drv_can_log_set_now(&b->log, (uint64_t)(hs_clock_us(CLOCK_MONOTONIC) - b->begun_us));
        hear(b, drv_can_log_port(&b->log));
    }
}

bool bus_send(struct bus *b, const struct lm_can_frame *frame)
{
    if (b->command->can != NULL) {
        if (b->head - b->tail == BUS_QUEUE) {
            return false;
        }
        b->queue[b->head++ % BUS_QUEUE] = *frame;
    } else {
        b->count.sent++;
    }
    carry(b, frame);
    return true;
}

int bus_close(struct bus *b, bool is_well)
{
    int status = 0;
    drv_can_socket_close(&b->socket);
    if (b->log_file != NULL) {
        fclose(b->log_file);
    }
    if (b->has_out && is_well) {
        status = hs_atomic_commit(&b->out);
    } else if (b->has_out) {
        hs_atomic_abort(&b->out);
    }
    ios_feed_close(&b->feed);
    return status;
}
