/* Geocentric places against PROJ's. */
#include "check.h"
#include "dis/earth.h"
#include "hs/rng.h"

#include <math.h>
#include <proj.h>

static PJ *geocentric(void)
{
    PJ *p = proj_create(PJ_DEFAULT_CTX, "+proj=cart +ellps=WGS84");
    assert_non_null(p);
    return p;
}

/* Metres between a place of ours and one of latitude, longitude (radians) and height. */
static double off_m(const double place_m[3], PJ_COORD from)
{
    const struct dis_place ours = dis_place_of(place_m);
    const double north_m = (ours.latitude_deg - proj_todeg(from.lpz.phi)) * 111700;
    const double turn_deg = remainder(ours.longitude_deg - proj_todeg(from.lpz.lam), 360);
    const double east_m = turn_deg * 111700 * cos(from.lpz.phi);
    return fmax(hypot(north_m, east_m), fabs(ours.height_m - from.lpz.z));
}

static PJ_COORD any_place(struct hs_rng *rng, double lowest_m, double highest_m)
{
    const double latitude = asin(2 * hs_rng_uniform(rng) - 1);
    const double longitude = (2 * hs_rng_uniform(rng) - 1) * 3.141592653589793;
    const double height_m = lowest_m + (highest_m - lowest_m) * hs_rng_uniform(rng);
    return proj_coord(longitude, latitude, height_m, 0);
}

/* PROJ's way forth is a closed formula, so what it began with is the truth. */
TEST(the_place_that_proj_made_geocentric_is_found_within_a_micrometre)
{
    PJ *p = geocentric();
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    double worst_m = 0;
    for (int i = 0; i < 200000; i++) {
        const PJ_COORD from = any_place(&rng, -11000, i % 2 == 0 ? 20000 : 900000);
        const PJ_COORD c = proj_trans(p, PJ_FWD, from);
        const double place_m[3] = {c.xyz.x, c.xyz.y, c.xyz.z};
        assert_true(dis_is_near_earth(place_m));
        worst_m = fmax(worst_m, off_m(place_m, from));
    }
    print_message("# worst of 200,000: %.2g m\n", worst_m);
    assert_true(worst_m < 1e-6);
    proj_destroy(p);
}

/* Its way back is one step of Bowring's formula. */
static double off_proj_m(PJ *p, const double place_m[3])
{
    return off_m(place_m, proj_trans(p, PJ_INV, proj_coord(place_m[0], place_m[1], place_m[2], 0)));
}

TEST(geocentric_places_are_those_of_projs_inverse_within_a_centimetre)
{
    PJ *p = geocentric();
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    for (int i = 0; i < 100000; i++) {
        const PJ_COORD c = proj_trans(p, PJ_FWD, any_place(&rng, -11000, 100000));
        const double place_m[3] = {c.xyz.x, c.xyz.y, c.xyz.z};
        assert_true(off_proj_m(p, place_m) < 0.01);
    }
    proj_destroy(p);
}

TEST(poles_axis_and_date_line_are_places_too)
{
    PJ *p = geocentric();
    static const double at[][3] = {{0, 0, 6356752.3142}, {0, 0, -6356752.3142},
                                   {1e-9, 0, 6356800},   {-6378137, 0, 0},
                                   {-6378137, 1e-9, 0},  {-6378137, -1e-9, 0},
                                   {0, -6378137, 0},     {3e-3, 4e-3, -6366752.3142}};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        assert_true(off_proj_m(p, at[i]) < 1e-3);
    }
    proj_destroy(p);
}

TEST(the_way_back_ends_where_it_began)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (int i = 0; i < 20000; i++) {
        const struct dis_place place = {180 * hs_rng_uniform(&rng) - 90,
                                        360 * hs_rng_uniform(&rng) - 180,
                                        20000 * hs_rng_uniform(&rng) - 1000};
        double there_m[3], back_m[3];
        dis_place_back(&place, there_m);
        const struct dis_place again = dis_place_of(there_m);
        dis_place_back(&again, back_m);
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(back_m[k] - there_m[k]) < 1e-6);
        }
    }
}

TEST(local_axes_are_the_directions_in_which_the_place_changes)
{
    const struct dis_place at = {47, -122, 300};
    const struct dis_axes axes = dis_axes_at(&at);
    const double *each[3] = {axes.east, axes.north, axes.up};
    double from_m[3];
    dis_place_back(&at, from_m);
    for (int i = 0; i < 3; i++) {
        double to_m[3];
        for (int k = 0; k < 3; k++) {
            to_m[k] = from_m[k] + 10 * each[i][k];
        }
        const struct dis_place to = dis_place_of(to_m);
        assert_true((to.longitude_deg > at.longitude_deg + 1e-5) == (i == 0));
        assert_true((to.latitude_deg > at.latitude_deg + 1e-5) == (i == 1));
        assert_true(fabs(to.height_m - at.height_m - (i == 2 ? 10 : 0)) < 1e-4);
        assert_true(fabs(dis_dot(each[i], each[(i + 1) % 3])) < 1e-15);
    }
}

TEST(what_is_not_near_the_earth_is_said_so)
{
    static const double far_m[][3] = {
        {0, 0, 0}, {(double)NAN, 0, 0}, {(double)INFINITY, 0, 0}, {0, 7.4e6, 0}};
    for (size_t i = 0; i < sizeof far_m / sizeof *far_m; i++) {
        assert_false(dis_is_near_earth(far_m[i]));
    }
}
