/* Narrowing that says so: a value that does not fit becomes the nearest one that does and is
 * counted in `*count`, which only ever grows. `count` may be NULL. Cost: a few instructions. */
#ifndef FX_SAT_H
#define FX_SAT_H

#include <stddef.h>
#include <stdint.h>

static inline int32_t fx_min_i32(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t fx_max_i32(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static inline uint32_t fx_min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint32_t fx_max_u32(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* The number of `lo`..`hi` nearest to x; lo <= hi. For a limit that is part of the design and needs
 * no count. */
static inline int32_t fx_clamp_i32(int32_t x, int32_t lo, int32_t hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* |x| without the overflow at INT32_MIN, whose magnitude is 2^31. */
static inline uint32_t fx_abs_u32(int32_t x)
{
    return x < 0 ? 0u - (uint32_t)x : (uint32_t)x;
}

static inline int32_t fx_sat_i32(int64_t x, uint32_t *count)
{
    const int64_t fits = x < INT32_MIN ? INT32_MIN : x > INT32_MAX ? INT32_MAX : x;
    if (fits != x && count != NULL) {
        (*count)++;
    }
    return (int32_t)fits;
}

/* For the three below: what the limits of the narrow types have in common. */
static inline int32_t fx_sat_to(int32_t x, int32_t lo, int32_t hi, uint32_t *count)
{
    const int32_t fits = fx_clamp_i32(x, lo, hi);
    if (fits != x && count != NULL) {
        (*count)++;
    }
    return fits;
}

static inline int16_t fx_sat_i16(int32_t x, uint32_t *count)
{
    return (int16_t)fx_sat_to(x, INT16_MIN, INT16_MAX, count);
}

static inline uint16_t fx_sat_u16(int32_t x, uint32_t *count)
{
    return (uint16_t)fx_sat_to(x, 0, UINT16_MAX, count);
}

static inline uint8_t fx_sat_u8(int32_t x, uint32_t *count)
{
    return (uint8_t)fx_sat_to(x, 0, UINT8_MAX, count);
}

#endif
