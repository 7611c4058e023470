#include "lm/canas.h"

#include "fx/float_bits.h"
#include "fx/sat.h"

#define HALVES (1u << LM_CANAS_DOUBLEH | 1u << LM_CANAS_DOUBLEL)

_Static_assert(LM_BUS_LATITUDE == 0 && LM_BUS_LONGITUDE == 1, "they index `pair`");

#define KIND(name) LM_CANAS_KIND_##name

const struct lm_canas_type lm_canas_types[LM_CANAS_TYPES] = {
    {"NODATA", KIND(NONE), 0, 0},     {"ERROR", KIND(BITS), 4, 1},
    {"FLOAT", KIND(FLOAT), 4, 1},     {"LONG", KIND(SIGNED), 4, 1},
    {"ULONG", KIND(UNSIGNED), 4, 1},  {"BLONG", KIND(BITS), 4, 1},
    {"SHORT", KIND(SIGNED), 2, 1},    {"USHORT", KIND(UNSIGNED), 2, 1},
    {"BSHORT", KIND(BITS), 2, 1},     {"CHAR", KIND(SIGNED), 1, 1},
    {"UCHAR", KIND(UNSIGNED), 1, 1},  {"BCHAR", KIND(BITS), 1, 1},
    {"SHORT2", KIND(SIGNED), 2, 2},   {"USHORT2", KIND(UNSIGNED), 2, 2},
    {"BSHORT2", KIND(BITS), 2, 2},    {"CHAR4", KIND(SIGNED), 1, 4},
    {"UCHAR4", KIND(UNSIGNED), 1, 4}, {"BCHAR4", KIND(BITS), 1, 4},
    {"CHAR2", KIND(SIGNED), 1, 2},    {"UCHAR2", KIND(UNSIGNED), 1, 2},
    {"BCHAR2", KIND(BITS), 1, 2},     {"MEMID", KIND(BITS), 4, 1},
    {"CHKSUM", KIND(BITS), 4, 1},     {"ACHAR", KIND(TEXT), 1, 1},
    {"ACHAR2", KIND(TEXT), 1, 2},     {"ACHAR4", KIND(TEXT), 1, 4},
    {"CHAR3", KIND(SIGNED), 1, 3},    {"UCHAR3", KIND(UNSIGNED), 1, 3},
    {"BCHAR3", KIND(BITS), 1, 3},     {"ACHAR3", KIND(TEXT), 1, 3},
    {"DOUBLEH", KIND(HALF), 4, 1},    {"DOUBLEL", KIND(HALF), 4, 1},
};

static bool is_integer(const struct lm_canas_type *type)
{
    return type->kind == LM_CANAS_KIND_SIGNED || type->kind == LM_CANAS_KIND_UNSIGNED;
}

bool lm_canas_fits(enum lm_bus_field field, uint8_t type)
{
    if (type >= LM_CANAS_TYPES) {
        return false;
    }
    const struct lm_canas_type *t = &lm_canas_types[type];
    if (lm_bus_fields[field].unit == LM_BUS_WORD) {
        return t->elements >= 2 && t->element_bytes * t->elements == 4;
    }
    if (lm_bus_fields[field].unit == LM_BUS_SECONDS) {
        return is_integer(t) && t->element_bytes == 1 && t->elements >= 3;
    }
    return t->kind == LM_CANAS_KIND_FLOAT || (is_integer(t) && t->elements == 1) ||
           type == LM_CANAS_SHORT2 || (t->kind == LM_CANAS_KIND_HALF && field <= LM_BUS_LONGITUDE);
}

static uint16_t big_endian_16(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] << 8 | bytes[1]);
}

static uint32_t big_endian_32(const uint8_t *bytes)
{
    return (uint32_t)big_endian_16(bytes) << 16 | big_endian_16(bytes + 2);
}

