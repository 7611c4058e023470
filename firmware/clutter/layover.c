#include "lm/layover.h"

#include "fx/log.h"
#include "lm/units.h"

/* Coordinate along the line at which the top of cell i is displayed: i less (top - z0) tan psi /
 * ds. Tops are below 2^29.3 and the lean is below 2^17: products are below 2^47. */
static int64_t appears_at_cells_q8(const struct lm_layover *l, uint32_t i, int32_t top_m_q14)
{
    const int64_t above_m_q14 = top_m_q14 - lm_m_q14_of_m_q10(l->reference_m_q10);
    const int64_t nearer_m_q8 = above_m_q14 * l->lean_q16 >> 22;
    return lm_cells_q8_of_cells((int32_t)i) - lm_cells_q8_of_m_q8(nearer_m_q8, l->cell_m_q8);
}

/* Add power to a cell. A sum beyond 64 bits saturates, and power outside the line is lost. */
static void add(const struct lm_layover *l, uint64_t *power_q32, int64_t cell, uint64_t share_q32)
{
    if (cell >= (int64_t)l->first && cell < (int64_t)l->cells) {
        const uint64_t sum_q32 = power_q32[cell] + share_q32;
        power_q32[cell] = sum_q32 < share_q32 ? UINT64_MAX : sum_q32;
    }
}

void lm_layover_run(const struct lm_layover *l, const struct lm_classes *classes,
                    const struct lm_scan_line *ground, int32_t *level_db_q8,
                    uint64_t power_q32[LM_CELLS_ROOM])
{
    /* Power in Q32 is split between the two cells around the displaced coordinate, in proportion to
     * its 8 bits of fraction. The parts sum to the whole exactly: no power is lost inside the
     * line. */
    const int32_t unit_q8 = fx_db_q8_u64((uint64_t)1 << 32);
    for (uint32_t i = l->first; i < l->cells; i++) {
        power_q32[i] = 0;
    }
    for (uint32_t i = l->first; i < l->cells; i++) {
        if (level_db_q8[i] <= LM_LEVEL_SHADOW / 2) {
            continue;
        }
        const int32_t height_m_q14 = lm_m_q14_of_dm(classes->height_dm[ground->cell[i] & 15]);
        const int64_t at_cells_q8 =
            appears_at_cells_q8(l, i, ground->elevation_m_q14[i] + height_m_q14);
        const uint64_t whole_q32 = fx_power_q32_vec(level_db_q8[i]);
        const uint64_t far_q32 = (whole_q32 >> 8) * (uint64_t)(at_cells_q8 & 255);
        add(l, power_q32, at_cells_q8 >> 8, whole_q32 - far_q32);
        add(l, power_q32, (at_cells_q8 >> 8) + 1, far_q32);
    }
    for (uint32_t i = l->first; i < l->cells; i++) {
        level_db_q8[i] = power_q32[i] == 0 ? LM_LEVEL_SHADOW : fx_db_q8_u64(power_q32[i]) - unit_q8;
    }
}
