#include "lm/footprint.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/aspect.h"

int32_t lm_footprint_offset(fx_bam_t spacing, uint32_t azimuths_log2, uint32_t turn)
{
    const uint32_t azimuths = 1u << azimuths_log2;
    const uint32_t part = (turn + azimuths / 2 + 1) % azimuths;
    /* A spacing of at most a circle times an odd number below 16. */
    const uint64_t from_left = (uint64_t)spacing * (2 * part + 1) >> (azimuths_log2 + 1);
    return (int32_t)((int64_t)from_left - spacing / 2);
}

void lm_footprint_clear(struct lm_footprint *f, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        f->power_q24[i] = 0;
    }
}

void lm_footprint_add(struct lm_footprint *f, const int32_t *restrict level_q8, uint32_t cells,
                      uint32_t azimuths_log2)
{
    uint32_t *restrict power_q24 = f->power_q24;
    for (uint32_t i = 0; i < cells; i++) {
        /* So many shares of less than 2^32 add up to less. */
        power_q24[i] += fx_power_q24_of_many(level_q8[i]) >> azimuths_log2;
    }
}

void lm_footprint_levels(const struct lm_footprint *f, int32_t *restrict level_q8, uint32_t cells)
{
    const uint32_t *restrict power_q24 = f->power_q24;
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t mean_q8 = fx_db_q8_of_many(power_q24[i]) - 24 * FX_DB_OCTAVE_Q14 / 64;
        level_q8[i] = fx_max_i32(mean_q8, LM_LEVEL_SHADOW);
    }
}
