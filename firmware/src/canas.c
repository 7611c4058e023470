#include "lm/canas.h"

#include "fx/float_bits.h"

#define TYPE(name) (1u << (LM_CANAS_##name))

#define ANALOGUE (TYPE(FLOAT) | TYPE(SHORT2))
#define CLOCK    TYPE(CHAR4)
#define HALVES   (TYPE(DOUBLEH) | TYPE(DOUBLEL))
#define POSITION (HALVES | ANALOGUE | TYPE(LONG))

#define ROW(field, name, id, types, unit, low, high, period_us, stale_ms, dead_ms)                 \
    [LM_CANAS_##field] = {name, types, low, high, period_us, id, LM_CANAS_##unit, stale_ms, dead_ms}

/* Ages. What comes every 100 ms is stale when three in a row were lost; one lost frame is a common
 * thing on a bus. Attitude and heading come eight times as often and turn fast: at 100 ms a roll of
 * 90 deg/s is wrong by 9 degrees, at 1 s it says nothing any more. Position and velocity die after
 * 2 s: until then dead reckoning in a turn of 3 deg/s stays within 32 m at 300 m/s, a pixel at the
 * longer ranges. Height moves slowly and dies after 5 s.
 *
 * Ranges. Wide enough for any aircraft, narrow enough that a wrong unit or a damaged exponent
 * shows; a heading or track may be written as 0..360 or as +-180, since the angle is the same. */
/* clang-format off */
const struct lm_canas_row lm_canas_table[LM_CANAS_FIELDS] = {
    ROW(LATITUDE,        "GPS latitude",                 1036, POSITION,  BAM,         -90,     90,   100000,   300,   2000),
    ROW(LONGITUDE,       "GPS longitude",                1037, POSITION,  BAM,        -180,    180,   100000,   300,   2000),
    ROW(GPS_HEIGHT,      "GPS height above ellipsoid",   1038, ANALOGUE,  Q6,        -1000,  30000,   100000,   500,   5000),
    ROW(GROUND_SPEED,    "GPS ground speed",             1039, ANALOGUE,  MM_S,          0,   1500,   100000,   300,   2000),
    ROW(TRUE_TRACK,      "GPS true track",               1040, ANALOGUE,  BAM,        -180,    360,   100000,   300,   2000),
    ROW(PITCH,           "body pitch angle",              311, ANALOGUE,  BAM,         -90,     90,    12500,   100,   1000),
    ROW(ROLL,            "body roll angle",               312, ANALOGUE,  BAM,        -180,    180,    12500,   100,   1000),
    ROW(HEADING,         "heading angle",                 321, ANALOGUE,  BAM,        -180,    360,    12500,   100,   1000),
    ROW(TRUE_HEADING,    "true heading",                 1133, ANALOGUE,  BAM,        -180,    360,   100000,   300,   1000),
    ROW(BARO_ALTITUDE,   "baro corrected altitude",       320, ANALOGUE,  Q6,        -1000,  30000,   100000,   500,   5000),
    ROW(TRUE_ALTITUDE,   "true altitude",                 332, ANALOGUE,  Q6,        -1000,  30000,   100000,   500,   5000),
    ROW(ALTITUDE_RATE,   "altitude rate",                 314, ANALOGUE,  MM_S,       -500,    500,   100000,   300,   2000),
    ROW(EAST_VELOCITY,   "true east velocity",           1130, ANALOGUE,  MM_S,      -1500,   1500,   100000,   300,   2000),
    ROW(NORTH_VELOCITY,  "true north velocity",          1131, ANALOGUE,  MM_S,      -1500,   1500,   100000,   300,   2000),
    ROW(UP_VELOCITY,     "true up velocity",             1132, ANALOGUE,  MM_S,       -500,    500,   100000,   300,   2000),
    ROW(PITCH_RATE,      "body pitch rate",               303, ANALOGUE,  BAM,        -170,    170,    12500,   100,   1000),
    ROW(YAW_RATE,        "body yaw rate",                 305, ANALOGUE,  BAM,        -170,    170,    12500,   100,   1000),
    ROW(UTC,             "UTC",                          1200, CLOCK,     SECONDS,       0,  86400,  1000000,  3000,  10000),
};
/* clang-format on */
_Static_assert(LM_CANAS_LATITUDE == 0 && LM_CANAS_LONGITUDE == 1, "they index `pair`");

/* Inside, a number is in the unit of the bus with `frac_bits`; the value is that times `multiplier`
 * / `divisor`. A BAM is 360 / 2^32 deg, hence 2^31 / 180. No product below passes 2^62: 360 deg *
 * 2^31 * 1 is 2^40, 1500 m/s * 2^20 * 1000 is 2^41. */
struct scale {
    int frac_bits;
    int32_t multiplier, divisor;
};

static const struct scale scales[] = {
    [LM_CANAS_BAM] = {31, 1, 180},
    [LM_CANAS_Q6] = {6, 1, 1},
    [LM_CANAS_MM_S] = {20, 1000, 1 << 20},
    [LM_CANAS_SECONDS] = {0, 1, 1},
};

/* To the nearest, halves away from zero; divisor > 0 and |n| + divisor below 2^63. */
static int64_t divide_rounded(int64_t n, int64_t divisor)
{
    return (n < 0 ? n - divisor / 2 : n + divisor / 2) / divisor;
}

static uint16_t big_endian_16(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] << 8 | bytes[1]);
}

