#include "lm/sea.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/class_kind.h"
#include "lm/const.h"
#include "lm/environment.h"
#include "lm/kernels_clutter.h"

enum {
    GRAZING_MIN_Q24 = 1 << 16, /* 1/256, as the receiver's gain has it */
    NOTHING_Q8 = 3,            /* less of a fall is none: lm/log.h is no more exact */
    WIND_STEPS = 64,
    GROUP = 16
};

/* [GIT]: mean wave height 4.52e-3 V^2.5 metres at a wind of V = 2.15 q^1.04 metres a second, which
 * is 0.030636 q^2.6. State 0 is flatter than the law knows; it counts as a half. */
static int32_t wave_height_log2_q16(uint8_t state)
{
    const int32_t one_q16 = -329553; /* log2(0.030636) */
    const int32_t state_q16 =
        state == 0 ? -65536 : fx_log2_q16(fx_min_u32(state, LM_SEA_STATE_MAX));
    return one_q16 + state_q16 * 13 / 5;
}

/* [GIT]: (l + 0.015) / ((14.4 l + 5.5) h), with l the wavelength and h the height of the waves. In
 * micrometres l is at most 10^6: all terms are below 2^25. */
static int32_t critical_q16(uint32_t wavelength_um, uint8_t state)
{
    const int32_t over_q16 = fx_log2_q16(wavelength_um + 15000);
    const int32_t under_q16 = fx_log2_q16(wavelength_um * 72 / 5 + 5500000);
    return over_q16 - under_q16 - wave_height_log2_q16(state);
}

/* Gain at a look `off` from where the wind comes from. */
static int32_t wind_at_db_q8(const struct lm_sea *s, fx_bam_t off)
{
    return s->wind_db_q8[0] + (s->wind_db_q8[1] * fx_cos_q15(off) >> 15) +
           (s->wind_db_q8[2] * fx_cos_q15(2 * off) >> 15);
}

/* Set the harmonics that pass through the three looks of the table, and lower them such that the
 * mean power over all looks is that of the state. A power is below 10^1.3, 2^20.4 in Q16. */
static void set_wind(struct lm_sea *s, const struct lm_sea_config *wind)
{
    const int32_t up = wind->upwind_db_q8, cross = wind->crosswind_db_q8,
                  down = wind->downwind_db_q8;
    uint32_t sum_q16 = 0;
    s->wind_db_q8[0] = (up + 2 * cross + down) / 4;
    s->wind_db_q8[1] = (up - down) / 2;
    s->wind_db_q8[2] = (up - 2 * cross + down) / 4;
    for (uint32_t n = 0; n < WIND_STEPS; n++) {
        sum_q16 += fx_power_q16_from_db_q8(wind_at_db_q8(s, n * (FX_BAM_180 / (WIND_STEPS / 2))));
    }
    s->wind_db_q8[0] -= fx_db_q8(sum_q16) - fx_db_q8(WIND_STEPS << 16);
}

void lm_sea_set(struct lm_sea *s, const struct lm_radar *radar, const struct lm_classes *classes,
                uint8_t state, const fx_bam_t *wind_from)
{
    s->water = 0;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        s->water |= (uint32_t)((classes->entry[i].kind & (LM_KINDS - 1)) == LM_KIND_WATER) << i;
    }
    s->critical_q16 = critical_q16(radar->wavelength_um, state);
    s->has_wind = wind_from != NULL;
    s->wind_from = wind_from ? *wind_from : 0;
    if (s->has_wind) {
        set_wind(s, &radar->sea);
    }
    s->even_db_q8 = 0;
    s->first = s->cells = 0;
}

/* -10 log10(1 + x^-4) for x the grazing angle over the critical one: log2 x is within 40. */
static int32_t fall_db_q8(int32_t over_q16)
{
    const int32_t fall_q8 = fx_db_q8_sum_vec(0, -fx_db_q8_of_log2_q16(4 * over_q16));
    return fall_q8 < NOTHING_Q8 ? 0 : -fx_min_i32(fall_q8, LM_SEA_FALL_MAX_DB_Q8);
}

void lm_sea_set_cells(struct lm_sea *s, const struct lm_range_grid *grid, uint32_t first_m_q8)
{
    const int64_t above_m_q10 = (int64_t)grid->height_m_q10 - grid->reference_m_q10;
    s->cells = s->first = grid->cells;
    for (uint32_t i = grid->cells; i-- > grid->first;) {
        const int64_t range_m_q8 = (int64_t)first_m_q8 + (int64_t)i * grid->cell_m_q8;
        /* The height is below 2^26 times 2^22. The curvature's is a range below 2^27, times 2^24.
         * Cells from `first` on are LM_RANGE_MIN_M away or more. */
        const int64_t grazing_q24 = above_m_q10 * (1 << 22) / (range_m_q8 ? range_m_q8 : 1) -
                                    (range_m_q8 * LM_CURVATURE_Q48 >> 32);
        const uint32_t seen_q24 = (uint32_t)fx_clamp_i64(grazing_q24, GRAZING_MIN_Q24, INT32_MAX);
        s->cell_db_q8[i] = fall_db_q8(fx_log2_q16(seen_q24) - (24 << 16) - s->critical_q16);
        s->first = s->cell_db_q8[i] != 0 ? i : s->first;
    }
    for (uint32_t i = 0; i < grid->first; i++) {
        s->cell_db_q8[i] = 0;
    }
}

void lm_sea_look(struct lm_sea *s, fx_bam_t azimuth)
{
    s->even_db_q8 = s->has_wind ? wind_at_db_q8(s, azimuth - s->wind_from) : 0;
}

void lm_sea_run(const struct lm_sea *s, const uint32_t *cell, int16_t *level_db_q8)
{
    const uint32_t from = s->even_db_q8 != 0 ? 0 : s->first / GROUP * GROUP;
    if (from < s->cells && s->water != 0) {
        lm_k_water_gain(s->water, s->even_db_q8, s->cell_db_q8 + from, cell + from,
                        level_db_q8 + from, s->cells - from);
    }
}
