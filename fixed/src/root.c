#include "fx/root.h"

#include "fx/bits.h"
#include "fx/tables.h"

/* One step of Heron's rule with 1/(2s) taken from the inverse root: s + (n - s^2) / (2s). The
 * difference, below 2^50, is right modulo 2^64 whatever the sizes of its parts. Shedding 20 of its
 * bits keeps the product with the inverse root below 2^62 and costs 2^-12 of the result. */
static inline uint64_t heron_step(uint64_t s, uint64_t n, uint32_t inverse_q30)
{
    const int64_t miss = (int64_t)(n - s * s);
    return s + (uint64_t)((miss >> 20) * (int64_t)inverse_q30 >> 43);
}

uint32_t fx_sqrt_u64(uint64_t x)
{
    if (x == 0) {
        return 0;
    }
    /* An even shift makes n = 2^62..2^64; the floor of its root, shifted back by half, is ours. */
    const int zeros = fx_clz64(x) & ~1;
    const uint64_t n = x << zeros;
    const uint64_t v_q32 = n >> 32; /* 2^30..2^32: 1/4..1 */

    /* The table's inverse root is right to 2^-8, and one step of Newton makes that 1.5 * 2^-16.
     * Its square is at most 2^32, and the factor (3 - v y^2) near 2. */
    const uint64_t table_q15 = fx_table_rsqrt_q15[(v_q32 >> 24) - 64u];
    const uint64_t factor_q30 = (3ull << 30) - (v_q32 * (table_q15 * table_q15) >> 32);
    const uint32_t inverse_q30 = (uint32_t)(table_q15 * factor_q30 >> 16);

    /* The first guess misses by up to 2^17, the second by 5 and the third by one. None of the two
     * steps lands above the truth, for both curves bend that way and every shift rounds down.
     * All 3 * 2^30 values of v_q32 were tried, at both ends of what it leaves out of n, and both
     * sides of all squares above 2^62. */
    uint64_t s = v_q32 * inverse_q30 >> 30;
    s = heron_step(s, n, inverse_q30);
    s = heron_step(s, n, inverse_q30);
    if (n - s * s > 2 * s) {
        s++;
    }
    return (uint32_t)(s >> (zeros / 2));
}
