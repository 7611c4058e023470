/* Bus profile: which fields the display takes from the avionics bus, and how they are encoded. A
 * profile is one const table. The decoder, the controller's filters, the tables of docs/bus.md and
 * the .dbc file of `landmass-bus` all follow from it. */
#ifndef LM_BUS_PROFILE_H
#define LM_BUS_PROFILE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_fields.h"
#include "lm/config.h"

/* Bits of a frame's data, counted from the top of byte 0 if big-endian, else from its bottom. */
struct lm_bus_bits {
    uint16_t first; /* number of the first bit */
    uint8_t count;  /* how many there are */
};

enum lm_bus_packed_type { LM_BUS_UNSIGNED, LM_BUS_SIGNED, LM_BUS_FLOAT }; /* FLOAT: 32 or 64 bits */

/* Encoding of a number in a frame of a packed profile. */
struct lm_bus_packing {
    uint32_t mask;            /* a frame is the row's if its identifier & mask is the row's id */
    struct lm_bus_bits bits;  /* count 1..64, of integers 1..32; within 64 bits from a byte on */
    struct lm_bus_bits match; /* count 0..8; the row applies if these bits are match_value */
    uint8_t match_value;
    uint8_t type; /* enum lm_bus_packed_type */
    bool is_little_endian, has_none;
    bool is_fast;  /* the bits are those of a joined message: lm/fast_packet.h */
    uint32_t none; /* if has_none: the integer, as encoded, for "not available" */
    /* value = (number * multiplier + bias) / 2^shift, rounded down. The number of a FLOAT is taken
     * times 2^frac_bits. |number| < 2^32, multiplier < 2^30 and |bias| < 2^61 keep every step below
     * 2^63. */
    int32_t multiplier;
    uint8_t shift, frac_bits;
    int64_t bias;
};

/* Row: one encoding of a field on the bus. */
struct lm_bus_row {
    const char *name;
    uint32_t id;        /* CANaerospace: identifier on channel 0; packed: of 29 bits */
    uint8_t field;      /* enum lm_bus_field */
    uint8_t priority;   /* among the rows of a field, all different; 0 is preferred */
    uint16_t stale_ms;  /* age from which the value is flagged */
    uint16_t dead_ms;   /* age from which the value is removed */
    uint32_t period_us; /* nominal time between two frames */
    int32_t low, high;  /* accepted range, both ends included, in the unit of the bus */
    uint32_t types;     /* CANaerospace: set of 1u << data type */
    int32_t per_unit;   /* CANaerospace: counts of the integer types in one unit of the bus */
    struct lm_bus_packing packing;
};

enum lm_bus_framing {
    LM_BUS_CANAEROSPACE, /* lm/canas.h */
    LM_BUS_PACKED        /* 29-bit identifiers, numbers of any bits: lm/bus_bitfield.h */
};

enum { LM_BUS_PROFILE_NAME_SIZE = 20 }; /* of a record (lm/bus_record.h), with its zero */

struct lm_bus_profile {
    const char *name;
    const struct lm_bus_row *rows;
    uint8_t row_count; /* 1..LM_BUS_ROWS_MAX */
    uint8_t framing;   /* enum lm_bus_framing */
    /* CANaerospace: the data type in byte 1 is ignored; each row has the one type that it is read
     * as. */
    bool are_types_assumed;
    /* Packed: bits of the identifier. */
    uint32_t channel_mask; /* number of the redundant sender; 0: there is only one */
    uint32_t invalid_mask; /* if one of these is set, the sender marks its data as invalid */
};

extern const struct lm_bus_profile lm_bus_canas17; /* the specification, and LONG positions */
extern const struct lm_bus_profile lm_bus_xcsoar;  /* as XCSoar reads the bus: types are assumed */
extern const struct lm_bus_profile lm_bus_generic; /* made from a text table: docs/bus.md */

/* A profile and the name by which a configuration selects it. */
struct lm_bus_named_profile {
    const char *name;
    const struct lm_bus_profile *profile;
};

/* The profiles above: "canas17", "xcsoar" and "generic"; a row of NULLs ends the list. Panel, bench
 * and tests take their names from it. Another built-in profile is its rows, an entry here and a
 * section of docs/bus.md. A board that has a profile of its own passes a list of its own:
 *
 *     static const struct lm_bus_named_profile mine[] = {
 *         {"canas17", &lm_bus_canas17}, {"ours", &our_profile}, {NULL, NULL}};
 *     board.bus_profile = lm_bus_profile_named(mine, "ours"); */
extern const struct lm_bus_named_profile lm_bus_profiles[];

/* The profile of this name in the list; NULL iff none has exactly this name. */
const struct lm_bus_profile *lm_bus_profile_named(const struct lm_bus_named_profile *list,
                                                  const char *name);

/* Check a profile that was not written by us: all that the decoder, the ownship and the weather
 * take for granted. `row` may be NULL; on failure it is the number of the first bad row, from 1, or
 * 0 if the profile itself is bad.
 *
 * Returns LM_OK, or LM_ERR_TABLE iff
 * - there are no rows, or more than LM_BUS_ROWS_MAX; the framing is unknown; a mask has bits
 * outside an identifier, or the channel's more than 8;
 * - a range is empty or beyond +-100,000, of latitudes +-90 and of turn rates +-179 deg/s; period,
 *   stale and dead do not rise in this order within 60 s (of latitude and longitude 4 s), or the
 *   period is below 1 ms;
 * - CANaerospace: an identifier outside 200..1999 or given twice; types that lm_canas_fits refuses,
 *   none, or, where types are assumed, two; per_unit outside 1..10^9;
 * - packed: an identifier outside its mask, bits outside the frame or unfit for their type, a
 * number of struct lm_bus_packing outside what its remarks say, more than LM_BUS_EVENTS rows for a
 *   frame, one frame both as a fast packet and by itself, or a field that comes in sets
 *   (lm_bus_is_of_set);
 * - two rows of one field have the same priority, or both take halves of a DOUBLE.
 *
 * Cost: grows with the square of the rows; done once, when a table is read. */
int lm_bus_profile_check(const struct lm_bus_profile *profile, uint32_t *row);

/* Outcome of a frame, or of a number in it. Each has a counter. */
enum lm_bus_outcome {
    LM_BUS_VALUE,         /* an event is filled */
    LM_BUS_HALF,          /* a part, kept until the rest comes: of a DOUBLE, of a fast packet */
    LM_BUS_NOT_DATA,      /* remote frame, or the controller's report of an error */
    LM_BUS_FOREIGN,       /* no identifier of the profile's framing */
    LM_BUS_OTHER_CHANNEL, /* a redundancy channel of LM_BUS_CHANNELS or above */
    LM_BUS_SERVICE,       /* a node service of CANaerospace: lm/canas_service.h */
    LM_BUS_UNUSED,        /* an identifier without a row */
    LM_BUS_NODE_REFUSED,  /* its sender is not on the list of nodes */
    LM_BUS_BAD_LENGTH,    /* too short, or not what the data type says */
    LM_BUS_BAD_NODE,      /* the sender is node 0, which addresses all nodes and is none */
    LM_BUS_BAD_TYPE,      /* a type that this identifier does not take */
    LM_BUS_NO_DATA,       /* the sender says that it has no value, or an invalid one */
    LM_BUS_NOT_A_NUMBER,  /* NaN, an infinity, a SHORT2 without a scale */
    LM_BUS_OUT_OF_RANGE,  /* below `low` or above `high` of the row */
    LM_BUS_OUTCOMES
};

#endif
