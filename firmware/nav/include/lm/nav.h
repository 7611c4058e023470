/* Navigation: position, height, attitude and velocity of the ownship now, extrapolated from the
 * values that came over the bus. */
#ifndef LM_NAV_H
#define LM_NAV_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/bus_event.h"
#include "lm/config.h"
#include "lm/geo.h"

/* Quality of a number, by its age; a larger value is better. The limits come with each event: a
 * number is stale if it is older than `stale_ms`, and dead if it is older than `dead_ms` or was
 * never received. */
enum lm_nav_quality {
    LM_NAV_DEAD,  /* not to be used: the numbers are zero */
    LM_NAV_STALE, /* extrapolated and flagged */
    LM_NAV_GOOD
};

/* Speed above which two positions are a jump. */
#define LM_NAV_JUMP_M_S 1500

/* Time that a sender must be received without a pause longer than its stale age before it is
 * preferred to a sender that had no such pause. */
#define LM_NAV_SETTLE_US 1000000

/* Coarsest resolution of a position, in BAM (20 m), that may be good; a coarser one is stale at
 * best: SHORT2 of full scale 180 degrees has steps of 612 m, FLOAT of at most 1.7 m. */
#define LM_NAV_COARSE_BAM 2144

/* State: the last value of each field from each of its senders; the caller owns it. Counters only
 * ever grow. */
struct lm_nav {
    struct lm_nav_item {
        uint64_t time_us;   /* arrival of the value */
        uint64_t steady_us; /* arrival of the first value since the sender's last pause */
        int32_t value;      /* in the field's unit */
        uint32_t step;      /* resolution: as in struct lm_bus_event */
        uint16_t stale_ms, dead_ms;
        uint16_t rank; /* priority of the row * 256 + channel: the least is preferred */
        uint8_t row, node;
        bool has_value;
    } item[LM_BUS_NAV_FIELDS][LM_NAV_SOURCES];

    bool is_heading_magnetic; /* the board says that LM_BUS_HEADING is magnetic */
    bool is_baro_preferred;   /* the operator chose barometric altitude before the other heights */

    /* Jumps: values of a coordinate that are farther from the sender's last one than
     * LM_NAV_JUMP_M_S allows (at least 150 m); latitude and longitude count separately. A jump is
     * believed at once, because an instructor may move the aircraft. The unit starts the picture
     * again when this number changes. */
    uint32_t position_jumps;
    uint32_t crowded;       /* values not kept: the field has LM_NAV_SOURCES better senders */
    uint32_t rivals;        /* values of a second node while the first is good: see lm_nav_take */
    uint32_t disagreements; /* values beyond the field's tolerance from another good sender's */
    uint8_t rival_node;     /* of the rival that came last */
    uint8_t disagreeing;    /* enum lm_bus_field of the disagreement that came last */
};

/* Origin of a number: its sender and its age. For a group of numbers, those of the older one. All
 * zero if the group's quality is LM_NAV_DEAD. */
struct lm_nav_origin {
    uint32_t age_us;
    uint16_t rank; /* as in struct lm_nav_item */
    uint8_t row;   /* row of the profile, of the group's first field */
    uint8_t node;
};

/* Ownship: the aircraft that carries the display, at one time. Each group of numbers has a quality.
 * If that is LM_NAV_DEAD, the numbers are zero and the source is meaningless. */
struct lm_ownship {
    fx_bam_t latitude, longitude; /* latitude signed */
    enum lm_nav_quality position_quality;
    struct lm_nav_origin position_origin;

    int32_t height_m_q6;             /* above what height_source says */
    enum lm_bus_field height_source; /* ELLIPSOID_HEIGHT; TRUE_ and BARO_ALTITUDE: mean sea level */
    enum lm_nav_quality height_quality;
    struct lm_nav_origin height_origin;

    fx_bam_t heading;                 /* of the nose, from north by east */
    enum lm_bus_field heading_source; /* TRUE_, MAGNETIC_HEADING or HEADING */
    bool is_heading_magnetic;         /* it is from magnetic north: there is no variation */
    enum lm_nav_quality heading_quality;
    int32_t turn_bam_s; /* rate of turn of the heading; 0 unless body rates and attitude are good */
    struct lm_nav_origin heading_origin;

