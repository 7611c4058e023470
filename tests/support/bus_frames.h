/* Frames of CANaerospace for the tests of canas and nav. */
#ifndef BUS_FRAMES_H
#define BUS_FRAMES_H

#include "lm/bus.h"

#include <stdint.h>
#include <string.h>

/* A data frame of node 9 with four data bytes on an 11-bit identifier. */
static inline struct lm_can_frame bus_frame(uint32_t id, uint8_t type, uint8_t code, uint32_t word,
                                            uint64_t time_us)
{
    return (struct lm_can_frame){
        .id = id,
        .length = 8,
        .data = {9, type, 0, code, (uint8_t)(word >> 24), (uint8_t)(word >> 16),
                 (uint8_t)(word >> 8), (uint8_t)word},
        .time_us = time_us,
    };
}

static inline uint32_t bus_float_bits(double value)
{
    const float number = (float)value;
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

static inline uint64_t bus_double_bits(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline struct lm_can_frame bus_float(enum lm_bus_field field, double value, uint64_t time_us)
{
    return bus_frame(lm_bus_canas17.rows[field].id, LM_CANAS_FLOAT, 0, bus_float_bits(value),
                     time_us);
}

/* How many counts of a field's fixed point make one unit of the bus. */
static inline double bus_counts_per_unit(enum lm_bus_field field)
{
    static const double counts[] = {
        [LM_BUS_BAM] = 4294967296.0 / 360.0,
        [LM_BUS_BAM_A_SECOND] = 4294967296.0 / 360.0,
        [LM_BUS_M_Q6] = 64.0,
        [LM_BUS_MM_S] = 1000.0,
        [LM_BUS_SECONDS] = 1.0,
        [LM_BUS_MM_H] = 1.0,
        [LM_BUS_DB_Q8] = 256.0,
        [LM_BUS_BITS] = 1.0,
        [LM_BUS_STATE] = 1.0,
        [LM_BUS_MS] = 1.0,
        [LM_BUS_RATE] = 256.0,
        [LM_BUS_AMOUNT] = 256.0,
        [LM_BUS_NUMBER] = 1.0,
        [LM_BUS_WORD] = 1.0,
    };
    return counts[lm_bus_fields[field].unit];
}

/* Give the decoder a frame. Says which one outcome it had; *event is its value, if it has one. */
static inline enum lm_bus_outcome bus_take(struct lm_bus *b, const struct lm_can_frame *frame,
                                           struct lm_bus_event *event)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    const struct lm_bus before = *b;
    if (lm_bus_take(b, frame, events) == 1) {
        *event = events[0];
    }
    int outcome = 0;
    while (b->count.outcome[outcome] == before.count.outcome[outcome]) {
        outcome++;
    }
    return (enum lm_bus_outcome)outcome;
}

static inline enum lm_bus_field bus_field(const struct lm_bus_event *event)
{
    return (enum lm_bus_field)lm_bus_canas17.rows[event->row].field;
}

/* A value as the bus would say it. An angle of 180..360 degrees comes back as -180..0. */
static inline double bus_unit_of(enum lm_bus_field field, int32_t value)
{
    return value / bus_counts_per_unit(field);
}

#endif
