#include "build/signatures.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

enum { LENGTH = sizeof((struct lm_signature *)0)->name };

int build_signatures_find(const struct build_signatures *s, const char *name)
{
    for (uint32_t i = 0; i < s->count; i++) {
        const char *known = s->items[i].head.name;
        if (strlen(name) == strnlen(known, LENGTH) && strncmp(known, name, LENGTH) == 0) {
            return (int)i;
        }
    }
    return -1;
}

int build_signatures_add(struct build_signatures *s, const char *name, const char *path)
{
    struct db_signature *item = &s->items[s->count];
    if (db_signature_read(item, path) != 0) {
        return -1;
    }
    s->paths[s->count] = strdup(path);
    if (!s->paths[s->count]) {
        db_signature_free(item);
        return hs_error(path, NULL, "out of memory");
    }
    memset(item->head.name, 0, sizeof item->head.name);
    memcpy(item->head.name, name, strlen(name));
    s->count++;
    return 0;
}

void *build_signatures_section(struct build_signatures *s, size_t *bytes)
{
    uint32_t chips = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        db_signature_seal(&s->items[i], i, chips);
        chips += db_signature_chips(&s->items[i].head);
    }
    const struct lm_signatures_head head = db_signatures_head(s->count, chips);
    const size_t chips_at = sizeof head + (size_t)s->count * LM_SIGNATURE_BYTES;
    *bytes = chips_at + (size_t)chips * LM_CHIP_BYTES;
    uint8_t *section = malloc(*bytes);
    if (!section) {
        return NULL;
    }
    memcpy(section, &head, sizeof head);
    for (uint32_t i = 0; i < s->count; i++) {
        const struct db_signature *item = &s->items[i];
        memcpy(section + sizeof head + i * sizeof item->head, &item->head, sizeof item->head);
        memcpy(section + chips_at + item->head.chip0 * sizeof *item->chips, item->chips,
               db_signature_chips(&item->head) * sizeof *item->chips);
    }
    return section;
}

void build_signatures_free(struct build_signatures *s)
{
    for (uint32_t i = 0; i < s->count; i++) {
        db_signature_free(&s->items[i]);
        free(s->paths[i]);
    }
    *s = (struct build_signatures){.count = 0};
}
