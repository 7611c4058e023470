/* Texture, the state of the sea and the noise floor, against the statistics of a K distribution and
 * the sum of powers: docs/EQUATIONS.md, "Speckle and texture". */
#include "check.h"
#include "hs/rng.h"
#include "lm/illumination.h"
#include "lm/radar.h"
#include "lm/speckle.h"
#include "tiny_image.h"

#include <math.h>
#include <string.h>

/* ROOM is what the stages take for a few cells. */
enum { SIDE = 384, CELLS = SIDE * SIDE, ROOM = 16, NONE = LM_TEXTURE_NONE };

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
    lm_texture_set(&texture, &config, tiny_classes(), 0, LM_SEA_STATE_OF_IMAGE, 0);
    for (uint32_t row = 0; row < SIDE; row++) {
        const struct lm_noise_key rough = lm_noise_key_of(LM_NOISE_TEXTURE, row, 77);
        const struct lm_noise_key speckle = lm_noise_key_of(LM_NOISE_SPECKLE, row, 77);
        const struct lm_speckle_config looks = {looks_log2};
        uint32_t cell[SIDE];
        int32_t level[SIDE] = {0};
        for (uint32_t i = 0; i < SIDE; i++) {
            cell[i] = cell_of(TINY_STRUCTURE);
        }
        lm_texture_run(&texture, &rough, cell, level, SIDE);
        lm_speckle_run(&looks, &speckle, level, SIDE);
        for (uint32_t i = 0; i < SIDE; i++) {
            power[row * SIDE + i] = pow(10, level[i] / 2560.0);
        }
    }
}

TEST(textured_speckle_has_the_variance_of_a_k_distribution)
{
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

/* What a cell of a class gains, for the n-th draw of any. */
static int32_t gain_q8(const struct lm_texture *texture, uint32_t cell, uint32_t n, int32_t level)
{
    const struct lm_noise_key noise_key = lm_noise_key_of(LM_NOISE_TEXTURE, n, 4);
    uint32_t cells[ROOM];
    int32_t levels[ROOM];
    for (int i = 0; i < ROOM; i++) {
        cells[i] = cell;
        levels[i] = level;
    }
    lm_texture_run(texture, &noise_key, cells, levels, 1);
    return levels[0] - level;
}

TEST(kinds_without_texture_keep_their_level_to_the_bit)
{
    struct lm_texture texture;
    lm_texture_set(&texture, &lm_radar_default.texture, tiny_classes(), 0, LM_SEA_STATE_OF_IMAGE,
                   0);
    for (uint32_t class_index = 0; class_index < LM_DB_CLASSES; class_index++) {
        const uint8_t kind = tiny_classes()->entry[class_index].kind;
        if (lm_radar_default.texture.shape_log2[kind] != LM_TEXTURE_NONE) {
            continue;
        }
        for (uint32_t n = 0; n < 1000; n++) {
            assert_int_equal(gain_q8(&texture, cell_of(class_index), n, -1234), 0);
        }
    }
}

/* Classes in turns, so that each of a block has neighbours of other shapes. */
TEST(each_class_gains_a_draw_of_its_own_shape)
{
    const struct lm_texture_config config = {.shape_log2 = {[LM_KIND_GROUND] = 4,
                                                            [LM_KIND_WATER] = NONE,
                                                            [LM_KIND_STRUCTURE] = 1,
                                                            [LM_KIND_TREES] = 2}};
    static const uint32_t class_index[4] = {TINY_SOIL, TINY_WATER, TINY_STRUCTURE, TINY_TREES};
    static const int log2_of[4] = {4, -1, 1, 2};
    struct lm_texture texture;
    struct hs_rng rng;
    hs_rng_seed(&rng, 8);
    lm_texture_set(&texture, &config, tiny_classes(), 0, LM_SEA_STATE_OF_IMAGE, 0);
    assert_int_equal(texture.shape_count, 3);
    for (uint32_t column = 0; column < 200; column++) {
        const struct lm_noise_key noise_key = lm_noise_key_of(LM_NOISE_TEXTURE, column, 9);
        uint32_t cell[48], which[48];
        int32_t level[48] = {0};
        for (int i = 0; i < 48; i++) {
            which[i] = hs_rng_below(&rng, column % 4 + 1);
            cell[i] = cell_of(class_index[which[i]]);
        }
        lm_texture_run(&texture, &noise_key, cell, level, 48);
        for (uint32_t i = 0; i < 48; i++) {
            const int log2 = log2_of[which[i]];
            assert_int_equal(level[i],
                             log2 < 0 ? 0 : lm_noise_cell_db_q8((uint32_t)log2, &noise_key, i));
        }
    }
}

/* [Nathanson]: -40 dB in state 3 and -30 dB in state 5. */
TEST(only_water_grows_with_the_state_of_the_sea_by_5_decibels_each)
{
    for (int sea = 0; sea <= 255; sea++) {
        struct lm_texture texture;
        lm_texture_set(&texture, &all_none, tiny_classes(), 0, (uint8_t)sea, 0);
        const struct lm_noise_key noise_key = lm_noise_key_of(LM_NOISE_TEXTURE, (uint32_t)sea, 1);
        const uint32_t cell[ROOM] = {cell_of(TINY_WATER), cell_of(TINY_SOIL),
                                     cell_of(TINY_STRUCTURE), cell_of(TINY_TREES)};
        int32_t level[ROOM] = {-40 * 256, -20 * 256, 0, -15 * 256};
        lm_texture_run(&texture, &noise_key, cell, level, 4);
        assert_int_equal(level[0], (-40 + 5 * ((sea < 8 ? sea : 8) - 3)) * 256);
        assert_int_equal(level[1], -20 * 256);
        assert_int_equal(level[2], 0);
        assert_int_equal(level[3], -15 * 256);
    }
}

TEST(a_loss_is_taken_off_every_class)
{
    struct lm_texture_config config = all_none;
    config.shape_log2[LM_KIND_TREES] = 2;
    static const uint16_t losses_q8[] = {35 * 256, LM_TEXTURE_LOSS_MAX_DB_Q8, UINT16_MAX};
    for (size_t n = 0; n < 3; n++) {
        struct lm_texture whole, less;
        lm_texture_set(&whole, &config, tiny_classes(), 0, 0, 0);
        lm_texture_set(&less, &config, tiny_classes(), 0, 0, losses_q8[n]);
        for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
            const int32_t lost =
                gain_q8(&whole, cell_of(i), i, 0) - gain_q8(&less, cell_of(i), i, 0);
            assert_int_equal(lost, losses_q8[n] < LM_TEXTURE_LOSS_MAX_DB_Q8
                                       ? losses_q8[n]
                                       : LM_TEXTURE_LOSS_MAX_DB_Q8);
        }
    }
}

