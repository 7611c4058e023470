/* Texture, the state of the sea and the noise floor, against the statistics of a K distribution and
 * the sum of powers: docs/DESIGN.md, "Speckle and texture". */
#include "fx/hash.h"
#include "hs/rng.h"
#include "lm/aspect.h"
#include "lm/radar.h"
#include "lm/speckle.h"
#include "tiny_image.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 384, CELLS = SIDE * SIDE, NONE = LM_TEXTURE_NONE };

static const struct lm_texture_config all_none = {{NONE, NONE, NONE, NONE}};

static uint32_t cell_of(uint32_t class_index)
{
    return 200u << 8 | class_index << 4 | 5;
}

struct moments {
    double mean, cv2; /* variance in squared means */
    double fourth;    /* root of the mean fourth power, to judge how well cv2 is known */
};

static struct moments moments_of(const double *x)
{
    double sum = 0, squares = 0, fourths = 0;
    for (int i = 0; i < CELLS; i++) {
        sum += x[i];
        squares += x[i] * x[i];
        fourths += pow(x[i], 4);
    }
    const double mean = sum / CELLS;
    return (struct moments){mean, squares / CELLS / (mean * mean) - 1, sqrt(fourths / CELLS)};
}

/* Powers of a field of 0 dB of structures with texture of shape 2^shape and speckle of 2^looks. */
static void fill_powers(double *power, uint8_t shape_log2, uint8_t looks_log2)
{
    struct lm_texture_config config = all_none;
    config.shape_log2[LM_KIND_STRUCTURE] = shape_log2;
    struct lm_texture texture;
    lm_texture_set(&texture, &config, tiny_classes(), LM_SEA_STATE_OF_IMAGE, 0);
    for (uint32_t row = 0; row < SIDE; row++) {
        uint32_t cell[SIDE], noise[SIDE];
        int32_t level[SIDE] = {0};
        for (uint32_t i = 0; i < SIDE; i++) {
            cell[i] = cell_of(TINY_STRUCTURE);
            noise[i] = fx_hash3(row, i, 77);
        }
        lm_texture_run(&texture, cell, noise, level, SIDE);
        for (uint32_t i = 0; i < SIDE; i++) {
            const int32_t speckle_q8 = lm_speckle_q8[looks_log2][noise[i] >> 22];
            power[row * SIDE + i] = pow(10, (level[i] + speckle_q8) / 2560.0);
        }
    }
}

static void textured_speckle_has_the_variance_of_a_k_distribution(void **state)
{
    (void)state;
    static double power[CELLS];
    for (uint8_t shape = 0; shape <= 4; shape++) {
        for (uint8_t looks = 0; looks <= 4; looks++) {
            fill_powers(power, shape, looks);
            const struct moments m = moments_of(power);
            const double nu = 1 << shape, l = 1 << looks;
            const double expected = (1 + 1 / nu) * (1 + 1 / l) - 1;
            /* Four deviations of a sample's second moment, and the slices, which cut the
             * distribution's end off: 0.5 % of an exponential's variance, each. */
            const double sampling = 4 * m.fourth / sqrt(CELLS);
            const double slices = 0.01 * (1 + expected);
            print_message("# nu %2.0f, %2.0f looks: mean %.4f, CV^2 %.4f of %.4f\n", nu, l, m.mean,
                          m.cv2, expected);
            assert_true(fabs(m.mean - 1) < 4 * sqrt(expected / CELLS) + 0.002);
            assert_true(fabs(m.cv2 - expected) < sampling + slices);
        }
    }
}

static void texture_and_speckle_of_a_cell_are_independent(void **state)
{
    (void)state;
    double both = 0;
    for (uint32_t row = 0; row < SIDE; row++) {
        for (uint32_t i = 0; i < SIDE; i++) {
            const uint32_t noise = fx_hash3(row, i, 3);
            both += ((noise >> 22) - 511.5) * ((noise >> 12 & 1023) - 511.5);
        }
    }
    assert_true(fabs(both / CELLS / (1024.0 * 1024 / 12)) < 4.0 / SIDE);
}

