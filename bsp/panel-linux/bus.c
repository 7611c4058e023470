#include "bus.h"

#include "report.h"

enum { RETRY_US = 500000 };

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct bus *b = ctx;
    b->count.polls++;
    if (b->socket.fd < 0) {
        return b->interface[0] == '\0' ? 0 : LM_ERR_IO;
    }
    const int status = b->driver.receive(b->driver.ctx, frame);
    b->is_failed = b->is_failed || status < 0;
    return status;
}

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct bus *b = ctx;
    if (b->socket.fd < 0 || b->driver.send == NULL) {
        return LM_ERR_IO;
    }
    return b->driver.send(b->driver.ctx, frame);
}

static void try_open(struct bus *b)
{
    drv_can_socket_close(&b->socket);
    b->is_failed = false;
    if (drv_can_socket_open(&b->socket, b->interface, &lm_bus_canas17, b->zero_us) == LM_OK) {
        b->driver = drv_can_socket_port(&b->socket);
        b->count.opens++;
    }
}

static bool is_up(const struct bus *b)
{
    return b->socket.fd >= 0 && !b->is_failed;
}

static void tell_state(const struct bus *b)
{
    if (is_up(b)) {
        report(REPORT_NOTICE, "bus: %s is open", b->interface);
    } else {
        report(REPORT_ERROR, "bus: %s; it is tried again twice a second", b->socket.error);
    }
}

void bus_open(struct bus *b, const char *interface, uint64_t zero_us)
{
    *b = (struct bus){.interface = interface, .zero_us = zero_us, .socket.fd = -1};
    b->port = (struct lm_can){.ctx = b, .receive = receive, .send = send_frame};
    if (interface[0] != '\0') {
        try_open(b);
        b->was_up = is_up(b);
        tell_state(b);
    }
}

void bus_close(struct bus *b)
{
    drv_can_socket_close(&b->socket);
}

/* An interface that went down keeps its socket, and the frames in it are still read until the next
 * try; one that was removed needs a new one. A new one does for both. */
void bus_service(struct bus *b, uint64_t now_us)
{
    if (b->interface[0] == '\0') {
        return;
    }
    if (is_up(b) != b->was_up) {
        b->was_up = !b->was_up;
        tell_state(b);
    }
    if (!is_up(b) && now_us >= b->retry_us) {
        b->retry_us = now_us + RETRY_US;
        try_open(b);
    }
}

int bus_fd(const struct bus *b)
{
    return b->socket.fd;
}
