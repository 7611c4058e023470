/* How the radar sees a target: where it is from here, at which tangent it appears, and how large a
 * cell of clutter is beside it. What sector and patch have in common; docs/EQUATIONS.md, "Targets".
 */
#ifndef LM_TARGET_VIEW_H
#define LM_TARGET_VIEW_H

#include "lm/target_candidates.h"

/* The antenna's height and that of the time gain's flat ground, metres * 1024. */
struct lm_target_heights {
    int32_t antenna_m_q10, reference_m_q10;
};

/* The place of a target from an origin, as PROJ's geodesics have it within a metre at 70 km. False
 * when there is none to be had: beyond 300 km, near a pole. Cost: about 1400 instructions. */
bool lm_target_view_locate(struct lm_position from, struct lm_position to, uint32_t *distance_m_q8,
                           fx_bam_t *azimuth);

/* The view that its bodies have of the radar, which lies in direction `back` from it at a ground
 * range of range_m_q8. */
void lm_target_view_of(struct lm_target_view *v, const struct lm_target_candidate *candidate,
                       fx_bam_t back, uint32_t range_m_q8, const struct lm_target_heights *h);

/* Cross section of a target without bodies, dBsm * 256: by its signature as `v` sees it, or as it
 * fluctuates (lm_swerling_dbsm_q8). LM_RCS_NONE_DBSM_Q8 for one whose signature was lost. */
int32_t lm_target_view_rcs_dbsm_q8(const struct lm_target_set *set, const struct lm_target *t,
                                   const struct lm_target_view *v, uint32_t scan, uint32_t pulse);

/* Tangent of the elevation angle at which a height (metres * 1024, below 2^26) appears, Q38. */
int64_t lm_target_view_tangent_q38(int32_t top_m_q10, uint32_t range_m_q8,
                                   const struct lm_target_heights *h);

/* Metres * 256 of an arc of `width` at a range of 2^26.6 at most. */
uint64_t lm_arc_m_q8(uint32_t range_m_q8, fx_bam_t width);

/* 10 log10 of a cell's area as flat ground shows it, w ds g, in 1/256 dB of a square metre.
 * `before_m_q8` is the range of the cell before, or that of the cell itself when it is the first.
 */
int32_t lm_clutter_area_dbm2_q8(uint64_t width_m_q8, uint32_t cell_m_q8, uint32_t range_m_q8,
                                uint32_t before_m_q8, const struct lm_target_heights *h);

#endif
