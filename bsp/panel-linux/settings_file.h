/* Settings of the panel that outlive a restart, in a file (docs/FORMATS.md, section 8):
 *
 *     board.settings = settings_file_read(&f, path);     NULL: there are none
 *     settings_file_start(&f);
 *     settings_file_keep(&f, unit, now_us);               in each step
 *     settings_file_close(&f);
 *
 * The loop copies the settings once a second and never waits; a thread writes them where they
 * differ from those of the file: a new file beside it, brought to the medium, then renamed. After a
 * power cut the file has the old settings or the new ones. */
#ifndef PANEL_SETTINGS_FILE_H
#define PANEL_SETTINGS_FILE_H

#include <stdatomic.h>

#include "hand_over.h"
#include "lm/unit.h"

enum { SETTINGS_KEPT_US = 1000000, SETTINGS_FILE_BYTES = 8 + LM_SETTINGS_BYTES + 4 };

struct settings_file {
    const char *path;            /* borrowed; "": none is kept */
    struct lm_settings settings; /* those read */
    struct hand_over writer;
    struct lm_settings handed, taken; /* the place, and the thread's copy */
    struct lm_settings last;          /* the file's; the thread's once it runs */
    uint64_t next_us;
    atomic_uint written; /* times */
};

/* Begin, and read the file. NULL where there is none, or `path` is empty; and, with a report, where
 * it is damaged. */
const struct lm_settings *settings_file_read(struct settings_file *f, const char *path);

/* Start the thread. */
void settings_file_start(struct settings_file *f);

/* Once a second, hand the unit's settings to the thread. Never waits. */
void settings_file_keep(struct settings_file *f, const struct lm_unit *unit, uint64_t now_us);

/* Write what was handed over last, and end. */
void settings_file_close(struct settings_file *f);

#endif
