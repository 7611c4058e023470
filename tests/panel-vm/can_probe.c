/* What the SocketCAN driver hands to the firmware, to be laid beside what others say about the same
 * frames (can_driver.c tries the driver from inside).
 *
 *   can_probe INTERFACE frames    as `candump -L` text
 *   can_probe INTERFACE values    what the decoder makes of the frames: "IDENTIFIER CHANNEL VALUE
 *                                 STEP", in the unit of the bus; STEP: of the fixed point
 *
 * Runs until SIGTERM. Lines beginning with '!' are the driver's words, and, at the end, its
 * counters. */
#include "drv/can_socket.h"
#include "lm/bus.h"
#include "lm/bus_filters.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { TICK_US = 2000 };

static volatile sig_atomic_t is_over;

static void end(int signal)
{
    (void)signal;
    is_over = 1;
}

static void print_frame(const char *interface, const struct lm_can_frame *f)
{
    const uint32_t flags = f->is_error ? 0x20000000u : 0;
    printf("(%llu.%06llu) %s ", (unsigned long long)(f->time_us / 1000000),
           (unsigned long long)(f->time_us % 1000000), interface);
    printf(f->is_extended || f->is_error ? "%08X#" : "%03X#", f->id | flags);
    printf(f->is_remote ? "R" : "");
    for (uint8_t i = 0; i < f->length && !f->is_remote; i++) {
        printf("%02X", f->data[i]);
    }
    printf("\n");
}

/* The fixed point back to the unit of the bus, exactly. */
static void print_values(struct lm_bus *bus, const struct lm_can_frame *frame)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    const uint32_t count = lm_bus_take(bus, frame, events);
    for (uint32_t i = 0; i < count; i++) {
        const struct lm_bus_row *row = &bus->profile->rows[events[i].row];
        const struct lm_bus_scale *scale = lm_bus_scale_of((enum lm_bus_field)row->field);
        const double counts_a_unit = ldexp(scale->multiplier, scale->frac_bits) / scale->divisor;
        printf("%u %u %.10f %.3g\n", row->id, events[i].channel, events[i].value / counts_a_unit,
               1 / counts_a_unit);
    }
}

static void take(struct drv_can_socket *s, struct lm_bus *bus)
{
    const struct lm_can port = drv_can_socket_port(s);
    struct lm_can_frame frame;
    int status;
    while ((status = port.receive(port.ctx, &frame)) == 1) {
        if (bus != NULL) {
            print_values(bus, &frame);
        } else {
            print_frame(s->interface, &frame);
        }
    }
    if (status < 0) {
        printf("! %s\n", s->error);
    }
}

/* As landmass opens it: the filters of canas17. */
static int open_canas17(struct drv_can_socket *s, const char *interface)
{
    struct lm_can_filter filters[LM_BUS_FILTERS_MAX];
    const uint32_t count = lm_bus_filters(&lm_bus_canas17, filters);
    return drv_can_socket_open(s, interface, filters, count, 0);
}

/* `bus` is NULL, or decodes. */
static void run(const char *interface, struct lm_bus *bus)
{
    struct drv_can_socket s;
    const int status = open_canas17(&s, interface);
    printf("! %s\n", status == LM_OK ? "open" : s.error);
    while (!is_over) {
        take(&s, bus);
        fflush(stdout);
        usleep(TICK_US);
    }
    printf("! frames %u malformed %u overflowed %u\n", s.count.frames, s.count.malformed,
           s.count.overflowed);
    drv_can_socket_close(&s);
}

int main(int argc, char **argv)
{
    const bool is_decoding = argc == 3 && strcmp(argv[2], "values") == 0;
    if (!is_decoding && (argc != 3 || strcmp(argv[2], "frames") != 0)) {
        fprintf(stderr, "can_probe INTERFACE frames | values\n");
        return 2;
    }
    struct lm_bus bus;
    lm_bus_init(&bus, &lm_bus_canas17);
    signal(SIGTERM, end);
    run(argv[1], is_decoding ? &bus : NULL);
    return 0;
}
