/* Targets: their records, what their scatterers return, and the draws of those that fluctuate. */
#include "hs/angle.h"
#include "lm/target.h"

#include "check.h"
#include "memory_flash.h"
#include "reference/rcs.h"
#include "target_image.h"
#include "target_support.h"

#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* ---- records ---- */

static struct lm_target sound_target(void)
{
    struct lm_target t = point_at(46, 11, 250, 10);
    add_scatterer(&t, LM_SHAPE_PLATE, 300, 1000, -2000, 3000, 10, 20);
    return t;
}

TEST(every_flipped_bit_of_a_record_is_refused)
{
    struct lm_target t = sound_target();
    assert_int_equal(lm_target_check(&t), LM_OK);
    for (size_t bit = 0; bit < sizeof t * 8; bit++) {
        uint8_t *byte = (uint8_t *)&t + bit / 8;
        *byte = (uint8_t)(*byte ^ 1u << bit % 8);
        assert_int_equal(lm_target_check(&t), LM_ERR_CORRUPT);
        *byte = (uint8_t)(*byte ^ 1u << bit % 8);
    }
}

static void refused(struct lm_target t)
{
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_ERR_CORRUPT);
}

TEST(a_number_out_of_range_is_refused_under_a_right_checksum)
{
    struct lm_target t = sound_target();
    refused((t.latitude = hs_bam(90.001), t));
    refused((t = sound_target(), t.elevation_m_q6 = (1 << 20) + 1, t));
    refused((t = sound_target(), t.scatterer_count = LM_SCATTERERS_MAX + 1, t));
    refused((t = sound_target(), t.swerling = 5, t));
    refused((t = sound_target(), t.mean_rcs_dbsm_q8 = INT32_MIN, t));
    refused((t = sound_target(), t.scatterers[0].kind = 0, t));
    refused((t = sound_target(), t.scatterers[0].kind = LM_SHAPE_KINDS, t));
    refused((t = sound_target(), t.scatterers[0].is_two_sided = 2, t));
    refused((t = sound_target(), t.scatterers[0].size_mm[0] = 0, t));
    refused((t = sound_target(), t.scatterers[0].size_mm[1] = LM_SHAPE_SIZE_MAX_MM + 1, t));
    refused((t = sound_target(), t.scatterers[0].offset_mm[2] = -LM_TARGET_OFFSET_MAX_MM - 1, t));
    /* A point with a signature that no image has, with bodies, or one that is a beacon, too. */
    const struct lm_target point = point_at(46, 11, 250, 10);
    refused((t = point, t.signature = 1, t));
    refused((t = point, t.flags = LM_TARGET_HAS_SIGNATURE, t.signature = LM_DB_SIGNATURES_MAX, t));
    refused((t = sound_target(), t.flags = LM_TARGET_HAS_SIGNATURE, t));
    refused((t = sound_target(), t.flags = LM_TARGET_IS_BEACON, t));
    refused((t = point, t.flags = LM_TARGET_HAS_SIGNATURE | LM_TARGET_IS_BEACON, t));
    t = point;
    t.flags = LM_TARGET_HAS_SIGNATURE;
    t.signature = LM_DB_SIGNATURES_MAX - 1;
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_OK);
    t = sound_target();
    t.latitude = hs_bam(-90);
    t.scatterers[0].offset_mm[1] = LM_TARGET_OFFSET_MAX_MM;
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_OK);
}

enum { POLLS = 4 };

static void build(struct tiny_image *image, struct with_targets *w)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    assert_int_equal(tiny_image_build(image, &spec), 0);
    add_targets(w, image, sound_target());
}