/* The row that takes an identifier of normal operation data, or row_count. */
static uint32_t row_of(const struct lm_bus_profile *profile, uint32_t id)
{
    uint32_t i = 0;
    while (i < profile->row_count && profile->rows[i].id != id) {
        i++;
    }
    return i;
}

/* LM_BUS_VALUE, with *row and *channel, if a row takes the frame's identifier. Channel 0 has 11
 * bits, channel n has 29 and adds 65536 * n; bits 11..15 are never set. */
static enum lm_bus_outcome find_row(const struct lm_bus_profile *profile,
                                    const struct lm_can_frame *frame, uint32_t *row,
                                    uint32_t *channel)
{
    const uint32_t id = frame->id & 0xffffu;
    *channel = frame->id >> 16;
    const bool is_possible =
        frame->is_extended ? *channel >= 1 && *channel <= 0x1fff : *channel == 0;
    if (!is_possible || id > 0x7ff) {
        return LM_BUS_FOREIGN;
    }
    if ((id >= LM_CANAS_SERVICE_FIRST && id <= LM_CANAS_SERVICE_LAST) ||
        (id >= LM_CANAS_LOW_SERVICE_FIRST && id <= LM_CANAS_LOW_SERVICE_LAST)) {
        return LM_BUS_SERVICE;
    }
    *row = row_of(profile, id);
    return *row == profile->row_count    ? LM_BUS_UNUSED
           : *channel >= LM_BUS_CHANNELS ? LM_BUS_OTHER_CHANNEL
                                         : LM_BUS_VALUE;
}

static uint8_t bytes_of(uint8_t type)
{
    return (uint8_t)(lm_canas_types[type].element_bytes * lm_canas_types[type].elements);
}

/* LM_BUS_VALUE if the row allows node, type and length. */
static enum lm_bus_outcome check_header(const struct lm_bus_row *row,
                                        const struct lm_can_frame *frame)
{
    const uint8_t type = frame->data[1];
    if (frame->length < 4) {
        return LM_BUS_BAD_LENGTH;
    }
    if (frame->data[0] == 0) {
        return LM_BUS_BAD_NODE;
    }
    const bool says_no_data = type == LM_CANAS_NODATA || type == LM_CANAS_ERROR;
    if (!says_no_data && (type >= LM_CANAS_TYPES || (row->types >> type & 1u) == 0)) {
        return LM_BUS_BAD_TYPE;
    }
    if (frame->length != 4 + bytes_of(type)) {
        return LM_BUS_BAD_LENGTH;
    }
    return says_no_data ? LM_BUS_NO_DATA : LM_BUS_VALUE;
}

/* The same for assumed types, where byte 1 is ignored: the data must hold the row's one type. */
static enum lm_bus_outcome check_assumed(uint8_t type, const struct lm_can_frame *frame)
{
    return frame->length > 8 || frame->length < 4 + bytes_of(type) ? LM_BUS_BAD_LENGTH
           : frame->data[0] == 0                                   ? LM_BUS_BAD_NODE
                                                                   : LM_BUS_VALUE;
}

/* Count a message code that does not follow the sender's last one. The first frame of a node
 * counts as no break. */
static void follow_sequence(struct lm_canas *c, uint32_t row, uint32_t channel,
                            const struct lm_can_frame *frame)
{
    const uint8_t node = frame->data[0], code = frame->data[3];
    const uint8_t expected = (uint8_t)(c->last[row][channel].code + 1);
    const bool is_known = c->last[row][channel].node == node;
    const bool is_still = is_known && code == c->last[row][channel].code;
    if (is_known && code != expected) {
        c->count.sequence_breaks++;
    }
    c->last[row][channel].has_counted =
        is_known && (c->last[row][channel].has_counted || !is_still);
    const uint32_t still = is_still ? c->last[row][channel].still + 1u : 1;
    c->last[row][channel].still = (uint8_t)fx_min_u32(still, LM_CANAS_STILL);
    c->last[row][channel].node = node;
    c->last[row][channel].code = code;
    if (still >= LM_CANAS_STILL && c->last[row][channel].has_counted) {
        c->count.stuck++;
        c->stuck_node = node;
    }
}

