/* Speckle against the statistics of a Gamma distribution, with the noise that a scan line gives its
 * cells. */
#include "lm/scan_line.h"
#include "lm/speckle.h"
#include "memory_flash.h"
#include "tiny_image.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 256, FLOOR_Q8 = -46 * 256, CELL_MM = 10000 };

struct fixture {
    struct tiny_image image;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    void *pool;
    struct lm_scan_line line;
    uint32_t noise[SIDE][SIDE];
};

static struct tiny_cell soil(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    (void)place;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

/* The noise of SIDE x SIDE cells of CELL_MM around the image, south to north, shifted by whole
 * noise cells eastward. */
static void fill_noise(struct fixture *f, uint32_t epoch, uint32_t east_bam)
{
    const struct lm_sampling s = lm_sampling_for(&f->db, CELL_MM, epoch);
    const uint64_t step = (uint64_t)(CELL_MM / 9.31506 * 4294967296.0);
    for (uint32_t row = 0; row < SIDE; row++) {
        const struct lm_ground_path path = {
            .latitude = ((uint64_t)f->db.centre_latitude << 32) + row * step,
            .longitude = (uint64_t)(f->db.centre_longitude + east_bam) << 32,
            .longitude_step = step};
        lm_scan_line_run(&f->line, &f->tiles, &s, &path, SIDE);
        memcpy(f->noise[row], f->line.noise, sizeof f->noise[row]);
    }
}

static int open_fixture(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    struct tiny_spec spec = tiny_spec_at(10, 20);
    const size_t bytes = 20 * sizeof(struct lm_tile);
    spec.cell = soil;
    spec.shift0 = 10;
    if (f == NULL || tiny_image_build(&f->image, &spec) != 0) {
        return -1;
    }
    f->pool = malloc(bytes);
    memory_flash_open(&f->flash, f->image.bytes, f->image.size);
    *state = f;
    return lm_db_open(&f->db, &f->flash.port, 10) == 0 &&
                   lm_tile_cache_init(&f->tiles, &f->db, f->pool, bytes, 10) == 0
               ? 0
               : -1;
}

static int close_fixture(void **state)
{
    struct fixture *f = *state;
    tiny_image_free(&f->image);
    free(f->pool);
    free(f);
    return 0;
}

/* Powers after speckle of `looks_log2` on a field of 0 dB. */
static void powers_of(const struct fixture *f, uint8_t looks_log2, double *power)
{
    const struct lm_speckle_config config = {looks_log2};
    for (int row = 0; row < SIDE; row++) {
        int32_t level[SIDE] = {0};
        lm_speckle_run(&config, f->noise[row], level, SIDE);
        for (int i = 0; i < SIDE; i++) {
            power[row * SIDE + i] = pow(10, level[i] / 2560.0);
        }
    }
}

static void moments(const double *x, double *mean, double *variance)
{
    const int n = SIDE * SIDE;
    double sum = 0, squares = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i];
        squares += x[i] * x[i];
    }
    *mean = sum / n;
    *variance = squares / n - *mean * *mean;
}

static void one_look_has_a_coefficient_of_variation_of_one(void **state)
{
    struct fixture *f = *state;
    static double power[SIDE * SIDE];
    double mean, variance;
    fill_noise(f, 5, 0);
    powers_of(f, 0, power);
    moments(power, &mean, &variance);
    print_message("# one look: mean %.4f, CV %.4f\n", mean, sqrt(variance) / mean);
    assert_true(fabs(mean - 1) < 0.02);
    assert_true(fabs(sqrt(variance) / mean - 1) < 0.03);
}

static void the_equivalent_number_of_looks_is_the_number_of_looks(void **state)
{
    struct fixture *f = *state;
    static double power[SIDE * SIDE];
    fill_noise(f, 6, 0);
    for (uint8_t log2 = 0; log2 <= LM_SPECKLE_LOOKS_LOG2_MAX; log2++) {
        double mean, variance;
        powers_of(f, log2, power);
        moments(power, &mean, &variance);
        const double looks = mean * mean / variance;
        print_message("# %d looks: mean %.4f, ENL %.3f\n", 1 << log2, mean, looks);
        assert_true(fabs(mean - 1) < 0.02);
        assert_true(fabs(looks / (1 << log2) - 1) < 0.1);
    }
}

