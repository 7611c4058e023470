#include "bus/words.h"

#include <stddef.h>

static const struct bus_word_part words[LM_BUS_FIELDS][BUS_WORD_PARTS] = {
    [LM_BUS_LIVE_VELOCITY] = {{"east", "m/s", 0.05}, {"north", "m/s", 0.05}},
    [LM_BUS_LIVE_HEADING] = {{"heading", "deg", 180.0 / 32768}, {"turn", "deg/s", 0.01}},
    [LM_BUS_LIVE_KIND] = {{"kind", "", 1},
                          {"reckoning", "", 1},
                          {"signature", "", 1},
                          {"parts", "", 1}},
    [LM_BUS_LIVE_ACCELERATION] = {{"east", "m/s2", 0.01}, {"north", "m/s2", 0.01}},
};

const struct bus_word_part *bus_word_parts(uint8_t field)
{
    return words[field][0].name == NULL ? NULL : words[field];
}

double bus_word_number(const struct lm_canas_type *type, uint32_t word, unsigned index)
{
    const unsigned bits = 8u * type->element_bytes;
    const uint32_t high = word << index * bits; /* at the top */
    return type->kind == LM_CANAS_KIND_SIGNED ? (double)((int32_t)high >> (32 - bits))
                                              : (double)(high >> (32 - bits));
}
