#include "nav/send.h"

#include "hs/progress.h"
#include "schedule.h"

#include <math.h>

struct sender {
    FILE *out;
    const char *interface;
    struct nav_motion motion;
    struct nav_schedule schedule;
};

static int put_line(void *context, const struct canas_frame *f, int64_t time_us)
{
    const struct sender *s = context;
    char line[CANAS_LINE_MAX];
    size_t length = canas_candump_line(line, f, time_us, s->interface);
    line[length++] = '\n';
    return fwrite(line, 1, length, s->out) == length ? 0 : -1;
}

static void kinematics(void *context, int64_t time_us, struct nav_state *state)
{
    nav_motion_kinematics(context, time_us, state);
}

static void position(void *context, int64_t time_us, struct nav_state *state)
{
    nav_motion_position(context, time_us, state);
}

int nav_send(const struct nav_track *track, const struct nav_send_options *options, FILE *out,
             struct nav_sent *sent)
{
    struct sender s = {.out = out,
                       .interface = options->interface,
                       .schedule = {.options = options,
                                    .datum = track->datum,
                                    .source = {kinematics, position, &s.motion},
                                    .sink = {put_line, &s}}};
    nav_motion_init(&s.motion, track);
    nav_schedule_begin(&s.schedule);
    const double period_us = NAV_MINOR_US / options->rate_scale;
    const int64_t last_us = track->fix[track->count - 1].time_us;
    const int64_t first_us =
        options->from_us > track->fix[0].time_us ? options->from_us : track->fix[0].time_us;
    const int64_t end_us = options->until_us < last_us ? options->until_us : last_us;
    uint64_t active = 0;
    int failed = 0;
    struct hs_progress progress;
    hs_progress_begin_beside(&progress, out, "sending",
                             end_us > first_us ? (uint64_t)(end_us - first_us) : 0);
    /* Counted from the epoch rather than summed, so that the grid keeps to whole seconds. */
    for (uint64_t n = (uint64_t)ceil((double)first_us / period_us); !failed; n++) {
        const int64_t tick_us = llround((double)n * period_us);
        if (tick_us > last_us || tick_us >= options->until_us) {
            break;
        }
        if (nav_motion_covers(&s.motion, tick_us)) {
            failed = nav_schedule_put(&s.schedule, n, tick_us, first_us);
            active++;
        }
        hs_progress_update(&progress, tick_us > first_us ? (uint64_t)(tick_us - first_us) : 0);
    }
    hs_progress_end(&progress);
    *sent = (struct nav_sent){.frames = s.schedule.frames,
                              .active_s = (double)active * period_us * 1e-6};
    return failed;
}
