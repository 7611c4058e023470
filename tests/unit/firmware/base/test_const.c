/* Constants of the Earth, of waves and of units: each is its formula in double precision, rounded.
 */
#include "check.h"
#include "lm/const.h"

#include <math.h>

static void is_nearest(const char *name, int64_t have, double value, int q)
{
    const int64_t want = llround(ldexp(value, q));
    if (have != want) {
        fail_msg("%s is %lld and should be %lld", name, (long long)have, (long long)want);
    }
}

#define IS_NEAREST(name, value, q) is_nearest(#name, name, value, q)

TEST(the_earth_is_its_formulas_rounded)
{
    const double two_radii_m = 2 * 4 / 3.0 * 6371000;
    IS_NEAREST(LM_TWO_RADII_M, two_radii_m, 0);
    IS_NEAREST(LM_CURVATURE_Q48, 1 / two_radii_m, 48);
    IS_NEAREST(LM_MM_PER_BAM_Q16, 40007862.917 * 1000 / 4294967296, 16);
}

TEST(the_eccentricity_is_cut)
{
    const double flattening = 1 / 298.257223563;
    const double eccentricity2 = flattening * (2 - flattening);
    assert_int_equal(LM_ECCENTRICITY2_Q30, floor(ldexp(eccentricity2, 30)));
}

TEST(waves_are_their_formulas_rounded)
{
    IS_NEAREST(LM_HALF_LIGHT_M_PER_NS_Q24, 299792458 / 2e9, 24);
    IS_NEAREST(LM_BEAM_ONE_WAY_DB_Q8, 40 * log10(2), 8);
    IS_NEAREST(LM_BEAM_TWO_WAY_DB_Q8, 80 * log10(2), 8);
    IS_NEAREST(LM_LOG2_TWO_WAY_Q16, log2(sqrt(M_PI / (8 * log(2)))), 16);
}

TEST(lengths_are_their_formulas_rounded)
{
    IS_NEAREST(LM_LOG2_TEN_NM_M_Q8_Q16, log2(10 * LM_NM_M * 256), 16);
    IS_NEAREST(LM_FEET_PER_M_Q12, 1 / 0.3048, 12);
    IS_NEAREST(LM_LOG2_MM2_Q16, -6 * log2(10), 16);
    assert_int_equal(LM_FOOT_UM, 0.3048 * 1e6);
}
