/* The gain of classes in the reference. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

TEST(only_water_gains_by_the_state_of_the_sea)
{
    const struct ref_params params = {.sea_db = ref_sea_db(5)};
    struct ref_bin bins[LM_KINDS] = {{0}};
    for (int kind = 0; kind < LM_KINDS; kind++) {
        bins[kind].kind = kind;
    }
    ref_class_gain(bins, LM_KINDS, &params, 0);
    for (int kind = 0; kind < LM_KINDS; kind++) {
        /* -40 dB to -30 dB */
        assert_true(bins[kind].class_gain_db == (kind == LM_KIND_WATER ? 10 : 0));
    }
}

TEST(a_class_gain_is_the_grounds_and_not_the_noises)
{
    static const double no_speckle[REF_GRAIN_VALUES];
    struct ref_bin bins[2] = {{.is_lit = true, .level_db = -20, .class_gain_db = 7},
                              {.is_lit = false, .level_db = -20, .class_gain_db = 7}};
    ref_speckle(bins, 2, no_speckle, -30);
    assert_true(fabs(bins[0].echo_db - 10 * log10(pow(10, -1.3) + 1e-3)) < 1e-9);
    assert_true(fabs(bins[1].echo_db + 30) < 1e-9);
}
