/* Reports: what the display tells the other avionics over CANaerospace without being asked: the
 * cursor, the designated place, mode and settings, the state of a patch, the track.
 *
 * Items that belong together are a set. A set is told at a stated rate. Its frames hold values of
 * one moment and have one message code, which counts up from set to set. A value that is not known
 * is told as NODATA. The state word of lm/canas_service.h is told with each designated place.
 * Tables for people: docs/bus.md, "What the display says".
 *
 * In each step of the unit:
 *
 *     sets = lm_canas_report_due(&r, now_us);
 *     if (sets != 0) { fill in `values`; lm_canas_report_begin(&r, sets, &values, now_us); }
 *     lm_canas_report_send(&r, can); */
#ifndef LM_CANAS_REPORT_H
#define LM_CANAS_REPORT_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

/* Items, in the order in which they are sent. */
enum lm_report_item {
    LM_REPORT_CURSOR_LATITUDE, /* 1e-7 degree */
    LM_REPORT_CURSOR_LONGITUDE,
    LM_REPORT_CURSOR_ELEVATION, /* of the map there, mm above mean sea level */
    LM_REPORT_CURSOR_BEARING,   /* from the ownship, from true north, 1e-7 degree */
    LM_REPORT_CURSOR_RANGE,   /* along the ground, mm; known up to 400 km, as is the slant range */
    LM_REPORT_CURSOR_SLANT,   /* from the antenna to the map's surface there, mm */
    LM_REPORT_PLACE_LATITUDE, /* designated place: what is tracked and stands still, or the centre
                                 of the patch that is shown */
    LM_REPORT_PLACE_LONGITUDE,
    LM_REPORT_PLACE_ELEVATION,
    LM_REPORT_PICTURE,     /* four bytes: enum lm_picture_kind, enum lm_sector_mode, enum lm_fov,
                              enum lm_format */
    LM_REPORT_RANGE_SCALE, /* of a sector, nautical miles */
    LM_REPORT_SETTINGS,    /* two bytes: half the sector in degrees, enum lm_report_switch */
    LM_REPORT_GAIN,        /* dB, signed */
    LM_REPORT_PATCH,       /* three bytes: enum lm_report_patch, per cent of its lines drawn, enum
                              lm_refusal of the last patch that was refused, for two seconds */
    LM_REPORT_PATCH_CELL,  /* mm */
    LM_REPORT_TRACK,       /* four bytes: kind, state, loss, number (lm/track.h) */
    LM_REPORT_TRACK_LATITUDE,
    LM_REPORT_TRACK_LONGITUDE,
    LM_REPORT_TRACK_ELEVATION, /* above mean sea level, mm */
    LM_REPORT_TRACK_BEARING,   /* from the ownship, from true north, 1e-7 degree */
    LM_REPORT_TRACK_SLANT,     /* straight from the antenna, mm */
    LM_REPORT_TRACK_RATE,      /* of that range, mm/s */
    LM_REPORT_TRACK_SPEED,     /* over the ground, mm/s */
    LM_REPORT_TRACK_COURSE,    /* of that speed, 1e-7 degree */
    LM_REPORT_ITEMS
};

/* Switches of LM_REPORT_SETTINGS, bits. */
enum lm_report_switch {
    LM_REPORT_FROZEN = 1 << 0,
    LM_REPORT_SILENT = 1 << 1, /* the operator silences the radar */
    LM_REPORT_SNOWPLOW = 1 << 2,
    LM_REPORT_AUTO_RANGE = 1 << 3,
    LM_REPORT_MANUAL_TILT = 1 << 4,
    LM_REPORT_PENCIL = 1 << 5,
    LM_REPORT_PLAN = 1 << 6 /* a patch is shown without layover */
};

enum lm_report_patch { LM_REPORT_NO_PATCH, LM_REPORT_READING, LM_REPORT_DRAWING, LM_REPORT_DRAWN };

enum lm_report_set {
    LM_REPORT_CURSOR,
    LM_REPORT_PLACE,
    LM_REPORT_STATE,
    LM_REPORT_TRACKED,
    LM_REPORT_SETS
};

/* An item's frame. */
struct lm_report_row {
    const char *name;
    uint16_t id;      /* identifier, of those that CANaerospace leaves to its users */
    uint8_t type;     /* LM_CANAS_...: LONG, UCHAR4, UCHAR3, UCHAR2 or CHAR */
    uint8_t set;      /* enum lm_report_set */
    const char *unit; /* of a number; of several bytes their names, apart by blanks */
    int32_t per_unit; /* counts in one unit */
};
extern const struct lm_report_row lm_report_rows[LM_REPORT_ITEMS];

/* Time between two sets of a kind. */
extern const uint32_t lm_report_period_us[LM_REPORT_SETS];

/* Values of a moment. */
struct lm_report {
    uint32_t
        word[LM_REPORT_ITEMS]; /* a number, or bytes with the first in the highest place used */
    uint32_t known;            /* bit n: item n is known */
    bool is_stale; /* navigation is old, and so is all that follows from it: service code 1 */
};

/* Most frames of one call of lm_canas_report_send. */
enum { LM_REPORT_FRAMES_A_STEP = 4 };

/* State; the caller owns it. Counters only ever grow. */
struct lm_canas_report {
    uint8_t node; /* the display's own, 1..255; 0: it tells nothing */
    struct {
        uint64_t next_us;  /* when it is due again */
        uint8_t item, end; /* items from `item` to before `end` wait to be sent */
        uint8_t code;      /* message code of the set begun last */
        uint8_t service;   /* service code of that set */
    } set[LM_REPORT_SETS];
    struct lm_report told; /* values of the sets begun last */
    struct {
        uint32_t sent; /* frames */
        uint32_t cut;  /* sets cut short, because the next one was due before the bus took them */
        uint32_t lost; /* frames that the driver could not send */
    } count;
};

/* Begin as `node` (0: tell nothing), with every set due. */
void lm_canas_report_init(struct lm_canas_report *r, uint8_t node);

/* Sets that are due: bit n for set n. 0 for node 0. */
uint32_t lm_canas_report_due(const struct lm_canas_report *r, uint64_t now_us);

/* Take the values of the sets of the bits `sets`, which the next calls of lm_canas_report_send
 * tell. They are due again at the next multiple of their period. */
void lm_canas_report_begin(struct lm_canas_report *r, uint32_t sets, const struct lm_report *values,
                           uint64_t now_us);

/* Offer up to LM_REPORT_FRAMES_A_STEP frames. Never waits: what the bus does not take now is
 * offered by the next call. No effect if the board can only listen. */
void lm_canas_report_send(struct lm_canas_report *r, const struct lm_can *can);

#endif
