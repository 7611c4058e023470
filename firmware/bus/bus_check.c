/* Check of a bus profile that came from outside: lm_bus_profile_check. */
#include "lm/bus_profile.h"

#include <stddef.h>

#include "lm/bus_event.h"
#include "lm/canas.h"
#include "lm/fast_packet.h"
#include "lm/status.h"

enum {
    RANGE_MOST = 100000,
    POLE = 90,
    TURN_MOST = 179, /* deg/s; 180 does not fit the unit that is kept */
    AGE_MOST_MS = 60000,
    COORDINATE_AGE_MOST_MS = 4000,
    FRAME_BITS = 64,
    SHIFT_MOST = 60
};

static bool are_ages_sound(const struct lm_bus_row *row)
{
    const uint32_t dead_most_ms =
        row->field <= LM_BUS_LONGITUDE ? COORDINATE_AGE_MOST_MS : AGE_MOST_MS;
    return row->period_us >= 1000 && row->period_us <= row->stale_ms * 1000u &&
           row->stale_ms < row->dead_ms && row->dead_ms <= dead_most_ms;
}

/* Within the frame or message, and within 64 bits from its first byte on. */
static bool is_run(struct lm_bus_bits bits, bool is_fast)
{
    const uint32_t room = is_fast ? 8 * LM_FAST_PACKET_BYTES : FRAME_BITS;
    return bits.first % 8u + bits.count <= FRAME_BITS && (uint32_t)bits.first + bits.count <= room;
}

static bool is_arithmetic_sound(const struct lm_bus_packing *p)
{
    const int64_t bias_most = 1LL << 61;
    return p->multiplier > 0 && p->multiplier < 1 << 30 && p->shift >= 1 &&
           p->shift <= SHIFT_MOST && p->frac_bits <= SHIFT_MOST && p->bias > -bias_most &&
           p->bias < bias_most;
}

static bool is_number_sound(const struct lm_bus_packing *p)
{
    const uint32_t count = p->bits.count;
    const bool is_float = p->type == LM_BUS_FLOAT;
    const bool has_float_bits = count == 32 || count == 64;
    const bool has_whole_bits = count >= 1 && count <= 32;
    if (p->type > LM_BUS_FLOAT || !(is_float ? has_float_bits : has_whole_bits)) {
        return false;
    }
    return !p->has_none || (!is_float && (count == 32 || p->none >> count == 0));
}

static bool is_packed_sound(const struct lm_bus_row *row)
{
    const struct lm_bus_packing *p = &row->packing;
    return !lm_bus_is_of_set((enum lm_bus_field)row->field) && p->mask != 0 &&
           p->mask <= LM_CAN_ID_EXTENDED && (row->id & ~p->mask) == 0 &&
           is_run(p->bits, p->is_fast) && is_run(p->match, p->is_fast) && p->match.count <= 8 &&
           p->match_value >> p->match.count == 0 && is_number_sound(p) && is_arithmetic_sound(p);
}

static bool is_canas_sound(const struct lm_bus_row *row, bool are_types_assumed)
{
    bool fits = row->types != 0;
    for (uint32_t type = 0; type < LM_CANAS_TYPES; type++) {
        fits = fits && ((row->types >> type & 1) == 0 ||
                        lm_canas_fits((enum lm_bus_field)row->field, (uint8_t)type));
    }
    return fits && row->id >= LM_CANAS_ROW_FIRST && row->id <= LM_CANAS_ROW_LAST &&
           row->per_unit >= 1 && row->per_unit <= 1000000000 &&
           (!are_types_assumed || (row->types & (row->types - 1)) == 0);
}

static bool have_halves(const struct lm_bus_row *row)
{
    return (row->types >> LM_CANAS_DOUBLEH & 3) != 0;
}

/* Against the rows before it. */
static bool has_no_rival(const struct lm_bus_profile *p, uint32_t index)
{
    const struct lm_bus_row *row = &p->rows[index];
    const bool is_packed = p->framing == LM_BUS_PACKED;
    uint32_t in_frame = 1;
    for (uint32_t i = 0; i < index; i++) {
        const struct lm_bus_row *other = &p->rows[i];
        const uint32_t common = other->packing.mask & row->packing.mask;
        if (other->field == row->field &&
            (other->priority == row->priority || (have_halves(other) && have_halves(row)))) {
            return false;
        }
        if (!is_packed && other->id == row->id) {
            return false;
        }
        const bool is_same_frame = (other->id & common) == (row->id & common);
        if (is_packed && is_same_frame && other->packing.is_fast != row->packing.is_fast) {
            return false;
        }
        in_frame += is_same_frame;
    }
    return !is_packed || in_frame <= LM_BUS_EVENTS;
}

/* Largest number of a field's range, in the unit of the bus. Other angles wrap. */
static int32_t range_most(uint8_t field)
{
    const bool is_latitude = field == LM_BUS_LATITUDE || field == LM_BUS_STEERPOINT_LATITUDE;
    return is_latitude                                        ? POLE
           : lm_bus_fields[field].unit == LM_BUS_BAM_A_SECOND ? TURN_MOST
                                                              : RANGE_MOST;
}

/* A count, which is kept as it comes, may have any 32 bits. */
static bool is_range_sound(const struct lm_bus_row *row)
{
    const struct lm_bus_scale *scale = lm_bus_scale_of((enum lm_bus_field)row->field);
    const bool is_count = scale->frac_bits == 0 && scale->multiplier == scale->divisor;
    const int32_t most = range_most(row->field);
    return row->low < row->high && (is_count || (row->low >= -most && row->high <= most));
}

static bool is_row_sound(const struct lm_bus_profile *p, uint32_t index)
{
    const struct lm_bus_row *row = &p->rows[index];
    const bool is_common = row->field < LM_BUS_FIELDS && is_range_sound(row) && are_ages_sound(row);
    return is_common && (p->framing == LM_BUS_PACKED ? is_packed_sound(row)
                                                     : is_canas_sound(row, p->are_types_assumed));
}

/* At most eight bits, so that a channel fits a byte. */
static bool is_channel_sound(uint32_t mask)
{
    for (uint32_t bits = 0; bits < 8; bits++) {
        mask &= mask - 1;
    }
    return mask == 0;
}

int lm_bus_profile_check(const struct lm_bus_profile *p, uint32_t *row)
{
    const uint32_t outside = ~(uint32_t)LM_CAN_ID_EXTENDED;
    uint32_t index = 0;
    bool is_sound = p->row_count >= 1 && p->row_count <= LM_BUS_ROWS_MAX &&
                    p->framing <= LM_BUS_PACKED && is_channel_sound(p->channel_mask) &&
                    ((p->channel_mask | p->invalid_mask) & outside) == 0;
    while (is_sound && index < p->row_count) {
        is_sound = is_row_sound(p, index) && has_no_rival(p, index);
        index++;
    }
    if (!is_sound && row != NULL) {
        *row = index;
    }
    return is_sound ? LM_OK : LM_ERR_TABLE;
}
