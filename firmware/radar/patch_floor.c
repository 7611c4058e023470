#include "lm/patch_floor.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"
#include "lm/units.h"

enum { NOTHING_DB_Q8 = LM_DB_Q8(-128) };

_Static_assert((int)LM_PATCH_FLOOR_STRIDE == (int)LM_K_STRIDE, "the kernel takes every fourth");

void lm_patch_floor_clear(struct lm_patch_floor *f)
{
    *f = (struct lm_patch_floor){.lines = 0};
}

/* Mean power of every fourth cell, relative to the ceiling, in Q24. */
static uint32_t mean_of_line_q24(int32_t most_db_q8, uint32_t number, const int16_t *level_db_q8,
                                 uint32_t cells)
{
    const uint32_t first = number % LM_PATCH_FLOOR_STRIDE;
    const uint32_t count =
        (fx_max_u32(cells, first) - first + LM_PATCH_FLOOR_STRIDE - 1) / LM_PATCH_FLOOR_STRIDE;
    return count ? lm_k_sum_powers(level_db_q8 + first, fx_sat_i16(most_db_q8), count) / count : 0;
}

int32_t lm_patch_floor_run(struct lm_patch_floor *f, const struct lm_sar_table *sar,
                           uint32_t number, const int16_t *level_db_q8, uint32_t cells)
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
