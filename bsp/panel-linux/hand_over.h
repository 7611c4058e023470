/* What the loop hands to a thread that writes files, without ever waiting for it:
 *
 *     hand_over_start(&h, "settings", &(struct hand_over_work){ctx, take, write});
 *     if (hand_over_begin(&h)) {        in the loop; false: the thread has the place just now
 *         ... change what take() reads ...
 *         hand_over_end(&h);
 *     }
 *     hand_over_close(&h);
 *
 * Loop and thread share one place, which belongs to whoever is between begin and end, or in
 * take(). News that come faster than they are written replace each other. */
#ifndef PANEL_HAND_OVER_H
#define PANEL_HAND_OVER_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

struct hand_over_work {
    void *ctx;
    void (*take)(void *ctx);  /* by the thread: copy the place; quick */
    void (*write)(void *ctx); /* by the thread, outside the place: write the copy */
};

struct hand_over {
    struct hand_over_work work;
    atomic_flag is_taken;
    atomic_bool is_closing, has_news;
    pthread_t thread;
    bool has_thread; /* without one, begin() is false for ever */
};

/* Start the thread. Where there is none to be had, a report says so, with `what` it was for. A
 * zeroed hand_over that was not started may be begun (false) and closed. */
void hand_over_start(struct hand_over *h, const char *what, const struct hand_over_work *work);

bool hand_over_begin(struct hand_over *h);
void hand_over_end(struct hand_over *h);

/* Write what was handed over last, and end the thread. */
void hand_over_close(struct hand_over *h);

#endif
