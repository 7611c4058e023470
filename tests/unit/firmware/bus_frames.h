/* Frames of CANaerospace for the tests of canas and nav. */
#ifndef BUS_FRAMES_H
#define BUS_FRAMES_H

#include "lm/canas.h"

#include <math.h>
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

static inline struct lm_can_frame bus_float(enum lm_canas_field field, double value,
                                            uint64_t time_us)
{
    return bus_frame(lm_canas_table[field].id, LM_CANAS_FLOAT, 0, bus_float_bits(value), time_us);
}

/* How many counts of a row's fixed point make one unit of the bus. */
static inline double bus_counts_per_unit(enum lm_canas_field field)
{
    static const double counts[] = {
        [LM_CANAS_BAM] = 4294967296.0 / 360.0,
        [LM_CANAS_Q6] = 64.0,
        [LM_CANAS_MM_S] = 1000.0,
        [LM_CANAS_SECONDS] = 1.0,
    };
    return counts[lm_canas_table[field].unit];
}

/* A value as the bus would say it. An angle of 180..360 degrees comes back as -180..0. */
static inline double bus_unit_of(enum lm_canas_field field, int32_t value)
{
    return value / bus_counts_per_unit(field);
}

#endif
