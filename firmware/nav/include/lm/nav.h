/* Navigation: position, height, velocity, heading and attitude of the ownship at any moment,
 * extrapolated from the last events of the bus. */
#ifndef LM_NAV_H
#define LM_NAV_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/bus_event.h"
#include "lm/config.h"
#include "lm/geo.h"

/* Quality of a group of numbers, by the age of the older one. stale_ms and dead_ms come with each
 * event (lm/bus_event.h). A larger quality is a better one. */
enum lm_nav_quality {
    LM_NAV_DEAD,  /* older than dead_ms, or never heard: the numbers are zero */
    LM_NAV_STALE, /* older than stale_ms: still extrapolated, and to be flagged */
    LM_NAV_GOOD
};

/* Speed above which two fixes of one sender are a jump. */
#define LM_NAV_JUMP_M_S 1500

/* Settling time of a sender: one that fell silent for longer than its stale age is preferred again
 * after it was heard for this long without another such pause. */
#define LM_NAV_SETTLE_US 1000000

/* Step of a coordinate above which the position is stale at best: 20 m, in BAM. A SHORT2 of full
 * scale 180 degrees has steps of 612 m, a FLOAT of at most 1.7 m. */
#define LM_NAV_COARSE_BAM 2144

/* What was heard: the last value of each field from each of its senders. The caller owns it.
 * Counters only ever grow. */
struct lm_nav {
    /* time_us, value, step, ages, row and node are those of the event: lm/bus_event.h. */
    struct lm_nav_item {
        uint64_t time_us;
        uint64_t steady_us; /* since when the sender is heard without a stale pause */
        int32_t value;
        uint32_t step;
        uint16_t stale_ms, dead_ms;
        uint16_t rank; /* of the sender: priority * 256 + channel; the lowest is preferred */
        uint8_t row, node;
        bool has_value;
    } item[LM_BUS_NAV_FIELDS][LM_NAV_SOURCES]; /* filled from the first sender on */

    bool is_baro_preferred; /* the operator's choice: barometric altitude before other heights */

    /* Fixes further from the same sender's last one than LM_NAV_JUMP_M_S allows (at least 150 m),
     * each coordinate counted for itself. A jump is believed at once, because an instructor may
     * move the aircraft; a picture that was drawn across it is to be started again. */
    uint32_t position_jumps;
    uint32_t crowded; /* values not kept: LM_NAV_SOURCES better senders of the field were alive */
    uint32_t rivals;  /* values of a second node while the first one is good: see lm_nav_take */
};

/* Sender and age of a group of numbers. All zero when the group is LM_NAV_DEAD. */
struct lm_nav_origin {
    uint32_t age_us; /* of the older number */
    uint16_t rank;   /* see struct lm_nav_item */
    uint8_t row;     /* row of the profile that brought the group's first number */
    uint8_t node;    /* sender of the group's first number */
};

/* The ownship at one moment. Each group of numbers has a quality; when that is LM_NAV_DEAD the
 * group's numbers are zero and its source says nothing. */
struct lm_ownship {
    fx_bam_t latitude, longitude; /* WGS-84; latitude signed, -90..90 degrees */
    enum lm_nav_quality position_quality;
    struct lm_nav_origin position_origin;

    int32_t height_q6;               /* metres * 64 */
    enum lm_bus_field height_source; /* ELLIPSOID_HEIGHT; TRUE_ and BARO_ALTITUDE: mean sea level */
    enum lm_nav_quality height_quality;
    struct lm_nav_origin height_origin;

    fx_bam_t heading;                 /* of the nose, from north by east */
    enum lm_bus_field heading_source; /* TRUE_HEADING, or HEADING, which may be magnetic */
    enum lm_nav_quality heading_quality;
    int32_t turn_bam_s; /* of the heading; 0 while the body's rates or the attitude are not good */
    struct lm_nav_origin heading_origin;

    int32_t pitch, roll; /* signed BAM: nose up, right wing down */
    enum lm_nav_quality attitude_quality;
    struct lm_nav_origin attitude_origin;

    int32_t velocity_north_mm_s, velocity_east_mm_s; /* over the ground */
    int32_t ground_speed_mm_s;
    fx_bam_t track; /* of the ground velocity; 0 at rest */
    enum lm_nav_quality velocity_quality;
    struct lm_nav_origin velocity_origin;

    struct lm_place steerpoint; /* place to fly to, as the bus says */
    enum lm_nav_quality steerpoint_quality;

    int32_t utc_s; /* since midnight */
    enum lm_nav_quality utc_quality;
    struct lm_nav_origin utc_origin;
};

/* Begin with nothing heard: every quality is LM_NAV_DEAD. */
void lm_nav_init(struct lm_nav *n);

/* Take an event. It is not kept when
 *
 * - its field is not the aircraft's (LM_BUS_NAV_FIELDS and above)
 * - LM_NAV_SOURCES better senders of the field are alive (counted in crowded)
 * - another node sends the same row and channel and is not stale yet (counted in rivals): the
 *   picture does not jump between two aircraft
 *
 * A later call wins over an earlier one, whatever their time stamps say, so that a recording that
 * starts over is followed at once.
 *
 * A coordinate of a type with steps, such as FLOAT, is smoothed: it says only that the aircraft is
 * within half a step. What is kept is the sender's last position, extrapolated with the velocity
 * and moved by no more than it takes to lie within that half step. The position is then never worse
 * than the type allows, and does not jump by up to 1.7 m ten times a second. Without a velocity the
 * value is kept as it came.
 *
 * Cost: 75 instructions, and those of an extrapolation for a coordinate. */
void lm_nav_take(struct lm_nav *n, const struct lm_bus_event *event);

/* Work out the ownship at `now_us`, on the clock of the frames' time stamps. A value up to its
 * stale age in the future counts as just heard; one further ahead comes from a clock that was set
 * back, and is dead until it is heard again.
 *
 * Senders. Of several senders of a field (rows of the profile, redundancy channels) the best is
 * used: good and settled (no pause in the last LM_NAV_SETTLE_US), then good, then stale; among
 * equals the lowest rank. Both fields of a pair, such as latitude and longitude, have one sender.
 *
 * Position. Each coordinate is extrapolated from its own time, along the velocity on the two radii
 * of WGS-84 at the present height. Worst errors after 2 s at 300 m/s, up to 80 degrees of latitude
 * (test_nav.c): 0.016 m against a course of constant velocity, 0.16 m against the geodesic, whose
 * course turns (0.06 m up to 60 degrees). Within 0.6 degree of a pole longitude moves too slowly.
 * The quality is stale at best when the velocity is dead, because the position then stands still,
 * or when a coordinate came in steps above LM_NAV_COARSE_BAM.
 *
 * Velocity. North and east, or else ground speed along the track.
 *
 * Height. Above the ellipsoid, or else true altitude, or else corrected barometric altitude, which
 * comes first when is_baro_preferred; extrapolated by up-velocity, or else altitude rate.
 *
 * Heading. True heading, or else heading; extrapolated by the body's pitch and yaw rates while
 * these and the attitude are good: within 0.06 degree after 100 ms at 12 and 7 deg/s and up to 60
 * degrees of pitch.
 *
 * Attitude. Pitch and roll as they came.
 *
 * "Or else" means when the former is dead, not already when it is stale: the two are different
 * quantities, and a picture that changes between them at every lost frame is worse than one that
 * is 300 ms old.
 *
 * Cost: 3,800 instructions with one sender of each field (x86-64, gcc -O2, counted). */
void lm_nav_at(const struct lm_nav *n, uint64_t now_us, struct lm_ownship *out);

#endif
