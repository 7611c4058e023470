/* A database from a file into the slot that is not flown. */
#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"

#include <stdio.h>

struct put {
    struct load_file file;
    struct load load;
    const char *key; /* options; NULL: of the configuration */
    bool is_any, is_older;
};

static void checking_file(void *ctx, uint64_t done, uint64_t total)
{
    load_bar_move(ctx, "checking the file", done, total);
}

static int take_options(struct put *p)
{
    struct slot_places *c = &p->load.places.places;
    c->is_any = c->is_any || p->is_any;
    c->is_older = c->is_older || p->is_older;
    if (p->key && snprintf(c->key, sizeof c->key, "%s", p->key) >= (int)sizeof c->key) {
        return hs_error(p->key, "choose a shorter one", "the path is too long");
    }
    return 0;
}

static int put(struct put *p)
{
    struct load *l = &p->load;
    l->name = p->file.name;
    l->source = &p->file.flash.port;
    int result = load_file_check(&p->file, checking_file, &l->bar);
    load_bar_end(&l->bar);
    if (result == 0) {
        result = load_accept(&l->places.places, l->name, l->source, LOAD_SIGNATURE);
    }
    if (result != 0) {
        return -1;
    }
    load_judge(l->slots, &l->places, SLOT_TABLES);
    result = load_run(l);
    if (result == 0) {
        load_report(l);
    }
    slot_close(&l->slots[0]);
    slot_close(&l->slots[1]);
    return result;
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
    struct put p = {.load = {.places = {.config = SLOT_CONFIG}}};
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &p.file.name, 0, 0, NULL,
         "the database image, or a folder with one of the name landmass.lmdb", true},
        LOAD_PLACES_OPTIONS(p.load.places),
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
    if (load_places_find(&p.load.places) != 0 || take_options(&p) != 0 ||
        load_file_open(&p.file) != 0) {
        return HS_EXIT_FAILED;
    }
    const int result = put(&p);
    drv_flash_file_close(&p.file.flash);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
