/* A flash that never makes the loop wait: a thread reads from another flash that may.
 * It is started once; afterwards nothing is allocated, and the loop takes no lock. */
#ifndef DRV_FLASH_READER_H
#define DRV_FLASH_READER_H

#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

struct drv_flash_reader {
    struct lm_flash port; /* its ctx is this struct, which must not move */

    /* How long read_poll may wait for the read under way: 0 in a loop. At the start, when nothing
     * else is to be done, waiting saves asking a million times. */
    uint32_t patience_us;

    const struct lm_flash *slow; /* borrowed; only the thread uses it */
    pthread_t thread;
    bool has_thread;
    sem_t asked;
    atomic_int status; /* LM_BUSY while the thread has it, or its result */
    atomic_bool is_over;
    uint64_t offset; /* the read that was asked for */
    void *destination;
    uint32_t length;

    struct {
        atomic_uint reads;
        atomic_uint again;  /* reads that failed and were tried a second time */
        atomic_uint failed; /* and failed again */
    } count;
};

/* Start the thread. 0 or an errno. `slow` is borrowed until drv_flash_reader_stop. */
int drv_flash_reader_start(struct drv_flash_reader *r, const struct lm_flash *slow);

/* End the thread, after the read under way. Safe when start failed, or on all zero. */
void drv_flash_reader_stop(struct drv_flash_reader *r);

#endif
