/* The options of the configuration file, one row each: the only place where they are described.
 * Private to config.c. */
#ifndef CONFIG_TABLE_H
#define CONFIG_TABLE_H

#include "config.h"

enum config_kind {
    CONFIG_TEXT,
    CONFIG_PATH_TO, /* a text that begins with '/' */
    CONFIG_NUMBER,
    CONFIG_CHOICE,  /* stored as the number of the word */
    CONFIG_PROFILE, /* of the bus, by its name in lm_bus_profiles; stored as a pointer */
    CONFIG_SIZE,
    CONFIG_DEVICE,
    CONFIG_AXIS,
    CONFIG_BUTTON
};

struct config_row {
    struct config_option is;
    enum config_kind kind;
    size_t offset; /* of the value in struct config */
    /* NUMBER and SIZE: what is allowed. TEXT and PATH_TO: `high` bytes hold it, its end included.
     */
    uint32_t low, high;
    const char *words; /* CHOICE: its words; TEXT, PATH_TO, SIZE: the word for an empty one */
};

enum { CONFIG_ROWS = 94 };
extern const struct config_row config_table[CONFIG_ROWS];

#endif
