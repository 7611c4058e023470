#include "track.h"

#include "nav/route.h"
#include "nav/send.h"

#include <math.h>

static void check_fixes(const struct nav_track *t, bool has_times)
{
    for (size_t i = 0; i < t->count; i++) {
        const struct nav_fix *f = &t->fix[i];
        FUZZ_ASSERT(fabs(f->latitude_deg) <= 90 && fabs(f->longitude_deg) <= 180);
        FUZZ_ASSERT(i == 0 || !has_times || f->time_us > t->fix[i - 1].time_us);
    }
}

static void send_second(const struct nav_track *t, int64_t from_us)
{
    char log[1 << 17];
    FILE *out = fmemopen(log, sizeof log, "w");
    FUZZ_ASSERT(out);
    const struct nav_send_options options = {
        .interface = "can0", .rate_scale = 0.1, .from_us = from_us, .until_us = from_us + 1000000};
    struct nav_sent sent;
    FUZZ_ASSERT(nav_send(t, &options, out, &sent) == 0);
    fclose(out);
}

static void read_track(char *text, size_t size, enum nav_format format)
{
    struct nav_track track = {0};
    struct nav_reading reading = {.name = "input"};
    if (nav_read_text(text, size, format, &track, &reading) == 0) {
        const struct nav_limits limits = {.max_speed_ms = 411};
        struct nav_findings found;
        check_fixes(&track, true);
        nav_track_drop_repeats(&track);
        check_fixes(&track, true);
        nav_track_complete(&track, &limits, &found);
        send_second(&track, track.fix[0].time_us);
        send_second(&track, track.fix[track.count - 1].time_us - 500000);
    }
    nav_track_free(&track);
}

/* Flying takes long, so few inputs are flown, and fast. */
static void read_route(char *text, size_t size, enum nav_format format)
{
    struct nav_track route = {0}, flight = {0};
    struct nav_reading reading = {.name = "input", .is_route = true};
    if (nav_read_text(text, size, format, &route, &reading) == 0) {
        check_fixes(&route, false);
        if (size % 64 == 0 && nav_fly_route(&route, 10000, 0, &flight) == 0) {
            check_fixes(&flight, true);
        }
    }
    nav_track_free(&route);
    nav_track_free(&flight);
}

int fuzz_track(const uint8_t *data, size_t size, enum nav_format format)
{
    char *text = malloc(size + 1);
    FUZZ_ASSERT(text);
    memcpy(text, data, size);
    text[size] = '\0';
    read_track(text, size, format);
    memcpy(text, data, size); /* the reader may have overwritten it */
    text[size] = '\0';
    read_route(text, size, format);
    free(text);
    return 0;
}