TEST(the_targets_of_an_image_are_read_and_faults_told_apart)
{
    struct tiny_image image;
    struct with_targets w;
    struct lm_db db;
    struct lm_target t;
    struct memory_flash flash;
    build(&image, &w);
    memory_flash_open(&flash, w.bytes, w.size);
    assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_OK);
    assert_int_equal(db.target_count, TARGETS);
    for (uint32_t i = 0; i < TARGETS; i++) {
        assert_int_equal(lm_target_read(&db, i, &t, POLLS), LM_OK);
        assert_int_equal(t.id, i);
    }
    assert_int_equal(lm_target_read(&db, TARGETS, &t, POLLS), LM_ERR_RANGE);
    w.bytes[w.head_at + 64 + 100] ^= 1;
    assert_int_equal(lm_target_read(&db, 0, &t, POLLS), LM_ERR_CORRUPT);
    assert_int_equal(lm_target_read(&db, 1, &t, POLLS), LM_OK);
    flash.fail_every = 1;
    assert_int_equal(lm_target_read(&db, 1, &t, POLLS), LM_ERR_IO);
    free(w.bytes);
    tiny_image_free(&image);
}

TEST(an_image_without_targets_has_none)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    struct lm_db db;
    struct lm_target t;
    struct memory_flash flash;
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    memory_flash_open(&flash, image.bytes, image.size);
    memset(&db, 0xA5, sizeof db);
    assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_OK);
    assert_int_equal(db.target_count, 0);
    assert_int_equal(lm_target_read(&db, 0, &t, POLLS), LM_ERR_RANGE);
    tiny_image_free(&image);
}

static int open_changed(struct with_targets *w, size_t at, uint64_t value, size_t bytes)
{
    struct lm_db db;
    struct memory_flash flash;
    uint8_t kept[8];
    memcpy(kept, w->bytes + at, sizeof kept);
    put(w->bytes + at, value, bytes);
    seal_head(w);
    seal_header(w);
    memory_flash_open(&flash, w->bytes, w->size);
    const int status = lm_db_open(&db, &flash.port, POLLS);
    memcpy(w->bytes + at, kept, sizeof kept);
    seal_head(w);
    seal_header(w);
    return status;
}

TEST(a_section_that_lies_about_itself_is_refused)
{
    struct tiny_image image;
    struct with_targets w;
    build(&image, &w);
    const size_t entry = SECTION_TABLE + 5 * SECTION_ENTRY;
    assert_int_equal(open_changed(&w, w.head_at, TARGETS, 4), LM_OK);
    assert_int_equal(open_changed(&w, w.head_at, TARGETS + 1, 4), LM_ERR_CORRUPT);
    assert_int_equal(open_changed(&w, w.head_at, UINT32_MAX, 4), LM_ERR_CORRUPT);
    assert_int_equal(open_changed(&w, w.head_at + 4, 641, 4), LM_ERR_CORRUPT);
    assert_int_equal(open_changed(&w, entry + 8, w.size, 8), LM_ERR_CORRUPT);
    assert_int_equal(open_changed(&w, entry + 8, UINT64_MAX - 63, 8), LM_ERR_CORRUPT);
    assert_int_equal(open_changed(&w, entry + 16, 63, 8), LM_ERR_CORRUPT);
    assert_int_equal(open_changed(&w, entry + 16, UINT64_MAX, 8), LM_ERR_CORRUPT);
    w.bytes[w.head_at + 20] ^= 1; /* under the old checksum */
    struct lm_db db;
    struct memory_flash flash;
    memory_flash_open(&flash, w.bytes, w.size);
    assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_ERR_CORRUPT);
    free(w.bytes);
    tiny_image_free(&image);
}

/* ---- returns ---- */

/* The same numbers to both: the place of the radar from whole BAM and millimetres. */
static struct ref_vector radar_of(fx_bam_t bearing, fx_bam_t elevation, uint32_t range_mm)
{
    const double b = (int32_t)bearing * pi / 2147483648.0,
                 e = (int32_t)elevation * pi / 2147483648.0;
    const double range_m = range_mm * 1e-3;
    return (struct ref_vector){range_m * cos(e) * cos(b), range_m * cos(e) * sin(b),
                               range_m * sin(e)};
}

