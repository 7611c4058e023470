/* Arithmetic of fixed/: zero bits, clamps, saturation and magnitudes.
 *
 * Proved, for every argument: no shift too wide, no signed overflow, and results as the headers
 * define them. fx/float_bits.h is in float_bits.c.
 *
 * Assumed: nothing. */
#include "fx/bits.h"
#include "fx/sat.h"

#include "prove.h"

void prove_bits(void)
{
    const uint64_t x = nondet_u64();
    const int zeros = fx_clz64(x), below = fx_ctz64(x);
    PROVE(zeros >= 0 && zeros <= 64 && (x == 0 ? zeros == 64 : x << zeros >> 63 == 1));
    PROVE(below >= 0 && below <= 64 && (x == 0 ? below == 64 : (x >> below & 1) == 1));
    PROVE(x == 0 || x == 1 || below == 0 || x << (64 - below) == 0);
}

void prove_saturation(void)
{
    const int64_t x = nondet_i64();
    const int32_t n = nondet_i32(), low = nondet_i32(), high = nondet_i32();
    const int32_t s = fx_sat_i32(x);
    PROVE((x <= INT32_MAX && x >= INT32_MIN) ? s == x : s == (x < 0 ? INT32_MIN : INT32_MAX));
    PROVE(fx_abs_u32(n) == (n < 0 ? (uint64_t) - (int64_t)n : (uint64_t)n));
    ASSUME(low <= high);
    const int32_t c = fx_clamp_i32(n, low, high);
    PROVE(c >= low && c <= high && (c == n || n < low || n > high));
}
