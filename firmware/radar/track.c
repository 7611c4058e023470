#include "lm/track.h"

#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/target_view.h"
#include "track_sight.h"

enum {
    TARGETS_A_STEP = 8, /* looked at in a step of a search */
    TWO_MEAN_RADII_M = 12742000
};

int32_t lm_track_needs_db_q8(uint32_t looks_log2)
{
    static const int16_t needs_db_q8[LM_LOOKS_LOG2_MAX + 1] = {3357, 2679, 2039, 1455, 920};
    return needs_db_q8[fx_min_u32(looks_log2, LM_LOOKS_LOG2_MAX)];
}

void lm_track_end(struct lm_track *t, enum lm_track_loss loss, uint64_t now_us)
{
    t->state = LM_TRACK_OFF;
    t->loss = (uint8_t)loss;
    t->ended_us = now_us;
}

void lm_track_begin(struct lm_track *t, enum lm_track_kind kind, struct lm_position place,
                    uint32_t gate_m, uint64_t now_us)
{
    t->kind = (uint8_t)kind;
    t->state = LM_TRACK_SEARCHING;
    t->loss = LM_TRACK_NOTHING;
    t->number++;
    t->has_target = false;
    t->search.place = place;
    t->search.gate_m = gate_m;
    t->search.next = 0;
    t->search.has_best = false;
    t->next_us = t->returned_us = now_us;
}

/* ---- where it is ---- */

static struct lm_target_heights heights_of(const struct lm_track_scene *s)
{
    return (struct lm_target_heights){s->platform.height_m_q10, 0};
}

/* Straight range between two heights over the curved Earth: the ground range grows with them by
 * (h + z) / 2R. It is below 2^27, the heights below 2^26 together: the product is below 2^53. */
static uint32_t slant_m_q8_of(uint32_t ground_m_q8, int32_t height_m_q10, int32_t elevation_m_q10)
{
    const int64_t sum_m_q10 = (int64_t)height_m_q10 + elevation_m_q10;
    const int64_t more_m_q8 = (int64_t)ground_m_q8 * sum_m_q10 / ((int64_t)TWO_MEAN_RADII_M << 10);
    return fx_hypot_u32((int32_t)((int64_t)ground_m_q8 + more_m_q8),
                        lm_m_q8_of_m_q10(height_m_q10 - elevation_m_q10));
}

/* Set what follows from position, elevation, speed and course. False beyond 300 km. */
static bool locate(const struct lm_track_scene *s, struct lm_track_seen *seen)
{
    const struct lm_platform *from = &s->platform;
    if (!lm_target_view_locate(from->position, seen->position, &seen->ground_m_q8,
                               &seen->bearing)) {
        return false;
    }
    const struct lm_target_heights h = heights_of(s);
    /* A tangent in Q38, cut to Q16, beside 1: within 2^24 beyond 256 m. */
    const int64_t tangent_q38 =
        lm_target_view_tangent_q38(seen->elevation_m_q10, seen->ground_m_q8, &h);
    seen->angle = (int32_t)fx_atan2((int32_t)(tangent_q38 >> 22), 1 << 16);
    seen->slant_m_q8 = slant_m_q8_of(seen->ground_m_q8, from->height_m_q10, seen->elevation_m_q10);
    const int32_t away_mm_s = lm_mover_closing_mm_s(seen->speed_mm_s, seen->course, seen->bearing) -
                              lm_mover_closing_mm_s(from->speed_mm_s, from->track, seen->bearing);
    seen->range_rate_mm_s = (int32_t)((int64_t)away_mm_s * fx_cos_q30((fx_bam_t)seen->angle) >> 30);
    return true;
}

static bool is_within_limits(const struct lm_track_scene *s, const struct lm_track_seen *seen)
{
    const struct lm_antenna_table *antenna = &s->radar->antenna;
    return fx_abs_u32((int32_t)(seen->bearing - s->platform.heading)) <= antenna->azimuth_limit &&
           fx_abs_u32(seen->angle) <= antenna->tilt_max;
}

