/* The sea by grazing angle and wind, against the reference and by hand: docs/EQUATIONS.md, "Sea".
 */
#include "check.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/sea.h"
#include "reference_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 200 };

struct world {
    struct lm_radar radar;
    struct lm_range_grid grid;
    struct lm_sea sea;
    struct ref_params params;
};

static const struct lm_tone_config tone = {0, 256, 256};
static const struct lm_speckle_config speckle = {0};

/* Cells of `cell_m` from `near_m` on, `height_m` below the antenna; a wind of NAN is none. */
static void set_world(struct world *w, int state, double wind_deg, double height_m, double near_m,
                      double cell_m)
{
    const uint32_t first_q8 = (uint32_t)lround((near_m + cell_m / 2) * 256);
    const fx_bam_t wind_from = hs_bam(isnan(wind_deg) ? 0 : wind_deg);
    lm_range_grid_set(&w->grid, &w->radar.illumination, first_q8, (uint32_t)lround(cell_m * 256),
                      CELLS, (int32_t)lround(height_m * 1024), 0);
    lm_sea_set(&w->sea, &w->radar, tiny_classes(), (uint8_t)state,
               isnan(wind_deg) ? NULL : &wind_from);
    lm_sea_set_cells(&w->sea, &w->grid, first_q8);
    w->params = params_of(&w->radar, -100, &tone, &speckle);
    w->params.sea.critical = ref_sea_critical(state, w->radar.wavelength_um * 1e-6);
    w->params.sea.has_wind = !isnan(wind_deg);
    w->params.sea.wind_from_deg = wind_deg;
}

/* What a line of one class gains along a look. */
static void run(struct world *w, uint32_t class_index, double look_deg, int16_t *level_q8)
{
    uint32_t cell[LM_CELLS_ROOM];
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        cell[i] = 200u << 8 | class_index << 4 | 5;
        level_q8[i] = 0;
    }
    lm_sea_look(&w->sea, hs_bam(look_deg));
    lm_sea_run(&w->sea, cell, level_q8);
}

/* Worst difference from the reference over the line's cells. */
static double worst_db(struct world *w, double look_deg)
{
    int16_t level_q8[LM_CELLS_ROOM];
    struct ref_bin bins[CELLS] = {{0}};
    const struct ref_view view = {w->grid.height_m_q10 / 1024.0, 0, w->grid.cell_m_q8 / 256.0};
    double worst = 0;
    for (uint32_t i = 0; i < CELLS; i++) {
        bins[i].kind = LM_KIND_WATER;
        bins[i].range_m = ldexp(1, 17 + (int)w->grid.tangent_bits) /
                          (w->grid.inverse_range[i] ? w->grid.inverse_range[i] : 1);
    }
    ref_sea(bins, CELLS, &view, &w->params, look_deg);
    run(w, TINY_WATER, look_deg, level_q8);
    for (uint32_t i = w->grid.first; i < CELLS; i++) {
        worst = fmax(worst, fabs(level_q8[i] / 256.0 - bins[i].class_gain_db));
    }
    return worst;
}

TEST(water_gains_what_the_reference_says_in_every_state_and_at_every_look)
{
    struct world *w = calloc(1, sizeof *w);
    struct hs_rng rng;
    double worst = 0;
    hs_rng_seed(&rng, 41);
    w->radar = lm_radar_default;
    for (int n = 0; n < 600; n++) {
        w->radar.wavelength_um = n % 5 ? 31228 : 1000 + hs_rng_below(&rng, 500000);
        w->radar.sea.upwind_db_q8 = (int16_t)(hs_rng_below(&rng, 5121) - 2560);
        w->radar.sea.crosswind_db_q8 = (int16_t)(hs_rng_below(&rng, 5121) - 2560);
        w->radar.sea.downwind_db_q8 = (int16_t)(hs_rng_below(&rng, 5121) - 2560);
        set_world(w, n % 9, n % 2 ? NAN : 360 * hs_rng_uniform(&rng),
                  100 + 12000 * hs_rng_uniform(&rng), n % 3 ? 0 : 50000 * hs_rng_uniform(&rng),
                  5 + 400 * hs_rng_uniform(&rng));
        worst = fmax(worst, worst_db(w, 720 * hs_rng_uniform(&rng) - 360));
    }
    print_message("# worst error %.3f dB\n", worst);
    assert_true(worst < 0.06);
    free(w);
}

