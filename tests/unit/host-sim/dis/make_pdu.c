#include "make_pdu.h"

#include <string.h>

static void put(struct made *m, uint64_t value, int bytes)
{
    for (int i = bytes - 1; i >= 0; i--) {
        m->bytes[m->length++] = (uint8_t)(value >> (8 * i));
    }
}

static void put_floats(struct made *m, const float v[3])
{
    for (int i = 0; i < 3; i++) {
        uint32_t bits;
        memcpy(&bits, &v[i], sizeof bits);
        put(m, bits, 4);
    }
}

static void put_doubles(struct made *m, const double v[3])
{
    for (int i = 0; i < 3; i++) {
        uint64_t bits;
        memcpy(&bits, &v[i], sizeof bits);
        put(m, bits, 8);
    }
}

static size_t put_header(struct made *m, const struct made_entity *e, uint8_t type, uint8_t family)
{
    const size_t begin = m->length;
    put(m, e->version, 1);
    put(m, e->exercise, 1);
    put(m, type, 1);
    put(m, family, 1);
    put(m, e->timestamp, 4);
    put(m, 0, 2); /* length */
    put(m, 0, 2); /* status and padding, or padding */
    return begin;
}

static void put_length(struct made *m, size_t begin)
{
    const size_t length = m->length - begin;
    m->bytes[begin + 8] = (uint8_t)(length >> 8);
    m->bytes[begin + 9] = (uint8_t)length;
}

static void put_records(struct made *m, uint8_t count)
{
    for (int i = 0; i < count; i++) {
        put(m, 0, 8);
        put(m, 0, 8);
    }
}

struct made_entity made_vehicle(uint16_t number)
{
    return (struct made_entity){.version = 7,
                                .exercise = 1,
                                .id = {11, 22, number},
                                .force = 2,
                                .kind = 1,
                                .domain = 1,
                                .country = 225,
                                .category = 1,
                                .place = {6378137, 0, 0},
                                .orientation = {1.57079633F, 0, 0},
                                .algorithm = 2,
                                .marking = "CAR"};
}

void made_entity_state(struct made *m, const struct made_entity *e)
{
    const size_t begin = put_header(m, e, 1, 1);
    put(m, e->id[0], 2);
    put(m, e->id[1], 2);
    put(m, e->id[2], 2);
    put(m, e->force, 1);
    put(m, e->records, 1);
    for (int twice = 0; twice < 2; twice++) { /* the type, and the alternative type */
        put(m, e->kind, 1);
        put(m, e->domain, 1);
        put(m, e->country, 2);
        put(m, e->category, 1);
        put(m, e->subcategory, 1);
        put(m, e->specific, 1);
        put(m, e->extra, 1);
    }
    put_floats(m, e->velocity);
    put_doubles(m, e->place);
    put_floats(m, e->orientation);
    put(m, e->appearance, 4);
    put(m, e->algorithm, 1);
    put(m, 0, 7); /* other parameters of the algorithm: 15 bytes */
    put(m, 0, 8);
    put_floats(m, e->acceleration);
    put_floats(m, e->turn);
    put(m, 1, 1); /* ASCII */
    for (size_t i = 0, end = strlen(e->marking); i < 11; i++) {
        put(m, i < end ? (uint8_t)e->marking[i] : 0, 1);
    }
    put(m, 0, 4); /* capabilities */
    put_records(m, e->records);
    put_length(m, begin);
}

void made_update(struct made *m, const struct made_entity *e)
{
    const size_t begin = put_header(m, e, 67, 1);
    put(m, e->id[0], 2);
    put(m, e->id[1], 2);
    put(m, e->id[2], 2);
    put(m, 0, 1);
    put(m, e->records, 1);
    put_floats(m, e->velocity);
    put_doubles(m, e->place);
    put_floats(m, e->orientation);
    put(m, e->appearance, 4);
    put_records(m, e->records);
    put_length(m, begin);
}

static size_t put_command(struct made *m, uint8_t exercise, uint8_t type)
{
    const struct made_entity e = {.version = 6, .exercise = exercise};
    const size_t begin = put_header(m, &e, type, 5);
    put(m, 5, 2); /* who says so: 5:6:7 */
    put(m, 6, 2);
    put(m, 7, 2);
    put(m, 0xffff, 2); /* to all */
    put(m, 0xffff, 2);
    put(m, 0xffff, 2);
    return begin;
}

void made_start(struct made *m, uint8_t exercise, int32_t hours, uint32_t past_hour)
{
    const size_t begin = put_command(m, exercise, 13);
    put(m, 1, 4); /* real time: an hour after 1970 */
    put(m, 0, 4);
    put(m, (uint32_t)hours, 4);
    put(m, past_hour, 4);
    put(m, 99, 4); /* request */
    put_length(m, begin);
}

void made_stop(struct made *m, uint8_t exercise, uint8_t behaviour)
{
    const size_t begin = put_command(m, exercise, 14);
    put(m, 2, 4);
    put(m, 0, 4);
    put(m, 1, 1); /* reason: a recess */
    put(m, behaviour, 1);
    put(m, 0, 2);
    put(m, 98, 4);
    put_length(m, begin);
}

void made_other(struct made *m, uint8_t type, size_t length)
{
    const struct made_entity e = {.version = 7, .exercise = 1};
    const size_t begin = put_header(m, &e, type, 4);
    while (m->length - begin < length) {
        put(m, 0xa5, 1);
    }
    put_length(m, begin);
}
