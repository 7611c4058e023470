#include "lm/sector_floor.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"

enum { STRIDE = LM_SECTOR_FLOOR_STRIDE, MIN_LOG2 = LM_SECTOR_FLOOR_BINS_LOG2_MIN };

_Static_assert((1 << MIN_LOG2) % STRIDE == 0, "all stretches are sampled alike");
_Static_assert((int)MIN_LOG2 == LM_K_SLOPE_PLACES,
               "the longest step is that of the shortest stretch");

void lm_sector_floor_clear(struct lm_sector_floor *f)
{
    f->lines = 0;
    for (uint32_t n = 0; n < LM_SECTOR_FLOOR_STRETCHES; n++) {
        f->mean_q29[n] = 0;
    }
}

/* Longer ones than a line are one, as long as that. */
static uint32_t bins_log2_of(uint32_t cell_m_q8)
{
    uint32_t log2 = MIN_LOG2;
    while (((uint32_t)LM_CELLS_MAX >> log2) != 0 &&
           (uint64_t)cell_m_q8 << log2 < (uint64_t)LM_SECTOR_FLOOR_REACH_M << 8) {
        log2++;
    }
    return log2;
}

void lm_sector_floor_set(struct lm_sector_floor *f, const struct lm_sector_floor_setting *setting)
{
    const uint32_t bins_log2 = bins_log2_of(setting->cell_m_q8);
    if (f->bins_log2 != bins_log2) {
        lm_sector_floor_clear(f);
    }
    f->bins_log2 = bins_log2;
    f->most_q24 = fx_min_u32(fx_power_q16_from_db_q8(setting->most_db_q8), (1u << 18) - 1) << 8;
    f->leak_q16 = fx_min_u32(fx_power_q16_from_db_q8(setting->leak_db_q8), 65536);
    f->lines_max = fx_max_u32(setting->beam / setting->line, 1);
    f->lines = fx_min_u32(f->lines, f->lines_max);
}

/* Mean of every fourth bin. */
static uint32_t mean_of_bins_q24(uint32_t most_q24, uint32_t number, const uint32_t *power_q24,
                                 uint32_t bins)
{
    const uint32_t first = number % STRIDE;
    const uint32_t count = (fx_max_u32(bins, first) - first + STRIDE - 1) / STRIDE;
    const uint32_t *const sample_q24 = power_q24 + first;
    uint64_t sum_q24 = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum_q24 += fx_min_u32(sample_q24[i * STRIDE], most_q24);
    }
    return count ? (uint32_t)(sum_q24 / count) : 0;
}

static void take_line(struct lm_sector_floor *f, uint32_t number, const uint32_t *power_q24,
                      uint32_t bins, uint32_t stretches)
{
    const uint32_t length = 1u << f->bins_log2;
    f->lines = fx_min_u32(f->lines + 1, f->lines_max);
    for (uint32_t n = 0; n < stretches; n++) {
        const uint32_t first = n * length, count = n + 1 < stretches ? length : bins - first;
        /* Both are below 2^31, and the mean stays between them. */
        const int32_t mean_q29 = (int32_t)f->mean_q29[n];
        const int32_t line_q29 =
            (int32_t)(mean_of_bins_q24(f->most_q24, number, power_q24 + first, count) << 5);
        f->mean_q29[n] = (uint32_t)(mean_q29 + (line_q29 - mean_q29) / (int32_t)f->lines);
    }
}

/* What stretch `n` leaves: below 2^26. */
static uint32_t left_q24(const struct lm_sector_floor *f, uint32_t n)
{
    return (uint32_t)((uint64_t)f->mean_q29[n] * f->leak_q16 >> 21);
}

void lm_sector_floor_run(struct lm_sector_floor *f, uint32_t number, uint32_t *power_q24,
                         uint32_t bins)
{
    const uint32_t length = 1u << f->bins_log2, stretches = fx_max_u32(bins >> f->bins_log2, 1);
    take_line(f, number, power_q24, bins, stretches);
    uint32_t first = 0, from = left_q24(f, 0);
    for (uint32_t n = 0; n < stretches; n++) {
        const uint32_t middle = fx_min_u32(n * length + length / 2, bins), to = left_q24(f, n);
        /* Division rounds towards 0, so that the floor stays between both and below 2^26. A step
         * down is negative, and wraps in unsigned arithmetic. */
        const int32_t step_q5 = (int32_t)(to - from) / (int32_t)(length >> LM_K_SLOPE_PLACES);
        lm_k_add_slope(power_q24 + first, middle - first, from, (uint32_t)step_q5);
        first = middle;
        from = to;
    }
    lm_k_add_slope(power_q24 + first, bins - first, from, 0);
}
