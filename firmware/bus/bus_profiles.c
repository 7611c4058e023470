#include <stddef.h>

#include "lm/canas.h"

#define TYPE(name) (1u << (LM_CANAS_##name))

#define ANALOGUE (TYPE(FLOAT) | TYPE(SHORT2))
#define POSITION (ANALOGUE | TYPE(LONG) | TYPE(DOUBLEH) | TYPE(DOUBLEL))
#define CLOCK    TYPE(CHAR4)
#define PLACE    (TYPE(FLOAT) | TYPE(LONG))

enum { TEN_MILLIONTHS = 10000000 };

#define ROW(name_, id_, field_, priority_, types_, low_, high_, period_, stale_, dead_)            \
    {                                                                                              \
        .name = (name_), .id = (id_), .field = LM_BUS_##field_, .priority = (priority_),           \
        .types = (types_), .low = (low_), .high = (high_), .period_us = (period_),                 \
        .stale_ms = (stale_), .dead_ms = (dead_),                                                  \
        .per_unit = (types_)&TYPE(LONG) ? TEN_MILLIONTHS : 1                                       \
    }

/* A whole number, once a second, of the exercise. */
#define COUNT_ROW(name_, id_, field_, types_, low_, high_)                                         \
    {                                                                                              \
        .name = (name_), .id = (id_), .field = LM_BUS_##field_, .types = (types_), .low = (low_),  \
        .high = (high_), .period_us = 1000000, .stale_ms = 3000, .dead_ms = 10000, .per_unit = 1   \
    }

/* Ages. What comes every 100 ms is stale when three in a row were lost; one lost frame is a common
 * thing on a bus. Attitude and heading come eight times as often and turn fast: at 100 ms a roll of
 * 90 deg/s is wrong by 9 degrees, at 1 s it says nothing any more. Position and velocity die after
 * 2 s: until then dead reckoning in a turn of 3 deg/s stays within 32 m at 300 m/s, a pixel at the
 * longer ranges. Height moves slowly and dies after 5 s.
 *
 * Ranges. Wide enough for any aircraft, narrow enough that a wrong unit or a damaged exponent
 * shows; a heading or track may be written as 0..360 or as +-180, since the angle is the same.
 *
 * Weather is sent by whoever runs the exercise, on identifiers that the specification leaves to the
 * user (1800..1899), once a second: three sets missed are stale, and after 10 s a storm that stands
 * still is a wrong picture. The wind over the sea comes from there too, or else from the aircraft's
 * own (334), of which the specification does not say whether it is the direction from or to: from,
 * as meteorologists say it.
 *
 * Live targets come from there as well, with the same rate and ages.
 *
 * Variation changes by a degree in an hour of flight, so that an old one is far better than none.
 * Of its sign the specification says nothing: east is positive, as on charts.
 *
 * The specification gives longitudes of waypoint, INS and auxiliary the type SHORT; that is a
 * misprint for the SHORT2 of the latitudes. */