/* The gates of the mode, as the picture has them. */
static bool is_in_gates(const struct lm_track_scene *s, const struct lm_track_seen *seen)
{
    const uint32_t *gate_mm_s = lm_radar_mode(s->radar, s->mode)->gate_mm_s;
    const uint32_t closing_mm_s =
        fx_abs_u32(lm_mover_closing_mm_s(seen->speed_mm_s, seen->course, seen->bearing));
    const uint32_t least_mm_s = fx_max_u32(
        gate_mm_s[0], lm_mover_clutter_mm_s(s->platform.speed_mm_s, s->radar->antenna.azimuth_beam,
                                            s->platform.track - seen->bearing));
    return gate_mm_s[1] == 0 || (closing_mm_s >= least_mm_s && closing_mm_s <= gate_mm_s[1]);
}

/* ---- how strong it is ---- */

static int32_t rcs_dbsm_q8(const struct lm_track_scene *s,
                           const struct lm_target_candidate *candidate,
                           const struct lm_track_seen *seen)
{
    struct lm_target_view view;
    struct lm_return returns[LM_SCATTERERS_MAX];
    const struct lm_target_heights h = heights_of(s);
    lm_target_view_of(&view, candidate, seen->bearing + FX_BAM_180, seen->ground_m_q8, &h);
    if (candidate->scatterer_count != 0) {
        const uint32_t count = lm_target_returns(&s->targets->items[candidate->index], &view,
                                                 s->radar->wavelength_um, returns);
        return lm_returns_sum_dbsm_q8(returns, (1u << count) - 1);
    }
    struct lm_target_body mean = candidate->body;
    mean.swerling = 0;
    return lm_target_view_rcs_dbsm_q8(s->targets, &mean, &view, 0, 0);
}

/* Signal over noise, and for a mover over what is left of the clutter. `candidate` is NULL for the
 * ground itself. */
static int32_t signal_db_q8_of(const struct lm_track_scene *s, enum lm_track_kind kind,
                               const struct lm_target_candidate *candidate,
                               const struct lm_track_seen *seen)
{
    struct lm_receiver_floor floor;
    const int32_t ground_db_q8 = lm_track_ground_db_q8(s->tiles, seen->position);
    lm_receiver_floor_at(&floor, s->radar, seen->slant_m_q8,
                         s->platform.height_m_q10 - seen->elevation_m_q10, s->range_index,
                         (enum lm_fov)s->fov);
    int32_t against_db_q8 =
        floor.noise_db_q8 + lm_malfunction_loss_db_q8(s->malfunctions) +
        lm_malfunction_q8(s->malfunctions, LM_MALFUNCTION_NOISE) +
        lm_noise_rise_db_q8(s->environment, s->radar, s->platform.position, seen->bearing);
    if (!candidate) {
        return ground_db_q8 - against_db_q8;
    }
    int32_t point_db_q8 = rcs_dbsm_q8(s, candidate, seen) - floor.area_db_q8;
    if (kind == LM_TRACK_MOVER) {
        const int32_t left_db_q8 = ground_db_q8 - lm_radar_mode(s->radar, s->mode)->clutter_db_q8;
        against_db_q8 = fx_db_q8_sum_vec(against_db_q8, left_db_q8);
    } else {
        point_db_q8 = fx_db_q8_sum_vec(point_db_q8, ground_db_q8);
    }
    return point_db_q8 - against_db_q8;
}

