/* IEEE 754 bit patterns: conversion of floating-point numbers from the bus to fixed point, with
 * integer arithmetic alone. */
#ifndef FX_FLOAT_BITS_H
#define FX_FLOAT_BITS_H

#include <stdbool.h>
#include <stdint.h>

/* Convert a single to fixed point: *out = value * 2^frac_bits, rounded to nearest, halves away from
 * zero. `bits` is the number's bit pattern and `frac_bits` any int. Zeros of either sign give 0,
 * and subnormal numbers are converted like all others.
 *
 * Returns true, or false with *out unchanged if the number is
 * - NaN,
 * - infinite,
 * - too large: the rounded result does not fit 64 bits.
 *
 * Cost: 44 instructions. */
bool fx_f32_bits_to_q(uint32_t bits, int frac_bits, int64_t *out);

/* Convert a double to fixed point. Rounding, failures and cost are those of fx_f32_bits_to_q. */
bool fx_f64_bits_to_q(uint64_t bits, int frac_bits, int64_t *out);

#endif
