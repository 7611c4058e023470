#include "drv/flash_reader.h"

#include <errno.h>
#include <string.h>
#include <time.h>

enum { PATIENCE_STEP_US = 50, STACK_BYTES = 64 << 10 };

static void rest(uint32_t us)
{
    const struct timespec t = {.tv_sec = us / 1000000, .tv_nsec = (long)(us % 1000000) * 1000};
    nanosleep(&t, NULL);
}

/* The thread may wait for the flash; nobody waits for the thread. */
static int read_slowly(const struct drv_flash_reader *r)
{
    const int started = r->slow->read_start(r->slow->ctx, r->offset, r->destination, r->length);
    if (started != LM_OK) {
        return started;
    }
    int status;
    while ((status = r->slow->read_poll(r->slow->ctx)) == LM_BUSY) {
        rest(PATIENCE_STEP_US);
    }
    return status;
}

static void *run(void *argument)
{
    struct drv_flash_reader *r = argument;
    for (;;) {
        while (sem_wait(&r->asked) != 0) {
        }
        if (atomic_load(&r->is_over)) {
            return NULL;
        }
        int status = read_slowly(r);
        atomic_fetch_add(&r->count.reads, 1);
        if (status != LM_OK) {
            atomic_fetch_add(&r->count.again, 1);
            status = read_slowly(r);
        }
        atomic_fetch_add(&r->count.failed, status != LM_OK);
        atomic_store(&r->status, status == LM_OK ? LM_OK : LM_ERR_IO);
    }
}

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct drv_flash_reader *r = ctx;
    if (offset > r->port.size_bytes || length > r->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    if (atomic_load(&r->status) == LM_BUSY) {
        return LM_ERR_IO;
    }
    r->offset = offset;
    r->destination = destination;
    r->length = length;
    atomic_store(&r->status, LM_BUSY);
    sem_post(&r->asked);
    return LM_OK;
}

static int read_poll(void *ctx)
{
    const struct drv_flash_reader *r = ctx;
    for (uint32_t us = 0; us < r->patience_us && atomic_load(&r->status) == LM_BUSY;
         us += PATIENCE_STEP_US) {
        rest(PATIENCE_STEP_US);
    }
    return atomic_load(&r->status);
}

int drv_flash_reader_start(struct drv_flash_reader *r, const struct lm_flash *slow)
{
    memset(r, 0, sizeof *r);
    r->slow = slow;
    r->port = (struct lm_flash){
        .ctx = r, .size_bytes = slow->size_bytes, .read_start = read_start, .read_poll = read_poll};
    if (sem_init(&r->asked, 0, 0) != 0) {
        return errno;
    }
    pthread_attr_t attributes;
    int cause = pthread_attr_init(&attributes);
    if (cause == 0) {
        pthread_attr_setstacksize(&attributes, STACK_BYTES);
        cause = pthread_create(&r->thread, &attributes, run, r);
        pthread_attr_destroy(&attributes);
    }
    r->has_thread = cause == 0;
    if (cause != 0) {
        sem_destroy(&r->asked);
    }
    return cause;
}

void drv_flash_reader_stop(struct drv_flash_reader *r)
{
    if (r->has_thread) {
        atomic_store(&r->is_over, true);
        sem_post(&r->asked);
        pthread_join(r->thread, NULL);
        sem_destroy(&r->asked);
        r->has_thread = false;
    }
}