    int32_t pitch, roll; /* signed BAM: nose up, right wing down */
    enum lm_nav_quality attitude_quality;
    struct lm_nav_origin attitude_origin;

    int32_t velocity_north_mm_s, velocity_east_mm_s; /* over the ground; both 0 when dead */
    int32_t ground_speed_mm_s;
    fx_bam_t track; /* direction of the ground velocity, from north; 0 at rest */
    enum lm_nav_quality velocity_quality;
    struct lm_nav_origin velocity_origin;

    struct lm_position steerpoint; /* of the bus */
    enum lm_nav_quality steerpoint_quality;

    int32_t utc_s; /* since midnight */
    enum lm_nav_quality utc_quality;
    struct lm_nav_origin utc_origin;
};

/* Begin with nothing received. */
void lm_nav_init(struct lm_nav *n);

/* Take an event of the bus. Events of other fields than the aircraft's change nothing. A later call
 * replaces an earlier value, whatever their time stamps say, so that a recording that starts over
 * is followed at once.
 *
 * An identifier has one node that sends it. If a second node sends it as well, the first is used
 * until it is stale, so that the picture does not jump between two aircraft.
 *
 * Good senders of one field (rows, channels) are compared as their values come. Positions may
 * differ by 0.02 degree, angles by 5, heights by 100 m, speeds by 20 m/s, the time of day by 5 s;
 * tracks, rates and steerpoints are not compared. More than that is counted, and both stay in use.
 *
 * A coordinate of a coarse data type, such as FLOAT, is smoothed: it says only that the aircraft is
 * within half a step of the value. The value kept is the sender's last position, extrapolated with
 * the velocity and then moved into that half step if it is outside. So the position is never worse
 * than the type allows, and does not jump by a step of up to 1.7 m ten times a second. Without a
 * velocity the value is kept as received. */
void lm_nav_take(struct lm_nav *n, const struct lm_bus_event *event);

/* Compute the ownship at `now_us`, on the clock of the frames' time stamps. A value whose time is
 * up to its stale age in the future counts as just received. A value further ahead comes from a
 * clock that was set back: it is dead until it is received again.
 *
 * Of several senders of a field (rows of the profile, redundancy channels) the one that is good and
 * settled is used; or else a good one; or else a stale one; among equals the one of the lowest
 * rank. A sender is settled if it had no pause in the last LM_NAV_SETTLE_US. Both fields of a pair,
 * such as latitude and longitude, are always of one rank.
 *
 * Position: latitude and longitude are extrapolated each from its own time, along the velocity, on
 * WGS-84's two radii at the present height, for at most the 2 s until they are dead. Worst errors
 * after 2 s at 300 m/s up to 80 degrees of latitude (test_nav.c): 0.016 m against a course of
 * constant velocity, 0.16 m against the geodesic, whose course turns (0.06 m up to 60 degrees).
 * Within 0.6 degree of a pole longitude moves too slowly. The position is stale at best if the
 * velocity is dead, because it is then not extrapolated, or if a coordinate's step is above
 * LM_NAV_COARSE_BAM.
 *
 * Velocity: north and east, or else ground speed along the track.
 *
 * Height: above the ellipsoid, or else true altitude, or else corrected barometric (the latter
 * first if is_baro_preferred); extrapolated by up-velocity, or else altitude rate.
 *
 * Heading: true heading; or else magnetic heading with the magnetic variation added; or else
 * heading, which is magnetic, too, if is_heading_magnetic; or else magnetic heading as it is.
 * Extrapolated by the body's pitch and yaw rates while these and the attitude are good. Error: 0.06
 * degree after 100 ms at 12 and 7 deg/s and up to 60 degrees of pitch.
 *
 * Attitude: pitch and roll as received.
 *
 * "Or else" means that the former is dead, not merely stale. The alternatives are different
 * quantities, and switching between them at every lost frame is worse than a value 300 ms old.
 *
 * Cost: 3,800 instructions with one sender of each field (x86-64, gcc -O2, counted). */
void lm_nav_at(const struct lm_nav *n, uint64_t now_us, struct lm_ownship *out);

#endif
