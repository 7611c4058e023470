/* Numbers in frames of packed profiles: ARINC 825, NMEA 2000 and a project's own
 * (lm/bus_bitfield.h).
 *
 * Proved, for each row that lm_bus_profile_check lets pass and for any data of 0..223 bytes: no
 * byte outside the data is read, no step overflows and no shift is too wide. A value lies between
 * `low` and `high` of its row where these fit 32 bits in the unit that is kept; bus_ranges.c shows
 * that they do, but for angles, which wrap. Any other outcome is one that the header lists, and
 * leaves the event alone.
 *
 * Assumed: nothing. */
#define lm_bus_counts real_counts
#include "firmware/bus/bus_fields.c"
#undef lm_bus_counts
int64_t lm_bus_counts(enum lm_bus_field field, int32_t amount);

#include "firmware/bus/bus_bitfield.c"
#include "firmware/bus/bus_check.c"
#include "prove.h"

void *malloc(size_t bytes);
struct lm_bus_row nondet_row(void);
struct lm_bus_event nondet_event(void);

/* Stands for the real one, which bus_ranges.c is about. */
static struct lm_bus_row row;
static int64_t low_counts, high_counts;
int64_t lm_bus_counts(enum lm_bus_field field, int32_t amount)
{
    PROVE(field == (enum lm_bus_field)row.field && (amount == row.low || amount == row.high));
    return amount == row.low ? low_counts : high_counts;
}

static bool is_listed(enum lm_bus_outcome outcome)
{
    return outcome == LM_BUS_BAD_LENGTH || outcome == LM_BUS_UNUSED || outcome == LM_BUS_NO_DATA ||
           outcome == LM_BUS_NOT_A_NUMBER || outcome == LM_BUS_OUT_OF_RANGE;
}

void prove_read(void)
{
    row = nondet_row();
    low_counts = nondet_i64();
    high_counts = nondet_i64();
    const struct lm_bus_profile profile = {.rows = &row, .row_count = 1, .framing = LM_BUS_PACKED};
    ASSUME(is_row_sound(&profile, 0));

    const uint32_t length = nondet_u32();
    ASSUME(length <= LM_FAST_PACKET_BYTES);
    const uint8_t *data = malloc(length);
    ASSUME(data != NULL);
    const struct lm_bus_payload payload = {data, length, nondet_u64()};

    const struct lm_bus_event before = nondet_event();
    struct lm_bus_event event = before;
    const enum lm_bus_outcome outcome = lm_bus_bitfield_read(&row, &payload, &event);
    if (outcome == LM_BUS_VALUE) {
        PROVE(event.time_us == payload.time_us);
        PROVE(low_counts < INT32_MIN || high_counts > INT32_MAX ||
              (event.value >= low_counts && event.value <= high_counts));
    } else {
        PROVE(is_listed(outcome));
        PROVE(event.value == before.value && event.step == before.step &&
              event.time_us == before.time_us);
    }
}
