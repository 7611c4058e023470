/* From level to grey: the equations of docs/EQUATIONS.md, "Tone", in double precision.
 */
#include "check.h"
#include "fx/sat.h"
#include "hs/rng.h"
#include "lm/radar.h"
#include "lm/status.h"
#include "lm/tone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct lm_tone_config configs[] = {
    {-42 * 256, 6 * 256, 384},   {-40 * 256, 8 * 256, 256},       {-60 * 256, -59 * 256, 256},
    {-100 * 256, 60 * 256, 300}, {-20 * 256 + 7, 11 * 256, 1024}, {-128 * 256, 127 * 256, 768},
    {-100 * 256, 60 * 256, 128}, {-70 * 256, 40 * 256, 26},
};
enum { CONFIGS = sizeof configs / sizeof configs[0] };

static uint8_t grey_of(const struct lm_tone *tone, int32_t level_q8)
{
    uint8_t grey = 0;
    const int16_t level = fx_sat_i16(level_q8);
    lm_tone_run(tone, &level, &grey, 1);
    return grey;
}

static double exact_grey(const struct lm_tone_config *c, double level_q8)
{
    const double v = (level_q8 - c->black_db_q8) / (c->white_db_q8 - c->black_db_q8);
    return 255 * pow(fmin(fmax(v, 0), 1), c->gamma_q8 / 256.0);
}

/* Errors of the levels within a window. */
struct errors {
    double worst;
    int levels, beyond_0_6, beyond_1_grey;
};

static struct errors errors_of(const struct lm_tone_config *c)
{
    struct lm_tone tone;
    struct errors e = {0};
    assert_int_equal(lm_tone_set(&tone, c), LM_OK);
    for (int32_t level_q8 = c->black_db_q8; level_q8 <= c->white_db_q8; level_q8++) {
        const double exact = exact_grey(c, level_q8);
        const int grey = grey_of(&tone, level_q8);
        e.worst = fmax(e.worst, fabs(grey - exact));
        e.levels++;
        e.beyond_0_6 += fabs(grey - exact) > 0.6;
        e.beyond_1_grey += labs(grey - lround(exact)) > 1;
    }
    return e;
}

TEST(tables_of_the_radar_are_within_0_7_of_the_equation_and_mostly_within_0_6)
{
    const struct lm_radar *radar = &lm_radar_default;
    const struct lm_tone_config *of_table[] = {&radar->sar.tone, &radar->mode[LM_SECTOR_GM].tone,
                                               &radar->mode[LM_SECTOR_GMT].tone,
                                               &radar->mode[LM_SECTOR_SEA].tone};
    for (int n = 0; n < 4; n++) {
        const struct errors e = errors_of(of_table[n]);
        print_message("# gamma %.2f: worst %.3f, %.2f %% of %d levels beyond 0.6\n",
                      of_table[n]->gamma_q8 / 256.0, e.worst, 100.0 * e.beyond_0_6 / e.levels,
                      e.levels);
        assert_true(e.worst < 0.7);
        assert_true(e.beyond_0_6 * 200 < e.levels);
        assert_int_equal(e.beyond_1_grey, 0);
    }
}

/* Windows of any width: the steps of those just too wide for twice as many are the largest. */
TEST(from_gamma_1_on_every_level_is_within_a_grey)
{
    struct hs_rng rng;
    double worst = 0;
    hs_rng_seed(&rng, 1);
    for (int n = 0; n < 400; n++) {
        const int32_t half = 65504 / 2 >> hs_rng_below(&rng, 7);
        const int32_t more = (int32_t)hs_rng_below(&rng, n % 2 ? (uint32_t)half : 20);
        const int32_t span_q8 = half + 1 + more < 255 * 256 ? half + 1 + more : 255 * 256;
        const int32_t black_q8 = (int32_t)hs_rng_below(&rng, (uint32_t)(65536 - span_q8)) - 0x8000;
        const struct lm_tone_config config = {
            (int16_t)black_q8, (int16_t)(black_q8 + span_q8),
            (uint16_t)(256 + (n % 3 == 0 ? 512 : hs_rng_below(&rng, 769)))};
        const struct errors e = errors_of(&config);
        worst = fmax(worst, e.worst);
        assert_int_equal(e.beyond_1_grey, 0);
    }
    print_message("# worst %.3f\n", worst);
    assert_true(worst < 1.3);
}

