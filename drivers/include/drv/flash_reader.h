/* Flash reader: a flash that never makes the loop wait. A thread reads from another flash, whose
 * reads may wait. Nothing is allocated after the start, and the loop takes no lock. */
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

    /* Longest time that read_poll waits for the read: 0 in a loop. At the start, when there is
     * nothing else to do, waiting replaces a million polls. */
    uint32_t patience_us;

    const struct lm_flash *slow; /* borrowed; only the thread uses it */
    pthread_t thread;
    bool has_thread;
    sem_t asked;
    atomic_int status; /* of the read: LM_BUSY while the thread has it, else its result */
    atomic_bool is_over;
    uint64_t offset;   /* the read that was asked for */
    void *destination; /* borrowed until the read is over */
    uint32_t length;   /* bytes */

    struct {
        atomic_uint reads;
        atomic_uint again;  /* reads that failed once and were tried again */
        atomic_uint failed; /* reads that failed twice */
    } count;
};

/* Start the thread. Returns 0 or an errno. `slow` is borrowed until drv_flash_reader_stop. */
int drv_flash_reader_start(struct drv_flash_reader *r, const struct lm_flash *slow);

/* End the thread after its present read. Safe if the start failed, and on all zero. */
void drv_flash_reader_stop(struct drv_flash_reader *r);

#endif