TEST(phases_are_those_of_the_true_way_to_every_scatterer)
{
    struct hs_rng rng;
    double worst_um = 0, worst_mm = 0;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < 4000; i++) {
        /* From the nearest range with the largest offsets on. */
        const struct lm_target t = random_target(&rng, i % 2 ? LM_TARGET_OFFSET_MAX_MM : 20000);
        const fx_bam_t bearing = (fx_bam_t)hs_rng_u64(&rng);
        const fx_bam_t elevation = hs_bam(89 * hs_rng_uniform(&rng));
        const uint32_t range_mm = 1000000 + (i % 4 ? hs_rng_below(&rng, 200000000) : 0);
        const struct ref_vector radar = radar_of(bearing, elevation, range_mm);
        struct lm_target_view v;
        struct lm_return returns[LM_SCATTERERS_MAX];
        lm_target_view_set(&v, bearing, elevation, range_mm);
        const uint32_t count = lm_target_returns(&t, &v, X_BAND_UM, returns);
        for (uint32_t k = 0; k < count; k++) {
            const double x = radar.ahead - t.scatterers[k].offset_mm[0] * 1e-3;
            const double y = radar.right - t.scatterers[k].offset_mm[1] * 1e-3;
            const double z = radar.up - t.scatterers[k].offset_mm[2] * 1e-3;
            const double turns =
                2 * (sqrt(x * x + y * y + z * z) - range_mm * 1e-3) / (X_BAND_UM * 1e-6);
            const double off = returns[k].phase / 4294967296.0 - (turns - floor(turns));
            worst_um = fmax(worst_um, fabs(off - round(off)) * X_BAND_UM / 2);
            const double *o =
                (const double[]){t.scatterers[k].offset_mm[0], t.scatterers[k].offset_mm[1]};
            const double b = (int32_t)bearing * pi / 2147483648.0;
            worst_mm = fmax(worst_mm, fabs(returns[k].along_mm + o[0] * cos(b) + o[1] * sin(b)));
            worst_mm = fmax(worst_mm, fabs(returns[k].across_mm - o[0] * sin(b) + o[1] * cos(b)));
            assert_int_equal(returns[k].up_mm, t.scatterers[k].offset_mm[2]);
        }
    }
    print_message("# worst path %.1f um, worst offset %.2f mm\n", worst_um, worst_mm);
    assert_true(worst_um < 10);
    assert_true(worst_mm < 0.6);
}

/* The far field's path, -s, would be wrong by o^2 / 2R: 50 m at 20 km, 2 wavelengths. */
TEST(ways_are_not_taken_from_the_far_field)
{
    struct lm_target t = {.id = 1};
    struct lm_target_view v;
    struct lm_return r[LM_SCATTERERS_MAX];
    add_scatterer(&t, LM_SHAPE_SPHERE, 100, 0, 50000, 0, 0, 0);
    lm_target_view_set(&v, 0, 0, 20000000);
    lm_target_returns(&t, &v, X_BAND_UM, r);
    const double turns = 2 * (hypot(20000, 50) - 20000) / (X_BAND_UM * 1e-6);
    assert_true(turns > 3);
    assert_true(fabs(r[0].phase / 4294967296.0 - (turns - floor(turns))) < 0.001);
}

static double sum_db(const struct lm_target *t, const struct lm_target_view *v, uint32_t mask)
{
    struct lm_return r[LM_SCATTERERS_MAX];
    lm_target_returns(t, v, X_BAND_UM, r);
    return lm_returns_sum_dbsm_q8(r, mask) / 256.0;
}

static double strongest_db(const struct lm_target *t, const struct lm_target_view *v)
{
    double strongest = -100;
    for (uint32_t i = 0; i < t->scatterer_count; i++) {
        strongest = fmax(strongest, sum_db(t, v, 1u << i));
    }
    return strongest;
}

