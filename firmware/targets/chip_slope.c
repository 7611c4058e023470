#include "lm/chip_slope.h"

#include "fx/sat.h"
#include "lm/units.h"

/* Grazing is 1/256 or more and a cell 1/4 m or more: 2^56 / (2^16 2^6) is 2^34 cells in Q16, held
 * to 2^26. */
void lm_chip_slope_set(struct lm_chip_slope *slope, int32_t foot_m_q10, uint32_t range_m_q8,
                       uint32_t cell_m_q8, const struct lm_target_heights *h)
{
    const uint64_t most = 1 << 26;
    const struct lm_target_heights above = {h->antenna_m_q10, foot_m_q10};
    const uint64_t sinks_q32 =
        (uint64_t)lm_target_grazing_q24(range_m_q8, range_m_q8, &above) * cell_m_q8;
    const uint64_t cells_q16 = ((uint64_t)1 << 48) / (sinks_q32 == 0 ? 1 : sinks_q32);
    *slope =
        (struct lm_chip_slope){.foot_m_q14 = foot_m_q10 * 16,
                               .cells_a_metre_q16 = (uint32_t)(cells_q16 < most ? cells_q16 : most),
                               .stretch_q16 = 1 << 16};
}

/* 2^31 * 2^26, of Q14 times Q16 to Q8. */
int64_t lm_chip_slope_level_cells_q8(const struct lm_chip_slope *slope, int32_t beyond_cells_q8,
                                     int32_t rise_m_q14)
{
    return beyond_cells_q8 + ((int64_t)rise_m_q14 * slope->cells_a_metre_q16 >> 22);
}

/* A place y beyond the origin is as much as y s higher, and shown at y (1 - s lean). */
void lm_chip_slope_lean(struct lm_chip_slope *slope, int32_t ground_m_q14, int32_t rise_m_q14,
                        uint32_t length_m_q8, int32_t lean_q16)
{
    /* Heights are within 2^30 in Q14: below 2^40, and less than 2^57 times the lean. */
    const int64_t slope_q16 = (int64_t)rise_m_q14 * 1024 / (int64_t)length_m_q8;
    const int64_t shown_q16 = 65536 - (slope_q16 * lean_q16 >> 16);
    const int64_t held_q16 =
        fx_clamp_i64(shown_q16, LM_CHIP_STRETCH_MIN_Q16, LM_CHIP_STRETCH_MAX_Q16);
    slope->is_known = true;
    slope->ground_m_q14 = ground_m_q14;
    slope->stretch_q16 = (uint32_t)(((int64_t)1 << 32) / held_q16);
}
