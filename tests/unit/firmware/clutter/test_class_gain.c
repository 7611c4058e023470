/* The gain of classes: docs/EQUATIONS.md, "Class gain". */
#include "check.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/class_gain.h"
#include "lm/illumination.h"
#include "lm/noise.h"
#include "reference/reference.h"
#include "tiny_image.h"

#include <string.h>

static const struct lm_facing_config walls = {FX_BAM_DEG(7), 60};

static uint32_t cell_of(uint32_t class_index)
{
    return 200u << 8 | class_index << 4 | 5;
}

/* A line of such cells, on ground that falls away, lit with the gains and without. */
static const struct lm_lit_line *light(const struct lm_class_gain *gain, uint32_t cell)
{
    enum { CELLS = 4, HIDDEN = 3 };
    static struct lm_range_grid grid;
    static struct lm_class_lut lut;
    static struct lm_scan_line line;
    static struct lm_lit_line lit;
    const struct lm_illumination_config config = {0};
    lm_range_grid_set(&grid, &config, 20000 * 256, 5 * 256, CELLS, 1000 * 1024, 0);
    lm_class_lut_set(&lut, &config, tiny_classes());
    for (uint32_t i = 0; i < CELLS; i++) {
        line.cell[i] = cell;
        line.elevation_m_q14[i] = i == HIDDEN ? -100 * 16384 : 0;
    }
    lm_illuminate(&grid, &lut, gain, &line, LM_HORIZON_OPEN, &lit);
    assert_int_equal(lit.level_db_q8[HIDDEN], LM_LEVEL_SHADOW);
    return &lit;
}

/* What a lit cell gains. */
static int32_t gain_q8(const struct lm_class_gain *gain, uint32_t cell)
{
    const int32_t without = light(NULL, cell)->level_db_q8[1];
    assert_in_range(without + 60 * 256, 0, 120 * 256);
    return light(gain, cell)->level_db_q8[1] - without;
}

TEST(a_picture_of_the_images_own_sea_keeps_every_level_to_the_bit)
{
    struct lm_class_gain gain;
    lm_class_gain_set(&gain, &walls, tiny_classes(), 0, LM_SEA_STATE_OF_IMAGE, 0);
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        assert_int_equal(gain_q8(&gain, cell_of(i)), 0);
    }
}

/* [Nathanson]: -40 dB in state 3 and -30 dB in state 5. */
TEST(only_water_grows_with_the_state_of_the_sea_by_5_decibels_each)
{
    for (int sea = 0; sea <= 255; sea++) {
        struct lm_class_gain gain;
        lm_class_gain_set(&gain, &walls, tiny_classes(), 0, (uint8_t)sea, 0);
        assert_int_equal(gain_q8(&gain, cell_of(TINY_WATER)), 5 * ((sea < 8 ? sea : 8) - 3) * 256);
        assert_int_equal(gain_q8(&gain, cell_of(TINY_SOIL)), 0);
        assert_int_equal(gain_q8(&gain, cell_of(TINY_STRUCTURE)), 0);
        assert_int_equal(gain_q8(&gain, cell_of(TINY_TREES)), 0);
    }
}

TEST(a_loss_is_taken_off_every_class)
{
    static const uint16_t losses_q8[] = {35 * 256, LM_CLUTTER_LOSS_MAX_DB_Q8, UINT16_MAX};
    for (size_t n = 0; n < 3; n++) {
        struct lm_class_gain whole, less;
        lm_class_gain_set(&whole, &walls, tiny_classes(), 0, 0, 0);
        lm_class_gain_set(&less, &walls, tiny_classes(), 0, 0, losses_q8[n]);
        for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
            const int32_t lost = gain_q8(&whole, cell_of(i)) - gain_q8(&less, cell_of(i));
            assert_int_equal(lost, losses_q8[n] < LM_CLUTTER_LOSS_MAX_DB_Q8
                                       ? losses_q8[n]
                                       : LM_CLUTTER_LOSS_MAX_DB_Q8);
        }
    }
}

TEST(a_shadow_gains_nothing_and_what_is_lost_ends_in_it)
{
    struct lm_class_gain most, least;
    lm_class_gain_set(&most, &walls, tiny_classes(), 0, LM_SEA_STATE_MAX, 0);
    lm_class_gain_set(&least, &walls, tiny_classes(), 0, 0, UINT16_MAX);
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        light(&most, cell_of(i)); /* which looks at the hidden cell */
        least.of_class_db_q8[i] = -0x7000;
        assert_int_equal(light(&least, cell_of(i) & 0xff)->level_db_q8[1], LM_LEVEL_SHADOW);
    }
}

