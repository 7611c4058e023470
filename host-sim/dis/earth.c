#include "dis/earth.h"

#include <math.h>

#define A_M       6378137.0
#define F         (1 / 298.257223563)
#define B_M       (A_M * (1 - F))
#define E2        (F * (2 - F))   /* eccentricity squared */
#define E2_SECOND (E2 / (1 - E2)) /* second eccentricity squared */
#define DEG       (180 / 3.14159265358979323846)

enum { STEPS = 4 };

bool dis_is_near_earth(const double place_m[3])
{
    const double distance_m = hypot(hypot(place_m[0], place_m[1]), place_m[2]);
    return distance_m >= B_M - DIS_DEPTH_MAX_M && distance_m <= A_M + DIS_HEIGHT_MAX_M;
}

/* Each step leaves an error that is smaller by the square of the flattening times the height over
 * the radius; the first is good to 1e-9 rad up to 1,000 km. */
static double latitude_rad(double across_m, double z_m)
{
    double reduced = atan2(z_m * A_M, across_m * B_M);
    double latitude = 0;
    for (int i = 0; i < STEPS; i++) {
        const double s = sin(reduced), c = cos(reduced);
        latitude = atan2(z_m + E2_SECOND * B_M * s * s * s, across_m - E2 * A_M * c * c * c);
        reduced = atan2(B_M * sin(latitude), A_M * cos(latitude));
    }
    return latitude;
}

struct dis_place dis_place_of(const double place_m[3])
{
    const double across_m = hypot(place_m[0], place_m[1]);
    const double latitude = latitude_rad(across_m, place_m[2]);
    const double s = sin(latitude), c = cos(latitude);
    return (struct dis_place){
        .latitude_deg = latitude * DEG,
        .longitude_deg = across_m > 0 ? atan2(place_m[1], place_m[0]) * DEG : 0,
        .height_m = across_m * c + place_m[2] * s - A_M * sqrt(1 - E2 * s * s)};
}

void dis_place_back(const struct dis_place *place, double place_m[3])
{
    const double latitude = place->latitude_deg / DEG, longitude = place->longitude_deg / DEG;
    const double s = sin(latitude), c = cos(latitude);
    const double normal_m = A_M / sqrt(1 - E2 * s * s);
    place_m[0] = (normal_m + place->height_m) * c * cos(longitude);
    place_m[1] = (normal_m + place->height_m) * c * sin(longitude);
    place_m[2] = (normal_m * (1 - E2) + place->height_m) * s;
}

struct dis_axes dis_axes_at(const struct dis_place *place)
{
    const double latitude = place->latitude_deg / DEG, longitude = place->longitude_deg / DEG;
    const double sp = sin(latitude), cp = cos(latitude);
    const double sl = sin(longitude), cl = cos(longitude);
    return (struct dis_axes){{-sl, cl, 0}, {-sp * cl, -sp * sl, cp}, {cp * cl, cp * sl, sp}};
}

double dis_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
