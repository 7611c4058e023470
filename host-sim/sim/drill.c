#include "sim/drill.h"

#include <string.h>

/* Whether a frame of the bus is one that the script speaks of, by the same node. */
static bool clashes(const struct drill *d, const struct lm_can_frame *f)
{
    const struct nav_exercise *x = d->exercise;
    const bool is_clock = f->id >= CANAS_EXERCISE_TIME && f->id <= CANAS_EXERCISE_SEED;
    const bool is_malfunction = f->id == CANAS_MALFUNCTION || f->id == CANAS_MALFUNCTION_CLEAR;
    return f->length > 0 && f->data[0] == NAV_EXERCISE_NODE &&
           ((is_clock && x->has_clock) || (is_malfunction && x->malfunction_count > 0));
}

static int hear(void *ctx, struct lm_can_frame *frame)
{
    struct drill *d = ctx;
    const int status = d->behind->receive(d->behind->ctx, frame);
    if (status > 0 && d->clash_id == 0 && clashes(d, frame)) {
        d->clash_id = frame->id;
        d->clash_us = d->now_us;
    }
    if (status != 0 || d->next == d->count) {
        return status;
    }
    const struct canas_frame *f = &d->frame[d->next++];
    *frame = (struct lm_can_frame){.id = f->id, .length = f->length, .time_us = d->now_us};
    memcpy(frame->data, f->data, sizeof frame->data);
    return 1;
}

static int pass(void *ctx, const struct lm_can_frame *frame)
{
    const struct drill *d = ctx;
    return d->behind->send(d->behind->ctx, frame);
}

struct lm_can drill_open(struct drill *d, const struct nav_exercise *exercise,
                         const struct lm_can *behind)
{
    *d = (struct drill){.exercise = exercise, .behind = behind};
    return (struct lm_can){.ctx = d, .receive = hear, .send = behind->send ? pass : NULL};
}

void drill_advance(struct drill *d, uint64_t now_us, uint64_t step_us)
{
    const double now_s = (double)now_us * 1e-6, step_s = (double)step_us * 1e-6;
    const struct nav_exercise *x = d->exercise;
    d->now_us = now_us;
    d->next = d->count = 0;
    /* The clock says nothing before the script sets it. */
    if (x->has_clock && now_s >= x->rate[0].from_s) {
        d->count = nav_exercise_frames(x, &d->codes, now_s, step_s, now_s, d->frame);
    }
    d->count += nav_malfunction_frames(x, &d->codes, now_s, step_s, d->frame + d->count);
}
