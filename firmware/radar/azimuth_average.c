#include "lm/azimuth_average.h"

#include "fx/const.h"
#include "fx/mem.h"
#include "fx/tables.h"
#include "lm/kernels_radar.h"
#include "lm/level.h"
#include "lm/radar.h"

_Static_assert((int)LM_AZIMUTH_AVERAGE_LOG2_MAX == (int)LM_RADAR_AZIMUTHS_LOG2_MAX,
               "what the table may ask for");

int32_t lm_azimuth_average_offset(fx_bam_t spacing, uint32_t azimuths_log2, uint32_t turn)
{
    const uint32_t azimuths = 1u << azimuths_log2, half = azimuths / 2;
    const uint32_t part = turn < half ? turn : azimuths - 1 - (turn - half);
    /* The spacing is below 2^32, and the odd number below 16: the product is below 2^36. */
    const uint64_t from_left = (uint64_t)spacing * (2 * part + 1) >> (azimuths_log2 + 1);
    return (int32_t)((int64_t)from_left - spacing / 2);
}

void lm_azimuth_average_begin(struct lm_azimuth_average *f, const int16_t *level_db_q8,
                              uint32_t cells)
{
    memcpy(f->sum_db_q8, level_db_q8, cells * sizeof *level_db_q8);
}

void lm_azimuth_average_add(struct lm_azimuth_average *f, const int16_t *level_db_q8,
                            uint32_t cells)
{
    lm_k_levels_add(f->sum_db_q8, level_db_q8, cells);
}

void lm_azimuth_average_mean(const struct lm_azimuth_average *f, uint32_t azimuths_log2,
                             int16_t *level_db_q8, uint32_t cells)
{
    const int32_t azimuths_db_q8 = ((int32_t)azimuths_log2 * FX_DB_PER_OCTAVE_Q14 + 32) / 64;
    lm_k_levels_mean(f->sum_db_q8, (int16_t)azimuths_db_q8, level_db_q8, cells);
}
