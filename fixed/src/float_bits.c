#include "fx/float_bits.h"

#include "fx/bits.h"

/* *out = `size` * 2^shift with a sign; `size` is below 2^53. False if that does not fit. */
static bool scale(uint64_t size, int64_t shift, bool is_negative, int64_t *out)
{
    if (shift < -53) {
        size = 0; /* below one half */
    } else if (shift < 0) {
        size = (size + (1ull << (-shift - 1))) >> -shift;
    } else if (size != 0) {
        if (shift > fx_clz64(size)) {
            return false;
        }
        size <<= shift;
    }
    const uint64_t largest = (uint64_t)INT64_MAX + is_negative;
    if (size > largest) {
        return false;
    }
    /* The magnitude of INT64_MIN, 2^63, does not fit int64_t: negate one less, then subtract. */
    *out = is_negative && size != 0 ? -(int64_t)(size - 1) - 1 : (int64_t)size;
    return true;
}

/* Decode either format from its sign, `exponent` and `fraction` of `fraction_bits`. An exponent of
 * 0 marks zero and the subnormal numbers, which lack the leading one. */
static bool decode(uint64_t fraction, int fraction_bits, int exponent, int bias, bool is_negative,
                   int frac_bits, int64_t *out)
{
    if (exponent == 2 * bias + 1) {
        return false; /* infinity or not a number */
    }
    const uint64_t size = exponent == 0 ? fraction : fraction | 1ull << fraction_bits;
    const int power = exponent == 0 ? 1 : exponent;
    return scale(size, (int64_t)power - bias - fraction_bits + frac_bits, is_negative, out);
}

bool fx_f32_bits_to_q(uint32_t bits, int frac_bits, int64_t *out)
{
    return decode(bits & 0x7fffffu, 23, (int)(bits >> 23 & 0xffu), 127, bits >> 31 != 0, frac_bits,
                  out);
}

bool fx_f64_bits_to_q(uint64_t bits, int frac_bits, int64_t *out)
{
    return decode(bits & 0xfffffffffffffull, 52, (int)(bits >> 52 & 0x7ffu), 1023, bits >> 63 != 0,
                  frac_bits, out);
}
