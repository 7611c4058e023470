#include "lm/target_view.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/const.h"
#include "lm/illumination.h"
#include "lm/units.h"

enum { GRAZING_MIN_Q24 = 1 << 16 /* 1/256, as in the range grid */ };

/* Two steps: the inverse problem on a plane, then a correction by the direct problem. The first is
 * good to 0.2 % of the distance. What it misses by is so short that its own error does not count.
 * Near a pole the steps do not agree, and the target has no position. */
bool lm_target_view_locate(struct lm_position from, struct lm_position to, uint32_t *distance_m_q8,
                           fx_bam_t *azimuth)
{
    struct lm_geo_origin origin;
    uint32_t miss_m_q8;
    fx_bam_t miss_azimuth;
    lm_geo_inverse(from, to, distance_m_q8, azimuth);
    if (*distance_m_q8 > LM_M_Q8(300000u)) {
        return false;
    }
    lm_geo_set_origin(&origin, from);
    const struct lm_position reached = lm_geo_direct(&origin, *azimuth, *distance_m_q8);
    lm_geo_inverse(reached, to, &miss_m_q8, &miss_azimuth);
    if (miss_m_q8 > *distance_m_q8 / 16 + LM_M_Q8(1)) {
        return false;
    }
    const fx_bam_t turn = miss_azimuth - *azimuth;
    const int32_t on_m_q8 = (int32_t)((int64_t)miss_m_q8 * fx_cos_q30(turn) >> 30);
    const int32_t aside_m_q8 = (int32_t)((int64_t)miss_m_q8 * fx_sin_q30(turn) >> 30);
    const int32_t along_m_q8 = (int32_t)*distance_m_q8 + on_m_q8;
    *distance_m_q8 = fx_hypot_u32(along_m_q8, aside_m_q8);
    *azimuth += fx_atan2(aside_m_q8, along_m_q8);
    return true;
}

/* Drop of the curved Earth below the horizontal at a ground range, r^2 / 2a. A range of 400 km is
 * 2^26.6. Its square in units of 16 m2 times the curvature is 2^57.2. */
static int32_t drop_m_q10(uint32_t range_m_q8)
{
    return (int32_t)(((((int64_t)range_m_q8 * range_m_q8) >> 20) * LM_CURVATURE_Q48) >> 34);
}

void lm_target_view_of(struct lm_target_view *v, const struct lm_target_candidate *candidate,
                       fx_bam_t back, uint32_t range_m_q8, const struct lm_target_heights *h)
{
    /* Heights are within 2^25.9 and 2^24 in Q10, ranges below 2^27 in Q8: all lengths are below
     * 2^29 in Q10. */
    const uint32_t held_m_q8 = fx_min_u32(range_m_q8, LM_M_Q8(400000u));
    const int32_t range_m_q10 = lm_m_q10_of_m_q8((int32_t)held_m_q8);
    const int32_t above_m_q10 =
        h->antenna_m_q10 - lm_m_q10_of_m_q6(candidate->elevation_m_q6) - drop_m_q10(held_m_q8);
    const uint64_t slant_m_q10 = fx_hypot_u32(range_m_q10, above_m_q10);
    lm_target_view_set(v, back - candidate->state.heading, fx_atan2(above_m_q10, range_m_q10),
                       lm_mm_of_m_q10(slant_m_q10));
}

int32_t lm_target_view_rcs_dbsm_q8(const struct lm_target_set *set,
                                   const struct lm_target_body *body,
                                   const struct lm_target_view *v, uint32_t scan, uint32_t pulse)
{
    const struct lm_signature *s = lm_target_signature(set, body);
    if (s) {
        return lm_signature_rcs_dbsm_q8(s, v->bearing, v->elevation);
    }
    return body->flags & LM_TARGET_HAS_SIGNATURE
               ? LM_RCS_NONE_DBSM_Q8
               : lm_swerling_dbsm_q8(body->swerling, body->mean_rcs_dbsm_q8, body->id, scan, pulse);
}

int64_t lm_target_view_tangent_q38(int32_t top_m_q10, uint32_t range_m_q8,
                                   const struct lm_target_heights *h)
{
    const int64_t apparent_m_q10 = (int64_t)top_m_q10 - h->antenna_m_q10 - drop_m_q10(range_m_q8);
    return apparent_m_q10 * ((int64_t)1 << 36) /
           (int64_t)fx_max_u32(range_m_q8, LM_M_Q8(LM_RANGE_MIN_M));
}

/* Range times turns, 2^26.6 * 2^32, cut to Q16; times 2 pi in Q26 it is below 2^63. */
uint64_t lm_arc_m_q8(uint32_t range_m_q8, fx_bam_t width)
{
    const uint64_t turns_q16 = (uint64_t)range_m_q8 * width >> 24;
    return turns_q16 * FX_TWO_PI_Q26 >> 34;
}

uint32_t lm_target_grazing_q24(uint32_t range_m_q8, uint32_t before_m_q8,
                               const struct lm_target_heights *h)
{
    /* As in the receiver's gain: g = h / s - s' / 2a, with s' the range of the cell before. The
     * height is below 2^26 in Q10; times 2^22 it is below 2^48. */
    const int64_t above_m_q10 = (int64_t)h->antenna_m_q10 - h->reference_m_q10;
    const int64_t grazing_q24 = above_m_q10 * (1 << 22) / (int64_t)fx_max_u32(range_m_q8, 1) -
                                ((int64_t)before_m_q8 * LM_CURVATURE_Q48 >> 32);
    return (uint32_t)fx_clamp_i64(grazing_q24, GRAZING_MIN_Q24, UINT32_MAX);
}

int32_t lm_clutter_area_dbm2_q8(uint64_t width_m_q8, uint32_t cell_m_q8, uint32_t range_m_q8,
                                uint32_t before_m_q8, const struct lm_target_heights *h)
{
    return fx_db_q8_of_log2_q16(fx_log2_q16_u64(width_m_q8) + fx_log2_q16(cell_m_q8) +
                                fx_log2_q16(lm_target_grazing_q24(range_m_q8, before_m_q8, h)) -
                                (8 + 8 + 24) * 65536);
}
