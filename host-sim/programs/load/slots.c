/* What each slot holds. */
#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "lm/db.h"
#include "lm/image.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

int load_places_find(struct load_places *p)
{
    if (slot_places_read(&p->places, p->config) != 0) {
        return -1;
    }
    for (int i = 0; i < LM_SLOTS; i++) {
        p->path[i] = p->path[i] ? p->path[i] : p->places.path[i];
    }
    if (strcmp(p->path[0], p->path[1]) == 0) {
        return hs_error(p->path[0], "name two places", "is both slots");
    }
    return 0;
}

int load_open(struct slot *s, const struct load_places *p, int slot, enum slot_use use)
{
    return p->chip_mib != 0 ? slot_open_chip(s, p->path[slot], (uint64_t)p->chip_mib << 20, use)
                            : slot_open(s, p->path[slot], use);
}

static void show_progress(void *ctx, uint64_t done, uint64_t total)
{
    struct hs_progress *bar = ctx;
    bar->total = total;
    hs_progress_update(bar, done);
}

void load_judge(struct slot slots[LM_SLOTS], const struct load_places *p, enum slot_depth depth)
{
    static const char *const labels[] = {"checking slot A", "checking slot B"};
    for (int i = 0; i < LM_SLOTS; i++) {
        struct hs_progress bar;
        (void)load_open(&slots[i], p, i, SLOT_TO_READ);
        hs_progress_begin(&bar, labels[i], 0);
        slot_judge(&slots[i], depth, depth == SLOT_RECORDS ? show_progress : NULL, &bar);
        hs_progress_end(&bar);
    }
}

static void report_slot(const struct slot *s, bool is_next, const char *title)
{
    hs_report_object(NULL);
    hs_report_text("path", s->path);
    hs_report_text("state", slot_word(s->verdict));
    hs_report_flag("is_flown_next", is_next);
    hs_report_count("load", s->record.sequence);
    hs_report_count("image_bytes", s->record.image_bytes);
    hs_report_text("title", title);
    hs_report_text("cause", s->fault.cause[0] != '\0' ? s->fault.cause : NULL);
    hs_report_count("cause_offset_bytes", s->fault.offset);
    hs_report_close();
}

/* The words between two bars of a table of one line. */
static void print_slot(const struct slot *s, int number, bool is_next, const char *title)
{
    printf("slot %c: %s: %s", load_letter(number), s->path, slot_word(s->verdict));
    if (s->verdict == SLOT_WHOLE) {
        printf(", load %" PRIu64 ", %" PRIu64 " bytes, \"%s\"", s->record.sequence,
               s->record.image_bytes, title);
    } else if (s->verdict == SLOT_CUT_OFF) {
        printf(", a load of %" PRIu64 " bytes has not come to its end", s->record.image_bytes);
    } else if (s->verdict == SLOT_ABSENT) {
        printf(": %s", s->fault.cause);
    } else if (s->verdict == SLOT_DAMAGED) {
        printf(", offset 0x%" PRIx64 ": %s", s->fault.offset, s->fault.cause);
    }
    printf("%s\n", is_next ? "; flown next" : "");
}

void load_tell(const struct slot slots[LM_SLOTS])
{
    const int next = slot_choose(slots);
    hs_report_array("slots");
    for (int i = 0; i < LM_SLOTS; i++) {
        struct lm_image_header header;
        char title[LM_IMAGE_TITLE_BYTES + 1] = "";
        const struct slot *s = &slots[i];
        if (s->verdict == SLOT_WHOLE &&
            s->medium.read(s->medium.ctx, 0, &header, sizeof header) == 0) {
            memcpy(title, header.title, LM_IMAGE_TITLE_BYTES);
        }
        print_slot(s, i, i == next, title);
        report_slot(s, i == next, s->verdict == SLOT_WHOLE ? title : NULL);
    }
    hs_report_close();
}

static int look(const struct hs_usage *usage, enum slot_depth depth, int argc, char **argv)
{
    struct load_places p = {.config = SLOT_CONFIG};
    struct slot slots[LM_SLOTS];
    int exit_code;
    const struct hs_option options[] = {LOAD_PLACES_OPTIONS(p)};
    if (!hs_options_read(usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    if (load_places_find(&p) != 0) {
        return HS_EXIT_FAILED;
    }
    load_judge(slots, &p, depth);
    load_tell(slots);
    int result = HS_EXIT_OK;
    if (slot_choose(slots) < 0) {
        hs_error(p.path[0], "`landmass-load put FILE` puts one in",
                 "neither slot holds a whole database");
        result = HS_EXIT_FAILED;
    }
    for (int i = 0; i < LM_SLOTS; i++) {
        if (slots[i].verdict == SLOT_DAMAGED) {
            hs_error(p.path[i], "`landmass-load put FILE` writes it again",
                     "offset 0x%" PRIx64 ": %s", slots[i].fault.offset, slots[i].fault.cause);
            result = HS_EXIT_FAILED;
        }
        slot_close(&slots[i]);
    }
    return result;
}

int load_cmd_show(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "show", "what each slot holds, and which one is flown next",
        "Looks at the slots as a panel does that starts: at their records, headers and tables.\n"
        "The exit code is 1 when there is no database to fly, or a slot is damaged."};
    return look(&usage, SLOT_TABLES, argc, argv);
}

int load_cmd_verify(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "verify", "check each slot record by record",
        "Reads every section, every directory entry and every tile record of both slots, and "
        "compares their checksums.\n"
        "The exit code is 1 when there is no database to fly, or a slot is damaged."};
    return look(&usage, SLOT_RECORDS, argc, argv);
}
