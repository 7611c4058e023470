/* Earth: geocentric places of DIS as WGS-84 latitude, longitude and height, and the local axes
 * there.
 *
 * Law: WGS-84 (NIMA TR8350.2, 3rd edition: a = 6378137 m, 1/f = 298.257223563). Latitude by
 * Bowring's formula (Survey Review 23, 1976), repeated until it stands: off by less than 1 um in
 * all of dis_is_near_earth (tests/unit/host-sim/dis/test_earth.c). */
#ifndef DIS_EARTH_H
#define DIS_EARTH_H

#include <stdbool.h>

/* What is deeper or higher is no target of a radar; it is what wrong units or axes look like. */
#define DIS_DEPTH_MAX_M  12000.0
#define DIS_HEIGHT_MAX_M 1000000.0

struct dis_place {
    double latitude_deg, longitude_deg; /* -90..90, -180..180 */
    double height_m;                    /* above the ellipsoid */
};

/* Unit vectors along the local axes, in geocentric axes. */
struct dis_axes {
    double east[3], north[3], up[3];
};

/* Within the limits above, roughly: judged by a sphere of each. False for what is not a number. */
bool dis_is_near_earth(const double place_m[3]);

/* `place_m` must pass dis_is_near_earth. */
struct dis_place dis_place_of(const double place_m[3]);
void dis_place_back(const struct dis_place *place, double place_m[3]);

struct dis_axes dis_axes_at(const struct dis_place *place);

double dis_dot(const double a[3], const double b[3]);

#endif
