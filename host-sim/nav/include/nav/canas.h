/* CANaerospace 1.7 frames as a sender makes them, and their text in the format of candump -L.
 * Source: Stock Flight Systems, "Interface specification for airborne CAN applications V 1.7",
 * revision of 12.1.2006: frame layout, data type codes and identifiers. */
#ifndef NAV_CANAS_H
#define NAV_CANAS_H

#include <stddef.h>
#include <stdint.h>

/* Data type codes, byte 1 of a frame. */
enum canas_type {
    CANAS_FLOAT = 2,
    CANAS_LONG = 3,
    CANAS_UCHAR = 10,
    CANAS_SHORT2 = 12,
    CANAS_CHAR4 = 15,
    CANAS_UCHAR4 = 16,
    CANAS_DOUBLEH = 30,
    CANAS_DOUBLEL = 31
};

/* Identifiers of normal operation data that this program sends. */
enum canas_id {
    CANAS_PITCH_RATE = 303,          /* deg/s, nose up positive */
    CANAS_ROLL_RATE = 304,           /* deg/s, right positive */
    CANAS_YAW_RATE = 305,            /* deg/s, right positive */
    CANAS_PITCH = 311,               /* deg, nose up positive */
    CANAS_ROLL = 312,                /* deg, right positive */
    CANAS_ALTITUDE_RATE = 314,       /* m/s, up positive */
    CANAS_BARO_ALTITUDE = 320,       /* m, corrected */
    CANAS_HEADING = 321,             /* deg, -180..180 */
    CANAS_TRUE_ALTITUDE = 332,       /* m above mean sea level */
    CANAS_GPS_LATITUDE = 1036,       /* deg, north positive */
    CANAS_GPS_LONGITUDE = 1037,      /* deg, east positive */
    CANAS_GPS_HEIGHT = 1038,         /* m above the ellipsoid */
    CANAS_GPS_GROUND_SPEED = 1039,   /* m/s */
    CANAS_GPS_TRUE_TRACK = 1040,     /* deg, 0..360 */
    CANAS_MAGNETIC_HEADING = 1069,   /* deg, -180..180 */
    CANAS_MAGNETIC_VARIATION = 1121, /* deg, east positive */
    CANAS_EAST_VELOCITY = 1130,      /* m/s */
    CANAS_NORTH_VELOCITY = 1131,     /* m/s */
    CANAS_UP_VELOCITY = 1132,        /* m/s */
    CANAS_TRUE_HEADING = 1133,       /* deg, -180..180 */
    CANAS_UTC = 1200,                /* hour, minute, second, 0 */
    CANAS_DATE = 1206,               /* day, month, century, year of the century */
    CANAS_RAIN_LATITUDE = 1800,      /* and 3 more: of the display's own, docs/bus.md, "Weather" */
    CANAS_JAMMER_LATITUDE = 1804,    /* and 2 more */
    CANAS_WEATHER_CLEAR = 1807,
    CANAS_LIVE_LATITUDE = 1810, /* likewise, "Live targets" */
    CANAS_LIVE_LONGITUDE = 1811,
    CANAS_LIVE_HEIGHT = 1812,
    CANAS_LIVE_VELOCITY = 1813,
    CANAS_LIVE_HEADING = 1814,
    CANAS_LIVE_KIND = 1815,
    CANAS_LIVE_REMOVE = 1817,
    CANAS_EXERCISE_TIME = 1820, /* likewise, "Exercise clock" */
    CANAS_EXERCISE_RATE = 1821,
    CANAS_EXERCISE_SEED = 1822,
    CANAS_MALFUNCTION = 1825, /* "Malfunctions" */
    CANAS_MALFUNCTION_CLEAR = 1826,
    CANAS_ID_COUNT = 2048
};

struct canas_frame {
    uint16_t id;
    uint8_t length; /* 4..8 */
    uint8_t data[8];
};

/* A sender's memory: the message code that the next frame of each identifier carries. Starts as
 * zeros; each frame made below uses one code and the code after 255 is 0. */
struct canas_codes {
    uint8_t next[CANAS_ID_COUNT];
};

/* `id` below CANAS_ID_COUNT, `node` 1..255. FLOAT rounds to nearest. */
struct canas_frame canas_float(struct canas_codes *codes, uint16_t id, uint8_t node, double value);
struct canas_frame canas_long(struct canas_codes *codes, uint16_t id, uint8_t node, int32_t value);
struct canas_frame canas_uchar(struct canas_codes *codes, uint16_t id, uint8_t node, uint8_t value);
struct canas_frame canas_char4(struct canas_codes *codes, uint16_t id, uint8_t node,
                               const uint8_t value[4]);

/* value * 32767 / full_scale in the first half, full_scale in the second; the physical value is
 * clamped to the full scale. `full_scale` 1..32767, in the unit of `value`. */
struct canas_frame canas_short2(struct canas_codes *codes, uint16_t id, uint8_t node, double value,
                                int16_t full_scale);

/* A double is two frames: DOUBLEH first, then DOUBLEL with the next message code. The
 * specification leaves the order open; this one is what independent senders use. */
void canas_double(struct canas_codes *codes, uint16_t id, uint8_t node, double value,
                  struct canas_frame pair[2]);

/* One frame as candump -L writes it, without the end of line:
 * "(1436509052.249713) can0 40C#091E000040459E04". `out` holds CANAS_LINE_MAX; the interface's name
 * is at most 15 characters (Linux IFNAMSIZ - 1). Returns the length of the line. */
enum { CANAS_LINE_MAX = 80 };
size_t canas_candump_line(char *out, const struct canas_frame *f, int64_t time_us,
                          const char *interface);

#endif