/* clang-format off */
static const struct lm_bus_row canas17_rows[] = {
    ROW("GPS latitude",                         1036, LATITUDE,         0, POSITION,   -90,    90,  100000,  300,  2000),
    ROW("GPS longitude",                        1037, LONGITUDE,        0, POSITION,  -180,   180,  100000,  300,  2000),
    ROW("GPS height above ellipsoid",           1038, ELLIPSOID_HEIGHT, 0, ANALOGUE, -1000, 30000,  100000,  500,  5000),
    ROW("GPS ground speed",                     1039, GROUND_SPEED,     0, ANALOGUE,     0,  1500,  100000,  300,  2000),
    ROW("GPS true track",                       1040, TRUE_TRACK,       0, ANALOGUE,  -180,   360,  100000,  300,  2000),
    ROW("body pitch angle",                      311, PITCH,            0, ANALOGUE,   -90,    90,   12500,  100,  1000),
    ROW("body roll angle",                       312, ROLL,             0, ANALOGUE,  -180,   180,   12500,  100,  1000),
    ROW("heading angle",                         321, HEADING,          0, ANALOGUE,  -180,   360,   12500,  100,  1000),
    ROW("true heading",                         1133, TRUE_HEADING,     0, ANALOGUE,  -180,   360,  100000,  300,  1000),
    ROW("baro corrected altitude",               320, BARO_ALTITUDE,    0, ANALOGUE, -1000, 30000,  100000,  500,  5000),
    ROW("true altitude",                         332, TRUE_ALTITUDE,    0, ANALOGUE, -1000, 30000,  100000,  500,  5000),
    ROW("altitude rate",                         314, ALTITUDE_RATE,    0, ANALOGUE,  -500,   500,  100000,  300,  2000),
    ROW("true east velocity",                   1130, EAST_VELOCITY,    0, ANALOGUE, -1500,  1500,  100000,  300,  2000),
    ROW("true north velocity",                  1131, NORTH_VELOCITY,   0, ANALOGUE, -1500,  1500,  100000,  300,  2000),
    ROW("true up velocity",                     1132, UP_VELOCITY,      0, ANALOGUE,  -500,   500,  100000,  300,  2000),
    ROW("body pitch rate",                       303, PITCH_RATE,       0, ANALOGUE,  -170,   170,   12500,  100,  1000),
    ROW("body yaw rate",                         305, YAW_RATE,         0, ANALOGUE,  -170,   170,   12500,  100,  1000),
    ROW("active nav wp latitude",               1000, STEERPOINT_LATITUDE, 0, ANALOGUE,  -90,    90, 1000000, 3000, 10000),
    ROW("active nav wp longitude",              1001, STEERPOINT_LONGITUDE, 0, ANALOGUE, -180,  180, 1000000, 3000, 10000),
    ROW("UTC",                                  1200, UTC,              0, CLOCK,        0, 86400, 1000000, 3000, 10000),
    ROW("magnetic heading",                     1069, MAGNETIC_HEADING, 0, ANALOGUE,  -180,   360,  100000,  300,  1000),
    ROW("magnetic variation",                   1121, MAGNETIC_VARIATION, 0, ANALOGUE, -180,  180,  100000, 10000, 60000),
    ROW("INS latitude",                         1049, LATITUDE,         1, ANALOGUE,   -90,    90,  100000,  300,  2000),
    ROW("INS longitude",                        1050, LONGITUDE,        1, ANALOGUE,  -180,   180,  100000,  300,  2000),
    ROW("INS height above ellipsoid",           1051, ELLIPSOID_HEIGHT, 1, ANALOGUE, -1000, 30000,  100000,  500,  5000),
    ROW("INS ground speed",                     1052, GROUND_SPEED,     1, ANALOGUE,     0,  1500,  100000,  300,  2000),
    ROW("INS true track",                       1053, TRUE_TRACK,       1, ANALOGUE,  -180,   360,  100000,  300,  2000),
    ROW("aux nav latitude",                     1059, LATITUDE,         2, ANALOGUE,   -90,    90,  100000,  300,  2000),
    ROW("aux nav longitude",                    1060, LONGITUDE,        2, ANALOGUE,  -180,   180,  100000,  300,  2000),
    ROW("aux nav height above ellipsoid",       1061, ELLIPSOID_HEIGHT, 2, ANALOGUE, -1000, 30000,  100000,  500,  5000),
    ROW("aux nav ground speed",                 1062, GROUND_SPEED,     2, ANALOGUE,     0,  1500,  100000,  300,  2000),
    ROW("aux nav true track",                   1063, TRUE_TRACK,       2, ANALOGUE,  -180,   360,  100000,  300,  2000),
    ROW("rain latitude",                        1800, RAIN_LATITUDE,    0, PLACE,      -90,    90, 1000000, 3000, 10000),
    ROW("rain longitude",                       1801, RAIN_LONGITUDE,   0, PLACE,     -180,   180, 1000000, 3000, 10000),
    ROW("rain radius",                          1802, RAIN_RADIUS,      0, TYPE(FLOAT), 100, 100000, 1000000, 3000, 10000),
    ROW("rain rate",                            1803, RAIN_RATE,        0, TYPE(FLOAT),   1,   150, 1000000, 3000, 10000),
    ROW("jammer latitude",                      1804, JAMMER_LATITUDE,  0, PLACE,      -90,    90, 1000000, 3000, 10000),
    ROW("jammer longitude",                     1805, JAMMER_LONGITUDE, 0, PLACE,     -180,   180, 1000000, 3000, 10000),
    ROW("jammer to noise ratio",                1806, JAMMER_RATIO,     0, TYPE(FLOAT), -20,    80, 1000000, 3000, 10000),
    ROW("weather clear",                        1807, WEATHER_CLEAR,    0, TYPE(UCHAR),   0,   255, 1000000, 3000, 10000),
    ROW("sea state",                            1808, SEA_STATE,        0, TYPE(UCHAR),   0,     8, 1000000, 3000, 10000),
    ROW("sea wind direction",                   1809, WIND_DIRECTION,   0, TYPE(FLOAT), -180,   360, 1000000, 3000, 10000),
    ROW("live latitude",                        1810, LIVE_LATITUDE,    0, TYPE(LONG),   -90,    90, 1000000, 3000, 10000),
    ROW("live longitude",                       1811, LIVE_LONGITUDE,   0, TYPE(LONG),  -180,   180, 1000000, 3000, 10000),
    ROW("live height",                          1812, LIVE_HEIGHT,      0, TYPE(FLOAT), -1000, 16000, 1000000, 3000, 10000),
    ROW("live velocity",                        1813, LIVE_VELOCITY,    0, TYPE(SHORT2), -32768, 32767, 1000000, 3000, 10000),
    ROW("live heading",                         1814, LIVE_HEADING,     0, TYPE(SHORT2), -32768, 32767, 1000000, 3000, 10000),
    ROW("live kind",                            1815, LIVE_KIND,        0, TYPE(UCHAR4),   0,   255, 1000000, 3000, 10000),
    ROW("live cross section",                   1816, LIVE_RCS,         0, TYPE(FLOAT),  -40,    60, 1000000, 3000, 10000),
    ROW("live remove",                          1817, LIVE_REMOVE,      0, TYPE(UCHAR),    0,   255, 1000000, 3000, 10000),
    ROW("live clear",                           1818, LIVE_CLEAR,       0, TYPE(UCHAR),    0,   255, 1000000, 3000, 10000),
    ROW("live acceleration",                    1819, LIVE_ACCELERATION, 0, TYPE(SHORT2), -32768, 32767, 1000000, 3000, 10000),
    ROW("wind direction",                        334, WIND_DIRECTION,   1, ANALOGUE,    -180,   360, 1000000, 3000, 10000),
    COUNT_ROW("exercise time",                  1820, EXERCISE_TIME,       TYPE(LONG),     0, INT32_MAX),
    ROW("exercise rate",                        1821, EXERCISE_RATE,    0, TYPE(FLOAT),    0,    16, 1000000, 3000, 10000),
    COUNT_ROW("exercise seed",                  1822, EXERCISE_SEED,       TYPE(LONG),     0, INT32_MAX),
    ROW("malfunction",                          1825, MALFUNCTION,      0, TYPE(FLOAT), -180,   180, 1000000, 3000, 10000),
    COUNT_ROW("malfunction clear",              1826, MALFUNCTION_CLEAR,   TYPE(UCHAR),    0,       255),
};

