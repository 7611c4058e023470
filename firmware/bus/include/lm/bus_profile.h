/* Bus profile: the table that says which frames of the avionics bus bring which fields. The decoder
 * (lm/bus.h), the controller's filters (lm/bus_filters.h), the tables of docs/bus.md and the .dbc
 * file of `landmass-bus` all follow from it. */
#ifndef LM_BUS_PROFILE_H
#define LM_BUS_PROFILE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_fields.h"
#include "lm/config.h"

/* A run of bits in the data of a packed frame. Bit 0 is the most significant bit of byte 0 in a
 * big-endian frame, the least significant one in a little-endian frame. */
struct lm_bus_bits {
    uint8_t first, count;
};

enum lm_bus_packed_type { LM_BUS_UNSIGNED, LM_BUS_SIGNED, LM_BUS_FLOAT }; /* FLOAT: 32 or 64 bits */

/* Packed: where the number of a row lies and what it means. */
struct lm_bus_packing {
    uint32_t mask;            /* a frame is the row's when its identifier & mask is the row's id */
    struct lm_bus_bits bits;  /* the number: count 1..32 for integers, 32 or 64 for FLOAT */
    struct lm_bus_bits match; /* condition: these bits are `match_value`; count 0..8, 0: none */
    uint8_t match_value;
    uint8_t type; /* enum lm_bus_packed_type */
    bool is_little_endian;
    bool has_none;
    uint32_t none; /* with has_none: raw integer that means "not available" */
    /* value = (number * multiplier + bias) / 2^shift, rounded down; the number of a FLOAT is taken
     * with frac_bits. |number| < 2^32, multiplier < 2^30 and |bias| < 2^61 bound every step by
     * 2^63. */
    int32_t multiplier;
    uint8_t shift, frac_bits;
    int64_t bias;
};

/* Row of a profile: one way in which a field comes over the bus. */
struct lm_bus_row {
    const char *name;   /* as the bus's specification has it: "GPS latitude" */
    uint32_t id;        /* CANaerospace: 11 bits, as on channel 0; packed: 29 bits */
    uint8_t field;      /* enum lm_bus_field */
    uint8_t priority;   /* among the rows of a field, all different; 0 is preferred */
    uint16_t stale_ms;  /* a value older than this is flagged */
    uint16_t dead_ms;   /* a value older than this is removed; above stale_ms */
    uint32_t period_us; /* nominal, between two values */
    int32_t low, high;  /* range that is believed, ends included, in the field's unit on the bus */
    uint32_t types;     /* CANaerospace: allowed data types, set of 1u << LM_CANAS_... */
    int32_t per_unit;   /* CANaerospace: counts of the integer types in one unit on the bus */
    struct lm_bus_packing packing; /* packed */
};

enum lm_bus_framing {
    LM_BUS_CANAEROSPACE, /* lm/canas.h */
    LM_BUS_PACKED        /* 29-bit identifiers, numbers at any bit: lm/bus_bitfield.h */
};

/* A profile. Constant; whoever decodes by it borrows it. */
struct lm_bus_profile {
    const char *name; /* for documents; a configuration uses that of lm_bus_profiles */
    const struct lm_bus_row *rows;
    uint8_t row_count;      /* 1..LM_BUS_ROWS_MAX */
    uint8_t framing;        /* enum lm_bus_framing */
    bool are_types_assumed; /* CANaerospace: byte 1 of a frame is not read; each row has exactly
                               one type, which is assumed */
    uint32_t channel_mask;  /* packed: bits of the identifier that tell redundant senders apart */
    uint32_t invalid_mask;  /* packed: bits of the identifier of which one that is set says that
                               the sender does not vouch for its data */
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

/* Outcome of a frame, or of a number in a packed one. Each has a counter in struct lm_bus. */
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
