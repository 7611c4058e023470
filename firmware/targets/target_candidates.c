#include "lm/target_candidates.h"

#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/scan_line.h"
#include "lm/units.h"

const struct lm_signature *lm_target_signature(const struct lm_target_set *set,
                                               const struct lm_target *t)
{
    const bool has_one = (t->flags & LM_TARGET_HAS_SIGNATURE) &&
                         t->signature < set->signature_count &&
                         set->signatures[t->signature].aspects != 0;
    return has_one ? &set->signatures[t->signature] : NULL;
}

static int32_t origin_elevation_m_q6(const struct lm_target *t, struct lm_position position,
                                     const struct lm_target_query *query)
{
    if (!(t->flags & LM_TARGET_ABOVE_GROUND)) {
        return t->elevation_m_q6;
    }
    /* Both are within 2^20 in Q6: the terrain because tiles are checked, the height above it
     * because the record is. */
    const int32_t ground_m_q10 =
        query->tiles ? lm_scan_elevation(query->tiles, query->lod, position,
                                         lm_m_q10_of_m_q6(query->tiles->db->mean_elevation_m_q6))
                     : 0;
    return t->elevation_m_q6 + lm_m_q6_of_m_q10(ground_m_q10);
}

/* Error of an approximate position. lm_geo_inverse and a plane are right within 1/256 of the
 * distance up to 75 degrees of latitude, and within 1/64 up to 88. A plane is right within 16 m for
 * the way that the antenna has gone since the selection. */
static uint32_t position_error_m_q8(struct lm_position from, uint32_t distance_m_q8)
{
    const bool is_polar = fx_abs_u32((int32_t)from.latitude) > FX_BAM_DEG(75);
    return distance_m_q8 / (is_polar ? 64 : 256) + LM_M_Q8(16);
}

/* Radius of a circle that holds the target. A scatterer lies within the sum of its two level
 * offsets, below 2^19 mm. A chip's far corner is up to 32 columns and 64 rows away, less than 72
 * pixels. */
static uint32_t extent_m_q8(const struct lm_target_set *set, const struct lm_target *t)
{
    const struct lm_signature *s = lm_target_signature(set, t);
    uint32_t most_mm = s ? s->pixel_mm * (LM_CHIP_SIDE * 9 / 8) : 0;
    for (uint32_t i = 0; i < t->scatterer_count; i++) {
        const int32_t *o = t->scatterers[i].offset_mm;
        most_mm = fx_max_u32(most_mm, fx_abs_u32(o[0]) + fx_abs_u32(o[1]));
    }
    return lm_m_q8_of_m(most_mm / 1000 + 1);
}

void lm_target_candidates_select(struct lm_target_candidates *candidates,
                                 const struct lm_target_set *set,
                                 const struct lm_target_query *query)
{
    candidates->set = *set;
    candidates->is_chosen = true;
    candidates->position = query->position;
    candidates->time_us = query->time_us;
    candidates->count = candidates->left_out = 0;
    const uint32_t reach_m_q8 =
        lm_m_q8_of_m(query->reach_m + LM_TARGET_DRIFT_M + LM_TARGET_EXTENT_M);
    for (uint32_t i = 0; i < set->count; i++) {
        const struct lm_target *t = &set->items[i];
        struct lm_target_candidate candidate = {.index = (uint16_t)i,
                                                .is_mover = t->speed_mm_s != 0,
                                                .state = lm_mover_state_at(t, query->time_us)};
        fx_bam_t azimuth;
        lm_geo_inverse(query->position, candidate.state.position, &candidate.distance_m_q8,
                       &azimuth);
        if (candidate.distance_m_q8 > reach_m_q8) {
            continue;
        }
        if (candidates->count == LM_TARGET_CANDIDATES_MAX) {
            candidates->left_out++;
            continue;
        }
        /* Distances are within 2^26, times sines of 2^15: below 2^41. */
        candidate.north_m_q8 =
            (int32_t)((int64_t)candidate.distance_m_q8 * fx_cos_q15(azimuth) >> 15);
        candidate.east_m_q8 =
            (int32_t)((int64_t)candidate.distance_m_q8 * fx_sin_q15(azimuth) >> 15);
        candidate.slack_m_q8 =
            extent_m_q8(set, t) + position_error_m_q8(query->position, candidate.distance_m_q8);
        candidate.elevation_m_q6 = origin_elevation_m_q6(t, candidate.state.position, query);
        candidates->candidate[candidates->count++] = candidate;
    }
}

bool lm_target_candidates_refresh(struct lm_target_candidates *candidates,
                                  const struct lm_target_set *set,
                                  const struct lm_target_query *query)
{
    /* 77,000 BAM are 717 m of latitude, and no more than that of longitude. */
    const uint32_t limit = 77000;
    const struct lm_position *from = &candidates->position, *to = &query->position;
    const bool holds = candidates->is_chosen && candidates->time_us == query->time_us &&
                       fx_abs_u32((int32_t)(to->latitude - from->latitude)) < limit &&
                       fx_abs_u32((int32_t)(to->longitude - from->longitude)) < limit;
    if (!holds) {
        lm_target_candidates_select(candidates, set, query);
    }
    return !holds;
}
