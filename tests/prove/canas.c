/* CANaerospace decoder (lm/canas.h): its steps, in the order of lm_canas_take.
 *
 * Proved, for any frame and any profile that lm_bus_profile_check lets pass:
 * - prove_find: a row is found inside the profile, whose identifier is the frame's, with a channel
 *   below LM_BUS_CHANNELS; or the frame is one that no row takes.
 * - prove_accept: of any decoder and any set of nodes. A frame that goes on has four bytes and its
 *   type's, comes from a node that is heard and has a type of its row. No count of equal message
 *   codes passes LM_CANAS_STILL.
 * - prove_half: two halves are joined only from one node, within a period, with adjacent codes; the
 *   value has the time of the first, which is not later than the frame.
 * - prove_number: for each field, no step of a conversion overflows, and each type that the row
 *   may have is read inside the frame.
 * - prove_scale: what is in range is converted without an overflow.
 *
 * Assumed: division and floats are stand-ins here: that they are called as their headers say is
 * proved, and their results are anything. float_bits.c and bus_ranges.c are about them. Tables have
 * at most 32 rows, the smallest limit that lm/config.h allows. */
#define lm_bus_divide real_divide
#include "firmware/bus/bus_fields.c"
#undef lm_bus_divide
int64_t lm_bus_divide(int64_t n, int64_t divisor);

#include "firmware/bus/bus_check.c"
#include "firmware/bus/canas.c"
#include "prove.h"

struct lm_canas nondet_canas(void);
struct lm_can_frame nondet_frame(void);
struct lm_canas_pair nondet_pair(void);
struct lm_bus_row nondet_row(void);

int64_t lm_bus_divide(int64_t n, int64_t divisor)
{
    PROVE(divisor > 0 && n >= -(INT64_MAX - divisor) && n <= INT64_MAX - divisor);
    return nondet_i64();
}

bool fx_f32_bits_to_q(uint32_t bits, int frac_bits, int64_t *q)
{
    PROVE(frac_bits >= 0 && frac_bits < 63);
    *q = nondet_i64();
    return nondet_bool();
}

bool fx_f64_bits_to_q(uint64_t bits, int frac_bits, int64_t *q)
{
    PROVE(frac_bits >= 0 && frac_bits < 63);
    *q = nondet_i64();
    return nondet_bool();
}

void prove_find(void)
{
    static struct lm_bus_row rows[LM_BUS_ROWS_MAX];
    for (uint32_t i = 0; i < LM_BUS_ROWS_MAX; i++) {
        rows[i] = nondet_row();
    }
    const struct lm_bus_profile p = {.rows = rows, .row_count = nondet_u8()};
    ASSUME(p.row_count <= LM_BUS_ROWS_MAX);
    const struct lm_can_frame frame = nondet_frame();
    uint32_t row, channel;
    const enum lm_bus_outcome outcome = find_row(&p, &frame, &row, &channel);
    if (outcome == LM_BUS_VALUE) {
        PROVE(row < p.row_count && channel < LM_BUS_CHANNELS);
        PROVE(rows[row].id == (frame.id & 0xffff) && channel == frame.id >> 16);
    } else {
        PROVE(outcome == LM_BUS_FOREIGN || outcome == LM_BUS_SERVICE || outcome == LM_BUS_UNUSED ||
              outcome == LM_BUS_OTHER_CHANNEL);
    }
}

void prove_accept(void)
{
    static struct lm_canas c;
    static uint8_t nodes[LM_BUS_NODE_BYTES];
    c = nondet_canas();
    c.nodes = nondet_bool() ? nodes : NULL;
    const uint32_t number = LM_BUS_ROWS_MAX - 1, channel = nondet_u32(); /* the last is like all */
    ASSUME(channel < LM_BUS_CHANNELS);
    ASSUME(c.last[number][channel].still <= LM_CANAS_STILL);
    const struct lm_can_frame frame = nondet_frame();
    const bool is_assumed = nondet_bool();
    static struct lm_bus_row rows[LM_BUS_ROWS_MAX];
    rows[number] = nondet_row();
    ASSUME(rows[number].field < LM_BUS_FIELDS && is_canas_sound(&rows[number], is_assumed));
    const struct lm_bus_profile p = {
        .rows = rows, .row_count = LM_BUS_ROWS_MAX, .are_types_assumed = is_assumed};
    struct accepted a;
    const enum lm_bus_outcome outcome = accept(&c, &p, &frame, number, channel, &a);
    PROVE(c.last[number][channel].still <= LM_CANAS_STILL);
    if (outcome == LM_BUS_VALUE) {
        PROVE(frame.length <= 8 && frame.length >= 4 + bytes_of(a.type));
        PROVE(frame.data[0] != 0 && lm_bus_is_heard(c.nodes, frame.data[0]));
        PROVE(a.type < LM_CANAS_TYPES && (a.row->types >> a.type & 1) == 1);
        PROVE(a.row == &rows[number] && a.frame == &frame);
    } else {
        PROVE(outcome == LM_BUS_BAD_LENGTH || outcome == LM_BUS_BAD_NODE ||
              outcome == LM_BUS_BAD_TYPE || outcome == LM_BUS_NO_DATA ||
              outcome == LM_BUS_NODE_REFUSED);
    }
}

