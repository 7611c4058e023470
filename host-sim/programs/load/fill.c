/* An image into the slot that is not flown, wherever the image comes from. */
#include "commands.h"

#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/report.h"
#include "lm/image.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void load_bar_move(struct load_bar *b, const char *label, uint64_t done, uint64_t total)
{
    if (b->label != label) {
        hs_progress_end(&b->bar);
        hs_progress_begin(&b->bar, label, total);
        b->label = label;
    }
    hs_progress_update(&b->bar, done);
}

void load_bar_end(struct load_bar *b)
{
    if (b->label) {
        hs_progress_end(&b->bar);
    }
    b->label = NULL;
}

/* Writing is the first half of what a panel shows, checking the second. */
static void tell(struct load *l, int32_t half, uint64_t done, uint64_t total)
{
    slot_teller_run(&l->teller, half + (total == 0 ? 0 : (int32_t)(done * 49 / total)));
}

static void writing(void *ctx, uint64_t done, uint64_t total)
{
    struct load *l = ctx;
    load_bar_move(&l->bar, "writing", done, total);
    tell(l, 0, done, total);
}

static void checking_slot(void *ctx, uint64_t done, uint64_t total)
{
    struct load *l = ctx;
    load_bar_move(&l->bar, "checking the slot", done, total);
    tell(l, 50, done, total);
    if (l->checking) {
        l->checking(l->ctx, done, total);
    }
}

/* Does this slot hold the image? */
static bool is_there(struct load *l, const struct slot *s)
{
    struct lm_image_header wanted, there;
    return s->verdict == SLOT_WHOLE &&
           lm_db_read(l->source, 0, &wanted, sizeof wanted, 1) == LM_OK &&
           s->medium.read(s->medium.ctx, 0, &there, sizeof there) == 0 &&
           memcmp(&wanted, &there, sizeof wanted) == 0;
}

/* The slot to write, or -1 with the error reported. The other one is whole then, or this one is
 * not: there is a database to fly whatever happens. */
static int pick(struct load *l)
{
    const int next = slot_choose(l->slots);
    const bool used[LM_SLOTS] = {slot_is_in_use(&l->slots[0]), slot_is_in_use(&l->slots[1])};
    int target = next >= 0 ? next ^ 1 : l->slots[1].verdict == SLOT_CUT_OFF;
    if (used[target] && next >= 0 && !used[next] && l->slots[target].verdict == SLOT_WHOLE) {
        target = next; /* the panel still flies the one before */
    }
    if (used[target]) {
        return hs_error(l->places.path[target],
                        "wait for the other landmass-load, or restart the panel",
                        "slot %c is in use", load_letter(target));
    }
    if (l->slots[target].verdict == SLOT_WHOLE && l->slots[target ^ 1].verdict != SLOT_WHOLE) {
        return hs_error(l->places.path[target ^ 1], "restart the panel, and it flies the other one",
                        "slot %c is flown and is no longer whole; the only whole slot is not "
                        "written",
                        load_letter(target ^ 1));
    }
    return target;
}

static int open_target(struct load *l, int target)
{
    struct slot *s = &l->slots[target];
    const char *path = l->places.path[target];
    if (hs_input_is(path)) {
        return hs_error(path, "name another file", "is the slot itself");
    }
    slot_close(s);
    int cause = load_open(s, &l->places, target, SLOT_TO_WRITE);
    if (cause == 0) {
        cause = slot_lock_to_write(s);
    }
    if (cause != 0) {
        return hs_error(path,
                        cause == EWOULDBLOCK ? "wait for the other landmass-load"
                        : cause == EACCES    ? "run it as root or as the panel's user"
                        : l->places.chip_mib ? "name a file of the length of --chip, or a new one"
                                             : "check the option slot.a or slot.b",
                        "slot %c cannot be written: %s", load_letter(target), strerror(cause));
    }
    slot_judge(s, SLOT_TABLES, NULL, NULL);
    return 0;
}

static int fail(const struct load *l, int target)
{
    const char *why = l->why ? l->why(l->ctx) : NULL;
    if (why) {
        return hs_error(l->name, "the other slot is flown as before; run it again to go on", "%s",
                        why);
    }
    return hs_error(l->slots[target].path,
                    "the other slot is flown as before; run it again to go on",
                    "slot %c: offset 0x%" PRIx64 ": %s", load_letter(target), l->load.fault.offset,
                    l->load.fault.cause);
}

/* Write the slot and switch to it. */
static int fill(struct load *l, int target)
{
    struct slot *s = &l->slots[target];
    int result = slot_fill(s, l->source, writing, checking_slot, l, &l->load);
    load_bar_end(&l->bar);
    if (result == 0 && load_accept(&l->places.places, s->path, &s->port, LOAD_FULL) != 0) {
        return -1;
    }
    if (result == 0) {
        result = slot_switch(s, &l->slots[target ^ 1], &l->load);
    }
    return result == 0 ? 0 : fail(l, target);
}

int load_run(struct load *l)
{
    const int next = slot_choose(l->slots);
    l->load = (struct slot_load){0};
    l->is_there = next >= 0 && is_there(l, &l->slots[next]);
    l->slot = l->is_there ? next : pick(l);
    if (l->is_there) {
        return 0;
    }
    if (l->slot < 0 || open_target(l, l->slot) != 0) {
        return -1;
    }
    if (l->opened) {
        l->opened(l->ctx, &l->slots[l->slot]);
    }
    slot_teller_open(&l->teller, l->places.chip_mib != 0 ? "" : l->places.places.progress);
    const int result = fill(l, l->slot);
    slot_teller_end(&l->teller, result == 0 ? LM_LOAD_DONE : LM_LOAD_FAILED);
    return result;
}

void load_report(const struct load *l)
{
    const struct slot *s = &l->slots[l->slot];
    if (l->is_there) {
        printf("slot %c holds this database already\n", load_letter(l->slot));
    } else {
        printf("slot %c: load %" PRIu64 ", %" PRIu64 " bytes written, %" PRIu64
               " were there; every record was read back and is right\n",
               load_letter(l->slot), s->record.sequence, l->load.written_bytes, l->load.kept_bytes);
        printf("%s%s\n",
               l->places.chip_mib ? "write it to its chip: " : "flown from the next start on: ",
               l->places.chip_mib ? s->path : "systemctl restart landmass-panel");
    }
    hs_report_text("slot", s->path);
    hs_report_count("load", s->record.sequence);
    hs_report_count("image_bytes", s->record.image_bytes);
    if (!l->is_there) {
        hs_report_count("written_bytes", l->load.written_bytes);
        hs_report_count("kept_bytes", l->load.kept_bytes);
        hs_report_count("bad_blocks", l->load.bad_blocks);
    }
    hs_report_flag("is_there_already", l->is_there);
}
