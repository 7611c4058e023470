/* Hidden units: what they make of the sum that enters them. Training and the pass over whole images
 * take the same, so that a network meets in an image what it has learnt with. */
#ifndef CLASSIFY_UNITS_H
#define CLASSIFY_UNITS_H

#include <stddef.h>

enum db_unit { DB_UNIT_TANH, DB_UNIT_SIGMOID };

/* tanh by the seventh convergent of Lambert's continued fraction, x (135135 + 17325 x^2 + 378 x^4 +
 * x^6) / (135135 + 62370 x^2 + 3150 x^4 + 28 x^6), held at +-1 where it would pass them. Error at
 * most 1e-4 anywhere. */
float db_fast_tanh(float x);

/* Replace sums by what the units say: a tanh, or the sigmoid of it, (1 + tanh(x / 2)) / 2. */
void db_units_say(enum db_unit unit, float *values, size_t count);

#endif
