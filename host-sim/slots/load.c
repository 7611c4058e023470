#include "slots/load.h"

#include "lm/image.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    BAD_BLOCKS_MAX = 64,  /* that may fail in one load: a device with more is worn out */
    SYNC_BYTES = 4 << 20, /* written between two syncs, so that none of them takes long */
    POLLS = 1000000
};

struct fill {
    struct slot *to;
    const struct lm_flash *source;
    struct lm_image_header header;
    slot_progress *progress;
    void *ctx;
    struct slot_load *load;
    uint8_t *wanted, *there; /* a piece of the image, and what the slot has in its place */
};

static int fail(struct slot_load *load, uint64_t offset, const char *what, int cause)
{
    load->fault.offset = offset;
    snprintf(load->fault.cause, sizeof load->fault.cause, "%s: %s", what, strerror(cause));
    return cause;
}

/* From here on the slot is not flown. */
static int begin(struct fill *f)
{
    struct slot_medium *m = &f->to->medium;
    const struct lm_slot_record record = {
        .state = LM_SLOT_LOADING, .image_bytes = f->header.image_bytes, .image_crc = f->header.crc};
    const int cause = slot_write_record(f->to, record);
    if (cause != 0) {
        return fail(f->load, 0, "the slot's record cannot be written", cause);
    }
    const int no_room = m->resize(m->ctx, f->header.image_bytes);
    return no_room == 0 ? 0 : fail(f->load, f->header.image_bytes, "no room in the slot", no_room);
}

static int write_piece(struct fill *f, uint64_t at, uint32_t length)
{
    const struct slot_medium *m = &f->to->medium;
    if (lm_db_read(f->source, at, f->wanted, length, POLLS) != LM_OK) {
        return fail(f->load, at, "the image", EIO);
    }
    if (m->read(m->ctx, at, f->there, length) == 0 && memcmp(f->wanted, f->there, length) == 0) {
        f->load->kept_bytes += length;
        return 0;
    }
    const int cause = m->write(m->ctx, at, f->wanted, length);
    f->load->written_bytes += length;
    return cause == 0 ? 0 : fail(f->load, at, "the slot cannot be written", cause);
}

static int write_all(struct fill *f)
{
    const struct slot_medium *m = &f->to->medium;
    const uint64_t all = f->header.image_bytes;
    uint64_t synced = 0;
    for (uint64_t at = 0; at < all;) {
        const uint64_t left = all - at;
        const uint32_t length = left < m->unit_bytes ? (uint32_t)left : m->unit_bytes;
        int cause = write_piece(f, at, length);
        at += length;
        if (cause == 0 && (at - synced >= SYNC_BYTES || at == all)) {
            cause = m->sync(m->ctx);
            synced = at;
            cause = cause == 0 ? 0 : fail(f->load, at, "the slot cannot be written", cause);
        }
        if (cause != 0) {
            return cause;
        }
        if (f->progress) {
            f->progress(f->ctx, at, all);
        }
    }
    return 0;
}

/* Begin again when a block has become bad: what lay behind it has moved. */
static int write_until_good(struct fill *f)
{
    int cause = EAGAIN;
    for (uint32_t i = 0; i < BAD_BLOCKS_MAX && cause == EAGAIN; i++) {
        cause = begin(f);
        if (cause == 0) {
            cause = write_all(f);
        }
        f->load->bad_blocks += cause == EAGAIN;
    }
    return cause == 0 ? 0 : -1;
}

/* By the firmware's reader, from the medium. */
static int read_back(struct fill *f, slot_progress *checking)
{
    struct lm_image_header header;
    struct slot *to = f->to;
    to->medium.forget(to->medium.ctx);
    slot_set_port(to, f->header.image_bytes);
    if (lm_db_read(&to->port, 0, &header, sizeof header, POLLS) != LM_OK ||
        memcmp(&header, &f->header, sizeof header) != 0) {
        return fail(f->load, 0, "the slot does not hold what was written", EIO);
    }
    return slot_check(&to->port, SLOT_RECORDS, checking, f->ctx, &f->load->fault);
}

int slot_fill(struct slot *to, const struct lm_flash *source, slot_progress *writing,
              slot_progress *checking, void *ctx, struct slot_load *load)
{
    struct fill f = {.to = to, .source = source, .progress = writing, .ctx = ctx, .load = load};
    *load = (struct slot_load){0};
    if (lm_db_read(source, 0, &f.header, sizeof f.header, POLLS) != LM_OK ||
        f.header.image_bytes > source->size_bytes) {
        fail(load, 0, "the image", EIO);
        return -1;
    }
    f.wanted = malloc(to->medium.unit_bytes);
    f.there = malloc(to->medium.unit_bytes);
    int result = -1;
    if (!f.wanted || !f.there) {
        fail(load, 0, "the load", ENOMEM);
    } else if (write_until_good(&f) == 0) {
        result = read_back(&f, checking) == 0 ? 0 : -1;
    }
    free(f.wanted);
    free(f.there);
    return result;
}

int slot_switch(struct slot *to, const struct slot *other, struct slot_load *load)
{
    struct lm_slot_record record = to->record;
    record.state = LM_SLOT_WHOLE;
    record.sequence = other->record.sequence + 1;
    const int cause = slot_write_record(to, record);
    return cause == 0 ? 0 : (fail(load, 0, "the slot's record cannot be written", cause), -1);
}
