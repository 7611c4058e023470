/* Option table of the configuration file, one row an option. Options are described nowhere else.
 * Private to config.c. */
#ifndef CONFIG_TABLE_H
#define CONFIG_TABLE_H

#include "config.h"

enum config_kind {
    CONFIG_TEXT,
    CONFIG_PATH_TO, /* a text that begins with '/' */
    CONFIG_NUMBER,
    CONFIG_CHOICE,  /* stored as the number of the word */
    CONFIG_PROFILE, /* a bus profile, by its name in lm_bus_profiles; stored as a pointer.
                     * auto: NULL */
    CONFIG_NODES,   /* numbers 1..255 between commas, stored as struct config_nodes */
    CONFIG_SIZE,
    CONFIG_DEVICE,
    CONFIG_AXIS,
    CONFIG_BUTTON
};

struct config_row {
    struct config_option is;
    enum config_kind kind;
    size_t offset; /* of the value in struct config */
    /* NUMBER and SIZE: accepted range. TEXT and PATH_TO: `high` is the room in bytes, including the
     * zero at the end. */
    uint32_t low, high;
    const char *words; /* CHOICE: its words; TEXT, PATH_TO, SIZE: the word for an empty one */
};

enum { CONFIG_ROWS = 122 };
extern const struct config_row config_table[CONFIG_ROWS];

#endif
