/* Where the reference puts a point, against PROJ's geodesics (Karney 2013: exact to nanometres). */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

#include <geodesic.h>

static const double range_80nm_m = 80 * 1852.0;

static struct geod_geodesic wgs84(void)
{
    struct geod_geodesic g;
    geod_init(&g, 6378137, 1 / 298.257223563);
    return g;
}

static double distance_m(const struct geod_geodesic *g, struct ref_place p, struct ref_place q)
{
    double metres;
    geod_inverse(g, p.latitude_deg, p.longitude_deg, q.latitude_deg, q.longitude_deg, &metres, NULL,
                 NULL);
    return metres;
}

static struct ref_place geodesic(const struct geod_geodesic *g, struct ref_place from,
                                 double azimuth_deg, double range_m)
{
    struct ref_place p;
    geod_direct(g, from.latitude_deg, from.longitude_deg, azimuth_deg, range_m, &p.latitude_deg,
                &p.longitude_deg, NULL);
    return p;
}

static double worst_direct_m(struct ref_place from, double range_m)
{
    const struct geod_geodesic g = wgs84();
    double worst = 0;
    for (int azimuth = 0; azimuth < 360; azimuth += 5) {
        worst = fmax(worst, distance_m(&g, ref_geo_direct(from, azimuth, range_m),
                                       geodesic(&g, from, azimuth, range_m)));
    }
    return worst;
}

/* EQUATIONS.md promises 2 m; what is left of e2 (s/R)^3 after its small factors is centimetres. */
TEST(a_point_80_nm_away_is_within_5_cm_of_the_geodesic)
{
    const double latitudes[] = {0, 45, 70, 80, -33, -80};
    for (int i = 0; i < 6; i++) {
        const struct ref_place from = {latitudes[i], 7};
        const double worst_m = worst_direct_m(from, range_80nm_m);
        print_message("# direct, latitude %g, 80 nm: worst %.3f m\n", latitudes[i], worst_m);
        assert_true(worst_m < 0.05);
        assert_true(worst_direct_m(from, range_80nm_m / 8) < 0.001);
    }
}

TEST(points_across_the_antimeridian_are_as_good)
{
    const double latitudes[] = {0, 45, 70, 80};
    for (int i = 0; i < 4; i++) {
        assert_true(worst_direct_m((struct ref_place){latitudes[i], 179.9}, range_80nm_m) < 0.05);
        assert_true(worst_direct_m((struct ref_place){latitudes[i], -179.9}, range_80nm_m) < 0.05);
        const struct ref_place east =
            ref_geo_direct((struct ref_place){latitudes[i], 179.9}, 90, range_80nm_m);
        assert_true(east.longitude_deg > 180 && east.longitude_deg < 190);
    }
}

/* Worst distance of the parabola from the curve it stands for, over all azimuths. */
static double worst_parabola_m(double latitude_deg, double length_m)
{
    const struct geod_geodesic g = wgs84();
    const struct ref_place from = {latitude_deg, 179.5};
    double worst = 0;
    for (int azimuth = 0; azimuth < 360; azimuth += 10) {
        const struct ref_path path = ref_gm_path(from, azimuth, length_m);
        for (int i = 0; i <= 64; i++) {
            worst = fmax(worst, distance_m(&g, ref_path_at(&path, i / 64.0),
                                           ref_geo_direct(from, azimuth, length_m * i / 64)));
        }
    }
    return worst;
}

/* EQUATIONS.md says 12 m at latitude 70. Half a range cell, which is what a line may err, is 290 m
 * at 80 nautical miles of 256 cells. Half the length is an eighth of the error. */
