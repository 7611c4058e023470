/* A database into the slot that is not flown. */
#include "commands.h"

#include "drv/flash_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/options.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "lm/image.h"
#include "slots/load.h"
#include "slots/progress.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char stick_name[] = "landmass.lmdb";

struct put {
    const char *file;
    char in_folder[PATH_MAX];
    struct load_places places;
    struct drv_flash_file source;
    struct slot slots[LM_SLOTS];
    struct hs_progress bar;
    struct slot_teller teller;
    const char *label; /* of the bar */
    const char *key;   /* options; NULL: of the configuration */
    bool is_any, is_older;
};

static void move_bar(struct put *p, const char *label, uint64_t done, uint64_t total)
{
    if (p->label != label) {
        hs_progress_end(&p->bar);
        hs_progress_begin(&p->bar, label, total);
        p->label = label;
    }
    hs_progress_update(&p->bar, done);
}

/* Writing is the first half of what a panel shows, checking the second. */
static void tell(struct put *p, int32_t half, uint64_t done, uint64_t total)
{
    slot_teller_run(&p->teller, half + (total == 0 ? 0 : (int32_t)(done * 49 / total)));
}

static void checking_file(void *ctx, uint64_t done, uint64_t total)
{
    move_bar(ctx, "checking the file", done, total);
}

static void writing(void *ctx, uint64_t done, uint64_t total)
{
    move_bar(ctx, "writing", done, total);
    tell(ctx, 0, done, total);
}

static void checking_slot(void *ctx, uint64_t done, uint64_t total)
{
    move_bar(ctx, "checking the slot", done, total);
    tell(ctx, 50, done, total);
}

static int open_file(struct put *p)
{
    struct stat about;
    if (stat(p->file, &about) == 0 && S_ISDIR(about.st_mode)) {
        if (snprintf(p->in_folder, sizeof p->in_folder, "%s/%s", p->file, stick_name) >=
            (int)sizeof p->in_folder) {
            return hs_error(p->file, "choose a shorter one", "the path is too long");
        }
        p->file = p->in_folder;
    }
    const int cause = drv_flash_file_open(&p->source, p->file);
    if (cause != 0) {
        return hs_error(p->file, "check the name", "cannot be read: %s", strerror(cause));
    }
    hs_input_note(p->file);
    return 0;
}

static int check_file(struct put *p)
{
    struct slot_fault fault;
    const int result = slot_check(&p->source.port, SLOT_RECORDS, checking_file, p, &fault);
    hs_progress_end(&p->bar);
    return result == 0 ? 0
                       : hs_error(p->file,
                                  "nothing was written; `landmass-db verify` lists what is wrong, "
                                  "`landmass-db build` makes it again",
                                  "offset 0x%" PRIx64 ": %s", fault.offset, fault.cause);
}

/* Does this slot hold the image of the file? */
static bool is_there(struct put *p, const struct slot *s)
{
    struct lm_image_header wanted, there;
    return s->verdict == SLOT_WHOLE &&
           lm_db_read(&p->source.port, 0, &wanted, sizeof wanted, 1) == LM_OK &&
           s->medium.read(s->medium.ctx, 0, &there, sizeof there) == 0 &&
           memcmp(&wanted, &there, sizeof wanted) == 0;
}

/* The slot to write, or -1 with the error reported. The other one is whole then, or this one is
 * not: there is a database to fly whatever happens. */
static int pick(struct put *p)
{
    const int next = slot_choose(p->slots);
    const bool used[LM_SLOTS] = {slot_is_in_use(&p->slots[0]), slot_is_in_use(&p->slots[1])};
    int target = next >= 0 ? next ^ 1 : p->slots[1].verdict == SLOT_CUT_OFF;
    if (used[target] && next >= 0 && !used[next] && p->slots[target].verdict == SLOT_WHOLE) {
        target = next; /* the panel still flies the one before */
    }
    if (used[target]) {
        return hs_error(p->places.path[target],
                        "wait for the other landmass-load, or restart the panel",
                        "slot %c is in use", load_letter(target));
    }
    if (p->slots[target].verdict == SLOT_WHOLE && p->slots[target ^ 1].verdict != SLOT_WHOLE) {
        return hs_error(p->places.path[target ^ 1], "restart the panel, and it flies the other one",
                        "slot %c is flown and is no longer whole; the only whole slot is not "
                        "written",
                        load_letter(target ^ 1));
    }
    return target;
}

static int open_target(struct put *p, int target)
{
    struct slot *s = &p->slots[target];
    const char *path = p->places.path[target];
    if (hs_input_is(path)) {
        return hs_error(path, "name another file", "is the slot itself");
    }
    slot_close(s);
    int cause = load_open(s, &p->places, target, SLOT_TO_WRITE);
    if (cause == 0) {
        cause = slot_lock_to_write(s);
    }
    if (cause != 0) {
        return hs_error(path,
                        cause == EWOULDBLOCK ? "wait for the other landmass-load"
                        : cause == EACCES    ? "run it as root or as the panel's user"
                        : p->places.chip_mib ? "name a file of the length of --chip, or a new one"
                                             : "check the option slot.a or slot.b",
                        "slot %c cannot be written: %s", load_letter(target), strerror(cause));
    }
    slot_judge(s, SLOT_TABLES, NULL, NULL);
    return 0;
}

