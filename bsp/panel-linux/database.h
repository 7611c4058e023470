/* Database: who made it, and whether the panel flies it. */
#ifndef PANEL_DATABASE_H
#define PANEL_DATABASE_H

#include <stdatomic.h>
#include <stdbool.h>

#include "config.h"
#include "lm/port.h"

struct database {
    bool is_flown;
    bool is_unsigned; /* flown though nobody whom the configuration names has signed it */
};

/* Read the database to its end and judge it by the options database.*. `flash` answers each read
 * within its first poll. What is found is reported. `is_check`: the serial number is not
 * remembered. It is not flown if
 * - its signature does not fit it, or the medium fails,
 * - database.trust is `signed`, and it is not signed by a key of database.key, or that file cannot
 *   be read,
 * - it is signed, and its serial number is below one that was flown, unless database.older is
 * `fly`,
 * - a signal has come that stops the panel (pending, and blocked), or *is_over is set, which may be
 *   NULL.
 * What is no image at all is left to the firmware, which says so. */
struct database database_judge(const struct config *config, const struct lm_flash *flash,
                               bool is_check, const atomic_bool *is_over);

#endif