TEST(the_parabola_stays_near_the_curve)
{
    const double latitudes[] = {0, 45, 60, 70, 80}, promised_m[] = {0.6, 2, 5, 12, 55};
    for (int i = 0; i < 5; i++) {
        const double worst_m = worst_parabola_m(latitudes[i], range_80nm_m);
        print_message("# parabola, latitude %g, 80 nm: worst %.2f m\n", latitudes[i], worst_m);
        assert_true(worst_m < promised_m[i]);
        assert_true(worst_parabola_m(latitudes[i], range_80nm_m / 2) < worst_m / 6);
    }
}

TEST(the_parabola_meets_both_ends_and_the_middle)
{
    const struct geod_geodesic g = wgs84();
    const struct ref_place from = {52, -179.8};
    const struct ref_path path = ref_gm_path(from, 250, 100000);
    for (int i = 0; i <= 2; i++) {
        assert_true(distance_m(&g, ref_path_at(&path, i / 2.0),
                               ref_geo_direct(from, 250, 50000.0 * i)) < 1e-6);
    }
}

/* A patch of 20 km at latitude 70, the largest there is: the surface is right everywhere, guard
 * cells included, and its lines are rays from the antenna. Returns the worst distance. */
static double worst_of_surface(double range_m)
{
    const struct geod_geodesic g = wgs84();
    double worst = 0;
    for (int azimuth = 0; azimuth < 360; azimuth += 30) {
        const struct ref_sar sar = {.centre = {70, -179.95},
                                    .azimuth_deg = azimuth,
                                    .range_m = range_m,
                                    .cell_m = 80,
                                    .cell_count = 256};
        const struct ref_surface s = ref_sar_surface(&sar, (struct ref_overscan){0});
        for (int i = 0; i < 441; i++) {
            const int column = i % 21, row = i / 21;
            const double x = (column - 10) * 1000.0, y = (row - 10) * 1000.0;
            const double across = x * (sar.range_m + y) / sar.range_m;
            const struct ref_place expected = geodesic(
                &g, sar.centre, azimuth + atan2(across, y) * 180 / acos(-1.0), hypot(across, y));
            worst = fmax(worst, distance_m(&g, ref_surface_at(&s, x, y), expected));
        }
    }
    print_message("# surface of 20 km at latitude 70, %.0f km away: worst %.3f m\n", range_m / 1000,
                  worst);
    return worst;
}

/* From near by the far end of the lines is 92 km wide, most of which no glass shows. */
TEST(the_surface_of_a_patch_is_right_within_a_fraction_of_a_cell)
{
    assert_true(worst_of_surface(60000) < 0.2);
    assert_true(worst_of_surface(16000) < 80 / 20);
}

TEST(right_of_a_line_of_sight_to_the_north_is_east)
{
    const struct ref_sar sar = {
        .centre = {46, 11}, .range_m = 20000, .cell_m = 8, .cell_count = 256};
    const struct ref_surface s = ref_sar_surface(&sar, (struct ref_overscan){0});
    const struct ref_place right = ref_surface_at(&s, 500, 0), far = ref_surface_at(&s, 0, 500);
    assert_true(right.longitude_deg > 11.006 && fabs(right.latitude_deg - 46) < 1e-5);
    assert_true(far.latitude_deg > 46.004 && fabs(far.longitude_deg - 11) < 1e-9);
}

TEST(the_way_back_finds_what_the_way_out_went)
{
    for (double latitude_deg = -80; latitude_deg <= 80; latitude_deg += 20) {
        for (double azimuth_deg = -170; azimuth_deg < 180; azimuth_deg += 37) {
            for (double distance_m = 500; distance_m < 300000; distance_m *= 6) {
                const struct ref_place from = {latitude_deg, 179.9};
                const struct ref_place to = ref_geo_direct(from, azimuth_deg, distance_m);
                double found_deg, found_m;
                ref_geo_inverse(from, to, &found_deg, &found_m);
                assert_true(fabs(found_m - distance_m) < 0.01);
                assert_true(fabs(remainder(found_deg - azimuth_deg, 360)) * distance_m < 0.5);
            }
        }
    }
}
