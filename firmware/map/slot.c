#include "lm/slot.h"

#include <stddef.h>

#include "fx/crc32c.h"
#include "fx/mem.h"

static const char magic[8] = {'L', 'M', 'D', 'B', 'S', 'L', 'O', 'T'};

enum { SEALED_BYTES = offsetof(struct lm_slot_record, crc) };

static bool is_sound(const struct lm_slot_record *r)
{
    return memcmp(r->magic, magic, sizeof magic) == 0 && r->version == LM_SLOT_VERSION &&
           (r->state == LM_SLOT_LOADING || r->state == LM_SLOT_WHOLE) &&
           r->crc == fx_crc32c(0, r, SEALED_BYTES);
}

const struct lm_slot_record *lm_slot_of(const struct lm_slot_record copies[LM_SLOT_COPIES])
{
    const bool first = is_sound(&copies[0]), second = is_sound(&copies[1]);
    if (first && second) {
        return &copies[copies[1].generation > copies[0].generation];
    }
    return first ? &copies[0] : second ? &copies[1] : NULL;
}

static uint64_t rank(const struct lm_slot_record *r)
{
    return r && r->state == LM_SLOT_WHOLE ? r->sequence : 0;
}

int lm_slot_later(const struct lm_slot_record *a, const struct lm_slot_record *b)
{
    const uint64_t first = rank(a), second = rank(b);
    return first == 0 && second == 0 ? -1 : second > first;
}

void lm_slot_seal(struct lm_slot_record *record)
{
    memcpy(record->magic, magic, sizeof magic);
    record->version = LM_SLOT_VERSION;
    record->crc = fx_crc32c(0, record, SEALED_BYTES);
}