/* Judge what is at seen->position, but for shadow. */
static enum lm_track_loss judge(const struct lm_track *t, const struct lm_track_scene *s,
                                const struct lm_target_candidate *candidate,
                                struct lm_track_seen *seen)
{
    const bool is_locked = t->state != LM_TRACK_SEARCHING;
    const int32_t needed_db_q8 = lm_track_needs_db_q8(s->radar->receiver.noise_looks_log2) -
                                 (is_locked ? LM_TRACK_HOLD_DB_Q8 : 0);
    if (!locate(s, seen) || !is_within_limits(s, seen)) {
        return LM_TRACK_LIMITS;
    }
    if (t->kind == LM_TRACK_MOVER && !is_in_gates(s, seen)) {
        return LM_TRACK_NOTCH;
    }
    seen->signal_db_q8 = signal_db_q8_of(s, (enum lm_track_kind)t->kind, candidate, seen);
    return seen->signal_db_q8 < needed_db_q8 ? LM_TRACK_WEAK : LM_TRACK_SOUND;
}

static struct lm_target_query query_of(const struct lm_track_scene *s)
{
    return (struct lm_target_query){.position = s->platform.position,
                                    .time_us = s->platform.time_us,
                                    .tiles = s->tiles,
                                    .lod = lm_track_lod(s->tiles->db)};
}

static void take_motion(struct lm_track_seen *seen, const struct lm_target_candidate *candidate)
{
    seen->position = candidate->state.position;
    seen->elevation_m_q10 = lm_m_q10_of_m_q6(candidate->elevation_m_q6);
    seen->speed_mm_s = candidate->state.speed_mm_s;
    seen->course = candidate->state.course;
}

/* ---- the three kinds ---- */

static enum lm_track_loss look_at_target(struct lm_track *t, const struct lm_track_scene *s,
                                         struct lm_track_seen *seen)
{
    struct lm_target_candidate candidate;
    const struct lm_target_query query = query_of(s);
    if (!lm_target_candidate_of(&candidate, s->targets, t->is_live, t->index, &query)) {
        return LM_TRACK_NOTHING;
    }
    take_motion(seen, &candidate);
    return judge(t, s, &candidate, seen);
}

static enum lm_track_loss look_at_place(struct lm_track *t, const struct lm_track_scene *s,
                                        struct lm_track_seen *seen)
{
    seen->position = t->search.place;
    seen->speed_mm_s = 0;
    return lm_track_ground_at(s->tiles, seen->position, &seen->elevation_m_q10)
               ? judge(t, s, NULL, seen)
               : LM_TRACK_NOTHING;
}

static enum lm_track_loss look(struct lm_track *t, const struct lm_track_scene *s,
                               struct lm_track_seen *seen)
{
    if (!s->is_nav_good || !s->is_sending) {
        return s->is_sending ? LM_TRACK_NO_NAV : LM_TRACK_SILENT;
    }
    if (t->kind == LM_TRACK_RANGING) {
        seen->speed_mm_s = 0;
        return lm_track_ahead(s, &seen->position, &seen->elevation_m_q10) ? judge(t, s, NULL, seen)
                                                                          : LM_TRACK_NOTHING;
    }
    const enum lm_track_loss loss =
        t->has_target ? look_at_target(t, s, seen) : look_at_place(t, s, seen);
    return loss == LM_TRACK_SOUND && !lm_track_sees(t, s, seen) ? LM_TRACK_SHADOW : loss;
}

/* ---- search ---- */

/* Look at a target of a search: remember the nearest that can be tracked. A mover that nothing can
 * be measured of leaves its reason. */
static void consider(struct lm_track *t, const struct lm_track_scene *s, bool is_live,
                     uint32_t index)
{
    struct lm_target_candidate candidate;
    struct lm_track_seen seen;
    const struct lm_target_query query = query_of(s);
    uint32_t away_m_q8;
    fx_bam_t azimuth;
    if (!lm_target_candidate_of(&candidate, s->targets, is_live, index, &query)) {
        return;
    }
    take_motion(&seen, &candidate);
    lm_geo_inverse(t->search.place, seen.position, &away_m_q8, &azimuth);
    const bool is_kind = t->kind == LM_TRACK_MOVER || seen.speed_mm_s == 0;
    if (!is_kind || away_m_q8 > lm_m_q8_of_m(t->search.gate_m) ||
        (t->search.has_best && away_m_q8 >= t->search.best_m_q8)) {
        return;
    }
    const enum lm_track_loss loss = judge(t, s, &candidate, &seen);
    if (loss != LM_TRACK_SOUND) {
        t->loss = t->search.has_best ? t->loss : (uint8_t)loss;
        return;
    }
    t->search.has_best = true;
    t->search.is_best_live = is_live;
    t->search.best = (uint16_t)index;
    t->search.best_m_q8 = away_m_q8;
}

