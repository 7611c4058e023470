/* Minimum, maximum, clamping and saturation. Cost of each: a few instructions, no branch. */
#ifndef FX_SAT_H
#define FX_SAT_H

#include <stdbool.h>
#include <stdint.h>

/* The smaller of two signed numbers. */
static inline int32_t fx_min_i32(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* The larger of two signed numbers. */
static inline int32_t fx_max_i32(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* The smaller of two unsigned numbers. */
static inline uint32_t fx_min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* The larger of two unsigned numbers. */
static inline uint32_t fx_max_u32(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Clamp x to lo..hi, both included; lo <= hi. */
static inline int32_t fx_clamp_i32(int32_t x, int32_t lo, int32_t hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* True if x is one of lo..hi, both included. */
static inline bool fx_is_within_i32(int32_t x, int32_t lo, int32_t hi)
{
    return x >= lo && x <= hi;
}

/* Clamp x of 64 bits to lo..hi, both included; lo <= hi. */
static inline int64_t fx_clamp_i64(int64_t x, int64_t lo, int64_t hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* Magnitude of x, 0..2^31. Unsigned, because that of INT32_MIN does not fit int32_t. */
static inline uint32_t fx_abs_u32(int32_t x)
{
    return x < 0 ? 0u - (uint32_t)x : (uint32_t)x;
}

/* Saturate to 16 bits: the number of INT16_MIN..INT16_MAX that is nearest to x. */
static inline int16_t fx_sat_i16(int32_t x)
{
    return (int16_t)fx_clamp_i32(x, INT16_MIN, INT16_MAX);
}

/* Saturate to 32 bits: the number of INT32_MIN..INT32_MAX that is nearest to x. */
static inline int32_t fx_sat_i32(int64_t x)
{
    return x < INT32_MIN ? INT32_MIN : x > INT32_MAX ? INT32_MAX : (int32_t)x;
}

#endif