static uint32_t big_endian_32(const uint8_t *bytes)
{
    return (uint32_t)big_endian_16(bytes) << 16 | big_endian_16(bytes + 2);
}

void lm_canas_init(struct lm_canas *c)
{
    *c = (struct lm_canas){0};
}

/* LM_CANAS_VALUE and *field when a row takes the frame's identifier on channel 0. */
static enum lm_canas_outcome find_row(const struct lm_can_frame *frame, enum lm_canas_field *field)
{
    if (frame->is_error || frame->is_remote) {
        return LM_CANAS_NOT_DATA;
    }
    const uint32_t id = frame->id & 0xffffu, channel = frame->id >> 16;
    const bool is_possible = frame->is_extended ? channel >= 1 && channel <= 0x1fff : channel == 0;
    if (!is_possible || id > 0x7ff) {
        return LM_CANAS_FOREIGN;
    }
    for (uint32_t i = 0; i < LM_CANAS_FIELDS; i++) {
        if (lm_canas_table[i].id == id) {
            *field = (enum lm_canas_field)i;
            return channel == 0 ? LM_CANAS_VALUE : LM_CANAS_OTHER_CHANNEL;
        }
    }
    return LM_CANAS_UNUSED;
}

/* LM_CANAS_VALUE when node, type and length are what the row allows. Every type that a row takes
 * has four data bytes. */
static enum lm_canas_outcome check_header(const struct lm_canas_row *row,
                                          const struct lm_can_frame *frame)
{
    if (frame->length < 4) {
        return LM_CANAS_BAD_LENGTH;
    }
    if (frame->data[0] == 0) {
        return LM_CANAS_BAD_NODE;
    }
    const uint8_t type = frame->data[1];
    if (type == LM_CANAS_NODATA || type == LM_CANAS_ERROR) {
        return frame->length == (type == LM_CANAS_NODATA ? 4 : 8) ? LM_CANAS_NO_DATA
                                                                  : LM_CANAS_BAD_LENGTH;
    }
    if (type >= 32 || (row->types >> type & 1u) == 0) {
        return LM_CANAS_BAD_TYPE;
    }
    return frame->length == 8 ? LM_CANAS_VALUE : LM_CANAS_BAD_LENGTH;
}

/* Count a message code that does not follow the sender's last one. The first frame of a node cannot
 * break anything. */
static void follow_sequence(struct lm_canas *c, enum lm_canas_field field, uint8_t node,
                            uint8_t code)
{
    if (c->last[field].node == node && code != (uint8_t)(c->last[field].code + 1)) {
        c->count.sequence_breaks++;
    }
    c->last[field].node = node;
    c->last[field].code = code;
}

static void drop_half(struct lm_canas *c, struct lm_canas_pair *p)
{
    if (p->state == LM_CANAS_WAITING) {
        c->count.torn_pairs++;
    }
    p->state = LM_CANAS_EMPTY;
}

/* Are two halves mates that are arranged by this habit? Learns on the way: of two ways to pair a
 * run of halves, the one that leaves less time between mates is right. A factor of two keeps jitter
 * from turning an evenly spaced sender over and over. */
