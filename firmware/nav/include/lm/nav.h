/* Where the aircraft is now and how it lies in the air, from what the bus said a moment ago. */
#ifndef LM_NAV_H
#define LM_NAV_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/bus_event.h"
#include "lm/config.h"
#include "lm/geo.h"

/* How far a number may be trusted. The ages that part the three come with the event: a
 * number is stale when it is older than `stale_ms`, dead when it is older than `dead_ms` or was
 * never heard. The better the larger. */
enum lm_nav_quality {
    LM_NAV_DEAD,  /* removed: the numbers are zero */
    LM_NAV_STALE, /* still extrapolated, but flagged */
    LM_NAV_GOOD
};

/* Two fixes that this speed cannot connect are a jump. */
#define LM_NAV_JUMP_M_S 1500

/* A sender that fell silent for longer than its stale age must be heard this long without another
 * such pause before it is preferred to one that did not. */
#define LM_NAV_SETTLE_US 1000000

/* A position whose type cannot tell places nearer than this apart, in BAM (20 m), is stale at best:
 * SHORT2 of full scale 180 degrees has steps of 612 m, FLOAT of at most 1.7 m. */
#define LM_NAV_COARSE_BAM 2144

/* The last value of each field from each of its senders; the caller owns it. Counters only ever
 * grow. */
struct lm_nav {
    struct lm_nav_item {
        uint64_t time_us;
        uint64_t steady_us; /* when the run without a pause began that this value continues */
        int32_t value;      /* in the field's unit */
        uint32_t step;      /* see lm_bus_event */
        uint16_t stale_ms, dead_ms;
        uint16_t rank; /* priority of the row * 256 + channel: the least is preferred */
        uint8_t row, node;
        bool has_value;
    } item[LM_BUS_NAV_FIELDS][LM_NAV_SOURCES];

    bool is_baro_preferred; /* height: barometric altitude before the others; the operator's choice
                             */

    /* Fixes that lie further from the sender's one before than LM_NAV_JUMP_M_S allows (at least
     * 150 m), each coordinate counted for itself. A jump is believed at once: an instructor moves
     * the aircraft. Whoever draws watches this number and starts the picture anew when it changes.
     */
    uint32_t position_jumps;
    uint32_t crowded; /* values not kept: LM_NAV_SOURCES better senders of the field were alive */
    uint32_t rivals;  /* values of a second node where a first one is good: see lm_nav_take */
};

/* Who said a number, and how long ago. For a group of fields, of the one that is older. All zero
 * when the group's quality is LM_NAV_DEAD. */
struct lm_nav_origin {
    uint32_t age_us;
    uint16_t rank; /* as above */
    uint8_t row;   /* of the profile; of the group's first field */
    uint8_t node;
};

/* Each group of numbers has a quality of its own; when that is LM_NAV_DEAD the numbers are zero and
 * the source says nothing. */
struct lm_ownship {
    fx_bam_t latitude, longitude; /* latitude signed */
    enum lm_nav_quality position_quality;
    struct lm_nav_origin position_origin;

    int32_t height_m_q6;             /* metres * 64 */
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

    struct lm_position steerpoint; /* place to fly to, as the bus says */
    enum lm_nav_quality steerpoint_quality;

    int32_t utc_s; /* since midnight */
    enum lm_nav_quality utc_quality;
    struct lm_nav_origin utc_origin;
};

/* Nothing heard yet. */
void lm_nav_init(struct lm_nav *n);

/* Take an event of the bus. Events of fields that are none of the aircraft's change nothing. A
 * later call wins over an earlier one, whatever their time stamps say, so that a recording that
 * starts over is followed at once.
 *
 * An identifier has one node that sends it. Where a second one sends it as well, the first is heard
 * until it is stale: the picture does not jump between two aircraft.
 *
 * A coordinate that came in a type of coarse steps, such as FLOAT, is smoothed: it says only that
 * the aircraft is within half a step. What is kept is the sender's last position carried on with
 * the velocity, moved by no more than it takes to lie within that half step. So the position is
 * never worse than the type allows and does not jump by a step of up to 1.7 m ten times a second.
 * Without a velocity the value is kept as it came. */
void lm_nav_take(struct lm_nav *n, const struct lm_bus_event *event);

/* The aircraft at `now_us`, on the clock of the frames' time stamps. A value up to its stale age in
 * the future counts as just heard; one further ahead comes from a clock that was set back, and is
 * dead until it is heard again.
 *
 * Of several senders of a field (rows of the profile, redundancy channels) that one is used which
 * is good and settled; or else good; or else stale; among equals the one of the lowest rank.
 * Settled is a sender without a pause in the last LM_NAV_SETTLE_US. Both fields of a pair (latitude
 * and longitude, and so on) are always of one rank.
 *
 * Position: latitude and longitude each from its own time, along the velocity on WGS-84's two radii
 * at the present height, for at most the 2 s until they are dead. Worst errors after 2 s at 300 m/s
 * up to 80 degrees of latitude (test_nav.c): 0.016 m against a course of constant velocity, 0.16 m
 * against the geodesic, whose course turns (0.06 m up to 60 degrees). Within 0.6 degree of a pole
 * longitude moves too slowly. Stale at best when the velocity is dead, because then it stands
 * still, or when a coordinate came in steps above LM_NAV_COARSE_BAM.
 *
 * Velocity: north and east, or else ground speed along the track.
 *
 * Height: above the ellipsoid, or else true altitude, or else corrected barometric (this one first
 * when is_baro_preferred); moved on by up-velocity, or else altitude rate.
 *
 * Heading: true heading, or else heading; turned on by the body's pitch and yaw rates while these
 * and the attitude are good, within 0.06 degree after 100 ms at 12 and 7 deg/s and up to 60 degrees
 * of pitch.
 *
 * Attitude: pitch and roll as they came.
 *
 * "Or else" means when the former is dead, not already when it is stale: these are different
 * quantities, and a picture that changes its mind at every lost frame is worse than one 300 ms old.
 *
 * Cost: 3,800 instructions with one sender of each field (x86-64, gcc -O2, counted). */
void lm_nav_at(const struct lm_nav *n, uint64_t now_us, struct lm_ownship *out);

#endif
