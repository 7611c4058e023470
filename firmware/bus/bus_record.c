#include "lm/bus_record.h"

#include <stddef.h>

#include "fx/crc32c.h"
#include "fx/mem.h"
#include "lm/status.h"

enum { FIELD_NAME_BYTES = 24, AT_VERSION = 4 };
enum { LITTLE_ENDIAN = 1, HAS_NONE = 2, IS_FAST = 4, FLAGS_KNOWN = 7 };
enum { FRAMING_CANAEROSPACE, FRAMING_TYPES_ASSUMED, FRAMING_PACKED, FRAMINGS };

/* Members are in an order that needs no padding. */
struct head {
    uint32_t crc; /* of all bytes behind it */
    uint16_t version, bytes;
    char name[LM_BUS_PROFILE_NAME_SIZE];
    uint8_t framing, rows;
    uint8_t reserved[2];
    uint32_t channel_mask, invalid_mask;
};

struct row {
    char field[FIELD_NAME_BYTES];
    uint32_t id, mask, period_us;
    uint16_t stale_ms, dead_ms;
    int32_t low, high;
    uint32_t types;
    int32_t per_unit;
    int64_t bias;
    int32_t multiplier;
    uint32_t none;
    uint16_t bits_first, match_first;
    uint8_t bits_count, match_count, match_value, priority;
    uint8_t type, flags, shift, frac_bits;
    uint8_t reserved[4];
};

_Static_assert(sizeof(struct head) == LM_BUS_RECORD_HEAD_BYTES, "as FORMATS.md says");
_Static_assert(sizeof(struct row) == LM_BUS_RECORD_ROW_BYTES, "as FORMATS.md says");

static void copy_name(char *to, const char *from, uint32_t room)
{
    for (uint32_t i = 0; i < room - 1 && from[i] != '\0'; i++) {
        to[i] = from[i];
    }
}

uint32_t lm_bus_pack(const struct lm_bus_profile *profile, uint8_t *record)
{
    const uint32_t bytes =
        LM_BUS_RECORD_HEAD_BYTES + profile->row_count * (uint32_t)LM_BUS_RECORD_ROW_BYTES;
    struct head head = {.version = LM_BUS_RECORD_VERSION,
                        .bytes = (uint16_t)bytes,
                        .framing = profile->framing == LM_BUS_PACKED ? FRAMING_PACKED
                                   : profile->are_types_assumed      ? FRAMING_TYPES_ASSUMED
                                                                     : FRAMING_CANAEROSPACE,
                        .rows = profile->row_count,
                        .channel_mask = profile->channel_mask,
                        .invalid_mask = profile->invalid_mask};
    copy_name(head.name, profile->name, sizeof head.name);
    memcpy(record, &head, sizeof head);
    for (uint32_t i = 0; i < profile->row_count; i++) {
        const struct lm_bus_row *from = &profile->rows[i];
        const struct lm_bus_packing *p = &from->packing;
        struct row row = {.id = from->id,
                          .mask = p->mask,
                          .period_us = from->period_us,
                          .stale_ms = from->stale_ms,
                          .dead_ms = from->dead_ms,
                          .low = from->low,
                          .high = from->high,
                          .types = from->types,
                          .per_unit = from->per_unit,
                          .bias = p->bias,
                          .multiplier = p->multiplier,
                          .none = p->none,
                          .bits_first = p->bits.first,
                          .match_first = p->match.first,
                          .bits_count = p->bits.count,
                          .match_count = p->match.count,
                          .match_value = p->match_value,
                          .priority = from->priority,
                          .type = p->type,
                          .flags =
                              (uint8_t)((p->is_little_endian ? LITTLE_ENDIAN : 0) |
                                        (p->has_none ? HAS_NONE : 0) | (p->is_fast ? IS_FAST : 0)),
                          .shift = p->shift,
                          .frac_bits = p->frac_bits};
        copy_name(row.field, lm_bus_fields[from->field].name, sizeof row.field);
        memcpy(record + sizeof head + i * sizeof row, &row, sizeof row);
    }
    const uint32_t crc = fx_crc32c(0, record + AT_VERSION, bytes - AT_VERSION);
    memcpy(record, &crc, sizeof crc);
    return bytes;
}

