#include "hs/team.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

struct run {
    const struct hs_team *team;
    uint32_t count;
    atomic_uint next; /* part that nobody took yet */
    pthread_mutex_t mutex;
    bool *is_done;     /* by part; owned, and guarded by the mutex */
    uint32_t finished; /* so many from 0 on; guarded by it */
};

uint32_t hs_team_threads(void)
{
    cpu_set_t set;
    const int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return (uint32_t)(count < 1 ? 1 : count > HS_TEAM_UNASKED_MAX ? HS_TEAM_UNASKED_MAX : count);
}

static void note_done(struct run *run, uint32_t part)
{
    pthread_mutex_lock(&run->mutex);
    run->is_done[part] = true;
    while (run->finished < run->count && run->is_done[run->finished]) {
        if (run->team->finish) {
            run->team->finish(run->team->ctx, run->finished);
        }
        run->finished++;
    }
    pthread_mutex_unlock(&run->mutex);
}

static void *take_parts(void *argument)
{
    struct run *run = argument;
    const struct hs_team *team = run->team;
    void *own = team->begin(team->ctx);
    uint32_t part;
    while (own && (part = atomic_fetch_add(&run->next, 1)) < run->count) {
        team->work(team->ctx, own, part);
        note_done(run, part);
    }
    if (own) {
        team->end(team->ctx, own);
    }
    return NULL;
}

int hs_team_run(const struct hs_team *team, uint32_t count, uint32_t threads)
{
    struct run run = {
        .team = team, .count = count, .is_done = calloc((size_t)count + 1, sizeof *run.is_done)};
    pthread_t others[HS_TEAM_MAX];
    uint32_t started = 0;
    if (!run.is_done) {
        return -1;
    }
    pthread_mutex_init(&run.mutex, NULL);
    while (started + 1 < threads && started + 1 < count && started + 1 < HS_TEAM_MAX &&
           pthread_create(&others[started], NULL, take_parts, &run) == 0) {
        started++;
    }
    take_parts(&run);
    for (uint32_t i = 0; i < started; i++) {
        pthread_join(others[i], NULL);
    }
    pthread_mutex_destroy(&run.mutex);
    free(run.is_done);
    return run.finished == count ? 0 : -1;
}
