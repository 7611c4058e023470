#include "lm/patch_floor.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"
#include "lm/lanes.h"
#include "lm/units.h"

enum { NOTHING_DB_Q8 = LM_DB_Q8(-128), SAMPLES_MAX = LM_CELLS_MAX / LM_PATCH_FLOOR_STRIDE };

_Static_assert(SAMPLES_MAX <= 256, "their powers of at most 2^24 add up to less than 2^32");

void lm_patch_floor_clear(struct lm_patch_floor *f)
{
    *f = (struct lm_patch_floor){.lines = 0};
}

/* Mean power of every fourth cell, relative to the ceiling, in Q24. */
static uint32_t mean_of_line_q24(int32_t most_db_q8, uint32_t number, const int32_t *level_db_q8,
                                 uint32_t cells)
{
    const uint32_t first = number % LM_PATCH_FLOOR_STRIDE;
    const uint32_t count =
        (fx_max_u32(cells, first) - first + LM_PATCH_FLOOR_STRIDE - 1) / LM_PATCH_FLOOR_STRIDE;
    const int32_t *const sample_db_q8 = level_db_q8 + first;
    uint32_t power[SAMPLES_MAX + LM_LANES], sum_q24 = 0;
    for (uint32_t i = 0; i < count; i++) {
        const int32_t db_q8 = sample_db_q8[i * LM_PATCH_FLOOR_STRIDE];
        power[i] = (uint32_t)fx_min_i32(db_q8 - most_db_q8, 0);
    }
    lm_k_powers_of_levels(power, count);
    for (uint32_t i = 0; i < count; i++) {
        sum_q24 += power[i];
    }
    return count ? sum_q24 / count : 0;
}

int32_t lm_patch_floor_run(struct lm_patch_floor *f, const struct lm_sar_table *sar,
                           uint32_t number, const int32_t *level_db_q8, uint32_t cells)
{
    const int32_t most_db_q8 = sar->ground_leak_most_db_q8;
    const int32_t line_q28 =
        (int32_t)(mean_of_line_q24(most_db_q8, number, level_db_q8, cells) << 4);
    f->lines = fx_min_u32(f->lines + 1, LM_PATCH_FLOOR_LINES);
    /* Both are below 2^28 + 2^13, and the mean stays between them. */
    const int32_t mean_q28 = (int32_t)f->mean_q28;
    f->mean_q28 = (uint32_t)(mean_q28 + (line_q28 - mean_q28) / (int32_t)f->lines);
    const int32_t mean_db_q8 =
        f->mean_q28 ? fx_db_q8(f->mean_q28) - fx_db_q8(1u << 28) : NOTHING_DB_Q8;
    return fx_max_i32(mean_db_q8 + most_db_q8 + sar->ground_leak_db_q8, NOTHING_DB_Q8);
}