TEST(sums_are_those_of_the_phasors)
{
    struct hs_rng rng;
    double worst = 0;
    int seen = 0;
    hs_rng_seed(&rng, 2);
    for (int i = 0; i < 3000; i++) {
        const struct lm_target t = random_target(&rng, 30000);
        const fx_bam_t bearing = (fx_bam_t)hs_rng_u64(&rng),
                       elevation = hs_bam(60 * hs_rng_uniform(&rng));
        const uint32_t range_mm = 3000000 + hs_rng_below(&rng, 90000000);
        struct lm_target_view v;
        lm_target_view_set(&v, bearing, elevation, range_mm);
        const uint32_t mask = (uint32_t)hs_rng_u64(&rng) & ((1u << t.scatterer_count) - 1);
        const double complex echo =
            ref_target_echo(&t, mask, X_BAND_UM * 1e-6, radar_of(bearing, elevation, range_mm));
        const double expected = 20 * log10(cabs(echo));
        if (expected > fmax(strongest_db(&t, &v) - 20, -60)) {
            worst = fmax(worst, fabs(sum_db(&t, &v, mask) - expected));
            seen++;
        }
    }
    print_message("# worst sum %.3f dB over %d targets\n", worst, seen);
    assert_true(seen > 1000);
    assert_true(worst < 0.2);
}

TEST(no_return_sums_to_nothing_and_opposite_ones_cancel)
{
    const struct lm_return pair[2] = {{.rcs_dbsm_q8 = 2560, .phase = 0},
                                      {.rcs_dbsm_q8 = 2560, .phase = FX_BAM_180}};
    assert_int_equal(lm_returns_sum_dbsm_q8(pair, 0), LM_RCS_NONE_DBSM_Q8);
    assert_int_equal(lm_returns_sum_dbsm_q8(pair, 1), 2560);
    assert_true(lm_returns_sum_dbsm_q8(pair, 3) < -60 * 256);
    struct lm_return same[LM_SCATTERERS_MAX];
    for (int i = 0; i < LM_SCATTERERS_MAX; i++) {
        same[i] = (struct lm_return){.rcs_dbsm_q8 = 2560, .phase = 12345};
    }
    assert_true(abs(lm_returns_sum_dbsm_q8(same, 0xFFFF) - 2560 - (int)(20 * log10(16) * 256)) <=
                3);
}

/* Figure 1 of [Heaton] as a test. Nine corner reflectors of one metre, metres apart, all facing the
 * radar's side: one cell that holds them all fluctuates by tens of decibels while the aspect
 * changes by 30 degrees; a cell that holds one of them does not. */
TEST(the_same_corners_are_steady_in_fine_cells_and_fluctuate_in_a_coarse_one)
{
    struct lm_target t = {.id = 1};
    for (int i = 0; i < 9; i++) {
        add_scatterer(&t, LM_SHAPE_TRIHEDRAL, 1000, 7000 * (i / 3) + 400 * (i % 3),
                      6000 * (i % 3) - 300 * (i / 3), 0, 0, 35.264);
    }
    double low[2] = {1e9, -1e9}, one[2] = {1e9, -1e9};
    for (double deg = -15; deg <= 15; deg += 0.01) {
        struct lm_target_view v;
        lm_target_view_set(&v, hs_bam(deg), hs_bam(20), 20000000);
        const double sum = sum_db(&t, &v, 0x1FF), single = sum_db(&t, &v, 1);
        low[0] = fmin(low[0], sum), low[1] = fmax(low[1], sum);
        one[0] = fmin(one[0], single), one[1] = fmax(one[1], single);
    }
    print_message(
        "# over 30 degrees: one corner %.2f to %.2f dBsm, all nine in a cell %.1f to %.1f\n",
        one[0], one[1], low[0], low[1]);
    assert_true(one[1] - one[0] < 2.5);
    assert_true(low[1] - low[0] > 25);
    assert_true(fabs(low[1] - one[1] - 20 * log10(9)) < 1.5);
}

