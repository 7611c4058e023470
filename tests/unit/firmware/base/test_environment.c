/* The ranges of an environment: lm/environment.h, field by field. */
#include "check.h"
#include "lm/environment.h"
#include "lm/status.h"

/* As much as there may be. Read as one more circle of rain, which they stand behind, the jammers
 * are within its ranges: then nothing but its number is wrong. */
static struct lm_environment full(void)
{
    struct lm_environment e = {
        .rain_count = LM_RAINS_MAX, .jammer_count = LM_JAMMERS_MAX, .sea_state = LM_SEA_STATE_MAX};
    for (int i = 0; i < LM_RAINS_MAX; i++) {
        e.rain[i] = (struct lm_rain){.radius_m = 100000, .mm_per_h = 150};
    }
    for (int i = 0; i < LM_JAMMERS_MAX; i++) {
        e.jammer[i] =
            (struct lm_jammer){.position = {.latitude = 1}, .noise_ratio_db_q8 = 80 * 256};
    }
    return e;
}

TEST(an_environment_with_all_that_it_may_have_is_accepted)
{
    const struct lm_environment e = full();
    assert_int_equal(lm_environment_check(&e), LM_OK);
}

TEST(one_more_of_anything_is_refused_however_little_there_is_of_the_rest)
{
    const struct lm_environment most[] = {{.rain_count = LM_RAINS_MAX + 1},
                                          {.jammer_count = LM_JAMMERS_MAX + 1},
                                          {.sea_state = LM_SEA_STATE_MAX + 1}};
    for (size_t i = 0; i < sizeof most / sizeof most[0]; i++) {
        /* Circles and jammers within their ranges, so that the count alone is wrong. */
        struct lm_environment e = full();
        e.rain_count = most[i].rain_count;
        e.jammer_count = most[i].jammer_count;
        e.sea_state = most[i].sea_state;
        assert_int_equal(lm_environment_check(&e), LM_ERR_RANGE);
    }
}

TEST(rain_and_jammers_may_stand_on_a_pole_and_not_beyond)
{
    static const struct {
        uint32_t latitude;
        int status;
    } cases[] = {{0x40000000, LM_OK},
                 {0xC0000000, LM_OK},
                 {0x40000001, LM_ERR_RANGE},
                 {0xBFFFFFFF, LM_ERR_RANGE}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct lm_environment e = full();
        e.rain[0].centre.latitude = cases[i].latitude;
        assert_int_equal(lm_environment_check(&e), cases[i].status);
        e = full();
        e.jammer[0].position.latitude = cases[i].latitude;
        assert_int_equal(lm_environment_check(&e), cases[i].status);
    }
}