static void report_load(const struct put *p, int target, const struct slot_load *load)
{
    const struct slot *s = &p->slots[target];
    printf("slot %c: load %" PRIu64 ", %" PRIu64 " bytes written, %" PRIu64
           " were there; every record was read back and is right\n",
           load_letter(target), s->record.sequence, load->written_bytes, load->kept_bytes);
    printf("%s%s\n",
           p->places.chip_mib ? "write it to its chip: " : "flown from the next start on: ",
           p->places.chip_mib ? s->path : "systemctl restart landmass-panel");
    hs_report_text("slot", s->path);
    hs_report_count("load", s->record.sequence);
    hs_report_count("image_bytes", s->record.image_bytes);
    hs_report_count("written_bytes", load->written_bytes);
    hs_report_count("kept_bytes", load->kept_bytes);
    hs_report_count("bad_blocks", load->bad_blocks);
    hs_report_flag("is_there_already", false);
}

static int report_there(const struct put *p, int slot)
{
    printf("slot %c holds this database already\n", load_letter(slot));
    hs_report_text("slot", p->slots[slot].path);
    hs_report_count("load", p->slots[slot].record.sequence);
    hs_report_count("image_bytes", p->slots[slot].record.image_bytes);
    hs_report_flag("is_there_already", true);
    return 0;
}

/* Write the slot and switch to it. */
static int fill(struct put *p, int target, struct slot_load *load)
{
    struct slot *s = &p->slots[target];
    int result = slot_fill(s, &p->source.port, writing, checking_slot, p, load);
    hs_progress_end(&p->bar);
    if (result == 0 && load_accept(&p->places.places, s->path, &s->port, LOAD_FULL) != 0) {
        return -1;
    }
    if (result == 0) {
        result = slot_switch(s, &p->slots[target ^ 1], load);
    }
    return result == 0
               ? 0
               : hs_error(s->path, "the other slot is flown as before; run it again to go on",
                          "slot %c: offset 0x%" PRIx64 ": %s", load_letter(target),
                          load->fault.offset, load->fault.cause);
}

static int put(struct put *p)
{
    struct slot_load load;
    const int next = slot_choose(p->slots);
    if (next >= 0 && is_there(p, &p->slots[next])) {
        return report_there(p, next);
    }
    const int target = pick(p);
    if (target < 0 || open_target(p, target) != 0) {
        return -1;
    }
    slot_teller_open(&p->teller, p->places.chip_mib != 0 ? "" : p->places.places.progress);
    const int result = fill(p, target, &load);
    slot_teller_end(&p->teller, result == 0 ? LM_LOAD_DONE : LM_LOAD_FAILED);
    if (result == 0) {
        report_load(p, target, &load);
    }
    return result;
}

static int take_options(struct put *p)
{
    struct slot_places *c = &p->places.places;
    c->is_any = c->is_any || p->is_any;
    c->is_older = c->is_older || p->is_older;
    if (p->key && snprintf(c->key, sizeof c->key, "%s", p->key) >= (int)sizeof c->key) {
        return hs_error(p->key, "choose a shorter one", "the path is too long");
    }
    return 0;
}

int load_cmd_put(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "put", "put a database into the slot that is not flown, and switch to it",
        "Checks the file and its signature, writes it, reads every record back, and then says in "
        "one step that the "
        "slot is whole. Until then the panel flies on, and would start, with the other slot.\n"
        "It may be cut off at any moment, by a signal or with the power. Run again, it goes on: "
        "what is there already is compared, not written."};
    struct put p = {.places = {.config = SLOT_CONFIG}};
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &p.file, 0, 0, NULL,
         "the database image, or a folder with one of the name landmass.lmdb", true},
        LOAD_PLACES_OPTIONS(p.places),
        {"key", HS_INPUT, &p.key, 0, 0, "FILE",
         "public keys of those who may sign it, PEM; left out: the configuration's", false},
        {"unsigned", HS_FLAG, &p.is_any, 0, 0, NULL,
         "take it though none of them has signed it, as with database.trust = any", false},
        {"older", HS_FLAG, &p.is_older, 0, 0, NULL,
         "take a lower serial number than one that was flown, as with database.older = fly", false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    if (load_places_find(&p.places) != 0 || take_options(&p) != 0 || open_file(&p) != 0) {
        return HS_EXIT_FAILED;
    }
    int result = check_file(&p) == 0
                     ? load_accept(&p.places.places, p.file, &p.source.port, LOAD_SIGNATURE)
                     : -1;
    if (result == 0) {
        load_judge(p.slots, &p.places, SLOT_TABLES);
        result = put(&p);
        slot_close(&p.slots[0]);
        slot_close(&p.slots[1]);
    }
    drv_flash_file_close(&p.source);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
