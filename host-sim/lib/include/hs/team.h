/* Work in numbered parts that need nothing of each other, done by several threads. */
#ifndef HS_TEAM_H
#define HS_TEAM_H

#include <stdint.h>

enum { HS_TEAM_MAX = 64, HS_TEAM_UNASKED_MAX = 16 }; /* threads; where nobody says how many */

/* `ctx` goes to each function, and `own` is what `begin` gave to the calling thread. */
struct hs_team {
    void *ctx;
    void *(*begin)(void *ctx); /* memory of one thread; NULL: there is none, others do its share */
    void (*work)(void *ctx, void *own, uint32_t part);
    void (*end)(void *ctx, void *own);
    /* Called for each part when it and all before it are done, in their order, by one thread at a
     * time. What it does looks as if one thread had done all the work. May be NULL. */
    void (*finish)(void *ctx, uint32_t part);
};

/* How many processors this program may use, at most HS_TEAM_UNASKED_MAX. */
uint32_t hs_team_threads(void);

/* Do parts 0 .. count - 1 with at most so many threads, of which the caller is one. Threads that
 * cannot be had are done without. Returns 0 when all is done; -1 when there was no memory, and some
 * parts are not done. */
int hs_team_run(const struct hs_team *team, uint32_t count, uint32_t threads);

#endif
