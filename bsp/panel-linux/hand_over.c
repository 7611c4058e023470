#include "hand_over.h"

#include "report.h"

#include <string.h>
#include <time.h>

enum { REST_NS = 100000000 };

static void *keep_writing(void *ctx)
{
    struct hand_over *h = ctx;
    for (bool is_last = false; !is_last;) {
        is_last = atomic_load(&h->is_closing);
        const struct timespec rest = {.tv_nsec = REST_NS};
        if (!atomic_load(&h->has_news) || atomic_flag_test_and_set(&h->is_taken)) {
            (void)nanosleep(&rest, NULL);
            continue;
        }
        h->work.take(h->work.ctx);
        atomic_store(&h->has_news, false);
        atomic_flag_clear(&h->is_taken);
        h->work.write(h->work.ctx);
    }
    return NULL;
}

void hand_over_start(struct hand_over *h, const char *what, const struct hand_over_work *work)
{
    memset(h, 0, sizeof *h);
    h->work = *work;
    atomic_flag_clear(&h->is_taken);
    const int cause = pthread_create(&h->thread, NULL, keep_writing, h);
    h->has_thread = cause == 0;
    if (cause != 0) {
        report(REPORT_ERROR, "%s: no thread to write them: %s", what, strerror(cause));
    }
}

bool hand_over_begin(struct hand_over *h)
{
    return h->has_thread && !atomic_flag_test_and_set(&h->is_taken);
}

void hand_over_end(struct hand_over *h)
{
    atomic_store(&h->has_news, true);
    atomic_flag_clear(&h->is_taken);
}

void hand_over_close(struct hand_over *h)
{
    if (h->has_thread) {
        atomic_store(&h->is_closing, true);
        (void)pthread_join(h->thread, NULL);
        h->has_thread = false;
    }
}
