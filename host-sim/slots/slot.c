#include "slots/slot.h"

#include "lm/image.h"
#include "media.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct slot *s = ctx;
    if (offset > s->port.size_bytes || length > s->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    const int cause = s->medium.read(s->medium.ctx, offset, destination, length);
    s->last_status = cause == 0 ? LM_OK : LM_ERR_IO;
    return LM_OK;
}

static int read_poll(void *ctx)
{
    const struct slot *s = ctx;
    return s->last_status;
}

void slot_set_port(struct slot *s, uint64_t image_bytes)
{
    s->port = (struct lm_flash){
        .ctx = s, .size_bytes = image_bytes, .read_start = read_start, .read_poll = read_poll};
}

void slot_lend(struct slot *s, const char *path, const struct slot_medium *medium)
{
    *s = (struct slot){.path = path, .medium = *medium, .is_open = true, .fd = -1};
}

static int say_absent(struct slot *s, int cause)
{
    snprintf(s->fault.cause, sizeof s->fault.cause, "%s", strerror(cause));
    return cause;
}

int slot_open(struct slot *s, const char *path, enum slot_use use)
{
    *s = (struct slot){.path = path, .fd = -1};
    int cause = slot_medium_mtd(&s->medium, path, use, &s->fd);
    /* ENOENT: a file that is to be made. */
    if (cause == ENOTTY || cause == ENOENT) {
        cause = slot_medium_file(&s->medium, path, 0, use, &s->fd);
    }
    s->is_open = cause == 0;
    return cause == 0 ? 0 : say_absent(s, cause);
}

int slot_open_chip(struct slot *s, const char *path, uint64_t chip_bytes, enum slot_use use)
{
    *s = (struct slot){.path = path, .fd = -1};
    const int cause = slot_medium_file(&s->medium, path, chip_bytes, use, &s->fd);
    s->is_open = cause == 0;
    return cause == 0 ? 0 : say_absent(s, cause);
}

static int find_record(struct slot *s)
{
    struct lm_slot_record copies[LM_SLOT_COPIES];
    for (uint32_t i = 0; i < LM_SLOT_COPIES; i++) {
        if (s->medium.read_record(s->medium.ctx, i, &copies[i]) != 0) {
            copies[i] = (struct lm_slot_record){0};
        }
    }
    const struct lm_slot_record *found = lm_slot_of(copies);
    s->record = found ? *found : (struct lm_slot_record){0};
    return found ? 0 : -1;
}

/* Is the image that lies there the one that the record was written for? */
static int check_identity(struct slot *s)
{
    struct lm_image_header header;
    if (s->medium.read(s->medium.ctx, 0, &header, sizeof header) != 0) {
        snprintf(s->fault.cause, sizeof s->fault.cause, "the header cannot be read");
        return -1;
    }
    if (header.crc != s->record.image_crc || header.image_bytes != s->record.image_bytes) {
        snprintf(s->fault.cause, sizeof s->fault.cause,
                 "it holds another image than its record says");
        return -1;
    }
    return 0;
}

void slot_judge(struct slot *s, enum slot_depth depth, slot_progress *progress, void *ctx)
{
    if (!s->is_open) {
        s->verdict = SLOT_ABSENT;
        return;
    }
    s->fault = (struct slot_fault){0};
    if (find_record(s) != 0) {
        s->verdict = SLOT_EMPTY;
        return;
    }
    if (s->record.state != LM_SLOT_WHOLE) {
        s->verdict = SLOT_CUT_OFF;
        return;
    }
    slot_set_port(s, s->record.image_bytes);
    const bool is_whole =
        check_identity(s) == 0 && slot_check(&s->port, depth, progress, ctx, &s->fault) == 0;
    s->verdict = is_whole ? SLOT_WHOLE : SLOT_DAMAGED;
}

int slot_choose(const struct slot slots[LM_SLOTS])
{
    return lm_slot_later(slots[0].verdict == SLOT_WHOLE ? &slots[0].record : NULL,
                         slots[1].verdict == SLOT_WHOLE ? &slots[1].record : NULL);
}

int slot_write_record(struct slot *s, struct lm_slot_record record)
{
    record.generation = s->record.generation + 1;
    lm_slot_seal(&record);
    for (uint32_t i = 0; i < LM_SLOT_COPIES; i++) {
        int cause = s->medium.write_record(s->medium.ctx, i, &record);
        if (cause == 0) {
            cause = s->medium.sync(s->medium.ctx);
        }
        if (cause != 0) {
            return cause;
        }
        s->record = record;
    }
    return 0;
}

static int lock(const struct slot *s, int how)
{
    return s->fd < 0 || flock(s->fd, how | LOCK_NB) == 0 ? 0 : errno;
}

int slot_lock_to_fly(const struct slot *s)
{
    return lock(s, LOCK_SH);
}

int slot_lock_to_write(const struct slot *s)
{
    return lock(s, LOCK_EX);
}

bool slot_is_in_use(const struct slot *s)
{
    if (!s->is_open || s->fd < 0) {
        return false;
    }
    const bool is_free = flock(s->fd, LOCK_EX | LOCK_NB) == 0;
    if (is_free) {
        (void)flock(s->fd, LOCK_UN); /* or a panel that starts now could not fly it */
    }
    return !is_free;
}

const char *slot_word(enum slot_verdict verdict)
{
    static const char *const words[] = {[SLOT_ABSENT] = "absent",
                                        [SLOT_EMPTY] = "empty",
                                        [SLOT_CUT_OFF] = "cut off",
                                        [SLOT_DAMAGED] = "damaged",
                                        [SLOT_WHOLE] = "whole"};
    return words[verdict];
}

void slot_close(struct slot *s)
{
    if (s->is_open) {
        s->medium.close(s->medium.ctx);
        s->is_open = false;
    }
}
