/* Ranges of a bus table in the units that are kept (lm/bus_fields.h).
 *
 * Proved, for each row that lm_bus_profile_check lets pass: its range, converted to the unit of its
 * field, fits 32 bits, and no step of the conversion overflows. So no value in range turns its
 * sign. One proof for each kind of unit; latitudes have one of their own. Headings, longitudes and
 * other angles wrap, and are left out.
 *
 * Assumed: nothing. */
#include "firmware/bus/bus_check.c"
#include "prove.h"

struct lm_bus_row nondet_row(void);

static void counts(enum lm_bus_field field)
{
    struct lm_bus_row any = nondet_row();
    any.field = (uint8_t)field;
    ASSUME(is_range_sound(&any));
    const int64_t low = lm_bus_counts(field, any.low), high = lm_bus_counts(field, any.high);
    PROVE(low >= INT32_MIN && high <= INT32_MAX);
}

void prove_counts_latitude(void)
{
    counts(LM_BUS_LATITUDE);
}

void prove_counts_turn(void)
{
    counts(LM_BUS_YAW_RATE);
}

void prove_counts_height(void)
{
    counts(LM_BUS_TRUE_ALTITUDE);
}

void prove_counts_speed(void)
{
    counts(LM_BUS_GROUND_SPEED);
}

void prove_counts_number(void)
{
    counts(LM_BUS_EXERCISE_SEED);
}
