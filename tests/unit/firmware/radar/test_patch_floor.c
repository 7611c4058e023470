/* The floor of a patch: the running mean of its ground, and a shadow as it shows beside grass.
 * docs/EQUATIONS.md, "Noise" of the synthetic aperture. */
#include "check.h"
#include "hs/rng.h"
#include "lm/patch_floor.h"
#include "lm/sar.h"
#include "reference_support.h"
#include "tiny_map.h"

#include <math.h>

enum { CELLS = 256, POOL_TILES = 400 };

static double run(struct lm_patch_floor *f, uint32_t number, const int16_t *level_q8,
                  uint32_t cells)
{
    return decibels(lm_patch_floor_run(f, &lm_radar_default.sar, number, level_q8, cells));
}

TEST(even_ground_leaves_its_level_less_the_leak)
{
    const double leak_db = decibels(lm_radar_default.sar.ground_leak_db_q8);
    const double most_db = decibels(lm_radar_default.sar.ground_leak_most_db_q8);
    for (int db = -40; db <= 20; db += 5) {
        struct lm_patch_floor f;
        int16_t level_q8[LM_CELLS_ROOM];
        lm_patch_floor_clear(&f);
        for (int i = 0; i < LM_CELLS_ROOM; i++) {
            level_q8[i] = (int16_t)(db * 256);
        }
        for (uint32_t line = 0; line < 50; line++) {
            const double wanted_db = fmin(db, most_db) + leak_db;
            assert_true(fabs(run(&f, line, level_q8, CELLS) - wanted_db) < 0.1);
        }
    }
}

TEST(a_patch_without_ground_leaves_nothing)
{
    struct lm_patch_floor f;
    int16_t level_q8[LM_CELLS_ROOM];
    lm_patch_floor_clear(&f);
    for (int i = 0; i < LM_CELLS_ROOM; i++) {
        level_q8[i] = LM_LEVEL_SHADOW;
    }
    for (uint32_t line = 0; line < 300; line++) {
        assert_true(run(&f, line, level_q8, LM_CELLS_MAX) < -85);
    }
}

TEST(the_mean_of_any_lines_is_that_of_the_reference)
{
    struct ref_params params = ref_params_default();
    struct hs_rng rng;
    hs_rng_seed(&rng, 12);
    params.leak_db = decibels(lm_radar_default.sar.ground_leak_db_q8);
    params.leak_most_db = decibels(lm_radar_default.sar.ground_leak_most_db_q8);
    for (uint32_t cells = 32; cells < LM_CELLS_MAX; cells += 37) {
        struct lm_patch_floor f;
        struct ref_leak leak = {0};
        lm_patch_floor_clear(&f);
        for (uint32_t line = 0; line < 90; line++) {
            static struct ref_bin bins[LM_CELLS_ROOM];
            int16_t level_q8[LM_CELLS_ROOM];
            const int32_t about_q8 = -(int32_t)hs_rng_below(&rng, 50 * 256);
            for (uint32_t i = 0; i < cells; i++) {
                level_q8[i] = (int16_t)(about_q8 + (int32_t)hs_rng_below(&rng, 30 * 256));
                bins[i].ground = pow(10, level_q8[i] / 2560.0);
            }
            const double wanted_db = 10 * log10(ref_leak(&leak, &params, line, bins, cells));
            assert_true(fabs(run(&f, line, level_q8, cells) - wanted_db) < 0.05);
        }
    }
}

/* Grass of -15 dB, and walls 60 m high that run across the look and stand far apart. */
static struct tiny_cell grass_and_walls(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return fabs(p->north_m + 300) < 12 ? (struct tiny_cell){-15, TINY_STRUCTURE, 13}
                                       : (struct tiny_cell){-15, TINY_SOIL, 0};
}

struct field {
    double sum, squares, power, n;
};

static void note(struct field *f, double grey, double level_db)
{
    f->sum += grey;
    f->squares += grey * grey;
    f->power += pow(10, level_db / 10);
    f->n++;
}

static double deviation(const struct field *f)
{
    return sqrt(f->squares / f->n - f->sum / f->n * f->sum / f->n);
}

/* Real patches of X band: the darkest 7 x 7 cells are 14 to 17 dB below the clutter around. The
 * wall throws a shadow of 60 m / tan psi = 400 m; psi is that of 3 km at 20 km. */
TEST(a_shadow_is_some_16_dB_below_the_grass_and_has_grain)
{
    static struct lm_sar sar;
    static struct lm_line line;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_map map;
    struct lm_tone tone;
    struct field shadow = {0}, grass = {0};
    spec.cell = grass_and_walls;
    spec.rows = spec.columns = 9;
    tiny_map_open(&map, &spec, POOL_TILES);
    const struct lm_sar_command command = {
        .centre = {map.db.centre_latitude, map.db.centre_longitude},
        .cell_mm = 5000,
        .range_m = 20000,
        .height_m_q6 = 3000 * 64};
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_tone_set(&tone, &lm_radar_default.sar.tone), LM_OK);
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map.db, &command, &setup), LM_OK);
    const struct lm_target_set none = {0};
    sar.targets = &none;
    for (uint32_t k = 0; k < CELLS; k++) {
        lm_sar_prefetch(&sar, &map.tiles, k);
        tiny_map_read_tiles(&map);
        const int16_t *level_q8 = lm_sar_draw_line(&sar, &map.tiles, &tone, &line);
        for (uint32_t i = 0; k >= 16 && i < CELLS; i++) {
            const double north_m = (i + 0.5 - CELLS / 2.0) * 5;
            const double db = decibels(level_q8[i]);
            if (north_m > -250 && north_m < 50) {
                note(&shadow, line.grey[i], db);
            } else if (north_m > 250 || north_m < -350) {
                note(&grass, line.grey[i], db);
            }
        }
    }
    tiny_map_close(&map);
    const double below_db = 10 * log10(grass.power / grass.n) - 10 * log10(shadow.power / shadow.n);
    print_message("# shadow %.1f dB below grass, grey %.1f, deviation %.1f; grass %.1f, %.1f\n",
                  below_db, shadow.sum / shadow.n, deviation(&shadow), grass.sum / grass.n,
                  deviation(&grass));
    assert_true(below_db > 14 && below_db < 18);
    assert_true(deviation(&shadow) > 4);
    assert_true(shadow.sum / shadow.n < 0.5 * grass.sum / grass.n);
}

/* A fourth of a line's cells is looked at, from another one on in each line. */
TEST(a_line_that_is_too_short_to_be_looked_at_leaves_nothing)
{
    struct lm_patch_floor f;
    const int16_t level_q8[LM_CELLS_ROOM] = {0};
    lm_patch_floor_clear(&f);
    assert_true(run(&f, 3, level_q8, 3) < -85);
    assert_true(run(&f, 7, level_q8, 2) < -85);
    assert_true(run(&f, 2, level_q8, 3) > -60); /* this one has a cell */
}
