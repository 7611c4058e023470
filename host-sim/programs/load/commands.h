/* Commands of landmass-load. */
#ifndef LOAD_COMMANDS_H
#define LOAD_COMMANDS_H

#include "drv/flash_file.h"
#include "hs/progress.h"
#include "slots/load.h"
#include "slots/places.h"
#include "slots/progress.h"
#include "slots/slot.h"

#include <limits.h>

/* The rows of the options that say where a panel's slots are; and those with slots that are chips.
 */
#define LOAD_PANEL_OPTIONS(p)                                                                      \
    {"config",                                                                                     \
     HS_TEXT,                                                                                      \
     &(p).config,                                                                                  \
     0,                                                                                            \
     0,                                                                                            \
     "FILE",                                                                                       \
     "the panel's configuration, which names the slots",                                           \
     false},                                                                                       \
        {"slot-a",                                                                                 \
         HS_TEXT,                                                                                  \
         &(p).path[0],                                                                             \
         0,                                                                                        \
         0,                                                                                        \
         "PATH",                                                                                   \
         "a slot: a file, a block device or an MTD device; left out: the configuration's",         \
         false},                                                                                   \
    {                                                                                              \
        "slot-b", HS_TEXT, &(p).path[1], 0, 0, "PATH", "the other one; likewise", false            \
    }

#define LOAD_PLACES_OPTIONS(p)                                                                     \
    LOAD_PANEL_OPTIONS(p),                                                                         \
        {"chip",                                                                                   \
         HS_INTEGER,                                                                               \
         &(p).chip_mib,                                                                            \
         1,                                                                                        \
         4096,                                                                                     \
         "MIB",                                                                                    \
         "the slots are files with the contents of flash chips of this size, for a board without " \
         "an operating system; put makes them",                                                    \
         false},                                                                                   \
        HS_NEEDS_ROW("chip", "slot-a"), HS_NEEDS_ROW("chip", "slot-b")

struct load_places {
    const char *config, *path[LM_SLOTS]; /* as given; path NULL: the configuration's */
    long chip_mib;                       /* 0: no chips */
    struct slot_places places;
};

int load_places_find(struct load_places *p);

/* Who signed the image behind `flash`? Error unless the configuration accepts it. At `full` length
 * every byte is read, else the signature alone. Returns 0, or -1 with the error reported. */
enum load_length { LOAD_SIGNATURE, LOAD_FULL };
int load_accept(const struct slot_places *c, const char *path, const struct lm_flash *flash,
                enum load_length length);

/* Open a slot, 0 or 1. */
int load_open(struct slot *s, const struct load_places *p, int slot, enum slot_use use);

/* Open both slots to read, and judge them. */
void load_judge(struct slot slots[LM_SLOTS], const struct load_places *p, enum slot_depth depth);

/* Print and report what each slot holds. */
void load_tell(const struct slot slots[LM_SLOTS]);

/* A progress bar whose label tells the kind of work; zeros to begin with. */
struct load_bar {
    struct hs_progress bar;
    const char *label; /* borrowed; NULL: there is no bar */
};

/* Another label begins another bar. */
void load_bar_move(struct load_bar *b, const char *label, uint64_t done, uint64_t total);
void load_bar_end(struct load_bar *b);

/* The database of a PC: a file, or that of the usual name in a folder. Its header, directory and
 * every record are checked. */
struct load_file {
    const char *name;
    char in_folder[PATH_MAX];
    struct drv_flash_file flash;
};

/* Both return 0, or -1 with the error reported; on failure nothing is open. */
int load_file_open(struct load_file *f);
int load_file_check(struct load_file *f, slot_progress *progress, void *ctx);

/* An image on its way into the slot that is not flown. */
struct load {
    const char *name;              /* of where it comes from, for messages */
    const struct lm_flash *source; /* it */
    struct load_places places;
    struct slot slots[LM_SLOTS]; /* judged */

    /* Told what happens on the way; each may be NULL. */
    void (*opened)(void *ctx, struct slot *target); /* before anything is written */
    slot_progress *checking;                        /* how far the slot is read back */
    const char *(*why)(void *ctx); /* why the source cannot be read; NULL: it can */
    void *ctx;

    /* How it ended. */
    struct slot_load load;
    int slot;
    bool is_there; /* a slot held it already */

    struct load_bar bar;
    struct slot_teller teller;
};

/* Write the image, read it back, check its signature and switch to it. Returns 0, or -1 with the
 * error reported. */
int load_run(struct load *l);

/* Print and report how it ended, after load_run has returned 0. */
void load_report(const struct load *l);

/* The letter of a slot. */
static inline char load_letter(int slot)
{
    return (char)('A' + slot);
}

int load_cmd_put(int argc, char **argv);
int load_cmd_receive(int argc, char **argv);
int load_cmd_send(int argc, char **argv);
int load_cmd_show(int argc, char **argv);
int load_cmd_verify(int argc, char **argv);

#endif