void prove_half(void)
{
    static struct lm_canas c;
    struct lm_canas_pair p = nondet_pair();
    const struct lm_canas_pair before = p;
    const struct lm_can_frame frame = nondet_frame();
    ASSUME(frame.data[1] == LM_CANAS_DOUBLEH || frame.data[1] == LM_CANAS_DOUBLEL);
    const uint32_t period_us = nondet_u32();
    uint64_t bits, time_us;
    if (take_half(&c, &p, period_us, &frame, &bits, &time_us)) {
        const uint8_t apart = (uint8_t)(frame.data[3] - before.code);
        PROVE(before.node == frame.data[0] && before.type != frame.data[1]);
        PROVE(apart == 1 || apart == 0xff);
        PROVE(time_us == before.time_us && time_us <= frame.time_us &&
              frame.time_us - time_us <= period_us);
    }
    PROVE(p.state != LM_CANAS_EMPTY && p.time_us == frame.time_us);
}

/* The field is one of which all members of the scale are known: no division has to be followed. */
static void read_one(enum lm_bus_field field)
{
    struct lm_canas_pair pair = nondet_pair();
    static struct lm_canas c;
    struct lm_bus_row row = nondet_row();
    row.field = (uint8_t)field;
    const struct lm_can_frame frame = nondet_frame();
    const struct accepted a = {&frame, &row, &pair, nondet_u8()};
    ASSUME(lm_canas_fits(field, a.type) && row.per_unit >= 1 && row.per_unit <= 1000000000);
    struct number number = {0};
    uint64_t time_us = frame.time_us;
    const enum lm_bus_outcome outcome = read_number(&c, &a, &number, &time_us);
    PROVE(outcome == LM_BUS_VALUE || outcome == LM_BUS_HALF || outcome == LM_BUS_NOT_A_NUMBER ||
          outcome == LM_BUS_OUT_OF_RANGE);
    PROVE(time_us <= frame.time_us);
}

/* One field of each unit. */
void prove_number(void)
{
    static const uint8_t of_unit[] = {
        LM_BUS_LATITUDE,      LM_BUS_YAW_RATE,      LM_BUS_TRUE_ALTITUDE, LM_BUS_GROUND_SPEED,
        LM_BUS_UTC,           LM_BUS_RAIN_RATE,     LM_BUS_JAMMER_RATIO,  LM_BUS_WEATHER_CLEAR,
        LM_BUS_SEA_STATE,     LM_BUS_EXERCISE_TIME, LM_BUS_EXERCISE_RATE, LM_BUS_MALFUNCTION,
        LM_BUS_EXERCISE_SEED, LM_BUS_LIVE_VELOCITY};
    _Static_assert(sizeof of_unit == LM_BUS_UNITS, "one of each");
    const uint8_t unit = nondet_u8();
    for (uint8_t u = 0; u < LM_BUS_UNITS; u++) {
        PROVE(lm_bus_fields[of_unit[u]].unit == u);
        if (u == unit) {
            read_one((enum lm_bus_field)of_unit[u]);
        }
    }
}

void prove_scale(void)
{
    const struct lm_bus_row row = nondet_row();
    ASSUME(row.field < LM_BUS_FIELDS && is_range_sound(&row));
    int32_t value;
    const enum lm_bus_outcome outcome = scale_number(&row, nondet_i64(), &value);
    PROVE(outcome == LM_BUS_VALUE || outcome == LM_BUS_OUT_OF_RANGE);
}
