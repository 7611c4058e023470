/* Texture and the state of the sea in the reference, against the K distribution. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

/* Mean and variance of a table's 1024 equally likely powers. */
static void moments_of(const double table_db[REF_SPECKLE_SLICES], double *mean, double *variance)
{
    double squares = 0;
    *mean = 0;
    for (int i = 0; i < REF_SPECKLE_SLICES; i++) {
        const double power = pow(10, table_db[i] / 10);
        *mean += power / REF_SPECKLE_SLICES;
        squares += power * power / REF_SPECKLE_SLICES;
    }
    *variance = squares - *mean * *mean;
}

/* Texture and speckle are independent, so the moments of their product are products. */
TEST(texture_times_speckle_is_k_distributed)
{
    struct ref_texture texture;
    double speckle_db[REF_SPECKLE_SLICES];
    for (unsigned nu = 1; nu <= 16; nu *= 2) {
        const struct ref_params params = {.texture_shape = {[LM_KIND_STRUCTURE] = nu}};
        ref_texture_tables(&texture, &params);
        for (unsigned looks = 1; looks <= 16; looks *= 2) {
            double mean, variance, rough_mean, rough_variance;
            ref_speckle_table(looks, speckle_db);
            moments_of(speckle_db, &mean, &variance);
            moments_of(texture.table_db[LM_KIND_STRUCTURE], &rough_mean, &rough_variance);
            const double cv2 = (1 + variance) * (1 + rough_variance) - 1;
            const double expected = (1 + 1.0 / nu) * (1 + 1.0 / looks) - 1;
            assert_true(fabs(mean - 1) < 1e-9 && fabs(rough_mean - 1) < 1e-9);
            /* A slice keeps its mean and loses its own spread, 0.2 % of an exponential's. */
            assert_true(cv2 < expected && cv2 > 0.99 * expected);
        }
    }
}

TEST(each_kind_has_its_own_texture_and_only_water_the_sea)
{
    const struct ref_params params = {
        .texture_shape = {[LM_KIND_STRUCTURE] = 2, [LM_KIND_TREES] = 4}, .sea_db = ref_sea_db(5)};
    static struct ref_texture texture;
    ref_texture_tables(&texture, &params);
    for (uint32_t slice = 0; slice < REF_SPECKLE_SLICES; slice += 31) {
        struct ref_bin bins[LM_KINDS] = {{0}};
        double nu2_db[REF_SPECKLE_SLICES], nu4_db[REF_SPECKLE_SLICES];
        ref_speckle_table(2, nu2_db);
        ref_speckle_table(4, nu4_db);
        for (int kind = 0; kind < LM_KINDS; kind++) {
            bins[kind].kind = kind;
            bins[kind].texture_slice = slice;
        }
        ref_texture(bins, LM_KINDS, &texture, &params);
        assert_true(bins[LM_KIND_GROUND].texture_db == 0);
        assert_true(bins[LM_KIND_WATER].texture_db == 10); /* -40 dB to -30 dB */
        assert_true(bins[LM_KIND_STRUCTURE].texture_db == nu2_db[slice]);
        assert_true(bins[LM_KIND_TREES].texture_db == nu4_db[slice]);
    }
}

TEST(texture_is_the_grounds_and_not_the_noises)
{
    static const double no_speckle[REF_SPECKLE_SLICES];
    struct ref_bin bins[2] = {{.is_lit = true, .level_db = -20, .texture_db = 7},
                              {.is_lit = false, .level_db = -20, .texture_db = 7}};
    ref_speckle(bins, 2, no_speckle, -30);
    assert_true(fabs(bins[0].echo_db - 10 * log10(pow(10, -1.3) + 1e-3)) < 1e-9);
    assert_true(fabs(bins[1].echo_db + 30) < 1e-9);
}