TEST(a_class_has_its_gain_in_the_lod_that_the_map_is_read_from)
{
    struct lm_classes classes = *tiny_classes();
    classes.entry[TINY_STRUCTURE].lod_gain_db_q8[3] = 5 * 256;
    classes.entry[TINY_WATER].lod_gain_db_q8[3] = -2 * 256;
    classes.entry[TINY_SOIL].lod_gain_db_q8[15] = INT16_MAX; /* more than a gain may be */
    for (uint8_t lod = 0; lod < LM_DB_LODS_MAX; lod++) {
        struct lm_class_gain gain;
        lm_class_gain_set(&gain, &walls, &classes, lod, LM_SEA_STATE_OF_IMAGE + 1, 256);
        const int32_t on = lod == 3;
        assert_int_equal(gain_q8(&gain, cell_of(TINY_STRUCTURE)), on * 5 * 256 - 256);
        assert_int_equal(gain_q8(&gain, cell_of(TINY_WATER)), 5 * 256 - on * 2 * 256 - 256);
        assert_int_equal(gain_q8(&gain, cell_of(TINY_SOIL)),
                         (lod == 15) * LM_CLASS_GAIN_MAX_DB_Q8 - 256);
    }
}

/* The classes of facings 1..8, and one without. */
static struct lm_classes faced_classes(void)
{
    struct lm_classes classes = *tiny_classes();
    for (uint32_t i = 0; i <= LM_FACINGS; i++) {
        classes.entry[i] = classes.entry[TINY_STRUCTURE];
        classes.entry[i].facing = (uint8_t)i;
    }
    return classes;
}

TEST(walls_gain_what_the_reference_has_from_every_side)
{
    static const struct lm_facing_config tables[] = {
        {FX_BAM_DEG(7), 60}, {FX_BAM_DEG(4), 10}, {FX_BAM_DEG(45), 500}, {FX_BAM_DEG(12), 1000}};
    const struct lm_classes classes = faced_classes();
    for (size_t n = 0; n < sizeof tables / sizeof tables[0]; n++) {
        const struct ref_params params = {.lobe_half_deg = hs_degrees(tables[n].lobe_half),
                                          .wall_floor = tables[n].floor_permille / 1000.0};
        struct lm_class_gain gain;
        lm_class_gain_set(&gain, &tables[n], &classes, 0, LM_SEA_STATE_OF_IMAGE, 0);
        double worst_db = 0;
        for (uint32_t look = 0; look < 7200; look++) {
            struct ref_bin bins[LM_FACINGS + 1] = {{0}};
            const fx_bam_t azimuth = look * 596523;
            lm_class_gain_look(&gain, azimuth);
            for (int i = 0; i <= LM_FACINGS; i++) {
                bins[i].facing = i;
            }
            ref_class_gain(bins, LM_FACINGS + 1, &params, hs_degrees(azimuth));
            for (uint32_t i = 0; i <= LM_FACINGS; i++) {
                worst_db = fmax(worst_db,
                                fabs(gain_q8(&gain, cell_of(i)) / 256.0 - bins[i].class_gain_db));
            }
        }
        print_message("# lobe of %.0f degrees over %.2f: worst %.3f dB\n", params.lobe_half_deg,
                      params.wall_floor, worst_db);
        assert_true(worst_db < (params.lobe_half_deg < 5 ? 0.1 : 0.03));
    }
}

TEST(the_mean_over_all_looks_is_kept_and_a_grid_town_flashes)
{
    const struct lm_classes classes = faced_classes();
    struct lm_class_gain gain;
    lm_class_gain_set(&gain, &walls, &classes, 0, LM_SEA_STATE_OF_IMAGE, 0);
    enum { LOOKS = 7200 };
    double mean = 0, brightest = 0, darkest = HUGE_VAL;
    for (uint32_t look = 0; look < LOOKS; look++) {
        lm_class_gain_look(&gain, look * 596523);
        const double power = pow(10, gain_q8(&gain, cell_of(3)) / 2560.0);
        mean += power / LOOKS;
        brightest = fmax(brightest, power);
        darkest = fmin(darkest, power);
    }
    print_message("# mean %.4f, flash %.1f dB\n", mean, 10 * log10(brightest / darkest));
    assert_true(fabs(mean - 1) < 0.005);
    assert_true(brightest / darkest > 10);
    assert_int_equal(gain_q8(&gain, cell_of(0)), 0); /* no facing */
}

TEST(hostile_classes_and_cells_read_nothing_but_the_table)
{
    struct lm_classes classes;
    memset(&classes, 0xff, sizeof classes);
    struct lm_class_gain gain;
    lm_class_gain_set(&gain, &walls, &classes, 0, 255, 1);
    lm_class_gain_look(&gain, FX_BAM_DEG(45));
    for (uint32_t i = 0; i < 16; i++) {
        assert_int_equal(gain_q8(&gain, cell_of(i)), gain.of_class_db_q8[i]);
    }
}
