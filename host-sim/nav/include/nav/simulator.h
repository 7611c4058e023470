/* Simulator: what a flight simulator tells of its aircraft in one datagram. */
#ifndef NAV_SIMULATOR_H
#define NAV_SIMULATOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A number that the datagram does not have is NAN. All others are finite and in range. */
struct nav_told {
    double latitude_deg, longitude_deg, height_m; /* height above mean sea level */
    double heading_deg, pitch_deg, roll_deg;      /* heading from true north, -180..180 */
    double magnetic_deg;                          /* heading from magnetic north, -180..180 */
    double north_ms, east_ms, up_ms;
    double roll_rate, pitch_rate, yaw_rate; /* of the body, deg/s, -170..170 */
    double elapsed_s; /* on the clock of the simulated world, which a pause stops */
    int64_t utc_us;   /* of the simulated world since 1970; -1: not told */
    int64_t order;    /* grows from datagram to datagram, 0.1 ms; -1: not told */
    int paused;       /* 1, 0, or -1: not told */
};

enum nav_told_fault {
    NAV_TOLD_OK,
    NAV_TOLD_FOREIGN,    /* no such datagram at all */
    NAV_TOLD_MALFORMED,  /* cut short, too long, or a number that is none */
    NAV_TOLD_RANGE,      /* a number that an aircraft on the bus cannot have */
    NAV_TOLD_INCOMPLETE, /* well, but without position, attitude or velocity */
    NAV_TOLD_FAULTS
};

enum { NAV_TOLD_BYTES = 2048 }; /* no datagram that is meant is longer */

/* Read a datagram of `length` bytes. *t is whole when NAV_TOLD_OK is returned, and else undefined.
 *
 * FlightGear: a line of the protocol landmass.xml.
 *
 * X-Plane: DATA with the rows 17, 20 and 21; RPOS; or RREF with what nav_xplane_ask asked for,
 * which has no position. */
enum nav_told_fault nav_flightgear_read(const uint8_t *bytes, size_t length, struct nav_told *t);
enum nav_told_fault nav_xplane_read(const uint8_t *bytes, size_t length, struct nav_told *t);

/* The datagrams that ask X-Plane for its position 60 times a second, and for pause and magnetic
 * heading; `stop`: to tell no more. Returns the length of number `index`, 0 behind the last. */
size_t nav_xplane_ask(int index, bool stop, uint8_t bytes[NAV_TOLD_BYTES]);

/* Is it in the ranges of the bus's items (docs/bus.md)? Wraps headings and limits rates. */
enum nav_told_fault nav_told_judge(struct nav_told *t);
void nav_told_blank(struct nav_told *t);

#endif
