#include "slots/places.h"

#include "hs/error.h"
#include "hs/text_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int take_line(struct slot_places *places, struct db_text_file *f)
{
    char *key, *value;
    if (db_text_split(f->line, &key, &value) != 0 || strncmp(key, "slot.", 5) != 0 ||
        (strcmp(key + 5, "a") != 0 && strcmp(key + 5, "b") != 0)) {
        return 0;
    }
    if (strcmp(value, "none") == 0) {
        return db_text_error(f, "name a file or a device", "the panel has no slots");
    }
    char *to = places->path[key[5] - 'a'];
    return snprintf(to, SLOT_PATH_BYTES, "%s", value) < SLOT_PATH_BYTES
               ? 0
               : db_text_error(f, "choose a shorter one", "the path is too long");
}

int slot_places_read(struct slot_places *places, const char *config)
{
    struct db_text_file f;
    *places = (struct slot_places){{SLOT_A, SLOT_B}};
    if (strcmp(config, SLOT_CONFIG) == 0 && access(config, F_OK) != 0) {
        return 0;
    }
    if (db_text_open(&f, config) != 0) {
        return -1;
    }
    int more, result = 0;
    while (result == 0 && (more = db_text_next(&f)) != 0) {
        result = more < 0 ? -1 : take_line(places, &f);
    }
    db_text_close(&f);
    return result;
}