/* What XCSoar's driver takes, and what is made for it therefore sends: byte 1 says nothing, each
 * identifier has one type, and positions are LONG. The glider has no inertial rates of its own, so
 * that the rest is the specification's, as FLOAT. */
static const struct lm_bus_row xcsoar_rows[] = {
    ROW("GPS latitude",                         1036, LATITUDE,         0, TYPE(LONG),   -90,    90,  100000,  300,  2000),
    ROW("GPS longitude",                        1037, LONGITUDE,        0, TYPE(LONG),  -180,   180,  100000,  300,  2000),
    ROW("GPS height above ellipsoid",           1038, ELLIPSOID_HEIGHT, 0, TYPE(FLOAT), -1000, 30000, 100000,  500,  5000),
    ROW("GPS ground speed",                     1039, GROUND_SPEED,     0, TYPE(FLOAT),    0,  1500,  100000,  300,  2000),
    ROW("GPS true track",                       1040, TRUE_TRACK,       0, TYPE(FLOAT), -180,   360,  100000,  300,  2000),
    ROW("body pitch angle",                      311, PITCH,            0, TYPE(FLOAT),  -90,    90,   12500,  100,  1000),
    ROW("body roll angle",                       312, ROLL,             0, TYPE(FLOAT), -180,   180,   12500,  100,  1000),
    ROW("heading angle",                         321, HEADING,          0, TYPE(FLOAT), -180,   360,   12500,  100,  1000),
    ROW("true heading",                         1133, TRUE_HEADING,     0, TYPE(FLOAT), -180,   360,  100000,  300,  1000),
    ROW("baro corrected altitude",               320, BARO_ALTITUDE,    0, TYPE(FLOAT), -1000, 30000, 100000,  500,  5000),
    ROW("altitude rate",                         314, ALTITUDE_RATE,    0, TYPE(FLOAT), -500,   500,  100000,  300,  2000),
    ROW("UTC",                                  1200, UTC,              0, CLOCK,          0, 86400, 1000000, 3000, 10000),
};
/* clang-format on */

#define COUNT(array) (sizeof(array) / sizeof *(array))

_Static_assert(COUNT(canas17_rows) <= LM_BUS_ROWS_MAX, "LM_BUS_ROWS_MAX is too small");

const struct lm_bus_profile lm_bus_canas17 = {
    .name = "canas17",
    .rows = canas17_rows,
    .row_count = COUNT(canas17_rows),
    .framing = LM_BUS_CANAEROSPACE,
};

const struct lm_bus_profile lm_bus_xcsoar = {
    .name = "xcsoar",
    .rows = xcsoar_rows,
    .row_count = COUNT(xcsoar_rows),
    .framing = LM_BUS_CANAEROSPACE,
    .are_types_assumed = true,
};

static bool are_same(const char *a, const char *b)
{
    while (*a != '\0' && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

const struct lm_bus_named_profile lm_bus_profiles[] = {{"canas17", &lm_bus_canas17},
                                                       {"xcsoar", &lm_bus_xcsoar},
                                                       {"generic", &lm_bus_generic},
                                                       {NULL, NULL}};

const struct lm_bus_profile *lm_bus_profile_named(const struct lm_bus_named_profile *list,
                                                  const char *name)
{
    while (list->name != NULL && !are_same(list->name, name)) {
        list++;
    }
    return list->profile;
}