/* Look at some targets. True when all were looked at. */
static bool search_on(struct lm_track *t, const struct lm_track_scene *s)
{
    const uint32_t count = s->targets->count;
    const uint32_t end = count + (lm_target_set_is_live(s->targets) ? LM_LIVE_MAX : 0u);
    for (uint32_t n = 0; n < TARGETS_A_STEP && t->search.next < end; n++, t->search.next++) {
        const bool is_live = t->search.next >= count;
        consider(t, s, is_live, is_live ? t->search.next - count : t->search.next);
    }
    return t->search.next >= end;
}

/* Take the best of a search that is over. A fixed track without one is of the place itself; a mover
 * that was not found is looked for again. True if there is something to look at. */
static bool choose(struct lm_track *t)
{
    t->has_target = t->search.has_best;
    t->is_live = t->search.is_best_live;
    t->index = t->search.best;
    t->search.next = 0;
    t->search.has_best = false;
    return t->has_target || t->kind == LM_TRACK_FIXED;
}

/* ---- state ---- */

/* Move what coasts by its last speed: below 2^20 mm/s for less than 2^22 us at a time. */
static void coast(struct lm_track *t, const struct lm_track_scene *s)
{
    struct lm_geo_origin origin;
    const uint64_t moved_us = s->platform.time_us - t->motion_us;
    const uint64_t held_us = moved_us < LM_TRACK_COAST_US ? moved_us : 0;
    const uint32_t moved_mm = (uint32_t)(t->seen.speed_mm_s * held_us / 1000000);
    lm_geo_set_origin(&origin, t->seen.position);
    t->seen.position = lm_geo_direct(&origin, t->seen.course, lm_m_q8_of_mm_u32(moved_mm));
    locate(s, &t->seen);
}

static void take(struct lm_track *t, const struct lm_track_scene *s, enum lm_track_loss loss,
                 const struct lm_track_seen *seen, uint64_t now_us)
{
    const bool is_locked = t->state != LM_TRACK_SEARCHING;
    const uint64_t most_us = is_locked ? LM_TRACK_COAST_US : LM_TRACK_SEARCH_US;
    t->loss = (uint8_t)loss;
    if (loss == LM_TRACK_SOUND) {
        t->seen = *seen;
        t->state = LM_TRACK_HELD;
        t->returned_us = now_us;
    } else if (t->kind == LM_TRACK_RANGING) {
        t->state = LM_TRACK_SEARCHING; /* until the operator ends it */
    } else if (now_us - t->returned_us > most_us) {
        lm_track_end(t, loss, now_us);
    } else if (is_locked) {
        t->state = LM_TRACK_COASTING;
        coast(t, s);
    }
    t->motion_us = s->platform.time_us;
}

void lm_track_step(struct lm_track *t, const struct lm_track_scene *s, uint64_t now_us)
{
    struct lm_track_seen seen = t->seen;
    if (t->state == LM_TRACK_OFF || now_us < t->next_us) {
        return;
    }
    if (t->state == LM_TRACK_SEARCHING && t->kind != LM_TRACK_RANGING) {
        if (!search_on(t, s)) {
            return;
        }
        if (!choose(t)) {
            t->next_us = now_us + LM_TRACK_STEP_US;
            take(t, s, (enum lm_track_loss)t->loss, &seen, now_us);
            return;
        }
    }
    t->next_us = now_us + LM_TRACK_STEP_US;
    take(t, s, look(t, s, &seen), &seen, now_us);
}
