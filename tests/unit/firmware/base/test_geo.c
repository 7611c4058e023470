/* Positions along a scan line, against PROJ's geodesics. */
#include "check.h"
#include "hs/angle.h"
#include "lm/geo.h"
#include "wgs84.h"

#include <math.h>
#include <stdlib.h>

static struct lm_position place_of(double latitude, double longitude)
{
    return (struct lm_position){hs_bam(latitude), hs_bam(longitude)};
}

/* Worst distance between our direct problem and the geodesic, over azimuths. */
static double worst_direct(double lat, double lon, double metres)
{
    struct lm_geo_origin o;
    const struct lm_position start = place_of(lat, lon);
    lm_geo_set_origin(&o, start);
    double worst = 0;
    for (int deg = 0; deg < 360; deg += 7) {
        const struct lm_position p = lm_geo_direct(&o, FX_BAM_DEG(deg), (uint32_t)(metres * 256));
        double to_lat, to_lon;
        wgs84_direct(hs_degrees(start.latitude), hs_degrees(start.longitude), deg, metres, &to_lat,
                     &to_lon);
        const double miss =
            wgs84_metres(to_lat, to_lon, hs_degrees(p.latitude), hs_degrees(p.longitude));
        worst = fmax(worst, miss);
    }
    return worst;
}

/* To the next cell of a path, by what its differences mean. */
static void go_on(struct lm_ground_path *p)
{
    p->latitude += p->latitude_step;
    p->latitude_step += p->latitude_bend;
    p->longitude += p->longitude_step;
    p->longitude_step += p->longitude_bend;
}

static const double latitudes[] = {0, 45, 68, 70, -33, 80, -89, 90};

TEST(the_direct_problem_is_within_10_cm_of_the_geodesic_at_80_nautical_miles)
{
    for (size_t i = 0; i < sizeof latitudes / sizeof *latitudes; i++) {
        const double worst = worst_direct(latitudes[i], 179.9, 148160);
        print_message("# latitude %g: direct problem off by %.2f m at 80 nm\n", latitudes[i],
                      worst);
        assert_true(worst < 0.1);
    }
}

TEST(nearby_points_are_within_5_cm)
{
    for (size_t i = 0; i < sizeof latitudes / sizeof *latitudes; i++) {
        assert_true(worst_direct(latitudes[i], -71, 640) < 0.05);
    }
}

TEST(what_is_too_far_counts_as_300_km)
{
    struct lm_geo_origin o;
    lm_geo_set_origin(&o, place_of(61, -5));
    const struct lm_position most = lm_geo_direct(&o, 7, 300000 * 256);
    const struct lm_position farther = lm_geo_direct(&o, 7, UINT32_MAX);
    assert_memory_equal(&most, &farther, sizeof most);
}

/* Worst distance of any cell of a GM line from where the geodesic puts it. */
static double worst_cell(double lat, double lon, double metres, uint32_t cells)
{
    struct lm_geo_origin o;
    const struct lm_position start = place_of(lat, lon);
    lm_geo_set_origin(&o, start);
    double worst = 0;
    for (int deg = 3; deg < 360; deg += 11) {
        const uint32_t length_q8 = (uint32_t)(metres * 256);
        const fx_bam_t azimuth = FX_BAM_DEG(deg);
        const struct lm_position points[3] = {start, lm_geo_direct(&o, azimuth, length_q8 / 2),
                                              lm_geo_direct(&o, azimuth, length_q8)};
        struct lm_ground_path path;
        lm_ground_path_fit(&path, points, cells);
        for (uint32_t i = 0; i < cells; i++, go_on(&path)) {
            const struct lm_position p = {(fx_bam_t)(path.latitude >> 32),
                                          (fx_bam_t)(path.longitude >> 32)};
            double to_lat, to_lon;
            wgs84_direct(hs_degrees(start.latitude), hs_degrees(start.longitude), deg,
                         (i + 0.5) * metres / cells, &to_lat, &to_lon);
            worst = fmax(worst, wgs84_metres(to_lat, to_lon, hs_degrees(p.latitude),
                                             hs_degrees(p.longitude)));
        }
    }
    return worst;
}

TEST(every_cell_of_an_80_mile_line_is_within_half_a_cell)
{
    static const double places[][2] = {{0, 10}, {45, -100}, {70, 20}, {45, 179.5}, {-70, -179.8}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const double worst = worst_cell(places[i][0], places[i][1], 148160, 256);
        print_message("# line from %g, %g: worst cell %.1f m off, half a cell is %.1f m\n",
                      places[i][0], places[i][1], worst, 148160 / 512.0);
        assert_true(worst < 148160 / 512.0);
    }
}

TEST(up_to_the_polar_latitude_every_cell_of_the_longest_line_is_within_a_cell)
{
    const double limit_deg = LM_GEO_POLAR_DEG, cell_m = 148160 / 512.0;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double at = worst_cell(sign * limit_deg, 179.5, 148160, 512);
        const double beyond = worst_cell(sign * (limit_deg + 1), 179.5, 148160, 512);
        print_message("# at %g: worst cell %.0f m off, at %g %.0f m; a cell is %.0f m\n",
                      sign * limit_deg, at, sign * (limit_deg + 1), beyond, cell_m);
        assert_true(at < cell_m && beyond > cell_m);
        assert_false(lm_geo_is_polar(place_of(sign * limit_deg, 0)));
        assert_true(lm_geo_is_polar(place_of(sign * (limit_deg + 1e-6), 0)));
        assert_true(lm_geo_is_polar(place_of(sign * 90, 0)));
    }
    assert_false(lm_geo_is_polar(place_of(0, 180)));
}

