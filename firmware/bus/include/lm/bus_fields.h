/* Bus fields: the quantities that the display takes from the avionics bus, and their units.
 *
 * A field is a quantity such as latitude, roll or rain rate. A profile (lm/bus_profile.h) says how
 * it travels; lm/nav.h, lm/weather_bus.h and lm/live_bus.h use it. */
#ifndef LM_BUS_FIELDS_H
#define LM_BUS_FIELDS_H

#include <stdbool.h>
#include <stdint.h>

/* Signs are those of ISO 1151, as CANaerospace prescribes: nose up, right wing down and nose right
 * are positive. The number of a field is written nowhere outside the program, except in generated
 * profiles, which are made again when it changes. */
enum lm_bus_field {
    LM_BUS_LATITUDE,
    LM_BUS_LONGITUDE,
    LM_BUS_ELLIPSOID_HEIGHT,
    LM_BUS_GROUND_SPEED,
    LM_BUS_TRUE_TRACK,
    LM_BUS_PITCH,
    LM_BUS_ROLL,
    LM_BUS_HEADING, /* true or magnetic, as the board says: CANaerospace does not */
    LM_BUS_TRUE_HEADING,
    LM_BUS_BARO_ALTITUDE, /* corrected by the altimeter setting: nearly above mean sea level */
    LM_BUS_TRUE_ALTITUDE, /* above mean sea level */
    LM_BUS_ALTITUDE_RATE,
    LM_BUS_EAST_VELOCITY,
    LM_BUS_NORTH_VELOCITY,
    LM_BUS_UP_VELOCITY,
    LM_BUS_PITCH_RATE,
    LM_BUS_YAW_RATE,
    LM_BUS_STEERPOINT_LATITUDE, /* the active waypoint of CANaerospace */
    LM_BUS_STEERPOINT_LONGITUDE,
    LM_BUS_UTC,
    LM_BUS_MAGNETIC_HEADING,
    LM_BUS_MAGNETIC_VARIATION, /* of magnetic from true north, east positive */
    LM_BUS_NAV_FIELDS, /* the fields above belong to lm/nav.h; those below, down to the wind, to
                          lm/weather_bus.h */

    LM_BUS_RAIN_LATITUDE = LM_BUS_NAV_FIELDS, /* of the centre of a circle of rain */
    LM_BUS_RAIN_LONGITUDE,
    LM_BUS_RAIN_RADIUS,
    LM_BUS_RAIN_RATE,
    LM_BUS_JAMMER_LATITUDE,
    LM_BUS_JAMMER_LONGITUDE,
    LM_BUS_JAMMER_RATIO,  /* jammer to noise, on the antenna's axis at ten nautical miles */
    LM_BUS_WEATHER_CLEAR, /* removes weather: bits 0..3 circles of rain, bits 4..7 jammers */
    LM_BUS_SEA_STATE,
    LM_BUS_WIND_DIRECTION, /* that the wind blows from */

    LM_BUS_EXERCISE_TIME, /* since the exercise began: lm/exercise.h */
    LM_BUS_EXERCISE_RATE, /* seconds of the exercise in a second; 0: it stands */
    LM_BUS_EXERCISE_SEED,
    LM_BUS_LIVE_LATITUDE, /* from here to LM_BUS_LIVE_CLEAR they belong to lm/live_bus.h */
    LM_BUS_LIVE_LONGITUDE,
    LM_BUS_LIVE_HEIGHT,       /* above mean sea level */
    LM_BUS_LIVE_VELOCITY,     /* east, north: 16 bits each, in 0.05 m/s */
    LM_BUS_LIVE_HEADING,      /* heading in 180/32768 deg, turn rate in 0.01 deg/s: 16 bits each */
    LM_BUS_LIVE_KIND,         /* kind, dead reckoning, signature, parts: 8 bits each */
    LM_BUS_LIVE_RCS,          /* cross section */
    LM_BUS_LIVE_ACCELERATION, /* east, north: 16 bits each, in 0.01 m/s2 */
    LM_BUS_LIVE_REMOVE,       /* removes the target of the service code */
    LM_BUS_LIVE_CLEAR,        /* removes all live targets */
    LM_BUS_MALFUNCTION,       /* of the kind that the service code numbers: lm/malfunction.h */
    LM_BUS_MALFUNCTION_CLEAR, /* number of a kind, or 255 for all */
    LM_BUS_FIELDS
};

/* Units in which values are kept. */
enum lm_bus_unit {
    LM_BUS_BAM,          /* angle, 2^32 a turn: cast to fx_bam_t, or keep it signed */
    LM_BUS_BAM_A_SECOND, /* rate of an angle, signed */
    LM_BUS_M_Q6,         /* metres * 64 */
    LM_BUS_MM_S,         /* millimetres a second */
    LM_BUS_SECONDS,      /* since midnight; 86,400 is a leap second */
    LM_BUS_MM_H,         /* millimetres an hour */
    LM_BUS_DB_Q8,        /* dB * 256 */
    LM_BUS_BITS,         /* a set of bits */
    LM_BUS_STATE,        /* a number of a scale: sea state */
    LM_BUS_MS,           /* milliseconds */
    LM_BUS_RATE,         /* a factor * 256 */
    LM_BUS_AMOUNT,       /* an amount * 256, in a unit that another number tells */
    LM_BUS_NUMBER,       /* a number without a unit */
    LM_BUS_WORD,         /* two or four small numbers, as the 32 bits that they travel in */
    LM_BUS_UNITS
};

/* Scale: conversion from a field's unit on the bus to the unit kept. The decoder holds a number in
 * the unit of the bus, times 2^frac_bits. The value kept is that number * multiplier / divisor. */
struct lm_bus_scale {
    const char *bus_unit; /* on the bus: "deg" */
    const char *kept_as;  /* the unit kept, in words for documents: "BAM" */
    int32_t multiplier, divisor;
    uint8_t frac_bits;
};

extern const struct lm_bus_scale lm_bus_scales[LM_BUS_UNITS];

/* Name and unit of a field. */
struct lm_bus_field_info {
    const char *name; /* its word in text tables: "true-heading" */
    uint8_t unit;     /* enum lm_bus_unit */
};

extern const struct lm_bus_field_info lm_bus_fields[LM_BUS_FIELDS];

/* True for the fields of lm/live_bus.h. */
static inline bool lm_bus_is_live(uint8_t field)
{
    return field >= LM_BUS_LIVE_LATITUDE && field <= LM_BUS_LIVE_CLEAR;
}

/* The scale of a field, in static memory. */
static inline const struct lm_bus_scale *lm_bus_scale_of(enum lm_bus_field field)
{
    return &lm_bus_scales[lm_bus_fields[field].unit];
}

/* True for a field that comes in sets with others, which only the codes of CANaerospace tell apart:
 * a packed profile cannot have it. */
static inline bool lm_bus_is_of_set(enum lm_bus_field field)
{
    return (field >= LM_BUS_NAV_FIELDS && field < LM_BUS_SEA_STATE) ||
           lm_bus_is_live((uint8_t)field);
}

/* Convert `amount` from the field's unit on the bus to the unit kept, rounded to the nearest. An
 * angle does not wrap: 360 degrees give 2^32. */
int64_t lm_bus_counts(enum lm_bus_field field, int32_t amount);

/* n / divisor, rounded to the nearest, halves away from zero. divisor > 0; |n| + divisor below
 * 2^63. */
int64_t lm_bus_divide(int64_t n, int64_t divisor);

#endif
