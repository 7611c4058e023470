/* Which height the antenna has: the map's elevations are above mean sea level, satellites tell the
 * height above the ellipsoid. */
#include "check.h"
#include "hs/angle.h"
#include "ownship.h"

static struct lm_unit_map map = {.images = {{.geoid_m_q6 = 48 * 64}}, .image_count = 1};

static struct lm_ownship at(double latitude_deg, double longitude_deg)
{
    return (struct lm_ownship){.latitude = hs_bam(latitude_deg),
                               .longitude = hs_bam(longitude_deg),
                               .height_m_q6 = 1000 * 64,
                               .height_source = LM_BUS_ELLIPSOID_HEIGHT};
}

TEST(a_height_above_the_ellipsoid_is_less_by_the_geoid_of_the_header)
{
    struct lm_ownship own = at(43, 7);
    map.images[0].geoid.rows = 0;
    assert_int_equal(lm_antenna_height_m_q6(&own, &map), (1000 - 48) * 64);
}

TEST(with_a_grid_it_is_less_by_the_geoid_of_the_place)
{
    map.images[0].geoid =
        (struct lm_geoid){.south = hs_bam(40),
                          .west = hs_bam(5),
                          .latitude_shift = 24,
                          .longitude_shift = 24,
                          .rows = 2,
                          .columns = 2,
                          .height_m_q6 = {{40 * 64, 50 * 64}, {40 * 64, 50 * 64}}};
    struct lm_ownship west = at(40, 5), east = at(40, 7);
    assert_int_equal(lm_antenna_height_m_q6(&west, &map), (1000 - 40) * 64);
    assert_int_equal(lm_antenna_height_m_q6(&east, &map), (1000 - 50) * 64);
}

TEST(other_heights_stay_as_they_are)
{
    struct lm_ownship own = at(40, 5);
    own.height_source = LM_BUS_TRUE_ALTITUDE;
    assert_int_equal(lm_antenna_height_m_q6(&own, &map), 1000 * 64);
}
