/* Target view: how the radar sees a target. It gives the target's direction and range, the tangent
 * at which it appears, and the area of the clutter cell beside it. Sectors and patches share it.
 * Source: docs/EQUATIONS.md, "Targets". No call fails unless its comment says so; nothing is kept.
 *
 *     antenna  o- - - - - - - - - - - - horizontal at the antenna
 *              |  .  depression
 *              |     .
 *              |        .             elevation: the same ray, at the target
 *     reference -----------.--o------ flat ground, where g is the tangent of grazing
 *              |<- range_m_q8 ->|     ground range */
#ifndef LM_TARGET_VIEW_H
#define LM_TARGET_VIEW_H

#include "lm/target_candidates.h"

/* Heights of the antenna and of the flat ground that the receiver's gain assumes. Both are above
 * mean sea level and within 2^26 (64 km). */
struct lm_target_heights {
    int32_t antenna_m_q10, reference_m_q10;
};

/* Find distance and azimuth of `to` from `from`, within a metre of PROJ's geodesics at 70 km.
 * False, with both outputs unspecified, if
 * - the distance is more than 300 km, or
 * - the position is too near a pole for the two steps of the solution to agree.
 * Cost: about 1400 instructions. */
bool lm_target_view_locate(struct lm_position from, struct lm_position to, uint32_t *distance_m_q8,
                           fx_bam_t *azimuth);

/* Set the view that the candidate's scatterers have of the radar. `back` is the direction from the
 * target to the radar. `range_m_q8` is the ground range, counted as 400 km if it is more. */
void lm_target_view_of(struct lm_target_view *v, const struct lm_target_candidate *candidate,
                       fx_bam_t back, uint32_t range_m_q8, const struct lm_target_heights *h);

/* Cross section of a target without scatterers: of its signature as `v` sees it, or one draw of
 * lm_swerling_dbsm_q8. LM_RCS_NONE_DBSM_Q8 if its signature was lost. `scan` and `pulse` choose the
 * draw. */
int32_t lm_target_view_rcs_dbsm_q8(const struct lm_target_set *set,
                                   const struct lm_target_body *body,
                                   const struct lm_target_view *v, uint32_t scan, uint32_t pulse);

/* Tangent of the elevation angle at which a height appears from the antenna, with the Earth's
 * curvature. top_m_q10 is below 2^26; ranges below LM_RANGE_MIN_M count as that. */
int64_t lm_target_view_tangent_q38(int32_t top_m_q10, uint32_t range_m_q8,
                                   const struct lm_target_heights *h);

/* Length of an arc of `width` at a range of at most 2^26.6 (400 km). */
uint64_t lm_arc_m_q8(uint32_t range_m_q8, fx_bam_t width);

/* Tangent of grazing on flat ground at a range, at least 1/256 and held to 32 bits. `before_m_q8`
 * is the range of the cell before this one. */
uint32_t lm_target_grazing_q24(uint32_t range_m_q8, uint32_t before_m_q8,
                               const struct lm_target_heights *h);

/* Area of a clutter cell on flat ground, w ds g, as 10 log10 of square metres. A cross section less
 * this is the gamma that the cell would need. `before_m_q8` is the range of the cell before this
 * one; for the first cell it is range_m_q8 itself. g is at least 1/256. */
int32_t lm_clutter_area_dbm2_q8(uint64_t width_m_q8, uint32_t cell_m_q8, uint32_t range_m_q8,
                                uint32_t before_m_q8, const struct lm_target_heights *h);

#endif
