#include "memory_flash.h"

#include <string.h>

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct memory_flash *f = ctx;
    if (offset > f->port.size_bytes || length > f->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    f->reads++;
    f->now.offset = offset;
    f->now.to = destination;
    f->now.length = length;
    f->now.polls_left = f->busy_polls;
    f->now.is_failing =
        f->reads == f->fail_read || (f->fail_every && f->reads % f->fail_every == 0);
    return LM_OK;
}

static int read_poll(void *ctx)
{
    struct memory_flash *f = ctx;
    if (f->now.polls_left > 0) {
        f->now.polls_left--;
        memset(f->now.to, 0xA5, f->now.length / 2);
        return LM_BUSY;
    }
    if (f->now.is_failing) {
        memset(f->now.to, 0x5A, f->now.length / 2);
        return LM_ERR_IO;
    }
    const uint8_t *from = (const uint8_t *)((uintptr_t)f->bytes + (uintptr_t)f->now.offset);
    if (f->fetch) {
        return f->fetch(f->now.to, from, f->now.length) ? LM_OK : LM_ERR_IO;
    }
    memcpy(f->now.to, from, f->now.length);
    return LM_OK;
}

void memory_flash_open(struct memory_flash *f, const uint8_t *bytes, size_t size)
{
    memset(f, 0, sizeof *f);
    f->bytes = bytes;
    f->port = (struct lm_flash){
        .ctx = f, .size_bytes = size, .read_start = read_start, .read_poll = read_poll};
}