static bool is_zero(const uint8_t *bytes, uint32_t count)
{
    uint32_t set = 0;
    for (uint32_t i = 0; i < count; i++) {
        set |= bytes[i];
    }
    return set == 0;
}

/* The version stands at the same place in every version, and the rest may differ. */
static int check_head(struct head *head, const uint8_t *record, uint32_t bytes)
{
    if (bytes < sizeof *head) {
        return LM_ERR_CORRUPT;
    }
    memcpy(head, record, sizeof *head);
    if (head->version != LM_BUS_RECORD_VERSION) {
        return LM_ERR_VERSION;
    }
    const bool is_whole = head->bytes == bytes &&
                          bytes == sizeof *head + head->rows * (uint32_t)LM_BUS_RECORD_ROW_BYTES &&
                          fx_crc32c(0, record + AT_VERSION, bytes - AT_VERSION) == head->crc;
    const bool is_sound = is_whole && head->name[sizeof head->name - 1] == '\0' &&
                          is_zero(head->reserved, sizeof head->reserved);
    if (!is_sound) {
        return LM_ERR_CORRUPT;
    }
    return head->rows <= LM_BUS_ROWS_MAX && head->framing < FRAMINGS ? LM_OK : LM_ERR_TABLE;
}

/* The field of a name that fills its room with zeros, or LM_BUS_FIELDS. */
static uint32_t field_named(const char name[FIELD_NAME_BYTES])
{
    uint32_t field = 0;
    for (; field < LM_BUS_FIELDS; field++) {
        char known[FIELD_NAME_BYTES] = {0};
        copy_name(known, lm_bus_fields[field].name, sizeof known);
        if (memcmp(known, name, sizeof known) == 0) {
            break;
        }
    }
    return field;
}

static int unpack_row(struct lm_bus_row *to, const uint8_t *record)
{
    struct row row;
    memcpy(&row, record, sizeof row);
    const uint32_t field = field_named(row.field);
    if (!is_zero(row.reserved, sizeof row.reserved)) {
        return LM_ERR_CORRUPT;
    }
    if (field == LM_BUS_FIELDS || (row.flags & ~FLAGS_KNOWN) != 0) {
        return LM_ERR_TABLE;
    }
    *to = (struct lm_bus_row){.name = lm_bus_fields[field].name,
                              .id = row.id,
                              .field = (uint8_t)field,
                              .priority = row.priority,
                              .stale_ms = row.stale_ms,
                              .dead_ms = row.dead_ms,
                              .period_us = row.period_us,
                              .low = row.low,
                              .high = row.high,
                              .types = row.types,
                              .per_unit = row.per_unit,
                              .packing = {.mask = row.mask,
                                          .bits = {row.bits_first, row.bits_count},
                                          .match = {row.match_first, row.match_count},
                                          .match_value = row.match_value,
                                          .type = row.type,
                                          .is_little_endian = (row.flags & LITTLE_ENDIAN) != 0,
                                          .has_none = (row.flags & HAS_NONE) != 0,
                                          .is_fast = (row.flags & IS_FAST) != 0,
                                          .none = row.none,
                                          .multiplier = row.multiplier,
                                          .shift = row.shift,
                                          .frac_bits = row.frac_bits,
                                          .bias = row.bias}};
    return LM_OK;
}

int lm_bus_unpack(struct lm_bus_table *t, const uint8_t *record, uint32_t bytes)
{
    struct head head;
    int status = check_head(&head, record, bytes);
    if (status != LM_OK) {
        return status;
    }
    memcpy(t->name, head.name, sizeof t->name);
    t->profile = (struct lm_bus_profile){
        .name = t->name,
        .rows = t->rows,
        .row_count = head.rows,
        .framing = head.framing == FRAMING_PACKED ? LM_BUS_PACKED : LM_BUS_CANAEROSPACE,
        .are_types_assumed = head.framing == FRAMING_TYPES_ASSUMED,
        .channel_mask = head.channel_mask,
        .invalid_mask = head.invalid_mask};
    for (uint32_t i = 0; i < head.rows && status == LM_OK; i++) {
        status = unpack_row(&t->rows[i], record + sizeof head + i * LM_BUS_RECORD_ROW_BYTES);
    }
    return status != LM_OK ? status : lm_bus_profile_check(&t->profile, NULL);
}
