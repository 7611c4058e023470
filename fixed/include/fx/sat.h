/* Numbers kept within limits. Cost: a few instructions. */
#ifndef FX_SAT_H
#define FX_SAT_H

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

/* The number of `lo`..`hi` nearest to x; lo <= hi. */
static inline int32_t fx_clamp_i32(int32_t x, int32_t lo, int32_t hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* The same of 64 bits. */
static inline int64_t fx_clamp_i64(int64_t x, int64_t lo, int64_t hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* |x| without the overflow at INT32_MIN, whose magnitude is 2^31. */
static inline uint32_t fx_abs_u32(int32_t x)
{
    return x < 0 ? 0u - (uint32_t)x : (uint32_t)x;
}

/* The 32-bit number nearest to x. */
static inline int32_t fx_sat_i32(int64_t x)
{
    return x < INT32_MIN ? INT32_MIN : x > INT32_MAX ? INT32_MAX : (int32_t)x;
}

#endif
