/* Where the aircraft is now and how it lies in the air, from what the bus said a moment ago. */
#ifndef LM_NAV_H
#define LM_NAV_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/canas.h"

/* How far a number may be trusted. The ages that part the three are columns of lm_canas_table: a
 * number is stale when it is older than `stale_ms`, dead when it is older than `dead_ms` or was
 * never heard. The better the larger. */
enum lm_nav_quality {
    LM_NAV_DEAD,  /* removed: the numbers are zero */
    LM_NAV_STALE, /* still extrapolated, but flagged */
    LM_NAV_GOOD
};

/* Two fixes that this speed cannot connect are a jump. */
#define LM_NAV_JUMP_M_S 1500

/* The last value of each field; the caller owns it. Counters only ever grow. */
struct lm_nav {
    struct lm_canas canas;
    struct lm_nav_item {
        int32_t value; /* unit: the field's row in lm_canas_table */
        bool has_value, is_coarse;
        uint64_t time_us;
    } item[LM_CANAS_FIELDS];

    /* Fixes that lie further from the one before than LM_NAV_JUMP_M_S allows (at least 150 m), each
     * coordinate counted for itself. A jump is believed at once: an instructor moves the aircraft.
     * Whoever draws watches this number and starts the picture anew when it changes. */
    uint32_t position_jumps;
};

/* Each group of numbers has a quality of its own; when that is LM_NAV_DEAD the numbers are zero and
 * the source says nothing. */
struct lm_ownship {
    fx_bam_t latitude, longitude; /* latitude signed */
    enum lm_nav_quality position_quality;

    int32_t height_q6;                 /* metres * 64 */
    enum lm_canas_field height_source; /* GPS_HEIGHT: above the ellipsoid; TRUE_ and BARO_ALTITUDE:
                                          mean sea level */
    enum lm_nav_quality height_quality;

    fx_bam_t heading;                   /* of the nose, from north by east */
    enum lm_canas_field heading_source; /* TRUE_HEADING, or HEADING, which may be magnetic */
    enum lm_nav_quality heading_quality;

    int32_t pitch, roll; /* signed BAM: nose up, right wing down */
    enum lm_nav_quality attitude_quality;

    int32_t velocity_north_mm_s, velocity_east_mm_s; /* over the ground */
    int32_t ground_speed_mm_s;
    fx_bam_t track; /* of the ground velocity; 0 at rest */
    enum lm_nav_quality velocity_quality;

    int32_t utc_s; /* since midnight */
    enum lm_nav_quality utc_quality;
};

void lm_nav_init(struct lm_nav *n);

/* Take a frame of the bus, whatever it is. A later call wins over an earlier one, whatever their
 * time stamps say, so that a recording that starts over is followed at once. */
void lm_nav_take(struct lm_nav *n, const struct lm_can_frame *frame);

/* The aircraft at `now_us`, on the clock of the frames' time stamps. A value up to its stale age in
 * the future counts as just heard; one further ahead comes from a clock that was set back, and is
 * dead until it is heard again.
 *
 * Position: latitude and longitude each from its own time, along the velocity on WGS-84's two radii
 * at the present height, for at most the 2 s until they are dead. Worst errors after 2 s at 300 m/s
 * up to 80 degrees of latitude (test_nav.c): 0.016 m against a course of constant velocity, 0.16 m
 * against the geodesic, whose course turns (0.06 m up to 60 degrees). Within 0.6 degree of a pole
 * longitude moves too slowly. Stale at best when the velocity is dead, because then it stands
 * still, or when a coordinate came as SHORT2.
 *
 * Velocity: 1131 and 1130, or else 1039 along 1040.
 *
 * Height: 1038, or else 332, or else 320; moved on by 1132, or else 314.
 *
 * Heading: 1133, or else 321; turned on by the body's pitch and yaw rates while these and the
 * attitude are good, within 0.06 degree after 100 ms at 12 and 7 deg/s and up to 60 degrees of
 * pitch.
 *
 * Attitude: 311 and 312 as they came.
 *
 * "Or else" means when the former is dead, not already when it is stale: sources differ, and a
 * picture that changes its mind at every lost frame is worse than one 300 ms old.
 *
 * Cost: 1,420 instructions (x86-64, gcc -O2, counted). */
void lm_nav_at(const struct lm_nav *n, uint64_t now_us, struct lm_ownship *out);

#endif