static void drop_half(struct lm_canas *c, struct lm_canas_pair *p)
{
    if (p->state == LM_CANAS_WAITING) {
        c->count.torn_pairs++;
    }
    p->state = LM_CANAS_EMPTY;
}

/* True if two halves belong together by the sender's habit. It also learns the habit: of the two
 * ways to pair a run of halves, the one with less time between two halves is right. The factor of
 * two keeps jitter from changing the habit of an evenly spaced sender again and again. */
static bool are_mates(struct lm_canas_pair *p, int8_t habit, uint64_t gap_us, uint32_t period_us)
{
    if (gap_us > period_us) {
        if (p->habit == habit) {
            p->habit = 0; /* the habit no longer fits: learn it again */
        }
        return false;
    }
    const uint32_t limit_us = p->habit == habit ? period_us
                              : p->habit == 0   ? period_us / 2
                                                : p->habit_gap_us / 2;
    if (gap_us > limit_us) {
        return false;
    }
    p->habit = habit;
    p->habit_gap_us = (uint32_t)gap_us;
    return true;
}

/* True if a half completes the one that waits. */
static bool completes(struct lm_canas_pair *p, const struct lm_can_frame *half, uint32_t period_us)
{
    const uint8_t type = half->data[1], code = half->data[3];
    if (p->state == LM_CANAS_EMPTY || type == p->type || half->time_us < p->time_us) {
        return false;
    }
    const bool is_low_last = type == LM_CANAS_DOUBLEL;
    const uint8_t difference = (uint8_t)(is_low_last ? code - p->code : p->code - code);
    if (difference != 1 && difference != 0xff) {
        return false;
    }
    const int habit = (difference == 1 ? 1 : -1) * (is_low_last ? 1 : 2);
    return are_mates(p, (int8_t)habit, half->time_us - p->time_us, period_us);
}

/* Take a half. True if it completes a value: *bits is the double, *time_us the arrival of its first
 * half. */
static bool take_half(struct lm_canas *c, struct lm_canas_pair *p, uint32_t period_us,
                      const struct lm_can_frame *frame, uint64_t *bits, uint64_t *time_us)
{
    const uint8_t node = frame->data[0], type = frame->data[1], code = frame->data[3];
    const uint32_t word = big_endian_32(frame->data + 4);
    if (p->state != LM_CANAS_EMPTY && node != p->node) {
        drop_half(c, p);
        p->habit = 0;
    }
    const bool is_joined = completes(p, frame, period_us);
    if (is_joined) {
        const uint64_t high = type == LM_CANAS_DOUBLEH ? word : p->word;
        const uint64_t low = type == LM_CANAS_DOUBLEL ? word : p->word;
        *bits = high << 32 | low;
        *time_us = p->time_us;
    } else {
        drop_half(c, p);
    }
    p->state = is_joined ? LM_CANAS_JOINED : LM_CANAS_WAITING;
    p->node = node;
    p->type = type;
    p->code = code;
    p->word = word;
    p->time_us = frame->time_us;
    return is_joined;
}

/* Hours, minutes, seconds. The only second 60 is the last one of a day. */
static enum lm_bus_outcome read_clock(const uint8_t *data, int64_t *seconds)
{
    const int32_t hour = data[0], minute = data[1], second = data[2];
    const bool is_leap = hour == 23 && minute == 59 && second == 60;
    if (hour > 23 || minute > 59 || (second > 59 && !is_leap)) {
        return LM_BUS_OUT_OF_RANGE;
    }
    *seconds = hour * 3600 + minute * 60 + second;
    return LM_BUS_VALUE;
}

/* A number that is being read: in the unit of the bus times 2^frac_bits of the scale; and its
 * resolution in units of the field. */
struct number {
    int64_t q;
    uint32_t step;
};

