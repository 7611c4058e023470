/* The avionics bus: which fields the display takes from it, and how they come. A profile is one
 * const table; the decoder, the controller's filters, the tables of docs/bus.md and the .dbc file
 * of `landmass-bus` all follow from it. */
#ifndef LM_BUS_PROFILE_H
#define LM_BUS_PROFILE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_fields.h"
#include "lm/config.h"

/* Where a number lies in a frame of a packed profile, and what it means. */
struct lm_bus_bits {
    uint8_t first, count; /* from the top of byte 0 when big-endian, else from its bottom */
};

enum lm_bus_packed_type { LM_BUS_UNSIGNED, LM_BUS_SIGNED, LM_BUS_FLOAT }; /* FLOAT: 32 or 64 bits */

struct lm_bus_packing {
    uint32_t mask;            /* a frame is the row's when its identifier & mask is the row's */
    struct lm_bus_bits bits;  /* count 1..64, of integers 1..32 */
    struct lm_bus_bits match; /* and when these bits are `match_value`; count 0..8 */
    uint8_t match_value;
    uint8_t type; /* enum lm_bus_packed_type */
    bool is_little_endian, has_none;
    uint32_t none; /* the integer, as it lies there, that says "not available" */
    /* value = (number * multiplier + bias) / 2^shift, rounded down; the number of a FLOAT is taken
     * with frac_bits. |number| < 2^32, multiplier < 2^30 and |bias| < 2^61 bound every step by
     * 2^63. */
    int32_t multiplier;
    uint8_t shift, frac_bits;
    int64_t bias;
};

/* One way in which a field comes over the bus. */
struct lm_bus_row {
    const char *name;
    uint32_t id;        /* CANaerospace: on channel 0; else of 29 bits */
    uint8_t field;      /* enum lm_bus_field */
    uint8_t priority;   /* among the rows of a field, all different; 0 is preferred */
    uint16_t stale_ms;  /* older than this: flagged */
    uint16_t dead_ms;   /* older than this: removed */
    uint32_t period_us; /* nominal */
    int32_t low, high;  /* what is believed, both ends included, in the unit of the bus */
    uint32_t types;     /* CANaerospace: set of 1u << data type */
    int32_t per_unit;   /* CANaerospace: what the integer types count to one unit of the bus */
    struct lm_bus_packing packing;
};

enum lm_bus_framing {
    LM_BUS_CANAEROSPACE, /* lm/canas.h */
    LM_BUS_PACKED        /* 29-bit identifiers, numbers somewhere in the data: lm/bus_bitfield.h */
};

struct lm_bus_profile {
    const char *name;
    const struct lm_bus_row *rows;
    uint8_t row_count; /* 1..LM_BUS_ROWS_MAX */
    uint8_t framing;   /* enum lm_bus_framing */
    /* CANaerospace: byte 1 of a frame is not looked at; each row has the one type it is taken for.
     */
    bool are_types_assumed;
    /* Packed: which bits of the identifier tell redundant senders apart (0: nothing does), and
     * which say, when one of them is set, that the sender does not vouch for its data. */
    uint32_t channel_mask, invalid_mask;
};

extern const struct lm_bus_profile lm_bus_canas17; /* the specification, and LONG positions */
extern const struct lm_bus_profile lm_bus_xcsoar;  /* as XCSoar reads it: types are assumed */
extern const struct lm_bus_profile lm_bus_generic; /* made of a text table: see docs/bus.md */

/* A profile and the name by which a configuration selects it. */
struct lm_bus_named_profile {
    const char *name;
    const struct lm_bus_profile *profile;
};

/* The profiles above: "canas17", "xcsoar" and "generic"; a row of NULLs ends the list. Panel, bench
 * and tests take their names from it, so that a profile beside these is its rows, an entry here and
 * a section of docs/bus.md. A board that has a profile of its own passes a list of its own:
 *
 *     static const struct lm_bus_named_profile mine[] = {
 *         {"canas17", &lm_bus_canas17}, {"ours", &our_profile}, {NULL, NULL}};
 *     board.bus_profile = lm_bus_profile_named(mine, "ours"); */
extern const struct lm_bus_named_profile lm_bus_profiles[];

/* The profile of this name in the list; NULL when none has exactly this name. */
const struct lm_bus_profile *lm_bus_profile_named(const struct lm_bus_named_profile *list,
                                                  const char *name);

/* What became of a frame, or of a number in it. Each has a counter. */
enum lm_bus_outcome {
    LM_BUS_VALUE,         /* an event is filled */
    LM_BUS_HALF,          /* half of a DOUBLE, kept until the other one comes */
    LM_BUS_NOT_DATA,      /* remote frame, or the controller's report of an error */
    LM_BUS_FOREIGN,       /* no identifier of the profile's framing */
    LM_BUS_OTHER_CHANNEL, /* a redundancy channel of LM_BUS_CHANNELS or above */
    LM_BUS_SERVICE,       /* a node service of CANaerospace: lm/canas_service.h */
    LM_BUS_UNUSED,        /* an identifier without a row */
    LM_BUS_BAD_LENGTH,    /* too short, or not what the data type says */
    LM_BUS_BAD_NODE,      /* node 0, which can only be addressed, as the sender */
    LM_BUS_BAD_TYPE,      /* a type that this identifier does not take */
    LM_BUS_NO_DATA,       /* the sender says that it has no value, or does not vouch for it */
    LM_BUS_NOT_A_NUMBER,  /* NaN, an infinity, a SHORT2 without a scale */
    LM_BUS_OUT_OF_RANGE,
    LM_BUS_OUTCOMES
};

#endif
