/* The avionics bus: which fields the display takes from it, and how they come. A profile is one
 * const table; the decoder, the controller's filters, the tables of docs/bus.md and the .dbc file
 * of `landmass-bus` all follow from it. */
#ifndef LM_BUS_PROFILE_H
#define LM_BUS_PROFILE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/config.h"

/* What the display knows about the aircraft. Signs are those of ISO 1151, as CANaerospace
 * prescribes: nose up, right wing down and nose right are positive. */
enum lm_bus_field {
    LM_BUS_LATITUDE,
    LM_BUS_LONGITUDE,
    LM_BUS_ELLIPSOID_HEIGHT,
    LM_BUS_GROUND_SPEED,
    LM_BUS_TRUE_TRACK,
    LM_BUS_PITCH,
    LM_BUS_ROLL,
    LM_BUS_HEADING, /* true or magnetic: CANaerospace does not say */
    LM_BUS_TRUE_HEADING,
    LM_BUS_BARO_ALTITUDE, /* corrected by the altimeter setting, about above mean sea level */
    LM_BUS_TRUE_ALTITUDE, /* above mean sea level */
    LM_BUS_ALTITUDE_RATE,
    LM_BUS_EAST_VELOCITY,
    LM_BUS_NORTH_VELOCITY,
    LM_BUS_UP_VELOCITY,
    LM_BUS_PITCH_RATE,
    LM_BUS_YAW_RATE,
    LM_BUS_WAYPOINT_LATITUDE, /* of the active waypoint: where it is to go */
    LM_BUS_WAYPOINT_LONGITUDE,
    LM_BUS_UTC,
    LM_BUS_NAV_FIELDS, /* those above are the aircraft's: lm/nav.h */

    LM_BUS_RAIN_LATITUDE = LM_BUS_NAV_FIELDS, /* of a circle's centre: lm/weather_bus.h */
    LM_BUS_RAIN_LONGITUDE,
    LM_BUS_RAIN_RADIUS,
    LM_BUS_RAIN_RATE,
    LM_BUS_JAMMER_LATITUDE,
    LM_BUS_JAMMER_LONGITUDE,
    LM_BUS_JAMMER_RATIO,  /* to the noise, on the axis at ten nautical miles */
    LM_BUS_WEATHER_CLEAR, /* which are taken away: bits 0..3 rain, 4..7 jammers */
    LM_BUS_FIELDS
};

/* What the number of a value means. */
enum lm_bus_unit {
    LM_BUS_BAM, /* angle: cast to fx_bam_t, or keep it signed */
    LM_BUS_BAM_A_SECOND,
    LM_BUS_Q6,      /* metres * 64 */
    LM_BUS_MM_S,    /* millimetres a second */
    LM_BUS_SECONDS, /* since midnight; 86,400 is a leap second */
    LM_BUS_MM_H,    /* millimetres an hour */
    LM_BUS_DB_Q8,   /* dB * 256 */
    LM_BUS_BITS,    /* each for itself */
    LM_BUS_UNITS
};

/* Inside the decoders a number is in the unit of the bus with `frac_bits` binary places; the value
 * is that times `multiplier` / `divisor`. */
struct lm_bus_scale {
    const char *bus_unit; /* "deg" */
    const char *kept_as;  /* "BAM" */
    int32_t multiplier, divisor;
    uint8_t frac_bits;
};

extern const struct lm_bus_scale lm_bus_scales[LM_BUS_UNITS];

struct lm_bus_field_info {
    const char *name; /* as text tables call it: "true-heading" */
    uint8_t unit;     /* enum lm_bus_unit */
};

extern const struct lm_bus_field_info lm_bus_fields[LM_BUS_FIELDS];

static inline const struct lm_bus_scale *lm_bus_scale_of(enum lm_bus_field field)
{
    return &lm_bus_scales[lm_bus_fields[field].unit];
}

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

/* "canas17", "xcsoar" or "generic", as a configuration writes it; NULL for any other name. */
const struct lm_bus_profile *lm_bus_profile_named(const char *name);

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

struct lm_bus_event {
    int32_t value;    /* in the field's unit */
    uint32_t step;    /* between neighbouring values of the type it came in; 0: less than 1 */
    uint8_t row;      /* of the profile */
    uint8_t channel;  /* redundancy channel; the lower is preferred */
    uint8_t node;     /* of the sender; 0 when the frame does not tell, */
    uint8_t service;  /* service code, likewise: of weather, which circle or jammer */
    uint8_t code;     /* message code, likewise: of weather, which set */
    uint64_t time_us; /* of arrival; for a DOUBLE that of the half that came first, when the value
                         existed already */
};

/* The most values that one frame may have: a packed frame has more than one. */
enum { LM_BUS_EVENTS = 8 };

/* `amount` of the unit of the bus as counts of the field, to the nearest; an angle is not wrapped.
 */
int64_t lm_bus_counts(enum lm_bus_field field, int32_t amount);

/* n / divisor to the nearest, halves away from zero; divisor > 0 and |n| + divisor below 2^63. */
int64_t lm_bus_divide(int64_t n, int64_t divisor);

#endif
