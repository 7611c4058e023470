/* Track: the recorded fixes of a flight, and its state at any instant between them. */
#ifndef NAV_TRACK_H
#define NAV_TRACK_H

#include <geodesic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One recorded fix. A value the record does not have is NAN until nav_track_complete. */
struct nav_fix {
    int64_t time_us; /* since 1970-01-01T00:00:00Z, leap seconds not counted */
    double latitude_deg, longitude_deg;
    double height_m; /* above the track's datum, once nav_track_settle_heights is done */
    double geoid_m;  /* what height_m is measured from lies so far above the WGS-84 ellipsoid: 0 for
                        a height above the ellipsoid itself; NAN: the record does not say */
    double speed_ms; /* over ground */
    double track_deg;                        /* true */
    double climb_ms;                         /* up positive */
    double heading_deg, pitch_deg, roll_deg; /* true heading; nose up, right wing down positive */
    bool starts_leg;    /* the record itself says that nothing is known before this fix */
    bool is_jump;       /* set by nav_track_complete: got here too fast to have flown */
    bool is_barometric; /* height_m is a pressure altitude */
};

/* What heights are measured from. */
enum nav_datum {
    NAV_DATUM_ELLIPSOID,  /* of WGS-84: the bus's 1038 */
    NAV_DATUM_SEA_LEVEL,  /* 332, true altitude */
    NAV_DATUM_BAROMETRIC, /* 320, barometric altitude */
    NAV_DATUM_BY_RECORD   /* what the record says; never of a settled track */
};

struct nav_track {
    struct nav_fix *fix; /* owned, in order of time, no two at the same time */
    size_t count, capacity;
    bool has_height; /* the record carries heights */
    enum nav_datum datum;
};

/* An empty fix: every number NAN. */
struct nav_fix nav_fix_blank(void);

/* Append a copy. Returns 0, or -1 when memory is short (reported). */
int nav_track_add(struct nav_track *t, const struct nav_fix *fix);
void nav_track_free(struct nav_track *t);

/* Choose the one datum of the track, and bring every height to it:
 * - the ellipsoid, where each height that is not barometric has its geoid_m, which is added;
 * - else mean sea level;
 * - barometric, where all heights are. Barometric ones among others become NAN.
 * Returns how many heights were given up so. */
size_t nav_track_settle_heights(struct nav_track *t);

/* Leave out fixes that repeat the position of the one before although the aircraft moves: stale
 * reports, behind which the next one jumps. It moves when it goes faster than 5 m/s to and from the
 * repeated position. Returns how many were left out. */
size_t nav_track_drop_repeats(struct nav_track *t);

struct nav_limits {
    double
        max_gap_s; /* a longer pause is a gap; 0 takes the larger of 30 s and 3 median intervals */
    double max_speed_ms; /* a faster step is a jump */
};

/* Result of nav_track_complete. */
struct nav_findings {
    double span_s, median_interval_s, max_gap_s; /* the last as it was applied */
    size_t gaps;                                 /* pauses, each beginning a new leg */
    size_t jumps;                                /* steps above max_speed_ms */
    size_t holds;    /* fixes at exactly the position of the one before */
    size_t isolated; /* fixes with a gap on both sides: at most one instant of each is sent */
};

/* Mark gaps and jumps and fill in every NAN: speed, track and climb from the neighbouring fixes of
 * the same leg (never across a jump); heading as the track; bank as that of a coordinated turn;
 * pitch as the angle of climb. What the record gives is kept as it is. */
void nav_track_complete(struct nav_track *t, const struct nav_limits *limits,
                        struct nav_findings *found);

/* Everything sent on the bus at one instant. Angles in degrees, rates in degrees per second about
 * the body's axes. */
struct nav_state {
    double latitude_deg, longitude_deg, height_m;
    double speed_ms, track_deg, climb_ms; /* track 0..360 */
    double east_ms, north_ms;
    double heading_deg, pitch_deg, roll_deg; /* heading -180..180 */
    double magnetic_deg, variation_deg; /* heading from magnetic north; true less magnetic. NAN:
                                           not known, as in every track */
    double roll_rate, pitch_rate, yaw_rate;
};

/* A moving finger along the track, so that a replay in order of time costs O(1) an instant. */
struct nav_motion {
    const struct nav_track *track; /* borrowed */
    size_t segment;                /* between fix[segment] and fix[segment + 1] */
    size_t line_segment;           /* the segment that `line` was made for, SIZE_MAX for none */
    struct geod_geodesic earth;
    struct geod_geodesicline line;
};

/* `track` has been completed and holds at least one fix. */
void nav_motion_init(struct nav_motion *m, const struct nav_track *track);

/* Is `time_us` within a leg? The bus is silent otherwise. */
bool nav_motion_covers(struct nav_motion *m, int64_t time_us);

/* The state at `time_us` (clamped to the leg's ends). Attitude, speeds and height are linear
 * between fixes, angles the short way round. The position moves at constant speed along the
 * geodesic of the WGS-84 ellipsoid between the fixes; across a jump everything stays at the fix
 * before, and is at the fix after when its time comes. nav_motion_kinematics leaves latitude,
 * longitude and height alone. */
void nav_motion_kinematics(struct nav_motion *m, int64_t time_us, struct nav_state *s);
void nav_motion_position(struct nav_motion *m, int64_t time_us, struct nav_state *s);

/* Bring an angle into [-180, 180). */
double nav_wrap_180(double deg);

#endif
