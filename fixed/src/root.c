#include "fx/root.h"

#include "fx/bits.h"
#include "fx/tables.h"

/* One step of Heron's rule, s + (n - s^2) / (2s), with 1/(2s) taken from the inverse root.
 *
 * The difference is below 2^50, so that it is right although its parts wrap modulo 2^64. Dropping
 * its lowest 20 bits keeps the product with the inverse root below 2^62, and costs 2^-12 of the
 * result. */
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
    /* An even shift makes n = 2^62..2^64. The floor of its root, shifted back by half as many bits,
     * is the result. */
    const int zeros = fx_clz64(x) & ~1;
    const uint64_t n = x << zeros;
    const uint64_t v_q32 = n >> 32; /* 2^30..2^32: 1/4..1 */

    /* The table's inverse root y is right to 2^-8. One step of Newton, y (3 - v y^2) / 2, makes
     * that 1.5 * 2^-16. The square of y is at most 2^32, and the factor (3 - v y^2) is near 2. */
    const uint64_t table_q15 = fx_table_rsqrt_q15[(v_q32 >> 24) - 64u];
    const uint64_t factor_q30 = (3ull << 30) - (v_q32 * (table_q15 * table_q15) >> 32);
    const uint32_t inverse_q30 = (uint32_t)(table_q15 * factor_q30 >> 16);

    /* The first guess is off by up to 2^17, the second by 5 and the third by one. Neither step ends
     * above the root: the curve bends that way and every shift rounds down.
     * All 3 * 2^30 values of v_q32 were tried, with the lowest and the highest n of each. So were
     * both sides of all squares above 2^62. */
    uint64_t s = v_q32 * inverse_q30 >> 30;
    s = heron_step(s, n, inverse_q30);
    s = heron_step(s, n, inverse_q30);
    if (n - s * s > 2 * s) {
        s++;
    }
    return (uint32_t)(s >> (zeros / 2));
}
