/* Keys of the text: what stands before the '=', and how its values are written. */
#ifndef RADAR_KEYS_H
#define RADAR_KEYS_H

#include "lm/radar_check.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { RADAR_KEYS_MAX = 128, RADAR_KEY_SIZE = 48 };

/* Names of the radar, its modes and fields of view, or a field of numbers. */
struct radar_key {
    char text[RADAR_KEY_SIZE];
    const struct lm_radar_field *field; /* NULL: names */
    size_t name_offset;                 /* of the first name in struct lm_radar */
    size_t name_stride;                 /* from name to name */
    size_t name_size;                   /* with its zero */
    uint32_t count;                     /* values at most */
};

/* All keys, in the order in which they are written. Returns their number. Fields that follow from
 * others (the number of scales) or have one value alone have none. */
uint32_t radar_keys(struct radar_key keys[RADAR_KEYS_MAX]);

/* Name number `index` of a key of names. */
char *radar_key_name(struct lm_radar *radar, const struct radar_key *key, uint32_t index);

/* A unit as people write it. */
struct radar_unit {
    const char *word; /* behind the numbers; "" for none */
    double one;       /* of it, in the table's unit */
    bool is_whole;    /* the table holds whole numbers of it */
};

const struct radar_unit *radar_unit_of(const struct lm_radar_field *field);

#endif
