/* From level to grey: the equations of docs/DESIGN.md, "Speckle, noise, tone", in double precision.
 */
#include "lm/radar.h"
#include "lm/status.h"
#include "lm/tone.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const struct lm_tone_config configs[] = {
    {-40 * 256, 6 * 256, 384},   {-40 * 256, 8 * 256, 256},       {-60 * 256, -59 * 256, 256},
    {-100 * 256, 60 * 256, 128}, {-20 * 256 + 7, 11 * 256, 1024}, {-70 * 256, 40 * 256, 26},
};
enum { CONFIGS = sizeof configs / sizeof configs[0] };

static uint8_t grey_of(const struct lm_tone *tone, int32_t level_q8)
{
    uint8_t grey = 0;
    lm_tone_run(tone, &level_q8, &grey, 1);
    return grey;
}

static double exact_grey(const struct lm_tone_config *c, int32_t level_q8)
{
    const double step = fmin(fmax(floor(16 * (level_q8 / 256.0 + 80)), 0), 2047);
    const double middle = (step + 0.5) / 16 - 80;
    const double v = (middle * 256 - c->black_q8) / (c->white_q8 - c->black_q8);
    return 255 * pow(fmin(fmax(v, 0), 1), c->gamma_q8 / 256.0);
}

static void every_level_gets_the_grey_of_the_equations(void **state)
{
    (void)state;
    for (int n = 0; n < CONFIGS; n++) {
        struct lm_tone tone;
        assert_int_equal(lm_tone_set(&tone, &configs[n]), LM_OK);
        for (int32_t level = -0x8000; level < 0x8000; level++) {
            assert_true(fabs(grey_of(&tone, level) - exact_grey(&configs[n], level)) <= 0.501);
        }
    }
}

static void black_and_below_is_black_white_and_above_is_white(void **state)
{
    (void)state;
    const struct lm_tone_config *c = &configs[0];
    struct lm_tone tone;
    assert_int_equal(lm_tone_set(&tone, c), LM_OK);
    assert_int_equal(grey_of(&tone, c->black_q8), 0);
    assert_int_equal(grey_of(&tone, c->black_q8 - 1), 0);
    assert_int_equal(grey_of(&tone, -1000 * 256), 0);
    assert_int_equal(grey_of(&tone, c->white_q8), 255);
    assert_int_equal(grey_of(&tone, c->white_q8 + 1), 255);
    assert_int_equal(grey_of(&tone, 1000 * 256), 255);
    assert_true(grey_of(&tone, c->white_q8 - 64) < 255);
}

static void a_higher_level_is_never_darker(void **state)
{
    (void)state;
    for (int n = 0; n < CONFIGS; n++) {
        struct lm_tone tone;
        assert_int_equal(lm_tone_set(&tone, &configs[n]), LM_OK);
        for (int32_t level = -0x8000; level < 0x8000; level++) {
            assert_true(grey_of(&tone, level + 1) >= grey_of(&tone, level));
        }
    }
}

static void a_window_that_makes_no_sense_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    static const struct lm_tone_config refused[] = {{0, 255, 256}, {0, 0, 256},     {256, 0, 256},
                                                    {0, 2560, 25}, {0, 2560, 1025}, {0, 2560, 0}};
    struct lm_tone tone, before;
    assert_int_equal(lm_tone_set(&tone, &configs[0]), LM_OK);
    before = tone;
    for (size_t n = 0; n < sizeof refused / sizeof refused[0]; n++) {
        assert_int_equal(lm_tone_set(&tone, &refused[n]), LM_ERR_RANGE);
        assert_memory_equal(&tone, &before, sizeof tone);
    }
    assert_int_equal(lm_tone_set(&tone, &(struct lm_tone_config){0, 256, 26}), LM_OK);
    assert_int_equal(lm_tone_set(&tone, &(struct lm_tone_config){0, 256, 1024}), LM_OK);
}

static void as_many_greys_are_written_as_were_asked_for(void **state)
{
    (void)state;
    struct lm_tone tone;
    assert_int_equal(lm_tone_set(&tone, &configs[0]), LM_OK);
    int32_t level[70];
    for (int i = 0; i < 70; i++) {
        level[i] = (i - 45) * 256;
    }
    for (uint32_t cells = 0; cells <= 70; cells++) {
        uint8_t grey[72];
        memset(grey, 7, sizeof grey);
        lm_tone_run(&tone, level, grey, cells);
        for (uint32_t i = 0; i < 72; i++) {
            assert_int_equal(grey[i], i < cells ? grey_of(&tone, level[i]) : 7);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_gets_the_grey_of_the_equations),
        cmocka_unit_test(black_and_below_is_black_white_and_above_is_white),
        cmocka_unit_test(a_higher_level_is_never_darker),
        cmocka_unit_test(a_window_that_makes_no_sense_is_refused_and_changes_nothing),
        cmocka_unit_test(as_many_greys_are_written_as_were_asked_for),
    };
    return cmocka_run_group_tests_name("tone", tests, NULL, NULL);
}
