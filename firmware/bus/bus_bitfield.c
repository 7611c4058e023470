#include "lm/bus_bitfield.h"

#include "fx/float_bits.h"

/* Up to 64 bits as one number. Its bytes are the eight from that of the first bit on, the first of
 * them on top or at the bottom; bytes past the end count as 0. The row's check says that the bits
 * lie within. */
static uint64_t extract(const struct lm_bus_payload *payload, struct lm_bus_bits bits,
                        bool is_little_endian)
{
    const uint32_t start = bits.first / 8u, skipped = bits.first % 8u;
    uint64_t word = 0;
    for (uint32_t i = 0; i < 8; i++) {
        const uint64_t byte = start + i < payload->length ? payload->data[start + i] : 0;
        word |= byte << 8 * (is_little_endian ? i : 7 - i);
    }
    const uint32_t below = is_little_endian ? skipped : 64u - skipped - bits.count;
    return word >> below & (UINT64_MAX >> (64 - bits.count));
}

static bool is_inside(struct lm_bus_bits bits, const struct lm_bus_payload *payload)
{
    return (uint32_t)bits.first + bits.count <= 8 * payload->length;
}

/* The float as a number with the row's frac_bits. */
static enum lm_bus_outcome read_float(const struct lm_bus_packing *p, uint64_t raw, int64_t *number)
{
    const bool is_single = p->bits.count == 32;
    const uint64_t exponent = is_single ? 0x7f800000 : 0x7ff0000000000000;
    if ((raw & exponent) == exponent) {
        return LM_BUS_NOT_A_NUMBER;
    }
    const bool fits = is_single ? fx_f32_bits_to_q((uint32_t)raw, p->frac_bits, number)
                                : fx_f64_bits_to_q(raw, p->frac_bits, number);
    return fits && *number > -(1LL << 32) && *number < 1LL << 32 ? LM_BUS_VALUE
                                                                 : LM_BUS_OUT_OF_RANGE;
}

static enum lm_bus_outcome read_number(const struct lm_bus_packing *p, uint64_t raw,
                                       int64_t *number)
{
    if (p->type == LM_BUS_FLOAT) {
        return read_float(p, raw, number);
    }
    if (p->has_none && raw == p->none) {
        return LM_BUS_NO_DATA;
    }
    const int64_t span = (int64_t)1 << p->bits.count; /* at most 2^32 */
    const bool is_negative = p->type == LM_BUS_SIGNED && (int64_t)raw >= span / 2;
    *number = is_negative ? (int64_t)raw - span : (int64_t)raw;
    return LM_BUS_VALUE;
}

/* Resolution of a number, in units of the field: that of one count of the integer, or of the last
 * place of a single float. The product, at most 2^30 * 2^8, is clamped to 2^32. */
static uint32_t step_of(const struct lm_bus_packing *p, uint64_t raw)
{
    int32_t up = -(int32_t)p->shift;
    if (p->type == LM_BUS_FLOAT) {
        if (p->bits.count == 64) {
            return 0;
        }
        up += (int32_t)(raw >> 23 & 0xff) - 150 + p->frac_bits;
    }
    if (up >= 0) { /* at most 8, the number being below 2^32 */
        const uint64_t step = (uint64_t)p->multiplier << up;
        return step < UINT32_MAX ? (uint32_t)step : UINT32_MAX;
    }
    return up > -31 ? (uint32_t)p->multiplier >> -up : 0;
}

bool lm_bus_bitfield_is_row(const struct lm_bus_row *row, const struct lm_can_frame *frame)
{
    return frame->is_extended && (frame->id & row->packing.mask) == row->id;
}

enum lm_bus_outcome lm_bus_bitfield_read(const struct lm_bus_row *row,
                                         const struct lm_bus_payload *payload,
                                         struct lm_bus_event *event)
{
    const struct lm_bus_packing *p = &row->packing;
    const enum lm_bus_field field = (enum lm_bus_field)row->field;
    if (!is_inside(p->bits, payload) || !is_inside(p->match, payload)) {
        return LM_BUS_BAD_LENGTH;
    }
    if (p->match.count != 0 && extract(payload, p->match, p->is_little_endian) != p->match_value) {
        return LM_BUS_UNUSED;
    }
    const uint64_t raw = extract(payload, p->bits, p->is_little_endian);
    int64_t number;
    const enum lm_bus_outcome outcome = read_number(p, raw, &number);
    if (outcome != LM_BUS_VALUE) {
        return outcome;
    }
    const int64_t value = (number * p->multiplier + p->bias) >> p->shift;
    if (value < lm_bus_counts(field, row->low) || value > lm_bus_counts(field, row->high)) {
        return LM_BUS_OUT_OF_RANGE;
    }
    event->value = (int32_t)(uint32_t)value; /* an angle of 180 degrees or more wraps */
    event->step = step_of(p, raw);
    event->time_us = payload->time_us;
    return LM_BUS_VALUE;
}