TEST(a_shadow_stays_below_minus_80_dB_whatever_is_added)
{
    int32_t strongest = 0;
    for (int row = 0; row <= LM_NOISE_LOOKS_LOG2_MAX; row++) {
        for (int n = 0; n < LM_NOISE_SLICES; n++) {
            strongest = lm_noise_db_q8[row][n] > strongest ? lm_noise_db_q8[row][n] : strongest;
        }
    }
    const struct lm_texture_config config = {{0, 0, 0, 0}};
    struct lm_texture texture;
    lm_texture_set(&texture, &config, tiny_classes(), 0, LM_SEA_STATE_MAX, 0);
    for (uint32_t class_index = 0; class_index < LM_DB_CLASSES; class_index++) {
        for (uint32_t n = 0; n < 4000; n++) {
            const int32_t level =
                LM_LEVEL_SHADOW + gain_q8(&texture, cell_of(class_index), n, LM_LEVEL_SHADOW);
            assert_true(level + strongest < -80 * 256);
            assert_true(level > -0x10000); /* what fx_power_q32_vec takes */
        }
    }
}

TEST(a_class_has_its_gain_in_the_lod_that_the_map_is_read_from)
{
    struct lm_classes classes = *tiny_classes();
    classes.entry[TINY_STRUCTURE].lod_gain_db_q8[3] = 5 * 256;
    classes.entry[TINY_WATER].lod_gain_db_q8[3] = -2 * 256;
    classes.entry[TINY_SOIL].lod_gain_db_q8[15] = INT16_MAX; /* more than a gain may be */
    for (uint8_t lod = 0; lod < LM_DB_LODS_MAX; lod++) {
        struct lm_texture t;
        lm_texture_set(&t, &all_none, &classes, lod, LM_SEA_STATE_OF_IMAGE + 1, 256);
        const int32_t on = lod == 3;
        assert_int_equal(gain_q8(&t, TINY_STRUCTURE << 4, 0, 0), on * 5 * 256 - 256);
        assert_int_equal(gain_q8(&t, TINY_WATER << 4, 0, 0), 5 * 256 - on * 2 * 256 - 256);
        assert_int_equal(gain_q8(&t, TINY_SOIL << 4, 0, 0),
                         (lod == 15) * LM_CLASS_GAIN_MAX_DB_Q8 - 256);
    }
}

TEST(a_hostile_table_reads_nothing_but_the_tables)
{
    struct lm_texture_config config;
    struct lm_classes classes;
    memset(&config, 0xff, sizeof config);
    memset(&classes, 0xff, sizeof classes);
    struct lm_texture texture;
    lm_texture_set(&texture, &config, &classes, 0, 255, 0);
    assert_int_equal(texture.shape_count, 0);
    for (uint32_t i = 0; i < 16; i++) {
        assert_int_equal(lm_texture_shape(texture.of_class[i]), LM_TEXTURE_NONE);
        /* The class's gain in the LOD, 0xffff, is -1/256 dB. */
        assert_int_equal(gain_q8(&texture, 0xffffff0fu | i << 4, i, 0), -1);
    }
}

/* A level over a floor, without the speckle of the sum. */
static int32_t over_floor_q8(int32_t floor_q8, int32_t level_q8)
{
    const struct lm_speckle_config config = {2};
    const struct lm_noise_key noise_key = lm_noise_key_of(LM_NOISE_SPECKLE, 700, 2);
    int32_t level[ROOM] = {level_q8}, speckled_q8[ROOM];
    lm_speckle_floor_run(&config, floor_q8, &noise_key, level, speckled_q8, 1);
    return speckled_q8[0] - lm_noise_cell_db_q8(2, &noise_key, 0);
}

TEST(the_floor_adds_as_power_to_every_level)
{
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
