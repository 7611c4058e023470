#include "power.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { RECORDS = LM_SLOT_COPIES * POWER_SECTOR, UNIT = 4096 };

uint32_t power_draw(struct power *p, uint32_t below)
{
    p->random ^= p->random << 13;
    p->random ^= p->random >> 7;
    p->random ^= p->random << 17;
    return (uint32_t)((p->random >> 16) % below);
}

/* EIO from the moment at which power fails. */
static int operate(struct power *p)
{
    p->operations++;
    if (p->operations == p->cut_at) {
        p->is_out = true;
    }
    return p->is_out ? EIO : 0;
}

/* The operation in which power fails is under way: its sectors are pending like those before. */
static int write_bytes(struct power_medium *m, uint64_t at, const void *from, uint32_t length)
{
    const uint8_t *bytes = from;
    if (m->power->is_out) {
        return EIO;
    }
    const int cause = operate(m->power);
    memcpy(m->seen + at, bytes, length);
    for (uint32_t done = 0; done < length;) {
        const uint32_t left = length - done;
        struct power_write *w = &m->pending[m->pending_count];
        if (m->pending_count++ >= POWER_PENDING) {
            abort();
        }
        w->at = (uint32_t)at + done;
        w->length = left < POWER_SECTOR ? left : POWER_SECTOR;
        memcpy(w->bytes, bytes + done, w->length);
        done += w->length;
    }
    return cause;
}

static int read_image(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    const struct power_medium *m = ctx;
    if (m->power->is_out || offset > m->seen_bytes || length > m->seen_bytes - offset) {
        return EIO;
    }
    memcpy(to, m->seen + RECORDS + offset, length);
    return 0;
}

static int write_image(void *ctx, uint64_t offset, const void *from, uint32_t length)
{
    return write_bytes(ctx, RECORDS + offset, from, length);
}

static int read_record(void *ctx, uint32_t copy, struct lm_slot_record *record)
{
    const struct power_medium *m = ctx;
    memcpy(record, m->seen + (size_t)copy * POWER_SECTOR, sizeof *record);
    return m->power->is_out ? EIO : 0;
}

static int write_record(void *ctx, uint32_t copy, const struct lm_slot_record *record)
{
    uint8_t sector[POWER_SECTOR] = {0};
    memcpy(sector, record, sizeof *record);
    return write_bytes(ctx, (uint64_t)copy * POWER_SECTOR, sector, sizeof sector);
}

static int resize(void *ctx, uint64_t bytes)
{
    struct power_medium *m = ctx;
    if (m->power->is_out || bytes > POWER_ROOM - RECORDS) {
        return m->power->is_out ? EIO : ENOSPC;
    }
    m->seen_bytes = bytes;
    return operate(m->power);
}

static int sync_all(void *ctx)
{
    struct power_medium *m = ctx;
    const int cause = operate(m->power);
    if (cause == 0 && !m->power->ignores_sync) {
        memcpy(m->kept, m->seen, sizeof m->kept);
        m->kept_bytes = m->seen_bytes;
        m->pending_count = 0;
    }
    return cause;
}

static void nothing(void *ctx)
{
    (void)ctx;
}

struct slot_medium power_medium(struct power_medium *m, struct power *power)
{
    m->power = power;
    return (struct slot_medium){.ctx = m,
                                .unit_bytes = UNIT,
                                .room_bytes = POWER_ROOM - RECORDS,
                                .read = read_image,
                                .write = write_image,
                                .read_record = read_record,
                                .write_record = write_record,
                                .resize = resize,
                                .sync = sync_all,
                                .forget = nothing,
                                .close = nothing};
}

/* One sector reaches the medium, or a part of it. */
static void land(struct power_medium *m, const struct power_write *w, bool is_torn)
{
    const uint32_t whole = is_torn ? power_draw(m->power, w->length) : w->length;
    memcpy(m->kept + w->at, w->bytes, whole);
    if (is_torn && power_draw(m->power, 2) == 0) {
        for (uint32_t i = whole; i < w->length; i++) {
            m->kept[w->at + i] = (uint8_t)power_draw(m->power, 256);
        }
    }
}

void power_restore(struct power_medium *m)
{
    struct power *p = m->power;
    const uint32_t lost = power_draw(p, 101); /* per cent of the sectors */
    const bool is_first_kept = power_draw(p, 4) == 0;
    for (uint32_t left = m->pending_count; left > 0; left--) {
        const uint32_t i = is_first_kept ? 0 : power_draw(p, left);
        if (power_draw(p, 100) >= lost) {
            land(m, &m->pending[i], power_draw(p, 8) == 0);
        }
        m->pending[i] = m->pending[left - 1];
    }
    if (power_draw(p, 2) == 0) {
        m->kept_bytes = m->seen_bytes;
    }
    memcpy(m->seen, m->kept, sizeof m->seen);
    m->seen_bytes = m->kept_bytes;
    m->pending_count = 0;
}
