/* IEEE 754 numbers from the bus, turned into fixed point without any floating arithmetic. */
#ifndef FX_FLOAT_BITS_H
#define FX_FLOAT_BITS_H

#include <stdbool.h>
#include <stdint.h>

/* Store the number whose bit pattern is `bits`, times 2^frac_bits, rounded to nearest with halves
 * away from zero; `frac_bits` may be any int. Returns false and leaves *out alone for NaN, for
 * infinities, and for results that do not fit. Cost 44 instructions. */
bool fx_f32_bits_to_q(uint32_t bits, int frac_bits, int64_t *out);
bool fx_f64_bits_to_q(uint64_t bits, int frac_bits, int64_t *out);

#endif
