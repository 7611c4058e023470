#include "storage.h"

#include "report.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* A loader that has switched over holds its lock for some milliseconds more. */
enum { LOCK_TRIES = 20, LOCK_REST_MS = 50 };

static char letter(int slot)
{
    return (char)('A' + slot);
}

static const char *slot_path(const struct config *c, int slot)
{
    return slot == 0 ? c->slot_a : c->slot_b;
}

static void judge(struct storage *d, const struct config *c)
{
    for (int i = 0; i < LM_SLOTS; i++) {
        const int cause = slot_path(c, i)[0] == '\0'
                              ? ENOENT
                              : slot_open(&d->slots[i], slot_path(c, i), SLOT_TO_READ);
        slot_judge(&d->slots[i], SLOT_TABLES, NULL, NULL);
        if (cause != 0 && cause != ENOENT) {
            report(REPORT_ERROR, "slot %c: %s: %s", letter(i), slot_path(c, i), strerror(cause));
        }
    }
}

static int lock(const struct slot *s)
{
    const struct timespec rest = {.tv_nsec = LOCK_REST_MS * 1000000L};
    int cause = slot_lock_to_fly(s);
    for (int i = 0; i < LOCK_TRIES && cause == EWOULDBLOCK; i++) {
        nanosleep(&rest, NULL);
        cause = slot_lock_to_fly(s);
    }
    return cause;
}

/* The newest whole slot that can be locked, or -1. What a loader did to it before the lock was ours
 * is seen by a second look. */
static int choose(struct storage *d)
{
    for (int chosen; (chosen = slot_choose(d->slots)) >= 0;) {
        struct slot *s = &d->slots[chosen];
        if (lock(s) != 0) {
            s->verdict = SLOT_CUT_OFF; /* being written */
            continue;
        }
        slot_judge(s, SLOT_TABLES, NULL, NULL);
        if (s->verdict == SLOT_WHOLE) {
            return chosen;
        }
    }
    return -1;
}

static void tell(const struct slot *s, int slot, int flown)
{
    switch (s->verdict) {
    case SLOT_WHOLE:
        report(REPORT_INFO, "slot %c: %s: load %" PRIu64 "%s", letter(slot), s->path,
               s->record.sequence, slot == flown ? ", flown" : " stands by");
        break;
    case SLOT_CUT_OFF:
        report(REPORT_WARNING,
               "slot %c: %s: not flown, a load has not come to its end; landmass-load put goes on "
               "with it",
               letter(slot), s->path);
        break;
    case SLOT_DAMAGED:
        report(REPORT_ERROR,
               "slot %c: %s: load %" PRIu64 " is not flown: offset 0x%" PRIx64
               ": %s; landmass-load put writes it again",
               letter(slot), s->path, s->record.sequence, s->fault.offset, s->fault.cause);
        break;
    default:
        break;
    }
}

/* A slot that is damaged had a database: what is flown instead is older, or none. */
static const char *trouble_of(const struct slot slots[LM_SLOTS])
{
    static const char *const words[] = {"slot A is damaged", "slot B is damaged",
                                        "both slots are damaged"};
    const bool first = slots[0].verdict == SLOT_DAMAGED, second = slots[1].verdict == SLOT_DAMAGED;
    return first && second ? words[2] : first ? words[0] : second ? words[1] : NULL;
}

/* An MTD device, or anything else that can be read like a file. NULL when neither can be opened. */
static const struct lm_flash *open_plain(struct storage *d, const char *path)
{
    int cause = drv_flash_mtd_open(&d->mtd, path);
    if (cause == 0) {
        report(REPORT_INFO, "%s: %u good erase blocks of %u bytes, %u bad ones", path,
               d->mtd.block_count, d->mtd.block_bytes, d->mtd.count.bad_blocks);
        return &d->mtd.port;
    }
    if (cause == ENOTTY) {
        cause = drv_flash_file_open(&d->file, path);
        if (cause == 0) {
            report(REPORT_INFO, "%s: flown, because no slot is whole", path);
            return &d->file.port;
        }
    }
    report(REPORT_ERROR,
           "no slot is whole, and %s: %s; landmass-load put FILE puts a database into a slot", path,
           strerror(cause));
    return NULL;
}

static bool has_damage(const struct slot slots[LM_SLOTS])
{
    return slots[0].verdict == SLOT_DAMAGED || slots[1].verdict == SLOT_DAMAGED;
}

/* The slot that stands in for a damaged one may have a lower serial number: its load was accepted
 * when it was newest, and the panel is not left without a database. */
static struct database judge_slot(const struct storage *d, const struct config *config, int slot,
                                  bool is_check)
{
    struct config c = *config;
    const bool stands_in = has_damage(d->slots);
    snprintf(c.database, sizeof c.database, "%s", slot_path(config, slot));
    c.database_older = stands_in ? 1 : config->database_older;
    return database_judge(&c, &d->slots[slot].port, is_check || stands_in, NULL);
}

/* The slot to fly, or -1. */
static int choose_accepted(struct storage *d, const struct config *config, bool is_check,
                           struct database *verdict)
{
    for (int chosen; (chosen = choose(d)) >= 0;) {
        *verdict = judge_slot(d, config, chosen, is_check);
        if (verdict->is_flown) {
            return chosen;
        }
        d->slots[chosen].verdict = SLOT_DAMAGED;
        snprintf(d->slots[chosen].fault.cause, sizeof d->slots[chosen].fault.cause,
                 "it is not accepted");
    }
    return -1;
}

const struct lm_flash *storage_open(struct storage *d, const struct config *config, bool is_check,
                                    struct database *verdict)
{
    d->file.descriptor = d->mtd.fd = -1;
    *verdict = (struct database){.is_flown = true};
    judge(d, config);
    const int flown = choose_accepted(d, config, is_check, verdict);
    d->flown = flown;
    for (int i = 0; i < LM_SLOTS; i++) {
        tell(&d->slots[i], i, flown);
        if (i != flown) {
            slot_close(&d->slots[i]);
        }
    }
    d->trouble = trouble_of(d->slots);
    d->path = flown >= 0 ? slot_path(config, flown) : config->database;
    if (flown >= 0) {
        return &d->slots[flown].port;
    }
    const struct lm_flash *plain = open_plain(d, d->path);
    if (plain != NULL) {
        *verdict = database_judge(config, plain, is_check, NULL);
    }
    return plain != NULL && verdict->is_flown ? plain : NULL;
}

struct lm_slots_state storage_state(const struct storage *d)
{
    struct lm_slots_state state = {.flown = d->flown + 1};
    for (int i = 0; i < LM_SLOTS; i++) {
        state.damaged |= (d->slots[i].verdict == SLOT_DAMAGED) << i;
        state.cut_off |= (d->slots[i].verdict == SLOT_CUT_OFF) << i;
    }
    return state;
}

void storage_close(struct storage *d)
{
    for (int i = 0; i < LM_SLOTS; i++) {
        slot_close(&d->slots[i]);
    }
    drv_flash_mtd_close(&d->mtd);
    if (d->file.descriptor >= 0) {
        drv_flash_file_close(&d->file);
    }
}

bool storage_check(const struct config *config)
{
    struct storage d = {.path = NULL};
    struct database verdict;
    (void)storage_open(&d, config, true, &verdict);
    storage_close(&d);
    return verdict.is_flown;
}