static void kinds_without_texture_keep_their_level_to_the_bit(void **state)
{
    (void)state;
    struct lm_texture texture;
    lm_texture_set(&texture, &lm_radar_default.texture, tiny_classes(), LM_SEA_STATE_OF_IMAGE, 0);
    for (uint32_t class_index = 0; class_index < LM_DB_CLASSES; class_index++) {
        const uint8_t kind = tiny_classes()->entry[class_index].kind;
        if (lm_radar_default.texture.shape_log2[kind] != LM_TEXTURE_NONE) {
            continue;
        }
        for (uint32_t slice = 0; slice < LM_SPECKLE_SLICES; slice++) {
            const uint32_t cell = cell_of(class_index), noise = slice << 12 | 0xffc00fffu;
            int32_t level = -1234;
            lm_texture_run(&texture, &cell, &noise, &level, 1);
            assert_int_equal(level, -1234);
        }
    }
}

static void bits_21_to_12_of_the_hash_choose_the_slice_and_no_others(void **state)
{
    (void)state;
    struct lm_texture_config config = all_none;
    config.shape_log2[LM_KIND_STRUCTURE] = 1;
    struct lm_texture texture;
    lm_texture_set(&texture, &config, tiny_classes(), LM_SEA_STATE_OF_IMAGE, 0);
    for (uint32_t slice = 0; slice < LM_SPECKLE_SLICES; slice++) {
        const uint32_t cell[2] = {cell_of(TINY_STRUCTURE), cell_of(TINY_STRUCTURE)};
        const uint32_t noise[2] = {slice << 12, slice << 12 | 0xffc00fffu};
        int32_t level[2] = {0, 0};
        lm_texture_run(&texture, cell, noise, level, 2);
        assert_int_equal(level[0], lm_speckle_q8[1][slice]);
        assert_int_equal(level[1], level[0]);
    }
}

/* Nathanson, as RADAR.md 2.2 quotes him: -40 dB in state 3 and -30 dB in state 5. */
static void only_water_grows_with_the_state_of_the_sea_by_5_decibels_each(void **state)
{
    (void)state;
    for (int sea = 0; sea <= 255; sea++) {
        struct lm_texture texture;
        lm_texture_set(&texture, &all_none, tiny_classes(), (uint8_t)sea, 0);
        const uint32_t cell[] = {cell_of(TINY_WATER), cell_of(TINY_SOIL), cell_of(TINY_STRUCTURE),
                                 cell_of(TINY_TREES)};
        const uint32_t noise[4] = {0, 1u << 20, 5, UINT32_MAX};
        int32_t level[4] = {-40 * 256, -20 * 256, 0, -15 * 256};
        lm_texture_run(&texture, cell, noise, level, 4);
        assert_int_equal(level[0], (-40 + 5 * ((sea < 8 ? sea : 8) - 3)) * 256);
        assert_int_equal(level[1], -20 * 256);
        assert_int_equal(level[2], 0);
        assert_int_equal(level[3], -15 * 256);
    }
}

static void a_loss_is_taken_off_every_class(void **state)
{
    (void)state;
    struct lm_texture_config config = all_none;
    config.shape_log2[LM_KIND_TREES] = 2;
    static const uint16_t losses_q8[] = {35 * 256, UINT16_MAX};
    for (size_t n = 0; n < 2; n++) {
        struct lm_texture whole, less;
        lm_texture_set(&whole, &config, tiny_classes(), 0, 0);
        lm_texture_set(&less, &config, tiny_classes(), 0, losses_q8[n]);
        for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
            const uint32_t cell = cell_of(i), noise = 0x00ff3000;
            int32_t level[2] = {0};
            lm_texture_run(&whole, &cell, &noise, &level[0], 1);
            lm_texture_run(&less, &cell, &noise, &level[1], 1);
            assert_int_equal(level[0] - level[1], losses_q8[n]);
        }
    }
}

static void a_shadow_stays_below_minus_80_dB_whatever_is_added(void **state)
{
    (void)state;
    int32_t strongest = 0;
    for (int row = 0; row <= LM_SPECKLE_LOOKS_LOG2_MAX; row++) {
        strongest = lm_speckle_q8[row][LM_SPECKLE_SLICES - 1] > strongest
                        ? lm_speckle_q8[row][LM_SPECKLE_SLICES - 1]
                        : strongest;
    }
    const struct lm_texture_config config = {{0, 0, 0, 0}};
    struct lm_texture texture;
    lm_texture_set(&texture, &config, tiny_classes(), LM_SEA_STATE_MAX, 0);
    for (uint32_t class_index = 0; class_index < LM_DB_CLASSES; class_index++) {
        for (uint32_t slice = 0; slice < LM_SPECKLE_SLICES; slice++) {
            const uint32_t cell = cell_of(class_index), noise = slice << 12;
            int32_t level = LM_LEVEL_SHADOW;
            lm_texture_run(&texture, &cell, &noise, &level, 1);
            assert_true(level + strongest < -80 * 256);
            assert_true(level > -0x10000); /* what fx_power_q24_of_many takes */
        }
    }
}

