/* Defocus and layover of a patch against the reference in double precision: docs/EQUATIONS.md,
 * "Unsteady flight" and "Layover". */
#include "check.h"
#include "hs/rng.h"
#include "lm/defocus.h"
#include "lm/layover.h"
#include "reference/reference.h"
#include "tiny_image.h"

#include <math.h>

enum { LINES = 2 * LM_DEFOCUS_REACH + 1, CELLS = 64 };

TEST(the_smear_is_as_wide_as_the_quadratic_phase_makes_it)
{
    double worst = 0;
    for (uint32_t lateral = 0; lateral < 60000; lateral = lateral * 3 / 2 + 1) {
        for (uint32_t dwell_us = 20000; dwell_us < 70000000; dwell_us = dwell_us * 5 / 3) {
            const uint32_t width_q8 = lm_defocus_lines_q8(lateral, 10, 31228, dwell_us);
            const double width = ref_mocomp_cells(31228e-6, lateral * 1e-5, dwell_us * 1e-6);
            worst = fmax(worst, fabs(width_q8 / 256.0 - fmin(width, LINES)) / fmin(width, LINES));
        }
    }
    print_message("# width of the smear: within %.2f %%\n", 100 * worst);
    assert_true(worst < 0.02);
    assert_int_equal(lm_defocus_lines_q8(UINT32_MAX >> 8, 1000, 1000, UINT64_MAX), 256 * LINES);
    assert_int_equal(lm_defocus_lines_q8(50000, 0, 31228, 60000000), 256);
}

TEST(shares_are_those_of_a_box_and_make_one)
{
    for (uint32_t width_q8 = 256; width_q8 <= 256 * LINES; width_q8 += 7) {
        uint32_t share_q16[LINES], sum = 0;
        lm_defocus_shares(width_q8, share_q16);
        for (int m = 0; m < LINES; m++) {
            const double share = ref_pulse_share(width_q8 / 256.0, m - LM_DEFOCUS_REACH);
            assert_true(fabs(share_q16[m] / 65536.0 - share) < 2e-4);
            sum += share_q16[m];
        }
        assert_int_equal(sum, 65536);
    }
}

TEST(lines_are_meant_in_power_down_to_what_is_black)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 21);
    static int16_t levels[LINES][CELLS], level[CELLS];
    static uint64_t scratch[CELLS];
    static double powers[LINES][CELLS], mean[CELLS];
    const int16_t *line_q8[LINES];
    const double *line[LINES];
    double worst_db = 0;
    for (uint32_t width_q8 = 256; width_q8 <= 256 * LINES; width_q8 += 131) {
        for (int m = 0; m < LINES; m++) {
            for (int i = 0; i < CELLS; i++) {
                levels[m][i] = (int16_t)((int32_t)hs_rng_below(&rng, 130 * 256) - 60 * 256);
                powers[m][i] = pow(10, levels[m][i] / 2560.0);
            }
            line_q8[m] = levels[m];
            line[m] = powers[m];
        }
        uint32_t share_q16[LINES];
        lm_defocus_shares(width_q8, share_q16);
        lm_defocus_run(line_q8, share_q16, level, scratch, CELLS);
        ref_mocomp(line, LINES, LM_DEFOCUS_REACH, width_q8 / 256.0, mean, CELLS);
        for (int i = 0; i < CELLS; i++) {
            worst_db = fmax(worst_db, fabs(level[i] / 256.0 - 10 * log10(mean[i])));
        }
    }
    print_message("# defocused levels: worst error %.3f dB\n", worst_db);
    assert_true(worst_db < 0.1);
}

/* Flat ground with posts of many heights, and hills. */
TEST(tops_appear_where_the_reference_puts_them)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 22);
    static struct lm_scan_line ground;
    static int16_t level[LM_CELLS_ROOM];
    static int16_t laid_q8[LM_LAYOVER_ROOM];
    double power[CELLS], nearer[CELLS], laid[CELLS];
    for (int n = 0; n < 200; n++) {
        const double lean = 0.05 + hs_rng_uniform(&rng), cell_m = 1 + 9 * hs_rng_uniform(&rng);
        const struct lm_layover_view l = {.reference_m_q10 = 100 * 1024,
                                          .lean_q16 = (uint32_t)lround(lean * 65536),
                                          .cell_m_q8 = (uint32_t)lround(cell_m * 256),
                                          .cells = CELLS};
        for (uint32_t i = 0; i < CELLS; i++) {
            const double hill_m = 100 + 20 * sin(i / 9.0 + n);
            const uint32_t height_code = hs_rng_below(&rng, 6) ? 0 : hs_rng_below(&rng, 16);
            ground.cell[i] = 120u << 8 | TINY_STRUCTURE << 4 | height_code;
            ground.elevation_m_q14[i] = (int32_t)lround(hill_m * 16384);
            level[i] = (int16_t)((int32_t)hs_rng_below(&rng, 60 * 256) - 40 * 256);
            power[i] = pow(10, level[i] / 2560.0);
            const double height_m = tiny_classes()->height_dm[height_code] / 10.0,
                         cells_m = l.lean_q16 / 65536.0 / (l.cell_m_q8 / 256.0);
            nearer[i] =
                (round(16 * (hill_m - 100) * cells_m) + round(16 * height_m * cells_m)) / 16;
        }
        struct lm_layover layover;
        lm_layover_set(&layover, tiny_classes(), &l);
        const int16_t *shown_q8 = lm_layover_run(&layover, &ground, level, laid_q8);
        ref_layover(power, nearer, CELLS, laid);
        for (uint32_t i = 0; i < CELLS; i++) {
            /* What is half-way between two sixteenths of a cell may be rounded to either. */
            const double beside =
                0.08 * (i > 0 ? laid[i - 1] : 0) + 0.08 * (i + 1 < CELLS ? laid[i + 1] : 0) + 1e-6;
            const double shown = pow(10, shown_q8[i] / 2560.0);
            assert_true(shown < 1.05 * laid[i] + beside && shown > 0.95 * laid[i] - beside);
        }
    }
}
