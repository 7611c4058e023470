#include "lm/slot_flash.h"

#include "fx/crc32c.h"
#include "fx/mem.h"
#include "lm/image.h"

enum { RECORDS_BYTES = LM_SLOT_COPIES * LM_SLOT_RECORD_STEP };

/* Who looks at the slots. */
struct look {
    struct lm_slot_flash *f;
    struct lm_db *db;
    struct lm_image_header *header; /* at the start of the scratch memory */
    uint8_t *piece;                 /* the rest of it */
    uint32_t piece_bytes, poll_limit;
};

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    const struct lm_slot_flash *f = ctx;
    if (offset > f->port.size_bytes || length > f->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    return f->flash->read_start(f->flash->ctx, f->start + offset, destination, length);
}

static int read_poll(void *ctx)
{
    const struct lm_slot_flash *f = ctx;
    return f->flash->read_poll(f->flash->ctx);
}

static void set_port(struct lm_slot_flash *f, uint64_t start, uint64_t bytes)
{
    f->start = start;
    f->port = (struct lm_flash){
        .ctx = f, .size_bytes = bytes, .read_start = read_start, .read_poll = read_poll};
}

/* A whole number of erase blocks, so that the records begin with one. */
static uint64_t slot_bytes(const struct lm_flash *flash)
{
    return flash->size_bytes / LM_SLOTS & ~(uint64_t)(LM_SLOT_RECORD_STEP - 1);
}

/* The record that counts, or one of zeros. */
static struct lm_slot_record read_record(const struct look *l, uint32_t slot)
{
    struct lm_slot_record copies[LM_SLOT_COPIES];
    const struct lm_flash *flash = l->f->flash;
    const uint64_t at = (slot + 1) * slot_bytes(flash) - RECORDS_BYTES;
    for (uint32_t i = 0; i < LM_SLOT_COPIES; i++) {
        if (lm_db_read(flash, at + (uint64_t)i * LM_SLOT_RECORD_STEP, &copies[i], sizeof copies[i],
                       l->poll_limit) != LM_OK) {
            copies[i] = (struct lm_slot_record){.version = 0};
        }
    }
    const struct lm_slot_record *found = lm_slot_of(copies);
    return found ? *found : (struct lm_slot_record){.version = 0};
}

/* By the record alone. One that is whole has the number of a load. */
static enum lm_slot_verdict verdict_of(const struct lm_slot_record *record)
{
    if (record->state != LM_SLOT_WHOLE) {
        return record->state == 0 ? LM_SLOT_EMPTY : LM_SLOT_CUT_OFF;
    }
    return record->sequence == 0 ? LM_SLOT_DAMAGED : LM_SLOT_STANDS_BY;
}

/* lm_db_open has not looked at the place of those that it does not use. */
static bool section_fits(const struct look *l, const struct lm_image_section *s)
{
    const struct lm_flash *port = &l->f->port;
    uint32_t crc = 0;
    if (s->offset > port->size_bytes || s->bytes > port->size_bytes - s->offset) {
        return false;
    }
    for (uint32_t at = 0; at < (uint32_t)s->bytes;) {
        const uint32_t left = (uint32_t)s->bytes - at;
        const uint32_t length = left < l->piece_bytes ? left : l->piece_bytes;
        if (lm_db_read(port, s->offset + at, l->piece, length, l->poll_limit) != LM_OK) {
            return false;
        }
        crc = fx_crc32c(crc, l->piece, length);
        at += length;
    }
    return crc == s->crc;
}

static bool sections_fit(const struct look *l)
{
    const struct lm_image_header *h = l->header;
    uint32_t room = LM_SLOT_CHECKED_BYTES;
    for (uint32_t i = 0; i < h->section_count && i < LM_IMAGE_SECTIONS_MAX; i++) {
        if (h->sections[i].bytes > room) {
            continue;
        }
        room -= (uint32_t)h->sections[i].bytes;
        if (!section_fits(l, &h->sections[i])) {
            return false;
        }
    }
    return true;
}

/* Leaves the port at the slot's image. */
static bool verifies(const struct look *l, uint32_t slot, const struct lm_slot_record *record)
{
    const uint64_t bytes = slot_bytes(l->f->flash);
    if (record->image_bytes > bytes - RECORDS_BYTES) {
        return false;
    }
    set_port(l->f, slot * bytes, record->image_bytes);
    return lm_db_open(l->db, &l->f->port, l->poll_limit) == LM_OK &&
           lm_db_read(&l->f->port, 0, l->header, sizeof *l->header, l->poll_limit) == LM_OK &&
           l->header->crc == record->image_crc && l->header->image_bytes == record->image_bytes &&
           sections_fit(l);
}

/* The later slot that verifies is flown. */
static bool choose(const struct look *l, const struct lm_slot_record records[LM_SLOTS])
{
    const struct lm_slot_record *left[LM_SLOTS] = {&records[0], &records[1]};
    struct lm_slot_flash *f = l->f;
    for (uint32_t tries = 0; tries < LM_SLOTS; tries++) {
        const int next = lm_slot_later(left[0], left[1]);
        if (next < 0) {
            break;
        }
        if (verifies(l, (uint32_t)next, left[next])) {
            f->slot[next].verdict = LM_SLOT_FLOWN;
            return true;
        }
        f->slot[next].verdict = LM_SLOT_DAMAGED;
        left[next] = NULL;
    }
    return false;
}

void lm_slot_flash_open(struct lm_slot_flash *f, const struct lm_flash *flash, struct lm_db *db,
                        void *scratch, uint32_t scratch_bytes, uint32_t poll_limit)
{
    const struct look l = {.f = f,
                           .db = db,
                           .header = scratch,
                           .piece = (uint8_t *)scratch + sizeof *l.header,
                           .piece_bytes = scratch_bytes - (uint32_t)sizeof *l.header,
                           .poll_limit = poll_limit};
    struct lm_slot_record records[LM_SLOTS];
    *f = (struct lm_slot_flash){.flash = flash};
    set_port(f, 0, flash->size_bytes);
    if (slot_bytes(flash) <= RECORDS_BYTES) {
        return;
    }
    for (uint32_t i = 0; i < LM_SLOTS; i++) {
        records[i] = read_record(&l, i);
        f->slot[i].sequence = records[i].state == LM_SLOT_WHOLE ? records[i].sequence : 0;
        f->slot[i].verdict = verdict_of(&records[i]);
    }
    if (!choose(&l, records)) {
        set_port(f, 0, f->slot[0].verdict == LM_SLOT_EMPTY ? flash->size_bytes : 0);
    }
}
