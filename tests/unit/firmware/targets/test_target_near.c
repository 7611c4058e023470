/* Where a candidate is taken to be, and how sure that is: the circle that lm/target_candidates.h
 * promises, by the geodesics of the reference. */
#include "check.h"
#include "hs/rng.h"
#include "lm/target_candidates.h"
#include "reference/reference.h"
#include "target_support.h"

static struct ref_place random_place_near(struct hs_rng *rng, struct ref_place from, double most_m)
{
    return ref_geo_direct(from, 360 * hs_rng_uniform(rng), most_m * hs_rng_uniform(rng));
}

static struct lm_position position_of(struct ref_place place)
{
    return (struct lm_position){hs_bam(place.latitude_deg), hs_bam(place.longitude_deg)};
}

/* Metres that the plane is wrong by, seen from an antenna that has gone on since the candidate was
 * selected: the plane takes the way gone for latitudes and longitudes on a sphere of 6,371 km. */
static double error_m(const struct lm_target_candidate *candidate, struct ref_place selected,
                      struct ref_place antenna, struct ref_place target)
{
    const double m_per_degree = 6371000 * acos(-1) / 180;
    const double gone_north_m = (antenna.latitude_deg - selected.latitude_deg) * m_per_degree;
    const double gone_east_m = (antenna.longitude_deg - selected.longitude_deg) * m_per_degree *
                               cos(antenna.latitude_deg / 57.29577951);
    double azimuth_deg, distance_m;
    ref_geo_inverse(antenna, target, &azimuth_deg, &distance_m);
    const double azimuth = azimuth_deg / 57.29577951;
    return hypot(candidate->north_m_q8 / 256.0 - gone_north_m - distance_m * cos(azimuth),
                 candidate->east_m_q8 / 256.0 - gone_east_m - distance_m * sin(azimuth));
}

TEST(the_circle_of_a_candidate_holds_it_wherever_the_antenna_has_gone)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 18);
    double closest_m = 1e9;
    for (int i = 0; i < 30000; i++) {
        const struct ref_place selected = {150 * hs_rng_uniform(&rng) - 75, 11};
        const double most_m = i % 2 ? 60000 : 500;
        const struct ref_place place = random_place_near(&rng, selected, most_m);
        const struct ref_place antenna = random_place_near(&rng, selected, LM_TARGET_DRIFT_M - 1);
        struct lm_target target = point_at(place.latitude_deg, place.longitude_deg, 0, 10);
        const struct lm_target_set set = {.items = &target, .count = 1};
        const struct lm_target_query query = {.position = position_of(selected), .reach_m = 100000};
        static struct lm_target_candidates found;
        lm_target_candidates_select(&found, &set, &query);
        assert_int_equal(found.count, 1);
        const double left_m = found.candidate[0].slack_m_q8 / 256.0 -
                              error_m(&found.candidate[0], selected, antenna, place);
        closest_m = fmin(closest_m, left_m);
    }
    print_message("# the circle is at least %.1f m wider than the error\n", closest_m);
    assert_true(closest_m > 0);
}
