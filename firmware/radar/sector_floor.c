#include "lm/sector_floor.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/config.h"

void lm_sector_floor_clear(struct lm_sector_floor *f)
{
    f->lines = 0;
    f->mean_q32 = 0;
}

void lm_sector_floor_set(struct lm_sector_floor *f, int32_t leak_db_q8, int32_t most_db_q8,
                         uint32_t beam, uint32_t line)
{
    /* A power in Q16 that is cut to 2^24 - 1 fits 32 bits in Q24. */
    f->most_q24 = fx_min_u32(fx_power_q16_from_db_q8(most_db_q8), (1u << 24) - 1) << 8;
    f->leak_q16 = fx_min_u32(fx_power_q16_from_db_q8(leak_db_q8), 65536);
    f->lines_max = fx_max_u32(beam / line, 1);
    f->lines = fx_min_u32(f->lines, f->lines_max);
}

/* Mean of every fourth bin. */
static uint32_t mean_of_line_q24(uint32_t most_q24, uint32_t number, const uint32_t *power_q24,
                                 uint32_t bins)
{
    const uint32_t first = number % LM_SECTOR_FLOOR_STRIDE;
    const uint32_t count =
        (fx_max_u32(bins, first) - first + LM_SECTOR_FLOOR_STRIDE - 1) / LM_SECTOR_FLOOR_STRIDE;
    const uint32_t *const sample_q24 = power_q24 + first;
    uint64_t sum_q24 = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum_q24 += fx_min_u32(sample_q24[i * LM_SECTOR_FLOOR_STRIDE], most_q24);
    }
    return count ? (uint32_t)(sum_q24 / count) : 0;
}

uint32_t lm_sector_floor_run(struct lm_sector_floor *f, uint32_t number, const uint32_t *power_q24,
                             uint32_t bins)
{
    /* Both are below 2^40, and the mean stays between them. */
    const int64_t mean_q32 = (int64_t)f->mean_q32;
    const int64_t line_q32 = (int64_t)mean_of_line_q24(f->most_q24, number, power_q24, bins) << 8;
    f->lines = fx_min_u32(f->lines + 1, f->lines_max);
    f->mean_q32 = (uint64_t)(mean_q32 + (line_q32 - mean_q32) / (int64_t)f->lines);
    return (uint32_t)((f->mean_q32 >> 8) * f->leak_q16 >> 16);
}
