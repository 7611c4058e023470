/* Words: what the numbers in a field of unit LM_BUS_WORD are. */
#ifndef BUS_WORDS_H
#define BUS_WORDS_H

#include "lm/canas.h"

enum { BUS_WORD_PARTS = 4 };

/* One number of a word; the name is NULL behind the last. */
struct bus_word_part {
    const char *name, *unit;
    double scale;
};

/* The BUS_WORD_PARTS parts of a field's word; NULL if the field is not one. */
const struct bus_word_part *bus_word_parts(uint8_t field);

/* Number `index` of a word of this type. */
double bus_word_number(const struct lm_canas_type *type, uint32_t word, unsigned index);

#endif