/* ---- fluctuation ---- */

enum { SCANS = 20000, PULSES = 4 };

/* Distribution function of the cross section over its mean. */
static double chance_below(int swerling, double x)
{
    return swerling <= 2 ? 1 - exp(-x) : 1 - (1 + 2 * x) * exp(-2 * x);
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Draws of a target in their place: [scan][pulse], over the mean. */
static double (*draw_all(uint8_t swerling))[PULSES]
{
    double(*power)[PULSES] = malloc(sizeof(double[SCANS][PULSES]));
    assert_non_null(power);
    for (uint32_t s = 0; s < SCANS; s++) {
        for (uint32_t p = 0; p < PULSES; p++) {
            power[s][p] =
                pow(10, (lm_swerling_dbsm_q8(swerling, 3072, 41, s, p) / 256.0 - 12) / 10);
        }
    }
    return power;
}

static double correlation(const double (*x)[PULSES], int scan_step, int pulse_step)
{
    double sum = 0, square = 0, product = 0;
    const int n = SCANS - scan_step;
    for (int s = 0; s < n; s++) {
        const double a = x[s][0], b = x[s + scan_step][pulse_step];
        sum += (a + b) / 2;
        square += (a * a + b * b) / 2;
        product += a * b;
    }
    const double mean = sum / n;
    return (product / n - mean * mean) / (square / n - mean * mean);
}

TEST(swerling_draws_have_the_mean_the_variance_and_the_shape_of_theory)
{
    for (uint8_t c = 1; c <= 4; c++) {
        double(*power)[PULSES] = draw_all(c);
        double column[SCANS], mean = 0, square = 0, distance = 0;
        for (int s = 0; s < SCANS; s++) {
            column[s] = power[s][0];
            mean += column[s] / SCANS;
            square += column[s] * column[s] / SCANS;
        }
        qsort(column, SCANS, sizeof column[0], by_value);
        for (int s = 0; s < SCANS; s++) {
            distance = fmax(distance, fabs(chance_below(c, column[s]) - (s + 0.5) / SCANS));
        }
        const double variance = square - mean * mean;
        print_message(
            "# case %d: mean %.3f, variance %.3f, largest distance of the distribution "
            "%.4f\n",
            c, mean, variance, distance);
        /* Three and a half standard errors of the mean, five or so of the variance, and
         * Kolmogorov's bound at 0.1 %. */
        assert_true(fabs(mean - 1) < 3.5 / sqrt(SCANS));
        assert_true(fabs(variance - (c <= 2 ? 1 : 0.5)) < 0.1);
        assert_true(distance < 1.95 / sqrt(SCANS));
        free(power);
    }
}

TEST(odd_cases_keep_their_draw_for_a_scan_and_even_ones_for_a_pulse)
{
    for (uint8_t c = 1; c <= 4; c++) {
        double(*power)[PULSES] = draw_all(c);
        const double from_scan_to_scan = correlation((const double(*)[PULSES])power, 1, 0);
        const double from_pulse_to_pulse = correlation((const double(*)[PULSES])power, 0, 1);
        assert_true(fabs(from_scan_to_scan) < 0.03);
        assert_true(c % 2 ? from_pulse_to_pulse > 0.999999 : fabs(from_pulse_to_pulse) < 0.03);
        free(power);
    }
}

TEST(a_steady_point_is_steady_and_draws_repeat)
{
    for (uint32_t i = 0; i < 1000; i++) {
        assert_int_equal(lm_swerling_dbsm_q8(0, -700, i, i * 3, i * 7), -700);
        assert_int_equal(lm_swerling_dbsm_q8(2, 500, i, 3, 9),
                         lm_swerling_dbsm_q8(2, 500, i, 3, 9));
    }
    assert_true(lm_swerling_dbsm_q8(1, 500, 1, 3, 0) != lm_swerling_dbsm_q8(1, 500, 2, 3, 0));
}
