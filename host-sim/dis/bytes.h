/* Big-endian numbers of a PDU. The caller has checked that the bytes are there. */
#ifndef DIS_BYTES_H
#define DIS_BYTES_H

#include <stdint.h>
#include <string.h>

static inline uint16_t dis_u16(const uint8_t *p)
{
    return (uint16_t)(p[0] << 8 | p[1]);
}

static inline uint32_t dis_u32(const uint8_t *p)
{
    return (uint32_t)dis_u16(p) << 16 | dis_u16(p + 2);
}

/* IEEE 754 numbers, as C of this machine has them too. */
static inline double dis_f32(const uint8_t *p)
{
    const uint32_t bits = dis_u32(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static inline double dis_f64(const uint8_t *p)
{
    const uint64_t bits = (uint64_t)dis_u32(p) << 32 | dis_u32(p + 4);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
