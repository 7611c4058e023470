/* Target: an entity as the display's bus has it, frames 1810 to 1819 of docs/bus.md, and where the
 * display takes it to be until the next frames come. */
#ifndef DIS_TARGET_H
#define DIS_TARGET_H

#include "dis/earth.h"
#include "dis/kinds.h"
#include "dis/reckon.h"
#include "lm/geoid.h"
#include "lm/port.h"

enum { DIS_TARGETS = 256, DIS_SET_MAX = 8 };

/* Identifiers of the frames; docs/bus.md, "Live targets". */
enum dis_frame_id {
    DIS_ID_LATITUDE = 1810,
    DIS_ID_LONGITUDE = 1811,
    DIS_ID_HEIGHT = 1812,
    DIS_ID_VELOCITY = 1813,
    DIS_ID_HEADING = 1814,
    DIS_ID_KIND = 1815,
    DIS_ID_RCS = 1816,
    DIS_ID_REMOVED = 1817,
    DIS_ID_ACCELERATION = 1819
};

/* Which frames a set has, in the last byte of 1815. */
enum {
    DIS_PART_HEIGHT = 1,
    DIS_PART_VELOCITY = 2,
    DIS_PART_HEADING = 4,
    DIS_PART_RCS = 8,
    DIS_PART_ACCELERATION = 16
};

/* Numbers as the frames carry them. */
struct dis_target {
    int32_t latitude_1e7, longitude_1e7;
    float height_m;                      /* above mean sea level */
    int16_t east_0m05_s, north_0m05_s;   /* 0.05 m/s */
    int16_t heading_bam16, turn_0d01_s;  /* 180/32768 degrees; 0.01 degree a second */
    int16_t east_0m01_s2, north_0m01_s2; /* 0.01 m/s2 */
    uint8_t kind, algorithm, signature, parts;
    float rcs_dbsm;
};

/* Mean sea level above the ellipsoid: a grid, or NULL, and then the same everywhere. */
struct dis_sea_level {
    const struct lm_geoid *grid;
    double height_m;
};

/* Why an entity is no target. */
enum dis_unfit { DIS_FIT, DIS_TOO_FAST, DIS_TOO_HIGH, DIS_UNFITS };

/* The target that an entity is `after_s` behind its PDU. */
enum dis_unfit dis_target_of(const struct dis_motion *motion, const struct dis_kind *kind,
                             const struct dis_sea_level *sea, double after_s,
                             struct dis_target *target);

/* How far the display is off that was told `old` so long ago, where `now` would be told. */
struct dis_error {
    double metres, degrees;
    bool is_other; /* kind, signature, cross section or the way it moves changed */
};
struct dis_error dis_target_error(const struct dis_target *old, double after_s,
                                  const struct dis_target *now);

/* The set of frames, 1815 first; returns how many. `code` is the same in all of them. */
int dis_target_frames(const struct dis_target *target, uint8_t node, uint8_t number, uint8_t code,
                      struct lm_can_frame frames[DIS_SET_MAX]);

/* The frame that removes a target. */
struct lm_can_frame dis_removal(uint8_t node, uint8_t number, uint8_t code);

#endif
