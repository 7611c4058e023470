/* Commands of landmass-load. */
#ifndef LOAD_COMMANDS_H
#define LOAD_COMMANDS_H

#include "slots/places.h"
#include "slots/slot.h"

/* The rows of the options that say where the slots are. */
#define LOAD_PLACES_OPTIONS(p)                                                                     \
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
        {"slot-b", HS_TEXT, &(p).path[1], 0, 0, "PATH", "the other one; likewise", false},         \
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

/* The letter of a slot. */
static inline char load_letter(int slot)
{
    return (char)('A' + slot);
}

int load_cmd_put(int argc, char **argv);
int load_cmd_show(int argc, char **argv);
int load_cmd_verify(int argc, char **argv);

#endif
