#include "slots/places.h"

#include "hs/error.h"
#include "hs/text_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int take_path(struct db_text_file *f, char *to, const char *value)
{
    return snprintf(to, SLOT_PATH_BYTES, "%s", value) < SLOT_PATH_BYTES
               ? 0
               : db_text_error(f, "choose a shorter one", "the path is too long");
}

/* landmass-panel judges the other lines. */
static int take_line(struct slot_places *places, struct db_text_file *f)
{
    char *key, *value;
    if (db_text_split(f->line, &key, &value) != 0) {
        return 0;
    }
    const bool is_none = strcmp(value, "none") == 0, is_a = strcmp(key, "slot.a") == 0;
    if (is_a || strcmp(key, "slot.b") == 0) {
        return is_none ? db_text_error(f, "name a file or a device", "the panel has no slots")
                       : take_path(f, places->path[!is_a], value);
    }
    if (strcmp(key, "slot.progress") == 0) {
        return take_path(f, places->progress, is_none ? "" : value);
    }
    if (strcmp(key, "database.key") == 0) {
        return take_path(f, places->key, is_none ? "" : value);
    }
    if (strcmp(key, "database.serial") == 0) {
        return take_path(f, places->serial, is_none ? "" : value);
    }
    if (strcmp(key, "database.trust") == 0) {
        places->is_any = strcmp(value, "any") == 0;
    } else if (strcmp(key, "database.older") == 0) {
        places->is_older = strcmp(value, "fly") == 0;
    }
    return 0;
}

int slot_places_read(struct slot_places *places, const char *config)
{
    struct db_text_file f;
    *places = (struct slot_places){
        .path = {SLOT_A, SLOT_B}, .serial = SLOT_SERIAL, .progress = SLOT_PROGRESS};
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
