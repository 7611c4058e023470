/* Where a cell lies: EQUATIONS.md, "Position of a cell". */
#include "reference/reference.h"

#include <math.h>

static const double semi_axis_m = 6378137.0, e2 = 0.00669437999014;
static const double rad = 0.017453292519943295;

struct ref_place ref_geo_direct(struct ref_place from, double azimuth_deg, double distance_m)
{
    const double sin_p = sin(from.latitude_deg * rad), cos_p = cos(from.latitude_deg * rad);
    const double sin_a = sin(azimuth_deg * rad), cos_a = cos(azimuth_deg * rad);
    const double w = 1 - e2 * sin_p * sin_p;
    const double prime_m = semi_axis_m / sqrt(w);
    const double meridian_m = semi_axis_m * (1 - e2) / (w * sqrt(w));
    const double radius_m = 1 / (cos_a * cos_a / meridian_m + sin_a * sin_a / prime_m);
    const double along_m = radius_m * sin(distance_m / radius_m);
    const double half = sin(distance_m / (2 * radius_m));
    const double drop_m = radius_m * 2 * half * half; /* R (1 - cos), without the cancellation */
    const double x = prime_m * cos_p - along_m * cos_a * sin_p - drop_m * cos_p;
    const double y = along_m * sin_a;
    const double z = prime_m * (1 - e2) * sin_p + along_m * cos_a * cos_p - drop_m * sin_p;
    return (struct ref_place){atan2(z, (1 - e2) * hypot(x, y)) / rad,
                              from.longitude_deg + atan2(y, x) / rad};
}

void ref_geo_inverse(struct ref_place from, struct ref_place to, double *azimuth_deg,
                     double *distance_m)
{
    /* What is missing at the end of a try, as metres north and east, is added to it. */
    double north_m = 0, east_m = 0;
    for (int n = 0; n < 30; n++) {
        *azimuth_deg = atan2(east_m, north_m) / rad;
        *distance_m = hypot(north_m, east_m);
        const struct ref_place end = ref_geo_direct(from, *azimuth_deg, *distance_m);
        const double degree_m = REF_MERIDIAN_M / 360;
        north_m += (to.latitude_deg - end.latitude_deg) * degree_m;
        east_m += remainder(to.longitude_deg - end.longitude_deg, 360) * degree_m *
                  cos(to.latitude_deg * rad);
    }
}

/* The parabola through (0, f[0]), (1/2, f[1]), (1, f[2]). */
static double parabola(const double f[3], double u)
{
    return f[0] * (2 * u - 1) * (u - 1) + f[1] * 4 * u * (1 - u) + f[2] * u * (2 * u - 1);
}

struct ref_path ref_gm_path(struct ref_place antenna, double azimuth_deg, double length_m)
{
    struct ref_path path;
    for (int i = 0; i < 3; i++) {
        const struct ref_place p = ref_geo_direct(antenna, azimuth_deg, length_m * i / 2);
        path.latitude_deg[i] = p.latitude_deg;
        path.longitude_deg[i] = p.longitude_deg;
    }
    return path;
}

struct ref_place ref_path_at(const struct ref_path *path, double u)
{
    return (struct ref_place){parabola(path->latitude_deg, u), parabola(path->longitude_deg, u)};
}

struct ref_place ref_patch_offset(struct ref_place centre, double azimuth_deg, double across_m,
                                  double along_m)
{
    return ref_geo_direct(centre, azimuth_deg + atan2(across_m, along_m) / rad,
                          hypot(across_m, along_m));
}

struct ref_surface ref_sar_surface(const struct ref_sar *sar, struct ref_overscan overscan)
{
    const double half_m = sar->cell_count * sar->cell_m / 2;
    const double near_m = -half_m - overscan.before * sar->cell_m;
    const double far_m = half_m + overscan.behind * sar->cell_m;
    struct ref_surface s = {
        .near_m = near_m, .far_m = far_m, .side_m = ref_sar_lines(sar) * sar->cell_m / 2};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const double along_m = near_m + (far_m - near_m) * j / 2;
            const double across_m = (i - 1) * s.side_m * (sar->range_m + along_m) / sar->range_m;
            const struct ref_place p =
                ref_patch_offset(sar->centre, sar->azimuth_deg, across_m, along_m);
            s.latitude_deg[i][j] = p.latitude_deg;
            s.longitude_deg[i][j] = p.longitude_deg;
        }
    }
    return s;
}

struct ref_place ref_surface_at(const struct ref_surface *surface, double across_m, double along_m)
{
    const double u = (across_m / surface->side_m + 1) / 2;
    const double v = (along_m - surface->near_m) / (surface->far_m - surface->near_m);
    double latitude[3], longitude[3];
    for (int i = 0; i < 3; i++) {
        latitude[i] = parabola(surface->latitude_deg[i], v);
        longitude[i] = parabola(surface->longitude_deg[i], v);
    }
    return (struct ref_place){parabola(latitude, u), parabola(longitude, u)};
}