static bool are_mates(struct lm_canas_pair *p, int8_t habit, uint64_t gap_us, uint32_t period_us)
{
    if (gap_us > period_us) {
        if (p->habit == habit) {
            p->habit = 0; /* what ought to be mates is not: learn the habit anew */
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

/* Does a half complete the one that is held? */
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

/* Take a half. True when it completes a value: *bits is the double, *time_us when its first half
 * came. */
static bool take_half(struct lm_canas *c, enum lm_canas_field field,
                      const struct lm_can_frame *frame, uint64_t *bits, uint64_t *time_us)
{
    struct lm_canas_pair *p = &c->pair[field];
    const uint8_t node = frame->data[0], type = frame->data[1], code = frame->data[3];
    const uint32_t word = big_endian_32(frame->data + 4);
    if (p->state != LM_CANAS_EMPTY && node != p->node) {
        drop_half(c, p);
        p->habit = 0;
    }
    const bool is_joined = completes(p, frame, lm_canas_table[field].period_us);
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
static enum lm_canas_outcome read_clock(const uint8_t *data, int64_t *seconds)
{
    const int32_t hour = data[0], minute = data[1], second = data[2];
    const bool is_leap = hour == 23 && minute == 59 && second == 60;
    if (hour > 23 || minute > 59 || (second > 59 && !is_leap)) {
        return LM_CANAS_OUT_OF_RANGE;
    }
    *seconds = hour * 3600 + minute * 60 + second;
    return LM_CANAS_VALUE;
}

/* Value and full scale. |value * scale| is at most 2^30 and frac_bits at most 31. */
static enum lm_canas_outcome read_short2(const uint8_t *data, int frac_bits, int64_t *q)
{
    const int16_t value = (int16_t)big_endian_16(data), scale = (int16_t)big_endian_16(data + 2);
    if (scale <= 0) {
        return LM_CANAS_NOT_A_NUMBER;
    }
    *q = divide_rounded((int64_t)value * scale * (1LL << frac_bits), 32767);
    return LM_CANAS_VALUE;
}

static enum lm_canas_outcome read_float(uint32_t bits, int frac_bits, int64_t *q)
{
    if ((bits & 0x7f800000u) == 0x7f800000u) {
        return LM_CANAS_NOT_A_NUMBER;
    }
    return fx_f32_bits_to_q(bits, frac_bits, q) ? LM_CANAS_VALUE : LM_CANAS_OUT_OF_RANGE;
}

static enum lm_canas_outcome read_double(uint64_t bits, int frac_bits, int64_t *q)
{
    if ((bits >> 52 & 0x7ff) == 0x7ff) {
        return LM_CANAS_NOT_A_NUMBER;
    }
    return fx_f64_bits_to_q(bits, frac_bits, q) ? LM_CANAS_VALUE : LM_CANAS_OUT_OF_RANGE;
}

/* The frame's number in the unit of the bus with `frac_bits`, by its type. */
static enum lm_canas_outcome read_number(struct lm_canas *c, const struct lm_can_frame *frame,
                                         int frac_bits, struct lm_canas_event *event, int64_t *q)
{
    const uint8_t *data = frame->data + 4;
    uint64_t bits;
    switch (frame->data[1]) {
    case LM_CANAS_FLOAT:
        return read_float(big_endian_32(data), frac_bits, q);
    case LM_CANAS_LONG:
        /* 2^31 * 2^31, with room for rounding. */
        *q = divide_rounded((int64_t)(int32_t)big_endian_32(data) * (1LL << frac_bits), 10000000);
        return LM_CANAS_VALUE;
    case LM_CANAS_SHORT2:
        event->is_coarse = true;
        return read_short2(data, frac_bits, q);
    case LM_CANAS_CHAR4:
        return read_clock(data, q);
    default: /* DOUBLEH or DOUBLEL: check_header lets nothing else pass */
        return take_half(c, event->field, frame, &bits, &event->time_us)
                   ? read_double(bits, frac_bits, q)
                   : LM_CANAS_HALF;
    }
}

static enum lm_canas_outcome decode(struct lm_canas *c, const struct lm_can_frame *frame,
                                    struct lm_canas_event *event)
{
    enum lm_canas_field field;
    enum lm_canas_outcome outcome = find_row(frame, &field);
    if (outcome != LM_CANAS_VALUE) {
        return outcome;
    }
    const struct lm_canas_row *row = &lm_canas_table[field];
    outcome = check_header(row, frame);
    const bool is_half = outcome == LM_CANAS_VALUE && frame->data[1] >= LM_CANAS_DOUBLEH;
    if ((row->types & HALVES) != 0 && !is_half) {
        drop_half(c, &c->pair[field]);
    }
    if (outcome == LM_CANAS_VALUE || outcome == LM_CANAS_NO_DATA) {
        follow_sequence(c, field, frame->data[0], frame->data[3]);
    }
    if (outcome != LM_CANAS_VALUE) {
        return outcome;
    }
    const struct scale *scale = &scales[row->unit];
    struct lm_canas_event e = {.field = field, .node = frame->data[0], .time_us = frame->time_us};
    int64_t q;
    outcome = read_number(c, frame, scale->frac_bits, &e, &q);
    if (outcome != LM_CANAS_VALUE) {
        return outcome;
    }
    const int64_t one = (int64_t)1 << scale->frac_bits;
    if (q < row->low * one || q > row->high * one) {
        return LM_CANAS_OUT_OF_RANGE;
    }
    /* An angle of 180 degrees or more wraps, as angles do. */
    e.value = (int32_t)(uint32_t)divide_rounded(q * scale->multiplier, scale->divisor);
    *event = e;
    return LM_CANAS_VALUE;
}

enum lm_canas_outcome lm_canas_take(struct lm_canas *c, const struct lm_can_frame *frame,
                                    struct lm_canas_event *event)
{
    const enum lm_canas_outcome outcome = decode(c, frame, event);
    c->count.frames++;
    c->count.outcome[outcome]++;
    return outcome;
}