/* 65,536 draws into 1024 slices: chi-square has mean 1023 and deviation sqrt(2 * 1023) = 45. */
static void every_slice_is_drawn_equally_often(void **state)
{
    struct fixture *f = *state;
    for (uint32_t epoch = 0; epoch < 4; epoch++) {
        int count[LM_SPECKLE_SLICES] = {0};
        fill_noise(f, epoch, 0);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const uint32_t n = f->noise[i / SIDE][i % SIDE] >> 22;
            assert_in_range(n, 0, LM_SPECKLE_SLICES - 1);
            count[n]++;
        }
        double chi_square = 0;
        for (int n = 0; n < LM_SPECKLE_SLICES; n++) {
            chi_square += (count[n] - 64.0) * (count[n] - 64.0) / 64;
        }
        assert_true(fabs(chi_square - 1023) < 5 * 45);
    }
}

/* Correlation of the draws of cells (row, column) and (row + down, column + along): for independent
 * ones its deviation is 1/256. */
static double correlation(const struct fixture *f, int down, int along)
{
    double sum = 0;
    int n = 0;
    for (int row = 0; row + down < SIDE; row++) {
        for (int i = 0; i + along < SIDE; i++, n++) {
            sum += ((f->noise[row][i] >> 22) - 511.5) *
                   ((f->noise[row + down][i + along] >> 22) - 511.5);
        }
    }
    return sum / n / (1024.0 * 1024 / 12);
}

static void neighbouring_cells_are_independent(void **state)
{
    struct fixture *f = *state;
    for (uint32_t epoch = 0; epoch < 3; epoch++) {
        fill_noise(f, epoch, 0);
        for (int down = 0; down <= 3; down++) {
            for (int along = down == 0; along <= 3; along++) {
                assert_true(fabs(correlation(f, down, along)) < 5.0 / SIDE);
            }
        }
    }
}

static void ground_keeps_its_noise_while_the_line_moves_over_it(void **state)
{
    struct fixture *f = *state;
    static uint32_t before[SIDE][SIDE];
    /* Seven cells' step is no whole number of BAM, so the line starts where cell 7 lay. */
    const double step_bam = CELL_MM / 9.31506;
    fill_noise(f, 9, 0);
    memcpy(before, f->noise, sizeof before);
    fill_noise(f, 9, (uint32_t)(7 * step_bam));
    int same = 0;
    for (int row = 0; row < SIDE; row++) {
        for (int i = 0; i + 7 < SIDE; i++) {
            same += f->noise[row][i] == before[row][i + 7];
        }
    }
    /* All but the few cells whose noise cell ends within that fraction of a BAM (one in 512). */
    assert_true(same > 0.99 * SIDE * (SIDE - 7));
    fill_noise(f, 9, 0);
    assert_memory_equal(before, f->noise, sizeof before);
}

static void another_epoch_gives_other_noise(void **state)
{
    struct fixture *f = *state;
    static uint32_t before[SIDE][SIDE];
    fill_noise(f, 1, 0);
    memcpy(before, f->noise, sizeof before);
    fill_noise(f, 2, 0);
    int same = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        same += f->noise[i / SIDE][i % SIDE] >> 22 == before[i / SIDE][i % SIDE] >> 22;
    }
    assert_true(abs(same - 64) < 5 * 8); /* by chance, 1 in 1024 */
}

static void each_slice_of_the_hash_adds_its_entry_of_the_table(void **state)
{
    (void)state;
    const struct lm_speckle_config config = {2};
    for (uint32_t n = 0; n < LM_SPECKLE_SLICES; n++) {
        const uint32_t noise[4] = {n << 22, n << 22 | 0x3fffff, n << 22, n << 22};
        int32_t level[4] = {-0x8000, FLOOR_Q8, FLOOR_Q8 + 1, 1000};
        lm_speckle_run(&config, noise, level, 4);
        assert_int_equal(level[0], -0x8000 + lm_speckle_q8[2][n]);
        assert_int_equal(level[1], FLOOR_Q8 + lm_speckle_q8[2][n]);
        assert_int_equal(level[2], FLOOR_Q8 + 1 + lm_speckle_q8[2][n]);
        assert_int_equal(level[3], 1000 + lm_speckle_q8[2][n]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_look_has_a_coefficient_of_variation_of_one),
        cmocka_unit_test(the_equivalent_number_of_looks_is_the_number_of_looks),
        cmocka_unit_test(every_slice_is_drawn_equally_often),
        cmocka_unit_test(neighbouring_cells_are_independent),
        cmocka_unit_test(ground_keeps_its_noise_while_the_line_moves_over_it),
        cmocka_unit_test(another_epoch_gives_other_noise),
        cmocka_unit_test(each_slice_of_the_hash_adds_its_entry_of_the_table),
    };
    return cmocka_run_group_tests_name("speckle", tests, open_fixture, close_fixture);
}
