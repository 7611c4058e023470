/* What the SocketCAN driver hands to the firmware, as `candump -L` text that can be laid beside
 * that of candump itself.
 *
 *   can_probe INTERFACE [PAUSE]    until a signal; PAUSE: sleep so many seconds first, the socket
 *                                  open and not looked at
 *
 * Lines beginning with '!' are the driver's words about a bus that is lost, and, at the end, its
 * counters. */
#include "drv/can_socket.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { TICK_US = 2000, REOPEN_TICKS = 50 };

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

/* Take what waits. An error is told once, until something else happens. */
static int take(struct drv_can_socket *s, const char *interface, char *told, size_t size)
{
    const struct lm_can port = drv_can_socket_port(s);
    struct lm_can_frame frame;
    int status;
    while ((status = port.receive(port.ctx, &frame)) == 1) {
        print_frame(interface, &frame);
    }
    if (status < 0 && strcmp(told, s->error) != 0) {
        snprintf(told, size, "%s", s->error);
        printf("! %s\n", told);
    }
    return status;
}

static void run(const char *interface, unsigned pause_s)
{
    struct drv_can_socket s;
    char told[sizeof s.error] = "";
    int ticks_lost = 0, status = drv_can_socket_open(&s, interface, &lm_bus_canas17, 0);
    printf(status == LM_OK ? "! open\n" : "! %s\n", s.error);
    fflush(stdout);
    sleep(pause_s);
    while (!is_over) {
        status = take(&s, interface, told, sizeof told);
        ticks_lost = status < 0 ? ticks_lost + 1 : 0;
        if (ticks_lost >= REOPEN_TICKS) { /* the interface may have come back as another one */
            drv_can_socket_close(&s);
            status = drv_can_socket_open(&s, interface, &lm_bus_canas17, 0);
            printf(status == LM_OK ? "! open\n" : "! %s\n", s.error);
            ticks_lost = 0;
        }
        fflush(stdout);
        usleep(TICK_US);
    }
    printf("! frames %u malformed %u down %u overflowed %u\n", s.count.frames, s.count.malformed,
           s.count.down, s.count.overflowed);
    drv_can_socket_close(&s);
}

int main(int argc, char **argv)
{
    if (argc < 2 || argc > 3) {
        fprintf(stderr, "can_probe INTERFACE [PAUSE]\n");
        return 2;
    }
    signal(SIGTERM, end);
    run(argv[1], argc == 3 ? (unsigned)atoi(argv[2]) : 0);
    return 0;
}