/* One unit of the bus in units of the field: below 2^24. */
static int64_t one_unit(const struct lm_bus_scale *scale)
{
    return ((int64_t)scale->multiplier << scale->frac_bits) / scale->divisor;
}

/* Value and full scale. |value * scale| is at most 2^30 and frac_bits at most 31. */
static enum lm_bus_outcome read_short2(const uint8_t *data, const struct lm_bus_scale *scale,
                                       struct number *number)
{
    const int16_t value = (int16_t)big_endian_16(data), full = (int16_t)big_endian_16(data + 2);
    if (full <= 0) {
        return LM_BUS_NOT_A_NUMBER;
    }
    number->q = lm_bus_divide((int64_t)value * full * (1LL << scale->frac_bits), 32767);
    number->step = (uint32_t)(one_unit(scale) * full / 32767);
    return LM_BUS_VALUE;
}

/* Bits 23..30 of a float are the power of two of its last place, plus 150. */
static enum lm_bus_outcome read_float(uint32_t bits, const struct lm_bus_scale *scale,
                                      struct number *number)
{
    const int32_t exponent = (int32_t)(bits >> 23 & 0xff), down = 150 - exponent;
    if (exponent == 0xff) {
        return LM_BUS_NOT_A_NUMBER;
    }
    number->step = down >= 0 && down < 32 ? (uint32_t)(one_unit(scale) >> down) : 0;
    return fx_f32_bits_to_q(bits, scale->frac_bits, &number->q) ? LM_BUS_VALUE
                                                                : LM_BUS_OUT_OF_RANGE;
}

static enum lm_bus_outcome read_double(uint64_t bits, const struct lm_bus_scale *scale,
                                       struct number *number)
{
    if ((bits >> 52 & 0x7ff) == 0x7ff) {
        return LM_BUS_NOT_A_NUMBER;
    }
    return fx_f64_bits_to_q(bits, scale->frac_bits, &number->q) ? LM_BUS_VALUE
                                                                : LM_BUS_OUT_OF_RANGE;
}

/* An integer of 1, 2 or 4 bytes. |integer * 2^frac_bits| is at most 2^63 - 2^31, and half of
 * per_unit below 2^31. */
static void read_integer(const uint8_t *data, const struct lm_canas_type *type, int32_t per_unit,
                         const struct lm_bus_scale *scale, struct number *number)
{
    const uint32_t unused_bits = 32 - 8u * type->element_bytes;
    const uint32_t word = big_endian_32(data) >> unused_bits << unused_bits;
    const int64_t integer = type->kind == LM_CANAS_KIND_SIGNED
                                ? (int64_t)(int32_t)word / (1LL << unused_bits)
                                : (int64_t)(word >> unused_bits);
    number->q = lm_bus_divide(integer * (1LL << scale->frac_bits), per_unit);
    number->step = (uint32_t)(one_unit(scale) / per_unit);
}

/* A frame whose row, channel and type are checked. */
struct accepted {
    const struct lm_can_frame *frame;
    const struct lm_bus_row *row;
    struct lm_canas_pair *pair; /* used only by rows that take halves: those of coordinates */
    uint8_t type;
};

static enum lm_bus_outcome read_number(struct lm_canas *c, const struct accepted *a,
                                       struct number *number, uint64_t *time_us)
{
    const struct lm_bus_scale *scale = lm_bus_scale_of((enum lm_bus_field)a->row->field);
    const struct lm_canas_type *type = &lm_canas_types[a->type];
    const uint8_t *data = a->frame->data + 4;
    uint64_t bits;
    if (lm_bus_fields[a->row->field].unit == LM_BUS_WORD) {
        number->q = (int32_t)big_endian_32(data);
        return LM_BUS_VALUE;
    }
    if (type->kind == LM_CANAS_KIND_HALF) {
        return take_half(c, a->pair, a->row->period_us, a->frame, &bits, time_us)
                   ? read_double(bits, scale, number)
                   : LM_BUS_HALF;
    }
    if (type->kind == LM_CANAS_KIND_FLOAT) {
        return read_float(big_endian_32(data), scale, number);
    }
    if (a->type == LM_CANAS_SHORT2) {
        return read_short2(data, scale, number);
    }
    if (type->elements >= 3) {
        return read_clock(data, &number->q);
    }
    read_integer(data, type, a->row->per_unit, scale, number);
    return LM_BUS_VALUE;
}

