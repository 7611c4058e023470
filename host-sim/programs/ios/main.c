/* landmass-ios: the instructor's station. */
#include "hs/error.h"
#include "hs/real_time.h"
#include "hs/report.h"
#include "server.h"

#include <signal.h>
#include <stdio.h>

static void report(const struct server *s)
{
    const struct bus *b = s->bus;
    hs_report_count("requests", s->count.requests);
    hs_report_count("pages", s->count.pages);
    hs_report_count("tiles_drawn", s->map.drawn);
    hs_report_count("frames_heard", b->count.heard);
    hs_report_count("frames_sent", b->count.sent);
    hs_report_count("frames_not_sent", b->count.failed);
    hs_report_count("malformed_lines", b->log.count.malformed);
    hs_report_object("refused");
    for (int i = 0; i < REFUSALS; i++) {
        hs_report_count(refusal_keys[i], s->count.refused[i]);
    }
    hs_report_close();
}

static void print_summary(const struct server *s)
{
    const struct bus *b = s->bus;
    fprintf(stderr, "%llu pages, %llu requests; %llu frames heard, %llu sent, %llu not sent\n",
            (unsigned long long)s->count.pages, (unsigned long long)s->count.requests,
            (unsigned long long)b->count.heard, (unsigned long long)b->count.sent,
            (unsigned long long)b->count.failed);
    for (int i = 0; i < REFUSALS; i++) {
        if (s->count.refused[i] > 0) {
            fprintf(stderr, "refused, %s: %llu\n", refusal_keys[i],
                    (unsigned long long)s->count.refused[i]);
        }
    }
}

static int serve(struct server *s, const struct command *c)
{
    const double until_s = (double)hs_clock_us(CLOCK_MONOTONIC) * 1e-6 + c->seconds;
    if (!c->is_quiet) {
        fprintf(stderr, "http://%s:%d/\n", c->bind, server_port(s));
    }
    while (!hs_is_interrupted() &&
           (c->seconds <= 0 || (double)hs_clock_us(CLOCK_MONOTONIC) * 1e-6 < until_s)) {
        if (!server_step(s) && !hs_is_interrupted()) {
            return hs_error("server", NULL, "cannot go on");
        }
    }
    return 0;
}

static int run(const struct command *c)
{
    static struct bus bus;
    static struct server server;
    struct image image;
    if (image_open(&image, c->image_path) != 0) {
        return -1;
    }
    int status = bus_open(&bus, c);
    if (status == 0) {
        status = server_open(&server, c, &bus, &image);
        status = status == 0 ? serve(&server, c) : status;
        if (status == 0) {
            report(&server);
        }
        if (status == 0 && !c->is_quiet) {
            print_summary(&server);
        }
        server_close(&server);
    }
    if (bus_close(&bus, status == 0) != 0) {
        status = -1;
    }
    image_close(&image);
    return status;
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-ios");
    struct command c;
    int exit_code;
    hs_catch_interrupts();
    signal(SIGPIPE, SIG_IGN);
    if (ios_options_read(&c, argc, argv, &exit_code)) {
        exit_code = run(&c) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    ios_options_free(&c);
    return hs_report_end(exit_code);
}
