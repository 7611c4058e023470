#include "lm/target_candidates.h"

#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/scan_line.h"
#include "lm/units.h"

const struct lm_signature *lm_target_signature(const struct lm_target_set *set,
                                               const struct lm_target_body *body)
{
    const bool has_one = (body->flags & LM_TARGET_HAS_SIGNATURE) &&
                         body->signature < set->signature_count &&
                         set->signatures[body->signature].aspects != 0;
    return has_one ? &set->signatures[body->signature] : NULL;
}

/* Elevation of an origin that is `height_m_q6` above the ground, or above mean sea level. */
static int32_t origin_elevation_m_q6(int32_t height_m_q6, bool is_above_ground,
                                     struct lm_position position,
                                     const struct lm_target_query *query)
{
    if (!is_above_ground) {
        return height_m_q6;
    }
    /* Both are within 2^20 in Q6: the terrain because tiles are checked, the height above it
     * because the record or the message is. */
    const int32_t ground_m_q10 =
        query->tiles ? lm_scan_elevation(query->tiles, query->lod, position,
                                         lm_m_q10_of_m_q6(query->tiles->db->mean_elevation_m_q6))
                     : 0;
    return height_m_q6 + lm_m_q6_of_m_q10(ground_m_q10);
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
 * pixels. `t` is NULL if it has no scatterers. */
static uint32_t extent_m_q8(const struct lm_signature *s, const struct lm_target *t)
{
    uint32_t most_mm = s ? s->pixel_mm * (LM_CHIP_SIDE * 9 / 8) : 0;
    for (uint32_t i = 0; t && i < t->scatterer_count; i++) {
        const int32_t *o = t->scatterers[i].offset_mm;
        most_mm = fx_max_u32(most_mm, fx_abs_u32(o[0]) + fx_abs_u32(o[1]));
    }
    return lm_m_q8_of_m(most_mm / 1000 + 1);
}

/* Reach for a target of this speed. A patch shows what is displaced into it, from 200 km away at
 * most. Speeds are below 2^20.1: the product is below 2^53. */
static uint32_t reach_m_of(const struct lm_target_query *query, uint32_t speed_mm_s)
{
    const uint64_t displaced_m = (uint64_t)speed_mm_s * query->displaced_q16 >> 16;
    return query->reach_m + (displaced_m < 200000 ? (uint32_t)displaced_m : 200000);
}

/* Add a candidate, whose state, kind and body are set, if it is in reach: find its place. Returns
 * false if it is not in reach. */
static bool add(struct lm_target_candidates *candidates, struct lm_target_candidate candidate,
                const struct lm_target *t, const struct lm_target_query *query)
{
    const uint32_t reach_m = reach_m_of(query, candidate.state.speed_mm_s);
    fx_bam_t azimuth;
    lm_geo_inverse(query->position, candidate.state.position, &candidate.distance_m_q8, &azimuth);
    if (candidate.distance_m_q8 > lm_m_q8_of_m(reach_m + LM_TARGET_DRIFT_M + LM_TARGET_EXTENT_M)) {
        return false;
    }
    if (candidates->count == LM_TARGET_CANDIDATES_MAX) {
        candidates->left_out++;
        return false;
    }
    /* Distances are within 2^26, times sines of 2^15: below 2^41. */
    candidate.north_m_q8 = (int32_t)((int64_t)candidate.distance_m_q8 * fx_cos_q15(azimuth) >> 15);
    candidate.east_m_q8 = (int32_t)((int64_t)candidate.distance_m_q8 * fx_sin_q15(azimuth) >> 15);
    candidate.slack_m_q8 = extent_m_q8(lm_target_signature(&candidates->set, &candidate.body), t) +
                           position_error_m_q8(query->position, candidate.distance_m_q8);
    candidates->candidate[candidates->count++] = candidate;
    return true;
}

static void begin(struct lm_target_candidates *candidates, const struct lm_target_set *set,
                  const struct lm_target_query *query)
{
    candidates->set = *set;
    candidates->is_chosen = true;
    candidates->position = query->position;
    candidates->time_us = query->time_us;
    candidates->count = candidates->left_out = 0;
}

static struct lm_target_candidate candidate_of_item(const struct lm_target_set *set, uint32_t index,
                                                    const struct lm_target_query *query)
{
    const struct lm_target *t = &set->items[index];
    return (struct lm_target_candidate){
        .index = (uint16_t)index,
        .is_mover = t->speed_mm_s != 0,
        .scatterer_count = t->scatterer_count,
        .body = {t->id, t->mean_rcs_dbsm_q8, t->swerling, t->signature, t->flags},
        .state = lm_mover_state_at(t, query->time_us)};
}

/* Set the elevation of a candidate of the image. */
static void raise_item(struct lm_target_candidate *candidate, const struct lm_target_set *set,
                       const struct lm_target_query *query)
{
    const struct lm_target *t = &set->items[candidate->index];
    candidate->elevation_m_q6 = origin_elevation_m_q6(
        t->elevation_m_q6, t->flags & LM_TARGET_ABOVE_GROUND, candidate->state.position, query);
}

void lm_target_candidates_select(struct lm_target_candidates *candidates,
                                 const struct lm_target_set *set,
                                 const struct lm_target_query *query)
{
    begin(candidates, set, query);
    for (uint32_t i = 0; i < set->count; i++) {
        if (add(candidates, candidate_of_item(set, i, query), &set->items[i], query)) {
            raise_item(&candidates->candidate[candidates->count - 1], set, query);
        }
    }
}

/* ---- live targets ---- */

/* Identity of live target 0, for its random draws. */
enum { LIVE_ID = 0x4c560000 };

/* What a live target returns. Without its signature it is a fluctuating point. */
static struct lm_target_body body_of_live(const struct lm_target_set *set, uint32_t number)
{
    const struct lm_live_target *t = &set->live->target[number];
    const bool is_beacon = t->kind == LM_LIVE_BEACON;
    const uint32_t named = t->signature - 1u;
    struct lm_target_body body = {
        .id = LIVE_ID + number,
        .mean_rcs_dbsm_q8 = t->rcs_dbsm_q8,
        .swerling = lm_live_echoes[t->kind].swerling,
        .signature = (uint8_t)(is_beacon ? t->signature : set->live_signature0 + named),
        .flags = is_beacon ? LM_TARGET_IS_BEACON : LM_TARGET_HAS_SIGNATURE};
    if (!is_beacon && (named >= set->live_signatures || lm_target_signature(set, &body) == NULL)) {
        body.signature = 0;
        body.flags = 0;
    }
    return body;
}

static struct lm_target_candidate candidate_of_live(const struct lm_target_set *set,
                                                    uint32_t number,
                                                    const struct lm_target_query *query)
{
    const struct lm_live_state s = lm_live_at(&set->live->target[number], query->time_us);
    return (struct lm_target_candidate){.index = (uint16_t)number,
                                        .is_mover = s.speed_mm_s != 0,
                                        .body = body_of_live(set, number),
                                        .state = {s.position, s.heading, s.course, s.speed_mm_s}};
}

/* Set the elevation of a live candidate. */
static void raise_live(struct lm_target_candidate *candidate, const struct lm_target_set *set,
                       const struct lm_target_query *query)
{
    const struct lm_live_target *t = &set->live->target[candidate->index];
    candidate->elevation_m_q6 =
        origin_elevation_m_q6(t->height_m_q6, !t->has_height, candidate->state.position, query);
}

static void add_live(struct lm_target_candidates *candidates, uint32_t number,
                     const struct lm_target_query *query)
{
    if (add(candidates, candidate_of_live(&candidates->set, number, query), NULL, query)) {
        raise_live(&candidates->candidate[candidates->count - 1], &candidates->set, query);
    }
}

/* Numbers of live targets that a sample or patch may meet. */
struct met {
    uint8_t number[LM_LIVE_MAX];
    uint32_t count;
};

/* Told cross section in whole dB above -100, 0..DB_STEPS - 1. */
enum { DB_STEPS = 201 };
static uint32_t strength_of(const struct lm_live_target *t)
{
    return (uint32_t)(fx_clamp_i32(t->rcs_dbsm_q8, LM_DB_Q8(-100), LM_DB_Q8(100)) / 256 + 100);
}

/* Strength from which on all those met have room, where more are met than that; *left becomes the
 * room for some that are a step weaker. */
static uint32_t least_strength(const struct lm_live_target *target, const struct met *met,
                               uint32_t *left)
{
    uint32_t least = DB_STEPS;
    uint16_t as_strong[DB_STEPS] = {0};
    for (uint32_t i = 0; i < met->count; i++) {
        as_strong[strength_of(&target[met->number[i]])]++;
    }
    while (as_strong[least - 1] <= *left) {
        *left -= as_strong[--least];
    }
    return least;
}

/* Add those met as far as there is room: the strongest, and of equally strong ones the lowest
 * numbers. In one beam strength is what decides between them: the width of its cells grows with the
 * range as their grazing falls. */
static void add_met(struct lm_target_candidates *candidates, const struct met *met,
                    const struct lm_target_query *query)
{
    const struct lm_live_target *target = candidates->set.live->target;
    uint32_t left = LM_TARGET_CANDIDATES_MAX - candidates->count;
    const uint32_t least = met->count > left ? least_strength(target, met, &left) : 0;
    for (uint32_t i = 0; i < met->count; i++) {
        const uint32_t strength = strength_of(&target[met->number[i]]);
        const bool is_last = strength + 1 == least && left > 0;
        left -= is_last;
        if (strength >= least || is_last) {
            add_live(candidates, met->number[i], query);
        } else {
            candidates->left_out++;
        }
    }
}

bool lm_target_candidate_of(struct lm_target_candidate *candidate, const struct lm_target_set *set,
                            bool is_live, uint32_t index, const struct lm_target_query *query)
{
    if (is_live) {
        if (!set->live || index >= LM_LIVE_MAX || !set->live->target[index].is_there) {
            return false;
        }
        *candidate = candidate_of_live(set, index, query);
        raise_live(candidate, set, query);
        return true;
    }
    if (index >= set->count) {
        return false;
    }
    *candidate = candidate_of_item(set, index, query);
    raise_item(candidate, set, query);
    return true;
}

/* Plane around a position, on which live targets are looked for. */
struct plane {
    struct lm_position position;
    int32_t cos_q15, sin_q15; /* of its latitude */
};

static struct plane plane_of(struct lm_position position)
{
    return (struct plane){position, fx_cos_q15(position.latitude), fx_sin_q15(position.latitude)};
}

static int64_t size_of(int64_t x)
{
    return x < 0 ? -x : x;
}

/* Place of a live target on the plane, roughly. */
struct rough {
    int64_t north_m_q8, east_m_q8;
    int64_t slack_m_q8; /* it is no farther than this from there */
};

/* Find the place roughly: told position, moved with the told velocity. East is shortened by the
 * latitude half-way, and turned by half the convergence of the meridians. False if it is more than
 * three degrees away.
 *
 * Differences are below 2^25 BAM, 311 km; the products below 2^58. A way is at most 16 s long:
 * 16,000 ms * 2^15 * 50 is below 2^35. */
static bool find_rough(struct rough *r, const struct plane *p, const struct lm_live_target *t,
                       uint64_t motion_us)
{
    /* 2 pi * 6,371 km / 2^32 in metres * 256, with an error of 0.6 %. */
    const int64_t bam_q10 = 2443;
    const int64_t dlat = (int32_t)(t->position.latitude - p->position.latitude);
    const int64_t dlon = (int32_t)(t->position.longitude - p->position.longitude);
    const int64_t most = 1 << 25;
    if (fx_clamp_i64(dlat, -most, most) != dlat ||
        fx_clamp_i64(dlon, -4 * most, 4 * most) != dlon) {
        return false;
    }
    /* Half the differences in radians, Q15: BAM * pi / 2^32 * 2^15. */
    const int64_t half_lat_q15 = dlat * 103 >> 22, half_lon_q15 = dlon * 103 >> 22;
    const int64_t cos_q15 = p->cos_q15 - (half_lat_q15 * p->sin_q15 >> 15);
    const int64_t north_m_q8 = dlat * bam_q10 >> 10;
    const int64_t east_m_q8 = (dlon * bam_q10 >> 10) * cos_q15 >> 15;
    const int64_t lean_q15 = half_lon_q15 * p->sin_q15 >> 15;
    const int64_t us = fx_clamp_i64((int64_t)(motion_us - t->motion_us), -16000000, 16000000);
    const int64_t ms = t->reckoning == LM_LIVE_STATIC ? 0 : us / 1000;
    const int64_t way_east_m_q8 = t->velocity[0] * ms / 78,
                  way_north_m_q8 = t->velocity[1] * ms / 78;
    r->north_m_q8 = north_m_q8 + (east_m_q8 * lean_q15 >> 15) + way_north_m_q8;
    r->east_m_q8 = east_m_q8 - (north_m_q8 * lean_q15 >> 15) + way_east_m_q8;
    r->slack_m_q8 = LM_M_Q8(16) + (size_of(north_m_q8) + size_of(east_m_q8)) / 128;
    if (t->reckoning >= LM_LIVE_RVW) {
        const int64_t gained = size_of(t->acceleration[0]) + size_of(t->acceleration[1]);
        r->slack_m_q8 +=
            (size_of(way_east_m_q8) + size_of(way_north_m_q8)) * 2 + gained * ms * ms / 781250;
    }
    return true;
}

void lm_target_candidates_add_live(struct lm_target_candidates *candidates,
                                   const struct lm_target_query *query)
{
    const struct lm_live *live = candidates->set.live;
    const struct plane plane = plane_of(query->position);
    struct met met;
    met.count = 0;
    for (uint32_t i = 0; live && live->count != 0 && i < LM_LIVE_MAX; i++) {
        const struct lm_live_target *t = &live->target[i];
        struct rough r;
        if (!t->is_there || !find_rough(&r, &plane, t, query->time_us)) {
            continue;
        }
        /* Speeds and what 12 s of acceleration add: below 2^23. */
        const uint32_t speed_mm_s =
            50 * (fx_abs_u32(t->velocity[0]) + fx_abs_u32(t->velocity[1])) +
            120 * (fx_abs_u32(t->acceleration[0]) + fx_abs_u32(t->acceleration[1]));
        const int64_t reach_m_q8 =
            (int64_t)lm_m_q8_of_m(reach_m_of(query, speed_mm_s)) + r.slack_m_q8;
        if (size_of(r.north_m_q8) <= reach_m_q8 && size_of(r.east_m_q8) <= reach_m_q8) {
            met.number[met.count++] = (uint8_t)i;
        }
    }
    if (met.count != 0) {
        add_met(candidates, &met, query);
    }
}

/* Displacement of movers in a line, as the plane has it: d = -(v . r) / (V sin o) across, for a
 * target at r with the velocity v. This is 2^30 over V sin o, in mm/s; 0 displaces nothing. */
static int64_t displacement_q30(const struct lm_live_line *line, bool *is_wild)
{
    const int32_t sin_q15 = fx_sin_q15(line->track - line->azimuth);
    *is_wild = line->is_doppler && fx_abs_u32(sin_q15) < 1 << 12; /* 7 degrees off the track */
    const int64_t across_mm_s = (int64_t)line->speed_mm_s * sin_q15 >> 15;
    return line->is_doppler && !*is_wild && across_mm_s != 0 ? (1 << 30) / across_mm_s : 0;
}

void lm_target_candidates_of_line(struct lm_target_candidates *candidates,
                                  const struct lm_target_set *set,
                                  const struct lm_target_query *query,
                                  const struct lm_live_line *line)
{
    const int64_t sin_q15 = fx_sin_q15(line->azimuth), cos_q15 = fx_cos_q15(line->azimuth);
    const struct plane plane = plane_of(query->position);
    bool is_wild;
    const int64_t shift_q30 = displacement_q30(line, &is_wild);
    /* Half the wedge in radians, Q15; what is displaced by more than 5/4 of the beam is not shown.
     */
    const int64_t width_q15 = (int64_t)line->width * 206 >> 22;
    const int64_t beam_q15 = (int64_t)line->beam * 206 >> 22;
    struct met met;
    met.count = 0;
    begin(candidates, set, query);
    for (uint32_t i = 0; i < LM_LIVE_MAX; i++) {
        const struct lm_live_target *t = &set->live->target[i];
        struct rough r;
        if (!t->is_there || (line->is_of_beacons && t->kind != LM_LIVE_BEACON) ||
            !find_rough(&r, &plane, t, query->time_us)) {
            continue;
        }
        const int64_t along_m_q8 = (r.north_m_q8 * cos_q15 + r.east_m_q8 * sin_q15) >> 15;
        const int64_t across_m_q8 = (r.east_m_q8 * cos_q15 - r.north_m_q8 * sin_q15) >> 15;
        /* 2^28 m * 256 by 2^15 * 50 mm/s, cut by 20 bits, by 2^30 at most. */
        const int64_t outward = (r.north_m_q8 * t->velocity[1] + r.east_m_q8 * t->velocity[0]) * 50;
        const int64_t shift_m_q8 = -((outward >> 20) * shift_q30 >> 10);
        int64_t slack_m_q8 =
            r.slack_m_q8 + (along_m_q8 * width_q15 >> 15) + size_of(shift_m_q8) / 8;
        slack_m_q8 += is_wild ? along_m_q8 * beam_q15 * 5 >> 17 : 0;
        if (size_of(across_m_q8 + shift_m_q8) <= slack_m_q8 &&
            size_of(shift_m_q8) <= (along_m_q8 * beam_q15 >> 14) + slack_m_q8 &&
            along_m_q8 >= (int64_t)line->begin_m_q8 - slack_m_q8 &&
            along_m_q8 <= (int64_t)line->end_m_q8 + slack_m_q8) {
            met.number[met.count++] = (uint8_t)i;
        }
    }
    add_met(candidates, &met, query);
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
