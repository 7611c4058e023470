/* Geodesics of WGS 84, by PROJ's library: degrees and metres. */
#ifndef WGS84_H
#define WGS84_H

#include <geodesic.h>
#include <stddef.h>

static inline struct geod_geodesic wgs84(void)
{
    struct geod_geodesic earth;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    return earth;
}

/* The distance between two places. */
static inline double wgs84_metres(double latitude_a, double longitude_a, double latitude_b,
                                  double longitude_b)
{
    const struct geod_geodesic earth = wgs84();
    double metres;
    geod_inverse(&earth, latitude_a, longitude_a, latitude_b, longitude_b, &metres, NULL, NULL);
    return metres;
}

/* The place so many metres away, in the direction of an azimuth at the start. */
static inline void wgs84_direct(double from_latitude, double from_longitude, double azimuth,
                                double metres, double *latitude, double *longitude)
{
    const struct geod_geodesic earth = wgs84();
    geod_direct(&earth, from_latitude, from_longitude, azimuth, metres, latitude, longitude, NULL);
}

#endif
