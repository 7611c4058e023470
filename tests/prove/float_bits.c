/* IEEE 754 bit patterns to fixed point (fx/float_bits.h).
 *
 * Proved, for every pattern and every place of the point: no step overflows, no shift is too wide;
 * NaN and infinities are refused; a refusal leaves *out alone; the sign is kept; whole numbers of a
 * single below 2^24 come out exact.
 *
 * Assumed: nothing. */
#include "fx/float_bits.h"

#include "prove.h"

void prove_single(void)
{
    const uint32_t bits = nondet_u32();
    const int frac_bits = nondet_i32();
    const int64_t before = nondet_i64();
    int64_t out = before;
    const bool is_number = fx_f32_bits_to_q(bits, frac_bits, &out);
    PROVE(is_number || out == before);
    PROVE(!is_number || (bits >> 23 & 0xff) != 0xff);
    PROVE(!is_number || (bits >> 31 != 0 ? out <= 0 : out >= 0));
}

void prove_double(void)
{
    const uint64_t bits = nondet_u64();
    const int frac_bits = nondet_i32();
    const int64_t before = nondet_i64();
    int64_t out = before;
    const bool is_number = fx_f64_bits_to_q(bits, frac_bits, &out);
    PROVE(is_number || out == before);
    PROVE(!is_number || (bits >> 52 & 0x7ff) != 0x7ff);
    PROVE(!is_number || (bits >> 63 != 0 ? out <= 0 : out >= 0));
}

/* The bits of a whole number are built here from its magnitude: the leading one is dropped. */
void prove_whole(void)
{
    const uint32_t size = nondet_u32(), top = nondet_u32();
    const bool is_negative = nondet_bool();
    ASSUME(top < 24 && size >> top == 1);
    const uint32_t bits =
        (is_negative ? 1u << 31 : 0) | (127 + top) << 23 | (size << (23 - top) & 0x7fffff);
    int64_t out = 0;
    PROVE(fx_f32_bits_to_q(bits, 0, &out));
    PROVE(out == (is_negative ? -(int64_t)size : (int64_t)size));
}
