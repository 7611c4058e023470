#include "fx/recip.h"

#include "fx/bits.h"
#include "fx/tables.h"

uint32_t fx_recip_q(uint32_t d, int *s)
{
    if (d == 0) {
        *s = 0;
        return UINT32_MAX;
    }
    const int zeros = fx_clz32(d);
    const uint64_t n = (uint64_t)d << zeros; /* 2^31..2^32 */
    if (n == 1ull << 31) {
        *s = 62 - zeros;
        return 1u << 31;
    }
    *s = 63 - zeros;

    /* Two steps of Newton, y (2 - n y), with n taken as 1..2 in Q31. The table's 1/n is right to
     * 2^-9 + 2^-16. A step never exceeds 1/n, and every shift here rounds down. Hence no remainder
     * is negative. The first step is low by at most 2^-17.9. The second is low by at most 2^-35.8
     * and less than one unit, which the last line corrects. */
    const uint64_t table_q16 = fx_table_recip_q16[n >> 23 & 255u];
    const uint64_t y_q32 = table_q16 * (((1ull << 48) - n * table_q16) >> 16) >> 15;
    const uint64_t rest = (1ull << 63) - n * y_q32; /* < 2^63 * 2^-17.9 = 2^45.1 */
    uint64_t r = y_q32 + (y_q32 * (rest >> 15) >> 48);
    if ((1ull << 63) - n * r >= n) {
        r++;
    }
    return (uint32_t)r;
}
