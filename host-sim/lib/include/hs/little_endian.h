/* Little-endian numbers out of the bytes of a file, at any alignment. fx/mem.h, which the firmware
 * uses for this, declares the memory functions again and cannot stand beside string.h. */
#ifndef HS_LITTLE_ENDIAN_H
#define HS_LITTLE_ENDIAN_H

#include <stdint.h>

static inline uint32_t hs_get_u32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static inline uint64_t hs_get_u64(const uint8_t *at)
{
    return (uint64_t)hs_get_u32(at) | (uint64_t)hs_get_u32(at + 4) << 32;
}

#endif