/* Check a number against the row's range, and convert it to the field's unit. An angle of 180
 * degrees or more wraps. |q| is below 2^62 / multiplier once it is in range. */
static enum lm_bus_outcome scale_number(const struct lm_bus_row *row, int64_t q, int32_t *value)
{
    const struct lm_bus_scale *scale = lm_bus_scale_of((enum lm_bus_field)row->field);
    const int64_t one = (int64_t)1 << scale->frac_bits;
    if (lm_bus_fields[row->field].unit == LM_BUS_WORD) {
        *value = (int32_t)q; /* the row's range is that of each number in it */
        return LM_BUS_VALUE;
    }
    if (q < row->low * one || q > row->high * one) {
        return LM_BUS_OUT_OF_RANGE;
    }
    *value = (int32_t)(uint32_t)lm_bus_divide(q * scale->multiplier, scale->divisor);
    return LM_BUS_VALUE;
}

static enum lm_bus_outcome accept(struct lm_canas *c, const struct lm_bus_profile *profile,
                                  const struct lm_can_frame *frame, uint32_t row, uint32_t channel,
                                  struct accepted *a)
{
    a->frame = frame;
    a->row = &profile->rows[row];
    const bool is_assumed = profile->are_types_assumed;
    a->type = is_assumed ? (uint8_t)__builtin_ctz(a->row->types) : frame->data[1];
    a->pair = &c->pair[a->row->field == LM_BUS_LONGITUDE][channel];
    const enum lm_bus_outcome outcome =
        is_assumed ? check_assumed(a->type, frame) : check_header(a->row, frame);
    if (frame->length > 0 && !lm_bus_is_heard(c->nodes, frame->data[0])) {
        return LM_BUS_NODE_REFUSED;
    }
    const bool is_half =
        outcome == LM_BUS_VALUE && lm_canas_types[a->type].kind == LM_CANAS_KIND_HALF;
    if ((a->row->types & HALVES) != 0 && !is_half) {
        drop_half(c, a->pair);
    }
    /* Sets of live targets leave frames out, so that codes of an identifier may jump. */
    const bool is_counted = !lm_bus_is_live(a->row->field);
    if (is_counted && (outcome == LM_BUS_VALUE || outcome == LM_BUS_NO_DATA)) {
        follow_sequence(c, row, channel, frame);
    }
    return outcome;
}

enum lm_bus_outcome lm_canas_take(struct lm_canas *c, const struct lm_bus_profile *profile,
                                  const struct lm_can_frame *frame, struct lm_bus_event *event)
{
    uint32_t row, channel;
    struct accepted a;
    enum lm_bus_outcome outcome = find_row(profile, frame, &row, &channel);
    if (outcome == LM_BUS_VALUE) {
        outcome = accept(c, profile, frame, row, channel, &a);
    }
    if (outcome != LM_BUS_VALUE) {
        return outcome;
    }
    struct number number = {0};
    struct lm_bus_event e = {.row = (uint8_t)row,
                             .channel = (uint8_t)channel,
                             .node = frame->data[0],
                             .service = frame->data[2],
                             .code = frame->data[3],
                             .time_us = frame->time_us};
    outcome = read_number(c, &a, &number, &e.time_us);
    if (outcome == LM_BUS_VALUE) {
        outcome = scale_number(a.row, number.q, &e.value);
    }
    if (outcome == LM_BUS_VALUE) {
        e.step = number.step;
        *event = e;
    }
    return outcome;
}