/* The worst cell of `cells` along every fifth of 256 lines of a fan, metres off. */
static double worst_patch_cell(double lat, double lon, const struct lm_ground_extent *extent,
                               int cells)
{
    struct lm_ground_patch patch;
    const double azimuth = 37, side_m = extent->side_m_q8 / 256.0,
                 near_m = extent->near_m_q8 / 256.0;
    const double cell_m = (extent->far_m_q8 / 256.0 - near_m) / cells;
    const struct lm_position centre = place_of(lat, lon);
    lm_ground_patch_set(&patch, centre, FX_BAM_DEG(37), extent);
    double worst = 0;
    for (uint32_t line = 0; line < 256; line += 5) {
        struct lm_position points[3];
        struct lm_ground_path path;
        lm_ground_patch_line(&patch, line, 256, points);
        lm_ground_path_fit(&path, points, (uint32_t)cells);
        for (int i = 0; i < cells; i++, go_on(&path)) {
            const double apex_m = extent->apex_m_q8 / 256.0, along = near_m + (i + 0.5) * cell_m;
            const double across = (line + 0.5 - 128) * side_m / 128 * (apex_m + along) / apex_m;
            double to_lat, to_lon;
            wgs84_direct(hs_degrees(centre.latitude), hs_degrees(centre.longitude),
                         azimuth + atan2(across, along) * 180 / 3.14159265358979,
                         hypot(across, along), &to_lat, &to_lon);
            const struct lm_position p = {(fx_bam_t)(path.latitude >> 32),
                                          (fx_bam_t)(path.longitude >> 32)};
            worst = fmax(worst, wgs84_metres(to_lat, to_lon, hs_degrees(p.latitude),
                                             hs_degrees(p.longitude)));
        }
    }
    return worst;
}

TEST(patch_lines_lie_where_across_and_along_offsets_say)
{
    for (uint32_t apex_m = 4000; apex_m < 200000; apex_m *= 6) {
        const struct lm_ground_extent patch = {-132 * 2560, 128 * 2560, 128 * 2560, apex_m * 256};
        const double worst = worst_patch_cell(61.8, 179.99, &patch, 260);
        print_message("# patch of 10 m cells, %u km away: worst cell %.3f m off\n", apex_m / 1000,
                      worst);
        assert_true(worst < 0.1);
    }
}

TEST(the_lines_before_a_patch_80_miles_away_are_within_a_tenth_of_their_cells)
{
    const struct lm_ground_extent foreground = {-138600 * 256, -1320 * 256, 128 * 2560,
                                                148000 * 256};
    const double worst = worst_patch_cell(61.8, 179.99, &foreground, 128);
    print_message("# foreground of 1,072 m cells: worst cell %.1f m off\n", worst);
    assert_true(worst < 107);
}

TEST(the_inverse_problem_finds_distance_and_azimuth)
{
    for (int deg = 0; deg < 360; deg += 13) {
        double to_lat, to_lon;
        wgs84_direct(52, 179.9, deg, 60000, &to_lat, &to_lon);
        uint32_t distance_q8;
        fx_bam_t azimuth;
        lm_geo_inverse(place_of(52, 179.9), place_of(to_lat, to_lon), &distance_q8, &azimuth);
        assert_true(fabs(distance_q8 / 256.0 - 60000) < 120);
        assert_true(fabs(remainder(hs_degrees(azimuth) - deg, 360)) < 0.1);
    }
}

TEST(the_inverse_problem_is_within_a_hundredth_up_to_the_polar_latitude)
{
    static const double places[][2] = {{75, 0.2}, {80, 0.4}, {-83, 0.7}, {85, 1}, {-85, 1}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const double latitude = places[i][0], metres = 148160;
        double worst = 0;
        for (int deg = 0; deg < 360; deg += 7) {
            double to_lat, to_lon;
            wgs84_direct(latitude, 179.9, deg, metres, &to_lat, &to_lon);
            uint32_t distance_q8;
            fx_bam_t azimuth;
            lm_geo_inverse(place_of(latitude, 179.9), place_of(to_lat, to_lon), &distance_q8,
                           &azimuth);
            const double turn = remainder(hs_degrees(azimuth) - deg, 360) * 3.14159265 / 180;
            worst = fmax(worst, hypot(distance_q8 / 256.0 - metres, turn * metres));
        }
        print_message("# latitude %g: inverse problem off by %.2f %% at 80 nm\n", latitude,
                      worst / metres * 100);
        assert_true(worst < places[i][1] / 100 * metres);
    }
}

TEST(a_hopeless_distance_does_not_overflow)
{
    uint32_t distance_q8;
    fx_bam_t azimuth;
    lm_geo_inverse(place_of(-90, 0), place_of(90, 180), &distance_q8, &azimuth);
    assert_true(distance_q8 / 256 > 300000);
}
