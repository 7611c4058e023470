/* Constants of mathematics: each is its formula in double precision, rounded. */
#include "check.h"
#include "fx/const.h"

#include <math.h>

static void is_nearest(const char *name, int64_t have, double value, int q)
{
    const int64_t want = llround(ldexp(value, q));
    if (have != want) {
        fail_msg("%s is %lld and should be %lld", name, (long long)have, (long long)want);
    }
}

#define IS_NEAREST(name, value, q) is_nearest(#name, name, value, q)

TEST(angles_are_their_formulas_rounded)
{
    IS_NEAREST(FX_BAM_PER_RADIAN, 0.5 / M_PI, 32);
    IS_NEAREST(FX_BAM_PER_RADIAN_Q2, 0.5 / M_PI, 34);
    IS_NEAREST(FX_TWO_PI_Q20, 2 * M_PI, 20);
    IS_NEAREST(FX_TWO_PI_Q26, 2 * M_PI, 26);
    IS_NEAREST(FX_TWO_PI_Q28, 2 * M_PI, 28);
}

TEST(logarithms_are_their_formulas_rounded)
{
    IS_NEAREST(FX_LOG2_PI_Q16, log2(M_PI), 16);
    IS_NEAREST(FX_LOG2_TWO_PI_Q16, log2(2 * M_PI), 16);
    IS_NEAREST(FX_LOG2_FOUR_PI_Q16, log2(4 * M_PI), 16);
    IS_NEAREST(FX_LOG2_E_Q16, log2(M_E), 16);
    IS_NEAREST(FX_LN2_Q32, log(2), 32);
    IS_NEAREST(FX_DB_PER_OCTAVE_Q13, 10 * log10(2), 13);
    IS_NEAREST(FX_DB_PER_OCTAVE_Q14, 10 * log10(2), 14);
    IS_NEAREST(FX_DB_PER_OCTAVE_Q24, 10 * log10(2), 24);
    IS_NEAREST(FX_OCTAVES_PER_DB_Q15, log2(10) / 10, 15);
    IS_NEAREST(FX_OCTAVES_PER_DB_Q16, log2(10) / 10, 16);
}

TEST(roots_are_their_formulas_rounded)
{
    IS_NEAREST(FX_ROOT_1_2_Q30, sqrt(1 / 2.0), 30);
    IS_NEAREST(FX_ROOT_1_3_Q30, sqrt(1 / 3.0), 30);
    IS_NEAREST(FX_ROOT_2_3_Q30, sqrt(2 / 3.0), 30);
    IS_NEAREST(FX_ROOT_1_6_Q30, sqrt(1 / 6.0), 30);
}
