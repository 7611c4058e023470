/* Route: points without times, flown at a steady speed. */
#ifndef NAV_ROUTE_H
#define NAV_ROUTE_H

#include "nav/track.h"

/* Append to `flight` fixes of every second of a flight along the geodesics between the points of
 * `route`, beginning at its first at `begin_us`. Turns are banked NAV_ROUTE_BANK_DEG and begun so
 * early that they end on the next leg (fly-by turns); a point that the turn cannot reach is passed.
 * Heights are linear along a leg; the datum is the route's. Returns 0, or -1 with the error
 * reported: fewer than two different points, a flight beyond NAV_ROUTE_MOST_S, no memory. */
int nav_fly_route(const struct nav_track *route, double speed_ms, int64_t begin_us,
                  struct nav_track *flight);

#define NAV_ROUTE_BANK_DEG 25.0
#define NAV_ROUTE_MOST_S   200000.0

#endif
