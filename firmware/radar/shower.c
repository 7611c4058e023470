#include "shower.h"

#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/units.h"

bool lm_bearing_find(struct lm_position antenna, struct lm_position position, fx_bam_t azimuth,
                     struct lm_bearing *b)
{
    const uint32_t far = 1u << 27;
    if (fx_abs_u32((int32_t)(position.latitude - antenna.latitude)) >= far ||
        fx_abs_u32((int32_t)(position.longitude - antenna.longitude)) >= far) {
        return false;
    }
    fx_bam_t bearing;
    lm_geo_inverse(antenna, position, &b->distance_m_q8, &bearing);
    b->off = bearing - azimuth;
    return true;
}

bool lm_shower_chord(const struct lm_shower *s, fx_bam_t aside, struct lm_chord *chord)
{
    const fx_bam_t off = s->at.off - aside;
    /* Distances are below 2^29, radii below 2^24.7: the squares fit. */
    const int64_t along_m_q8 = ((int64_t)s->at.distance_m_q8 * fx_cos_q30(off)) >> 30;
    const int64_t across_m_q8 = ((int64_t)s->at.distance_m_q8 * fx_sin_q30(off)) >> 30;
    const int64_t radius_m_q8 = lm_m_q8_of_m(s->radius_m);
    const int64_t square = radius_m_q8 * radius_m_q8 - across_m_q8 * across_m_q8;
    const int64_t half_m_q8 = square > 0 ? (int64_t)fx_sqrt_u64((uint64_t)square) : 0;
    if (half_m_q8 == 0 || along_m_q8 + half_m_q8 <= 0) {
        return false;
    }
    chord->from_m_q8 = (int32_t)(along_m_q8 > half_m_q8 ? along_m_q8 - half_m_q8 : 0);
    chord->to_m_q8 = (int32_t)(along_m_q8 + half_m_q8);
    return true;
}

void lm_shower_set_rate(struct lm_shower *s, uint32_t mm_per_h, uint32_t wavelength_um)
{
    /* Loss 2 k R^alpha with k = 0.01217 and alpha = 1.2571, as log2 in Q16; below 2^19.7 dB a
     * kilometre * 65536. */
    const int32_t rate_q16 = fx_log2_q16(fx_max_u32(mm_per_h, 1));
    const uint32_t loss_q16 = fx_exp2_q16((int32_t)((int64_t)rate_q16 * 82385 >> 16) - 351307);
    s->loss_db_per_m_q32 = (uint32_t)(((uint64_t)loss_q16 << 16) / 1000);
    /* Echo pi^5 |K|^2 Z / l^4 with Z = 200 R^1.6: the constants are -132.4479 dB, with 240 dB for
     * the wavelength in micrometres. */
    s->echo_db_q8 = 27533 + fx_db_q8_of_log2_q16((int32_t)((int64_t)rate_q16 * 8 / 5)) -
                    fx_db_q8_of_log2_q16(4 * fx_log2_q16(wavelength_um));
}

/* The rain before a cell's middle is the mean of that before its two edges. Depths are below 2^27.
 * A loss is below 2^31 a metre: 2^26 on the level, and at most 32 times as much on the steepest
 * ray. The product is dB * 256 in Q32. */
void lm_shower_add_loss(const struct lm_shower *s, const struct lm_chord *chord,
                        const struct lm_shower_cells *reach, int32_t *restrict loss_db_q8)
{
    const int32_t step_m_q8 = (int32_t)reach->cell_m_q8;
    const int32_t edge_m_q8 = (int32_t)reach->first_m_q8 - step_m_q8 / 2;
    const struct lm_chord c = *chord;
    for (uint32_t i = 0; i < reach->cells; i++) {
        const int32_t near_m_q8 = edge_m_q8 + (int32_t)i * step_m_q8;
        const int32_t twice_q8 =
            lm_chord_before_m_q8(c, near_m_q8) + lm_chord_before_m_q8(c, near_m_q8 + step_m_q8);
        loss_db_q8[i] += (int32_t)((uint64_t)(uint32_t)twice_q8 * s->loss_db_per_m_q32 >> 33);
    }
}