static void a_hostile_table_reads_nothing_but_the_tables(void **state)
{
    (void)state;
    struct lm_texture_config config;
    struct lm_classes classes;
    memset(&config, 0xff, sizeof config);
    memset(&classes, 0xff, sizeof classes);
    struct lm_texture texture;
    lm_texture_set(&texture, &config, &classes, 255, 0);
    for (uint32_t i = 0; i < 16; i++) {
        const uint32_t cell = 0xffffff0fu | i << 4, noise = UINT32_MAX;
        int32_t level = 0;
        assert_in_range(texture.of_class[i] & ((1 << LM_TEXTURE_ENTRY_BITS) - 1), 0,
                        5 * LM_SPECKLE_SLICES - 1);
        lm_texture_run(&texture, &cell, &noise, &level, 1);
        assert_int_equal(level, 0);
    }
}

/* A level over a floor, without the speckle of the sum. */
static int32_t over_floor_q8(int32_t floor_q8, int32_t level_q8)
{
    const struct lm_speckle_config config = {2};
    const uint32_t slice = 700, noise = slice << 22;
    int32_t speckled_q8;
    lm_speckle_floor_run(&config, floor_q8, &noise, &level_q8, &speckled_q8, 1);
    return speckled_q8 - lm_speckle_q8[2][slice];
}

static void the_floor_adds_as_power_to_every_level(void **state)
{
    (void)state;
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    for (int n = 0; n < 20000; n++) {
        const int32_t floor_q8 = (int32_t)hs_rng_below(&rng, 40000) - 30000;
        const int32_t level_q8 = (int32_t)hs_rng_below(&rng, 60000) - 40000;
        const int32_t sum_q8 = over_floor_q8(floor_q8, level_q8);
        const double expected = 10 * log10(pow(10, level_q8 / 2560.0) + pow(10, floor_q8 / 2560.0));
        assert_true(fabs(sum_q8 / 256.0 - expected) < 0.018);
    }
    assert_in_range(over_floor_q8(-46 * 256, LM_LEVEL_SHADOW) + 46 * 256, 0, 1);
}

static void as_many_cells_change_as_were_asked_for(void **state)
{
    (void)state;
    struct lm_texture_config config = all_none;
    config.shape_log2[LM_KIND_TREES] = 1;
    struct lm_texture texture;
    lm_texture_set(&texture, &config, tiny_classes(), LM_SEA_STATE_OF_IMAGE, 0);
    uint32_t cell[40], noise[40] = {0};
    for (uint32_t i = 0; i < 40; i++) {
        cell[i] = cell_of(TINY_TREES);
    }
    for (uint32_t cells = 0; cells < 40; cells++) {
        const struct lm_speckle_config speckle = {2};
        int32_t level[40] = {0}, speckled[40] = {0};
        lm_texture_run(&texture, cell, noise, level, cells);
        lm_speckle_floor_run(&speckle, 0, noise, level, speckled, cells);
        for (uint32_t i = 0; i < 40; i++) {
            assert_int_equal(level[i], i < cells ? lm_speckle_q8[1][0] : 0);
            assert_int_equal(speckled[i] != 0, i < cells);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(textured_speckle_has_the_variance_of_a_k_distribution),
        cmocka_unit_test(texture_and_speckle_of_a_cell_are_independent),
        cmocka_unit_test(kinds_without_texture_keep_their_level_to_the_bit),
        cmocka_unit_test(bits_21_to_12_of_the_hash_choose_the_slice_and_no_others),
        cmocka_unit_test(only_water_grows_with_the_state_of_the_sea_by_5_decibels_each),
        cmocka_unit_test(a_loss_is_taken_off_every_class),
        cmocka_unit_test(a_shadow_stays_below_minus_80_dB_whatever_is_added),
        cmocka_unit_test(a_hostile_table_reads_nothing_but_the_tables),
        cmocka_unit_test(the_floor_adds_as_power_to_every_level),
        cmocka_unit_test(as_many_cells_change_as_were_asked_for),
    };
    return cmocka_run_group_tests_name("texture", tests, NULL, NULL);
}