TEST(below_gamma_1_a_level_gets_the_grey_of_the_nearest_step)
{
    for (int n = CONFIGS - 2; n < CONFIGS; n++) {
        const struct lm_tone_config *c = &configs[n];
        struct lm_tone tone;
        assert_int_equal(lm_tone_set(&tone, c), LM_OK);
        const double step_q8 = 1 << tone.step_log2;
        for (int32_t level = c->black_db_q8; level < c->white_db_q8 - step_q8; level++) {
            const double step = floor((level - c->black_db_q8) / step_q8 + 0.5);
            const double exact = exact_grey(c, c->black_db_q8 + step * step_q8);
            assert_true(fabs(grey_of(&tone, level) - exact) <= 0.501);
        }
    }
}

/* As a machine with vectors reads them: the low byte of a step is its place in a piece and what of
 * it lies before the piece. */
TEST(straight_pieces_have_the_greys_of_the_table_where_a_curve_has_them)
{
    int with_pieces = 0;
    for (int n = 0; n < CONFIGS; n++) {
        const struct lm_tone_config *c = &configs[n];
        struct lm_tone tone;
        assert_int_equal(lm_tone_set(&tone, c), LM_OK);
        const int32_t span_db_q8 = c->white_db_q8 - c->black_db_q8;
        const bool is_gentle =
            span_db_q8 >= 4 * 256 && c->gamma_q8 >= 256 && c->gamma_q8 <= 3 * 256;
        assert_int_equal(tone.has_pieces, is_gentle);
        const uint32_t white = (uint32_t)span_db_q8 >> tone.step_log2;
        for (uint32_t step = 0; tone.has_pieces && step < white; step++) {
            const uint32_t piece = step / LM_TONE_PIECE_STEPS;
            const uint32_t base = tone.pieces[0][piece] | (uint32_t)tone.pieces[1][piece] << 8;
            const uint32_t grey_q8 = (base + (step & 255) * tone.pieces[2][piece]) & 0xffff;
            assert_int_equal(grey_q8 >> 8, tone.grey[step]);
        }
        with_pieces += tone.has_pieces;
    }
    assert_in_range(with_pieces, 3, CONFIGS - 1);
}

TEST(black_and_below_is_black_white_and_above_is_white)
{
    for (int n = 0; n < CONFIGS; n++) {
        const struct lm_tone_config *c = &configs[n];
        struct lm_tone tone;
        assert_int_equal(lm_tone_set(&tone, c), LM_OK);
        assert_int_equal(grey_of(&tone, c->black_db_q8), 0);
        assert_int_equal(grey_of(&tone, c->black_db_q8 - 1), 0);
        assert_int_equal(grey_of(&tone, -1000 * 256), 0);
        assert_int_equal(grey_of(&tone, c->white_db_q8), 255);
        assert_int_equal(grey_of(&tone, c->white_db_q8 + 1), 255);
        assert_int_equal(grey_of(&tone, 1000 * 256), 255);
        assert_true(grey_of(&tone, (c->black_db_q8 + c->white_db_q8) / 2) < 255);
    }
}

TEST(a_higher_level_is_never_darker)
{
    for (int n = 0; n < CONFIGS; n++) {
        struct lm_tone tone;
        assert_int_equal(lm_tone_set(&tone, &configs[n]), LM_OK);
        for (int32_t level = -0x8000; level < 0x8000; level++) {
            assert_true(grey_of(&tone, level + 1) >= grey_of(&tone, level));
        }
    }
}

TEST(a_window_that_makes_no_sense_is_refused_and_changes_nothing)
{
    static const struct lm_tone_config refused[] = {
        {0, 255, 256}, {-0x8000, 0x7f01, 256}, {0, 0, 256}, {256, 0, 256},
        {0, 2560, 25}, {0, 2560, 1025},        {0, 2560, 0}};
    struct lm_tone tone, before;
    assert_int_equal(lm_tone_set(&tone, &configs[0]), LM_OK);
    before = tone;
    for (size_t n = 0; n < sizeof refused / sizeof refused[0]; n++) {
        assert_int_equal(lm_tone_set(&tone, &refused[n]), LM_ERR_RANGE);
        assert_memory_equal(&tone, &before, sizeof tone);
    }
    assert_int_equal(lm_tone_set(&tone, &(struct lm_tone_config){0, 256, 26}), LM_OK);
    assert_int_equal(lm_tone_set(&tone, &(struct lm_tone_config){0, 256, 1024}), LM_OK);
    assert_int_equal(lm_tone_set(&tone, &(struct lm_tone_config){-0x8000, 0x7f00, 256}), LM_OK);
}

TEST(as_many_greys_are_written_as_were_asked_for)
{
    struct lm_tone tone;
    assert_int_equal(lm_tone_set(&tone, &configs[0]), LM_OK);
    int16_t level[70];
    for (int i = 0; i < 70; i++) {
        level[i] = (int16_t)((i - 45) * 256);
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
