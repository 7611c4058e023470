#include "bus.h"

#include "drv/not_fitted.h"
#include "lm/bus_filters.h"
#include "report.h"

/* The driver tells each loss once; what is said here is said once for a loss and once when it is
 * over. */
static void report_loss(struct bus *b, int status)
{
    if (status < 0 && !b->is_lost) {
        b->is_lost = true;
        report(REPORT_ERROR, "bus: %s", b->socket.error);
    } else if (status == 1 && b->is_lost) {
        b->is_lost = false;
        report(REPORT_NOTICE, "bus: frames come again");
    }
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct bus *b = ctx;
    b->polls++;
    const int status = b->driver.receive(b->driver.ctx, frame);
    report_loss(b, status);
    return status;
}

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct bus *b = ctx;
    return b->driver.send(b->driver.ctx, frame);
}

void bus_open(struct bus *b, const char *interface, const struct lm_bus_profile *profile,
              const struct lm_bus_profile *beside, uint64_t zero_us)
{
    *b = (struct bus){.socket.fd = -1, .driver = drv_no_can};
    b->port = (struct lm_can){.ctx = b, .receive = receive};
    if (interface[0] == '\0') {
        return;
    }
    struct lm_can_filter filters[2 * LM_BUS_FILTERS_MAX]; /* a socket takes 512 */
    uint32_t count = lm_bus_filters(profile, filters);
    if (beside != NULL) {
        count += lm_bus_filters(beside, filters + count);
    }
    report_loss(b, drv_can_socket_open(&b->socket, interface, filters, count, zero_us));
    b->driver = drv_can_socket_port(&b->socket);
    b->port.send = send_frame;
}

void bus_close(struct bus *b)
{
    drv_can_socket_close(&b->socket);
}

int bus_fd(const struct bus *b)
{
    return b->socket.fd;
}
