/* PDUs made byte by byte from the standard's tables of fields: IEEE Std 1278.1-2012, 7.2.2 (Entity
 * State), 7.2.3 (Entity State Update), 7.5.4 (Start/Resume), 7.5.5 (Stop/Freeze). Written from the
 * tables alone, in their order, without an offset: the reader under test has the offsets. */
#ifndef MAKE_PDU_H
#define MAKE_PDU_H

#include <stddef.h>
#include <stdint.h>

enum { MADE_MAX = 8192 };

struct made {
    uint8_t bytes[MADE_MAX];
    size_t length;
};

struct made_entity {
    uint8_t version, exercise;
    uint32_t timestamp;
    uint16_t id[3];
    uint8_t force, records;
    uint8_t kind, domain;
    uint16_t country;
    uint8_t category, subcategory, specific, extra;
    float velocity[3];
    double place[3];
    float orientation[3];
    uint32_t appearance;
    uint8_t algorithm;
    float acceleration[3], turn[3];
    const char *marking;
};

/* A vehicle of version 7 in exercise 1 that stands on the equator and points
 * east. */
struct made_entity made_vehicle(uint16_t number);

/* Append a PDU to the datagram. The length in its header is that of what is appended. */
void made_entity_state(struct made *m, const struct made_entity *e);
void made_update(struct made *m, const struct made_entity *e);
void made_start(struct made *m, uint8_t exercise, int32_t hours, uint32_t past_hour);
void made_stop(struct made *m, uint8_t exercise, uint8_t behaviour);
void made_other(struct made *m, uint8_t type, size_t length);

#endif