TEST(land_gains_nothing)
{
    struct world *w = calloc(1, sizeof *w);
    int16_t level_q8[LM_CELLS_ROOM];
    w->radar = lm_radar_default;
    set_world(w, 1, 30, 500, 0, 150);
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const bool is_water = tiny_classes()->entry[i].kind == LM_KIND_WATER;
        run(w, i, 30, level_q8);
        for (uint32_t k = 0; k < CELLS; k++) {
            assert_true(is_water || level_q8[k] == 0);
        }
        assert_true(!is_water || (level_q8[0] > 0 && level_q8[CELLS - 1] < -10 * 256));
    }
    free(w);
}

/* The table: 5 dB between looks against the wind and across it, 3 between those against and with
 * it. The mean power over all looks is that of the state. */
TEST(the_sea_is_brightest_against_the_wind_and_darkest_across_it)
{
    struct world *w = calloc(1, sizeof *w);
    int16_t level_q8[LM_CELLS_ROOM];
    double sum = 0;
    w->radar = lm_radar_default;
    set_world(w, 5, 40, 3000, 0, 70);
    double of_look_db[360];
    for (int deg = 0; deg < 360; deg++) {
        run(w, TINY_WATER, deg + 40, level_q8);
        of_look_db[deg] = level_q8[0] / 256.0;
        sum += pow(10, of_look_db[deg] / 10) / 360;
    }
    assert_true(fabs(of_look_db[0] - of_look_db[90] - 5) < 0.05);
    assert_true(fabs(of_look_db[0] - of_look_db[270] - 5) < 0.05);
    assert_true(fabs(of_look_db[0] - of_look_db[180] - 3) < 0.05);
    assert_true(fabs(10 * log10(sum)) < 0.05);
    free(w);
}

/* Half the power at the critical angle, and nearly 12 dB for each halving below it. By hand: state
 * 3 at 31.2 mm has waves of 0.53 m and a critical angle of 0.84 degrees. */
TEST(below_the_critical_angle_the_return_falls_with_its_fourth_power)
{
    const double critical = ref_sea_critical(3, 0.031228);
    print_message("# critical angle of state 3: %.3f degrees\n", critical * 180 / acos(-1));
    assert_true(fabs(critical * 180 / acos(-1) - 0.835) < 0.01);
    assert_true(fabs(ref_sea_grazing_db(1) + 3.01) < 0.01);
    assert_true(fabs(ref_sea_grazing_db(0.54) - ref_sea_grazing_db(0.27) - 12.04) < 0.4);
    for (int sea = 1; sea <= 8; sea++) { /* the calmer, the steeper */
        assert_true(ref_sea_critical(sea, 0.031228) < ref_sea_critical(sea - 1, 0.031228));
    }
}

TEST(a_sea_without_wind_and_above_the_critical_angle_costs_nothing)
{
    struct world *w = calloc(1, sizeof *w);
    w->radar = lm_radar_default;
    set_world(w, 5, NAN, 3000, 0, 72);
    assert_int_equal(w->sea.first, CELLS);
    free(w);
}

TEST(hostile_states_and_classes_stay_in_their_bounds)
{
    struct world *w = calloc(1, sizeof *w);
    struct lm_classes classes;
    int16_t level_q8[LM_CELLS_ROOM];
    memset(&classes, 0xff, sizeof classes);
    w->radar = lm_radar_default;
    for (int sea = 0; sea < 256; sea += 5) {
        set_world(w, 0, 10, 29000, 0, 1000);
        lm_sea_set(&w->sea, &w->radar, &classes, (uint8_t)sea, NULL);
        lm_sea_set_cells(&w->sea, &w->grid, 128000);
        run(w, 3, 0, level_q8);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_in_range(-level_q8[i], 0, LM_SEA_FALL_MAX_DB_Q8);
        }
    }
    free(w);
}
