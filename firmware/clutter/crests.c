#include "lm/crests.h"

#include "fx/bits.h"
#include "fx/sat.h"

enum { CELL_LEAST_MM = 24000 };

bool lm_crests_are_wanted(const struct lm_db *db, uint8_t lod, bool is_blended, uint32_t cell_mm)
{
    return lod == db->finest && !is_blended && cell_mm >= CELL_LEAST_MM;
}

/* What the crest between cell 0 and cell 1 stands out of cell 0. `fall` is how far the line of
 * sight to cell 0 falls in a cell. Heights are Q14.
 *
 * Ground is -16..33 km high, so that two heights differ by less than 2^29.7. A fall is below 2^26.
 */
static inline int32_t crest_m_q14(const int32_t *z, int32_t fall)
{
    const int32_t near_rise = z[0] - z[-1] + fall, far_rise = z[1] - z[2] - fall;
    const int32_t next = z[1] - z[0] + fall;
    const int32_t bulge =
        fx_min_i32((near_rise >> 4) + (far_rise >> 4), fx_min_i32(near_rise, far_rise) >> 2);
    const int32_t half = next >> 1;
    const int32_t crest = half + bulge;
    return bulge > half && bulge > -half ? crest : 0;
}

void lm_crests_raise(const struct lm_range_grid *grid, struct lm_scan_line *line, int32_t *work)
{
    int32_t *restrict rise = work;
    const int32_t *restrict z = line->elevation_m_q14;
    const int32_t *restrict fall_m_q14 = grid->fall_m_q14;
    const int32_t *restrict inverse_range = grid->inverse_range;
    const uint32_t end = grid->cells - 2;
    /* Cells are at most 100 m long and 4,096 m away or more: the product is below 2^15 * 2^15, the
     * share below 2^9, and ground is less than 2^17 m below the antenna's plane. */
    const int32_t shift = (int32_t)grid->tangent_bits - 5;
    const int32_t cell_m_q8 = (int32_t)grid->cell_m_q8;
    for (uint32_t i = grid->first + 1; i < end; i++) {
        const int32_t share_q14 = (inverse_range[i] >> 16) * cell_m_q8 >> shift;
        const int32_t below_m = (fall_m_q14[i] - z[i]) >> 14;
        rise[i] = crest_m_q14(z + i, below_m * share_q14);
    }
    for (uint32_t i = grid->first + 1; i < end; i++) {
        line->elevation_m_q14[i] += rise[i];
    }
}
