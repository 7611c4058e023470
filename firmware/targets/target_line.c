#include "lm/target_line.h"

#include "fx/bits.h"
#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/chip_sector.h"
#include "lm/const.h"
#include "lm/units.h"

enum { NO_CELL = -1 };

/* Greatest displacement of a mover, 5/4 of the beam. The beam that points where it would appear
 * leaves less than -37 dB of it. */
static uint32_t shift_most(const struct lm_target_line *line)
{
    return line->beam + line->beam / 4;
}

/* ---- which targets the line may meet ---- */

/* Ground between two azimuths on a plane, as the sines and cosines of the azimuths. */
struct wedge {
    int32_t left_sin_q15, left_cos_q15, right_sin_q15, right_cos_q15;
};

/* Wedge from `half` left of an azimuth to `half` right of it. With a right angle or more it is all
 * zeros, which excludes nothing. */
static struct wedge wedge_of(fx_bam_t azimuth, uint64_t half)
{
    const fx_bam_t left = azimuth - (fx_bam_t)half, right = azimuth + (fx_bam_t)half;
    struct wedge w = {0};
    if (half < FX_BAM_90) {
        w = (struct wedge){fx_sin_q15(left), fx_cos_q15(left), fx_sin_q15(right),
                           fx_cos_q15(right)};
    }
    return w;
}

/* Ground that a line covers, on a plane around the position that the candidates were selected from.
 */
struct cover {
    int32_t north_m_q8, east_m_q8; /* the antenna */
    uint32_t begin_m_q8, end_m_q8; /* ranges of the line's cells, seen from that position */
    struct wedge still, mover; /* azimuths of still targets, and of movers before displacement */
};

/* The candidates' positions are relative to where they were selected, and the antenna has moved
 * since. A BAM of latitude is 2 pi a / 2^32 metres; one of longitude is that times the cosine of
 * the latitude. Ranges are widened by the way gone, and by a cell at the near end. dlat and dlon
 * are within 2^24; the products are below 2^51. */
static struct cover cover_of(const struct lm_target_line *line, struct lm_position from)
{
    /* 2 pi * 6,371 km / 2^32 in metres * 256, with an error of 0.6 %. */
    const int64_t bam_q10 = 2443;
    const int32_t far = 1 << 24; /* 156 km: far beyond LM_TARGET_DRIFT_M */
    const struct lm_position at = line->position;
    const int64_t dlat = fx_clamp_i32((int32_t)(at.latitude - from.latitude), -far, far);
    const int64_t dlon = fx_clamp_i32((int32_t)(at.longitude - from.longitude), -far, far);
    const int32_t north_m_q8 = (int32_t)(dlat * bam_q10 >> 10);
    const int32_t east_m_q8 = (int32_t)(dlon * bam_q10 * fx_cos_q15(at.latitude) >> 25);
    const uint32_t gone_m_q8 = fx_abs_u32(north_m_q8) + fx_abs_u32(east_m_q8);
    const uint32_t begin_m_q8 = line->first_m_q8 + line->first * line->cell_m_q8;
    struct cover c = {.north_m_q8 = north_m_q8, .east_m_q8 = east_m_q8};
    c.begin_m_q8 = begin_m_q8 - fx_min_u32(begin_m_q8, line->cell_m_q8 + gone_m_q8);
    c.end_m_q8 = line->first_m_q8 + line->cells * line->cell_m_q8 + gone_m_q8;
    c.still = c.mover = wedge_of(line->azimuth, line->width);
    if (line->is_doppler) {
        c.mover = wedge_of(line->azimuth, (uint64_t)line->width + shift_most(line));
    }
    return c;
}

/* True if the line may meet the candidate: if its circle touches the wedge and the ranges. It is on
 * the left edge's side if the cross product of edge and position is not above the slack. Positions
 * are within 2^27, times sines of 2^15. */
static inline bool may_meet(const struct cover *c, const struct lm_target_candidate *candidate)
{
    const struct wedge *w = candidate->is_mover ? &c->mover : &c->still;
    const int64_t north_m_q8 = candidate->north_m_q8 - c->north_m_q8,
                  east_m_q8 = candidate->east_m_q8 - c->east_m_q8;
    const int64_t slack_m_q23 = (int64_t)candidate->slack_m_q8 << 15;
    return north_m_q8 * w->left_sin_q15 - east_m_q8 * w->left_cos_q15 <= slack_m_q23 &&
           east_m_q8 * w->right_cos_q15 - north_m_q8 * w->right_sin_q15 <= slack_m_q23 &&
           candidate->distance_m_q8 <= c->end_m_q8 + candidate->slack_m_q8 &&
           candidate->distance_m_q8 + candidate->slack_m_q8 >= c->begin_m_q8;
}

_Static_assert(LM_TARGET_CANDIDATES_MAX <= 32, "a bit for each");

/* Candidates that the line may meet: bit i for candidate i. Most lines meet none, so this loop is
 * most of what targets cost. */
static uint32_t find_in_reach(const struct lm_target_candidates *candidates,
                              const struct lm_target_line *line)
{
    const struct cover cover = cover_of(line, candidates->position);
    uint32_t found = 0;
    for (uint32_t i = 0; i < candidates->count; i++) {
        found |= (uint32_t)may_meet(&cover, &candidates->candidate[i]) << i;
    }
    return found;
}

/* ---- apparent position of a target ---- */

struct apparent_position {
    uint32_t range_m_q8;   /* ground range from the antenna */
    fx_bam_t azimuth;      /* from the antenna, where the target appears */
    fx_bam_t true_azimuth; /* azimuth where the target is */
    int32_t gain_db_q8;    /* loss by the beam; 0 or less */
};

/* True if a closing speed is within the mode's gates. The lower gate is never finer than the
 * spread of the ground beside the target. */
static bool is_in_gate(const struct lm_target_line *line, int32_t closing_mm_s,
                       fx_bam_t target_azimuth)
{
    if (line->gate_mm_s[1] == 0) {
        return true;
    }
    const uint32_t either_way_mm_s = fx_abs_u32(closing_mm_s);
    const uint32_t clutter_mm_s =
        lm_mover_clutter_mm_s(line->speed_mm_s, line->beam, line->track - target_azimuth);
    return either_way_mm_s >= fx_max_u32(line->gate_mm_s[0], clutter_mm_s) &&
           either_way_mm_s <= line->gate_mm_s[1];
}

/* Displace a target by Doppler, and attenuate it by the beam, which points at where it appears: the
 * two-way pattern 2^(-8 x^2), x in beam widths. False if it appears nowhere. */
static bool displace(const struct lm_target_line *line, int32_t closing_mm_s,
                     struct apparent_position *seen)
{
    int32_t shift;
    const fx_bam_t off = line->track - seen->azimuth;
    if (!lm_mover_shift(closing_mm_s, line->speed_mm_s, off, &shift) ||
        fx_abs_u32(shift) > shift_most(line)) {
        return false;
    }
    /* x in Q12 is at most 5/4. */
    const uint64_t x_q12 = ((uint64_t)fx_abs_u32(shift) << 12) / fx_max_u32(line->beam, 1);
    seen->azimuth += (fx_bam_t)shift;
    seen->gain_db_q8 = -(int32_t)(x_q12 * x_q12 * LM_BEAM_TWO_WAY_DB_Q8 >> 24);
    return true;
}

/* Direction from the target to the antenna. */
static fx_bam_t back_of(const struct lm_target_line *line,
                        const struct lm_target_candidate *candidate)
{
    uint32_t distance_m_q8;
    fx_bam_t back;
    lm_geo_inverse(candidate->state.position, line->position, &distance_m_q8, &back);
    return back;
}

/* Closing speed of a target; 0 if nothing depends on it. */
static int32_t closing_mm_s(const struct lm_target_line *line,
                            const struct lm_target_candidate *candidate)
{
    const bool is_asked_for = line->is_doppler || line->gate_mm_s[1] != 0;
    return is_asked_for && candidate->is_mover
               ? lm_mover_closing_mm_s(candidate->state.speed_mm_s, candidate->state.course,
                                       back_of(line, candidate))
               : 0;
}

static bool find_apparent(const struct lm_target_line *line,
                          const struct lm_target_candidate *candidate,
                          struct apparent_position *seen)
{
    const int32_t closing = closing_mm_s(line, candidate);
    if (!lm_target_view_locate(line->position, candidate->state.position, &seen->range_m_q8,
                               &seen->azimuth) ||
        !is_in_gate(line, closing, seen->azimuth)) {
        return false;
    }
    seen->true_azimuth = seen->azimuth;
    seen->gain_db_q8 = 0;
    return !line->is_doppler || displace(line, closing, seen);
}

/* Apparent position of a scatterer, `along_mm` beyond the target's origin and `across_mm` to the
 * right. It moves with its target. */
static struct apparent_position beside(const struct apparent_position *target,
                                       const struct lm_return *r)
{
    const int32_t along_m_q8 = (int32_t)target->range_m_q8 + lm_m_q8_of_mm(r->along_mm);
    const int32_t across_m_q8 = lm_m_q8_of_mm(r->across_mm);
    return (struct apparent_position){.range_m_q8 = fx_hypot_u32(along_m_q8, across_m_q8),
                                      .azimuth =
                                          target->azimuth + fx_atan2(across_m_q8, along_m_q8),
                                      .gain_db_q8 = target->gain_db_q8};
}

static uint32_t off_line(const struct lm_target_line *line, const struct apparent_position *s)
{
    return fx_abs_u32((int32_t)(s->azimuth - line->azimuth));
}

/* Share of a line in the power at an apparent position. The two lines that it lies between share
 * the power by nearness, and the beam's mean of both has its middle there. Only for a position less
 * than a line's width off. */
static int32_t share_db_q8(const struct lm_target_line *line, const struct apparent_position *s)
{
    return fx_db_q8(line->width - off_line(line, s)) - fx_db_q8(line->width);
}

/* Cell of the line that holds an apparent position, or NO_CELL. Cells are half-open, so no two
 * cells share a position. */
static int32_t cell_of(const struct lm_target_line *line, const struct apparent_position *s)
{
    const int32_t half_m_q8 = (int32_t)(line->cell_m_q8 / 2);
    const int64_t past_m_q8 = (int64_t)s->range_m_q8 - line->first_m_q8 + half_m_q8;
    if (off_line(line, s) >= line->width || past_m_q8 < 0) {
        return NO_CELL;
    }
    const uint32_t cell = (uint32_t)past_m_q8 / line->cell_m_q8;
    return cell >= line->first && cell < line->cells ? (int32_t)cell : NO_CELL;
}

/* ---- echo of a target ---- */

static struct lm_target_heights heights_of(const struct lm_target_line *line)
{
    return (struct lm_target_heights){line->height_m_q10, line->reference_m_q10};
}

static struct lm_target_view view_of(const struct lm_target_line *line,
                                     const struct lm_target_candidate *candidate,
                                     uint32_t range_m_q8)
{
    const struct lm_target_heights h = heights_of(line);
    struct lm_target_view v;
    lm_target_view_of(&v, candidate, back_of(line, candidate), range_m_q8, &h);
    return v;
}

/* Area of a clutter cell, as 10 log10; it is as wide as the line's arc. */
static int32_t area_dbm2_q8(const struct lm_target_line *line, uint32_t cell)
{
    const struct lm_target_heights h = heights_of(line);
    const uint32_t range_m_q8 = line->first_m_q8 + cell * line->cell_m_q8;
    const uint32_t before_m_q8 = cell == line->first ? range_m_q8 : range_m_q8 - line->cell_m_q8;
    return lm_clutter_area_dbm2_q8(lm_arc_m_q8(range_m_q8, line->width), line->cell_m_q8,
                                   range_m_q8, before_m_q8, &h);
}

/* Echo of one target in one line: the returns of its scatterers and their cells. */
struct echo {
    struct lm_return returns[LM_SCATTERERS_MAX];
    int32_t cell[LM_SCATTERERS_MAX]; /* or NO_CELL */
    uint32_t count;
};

/* Cell of a return, or NO_CELL if terrain before that cell hides it. */
static int32_t lit_cell(const struct lm_target_line *line, const struct lm_target_horizon *horizon,
                        const struct lm_target_candidate *candidate,
                        const struct apparent_position *s, int32_t up_mm)
{
    const struct lm_target_heights h = heights_of(line);
    const int32_t cell = cell_of(line, s);
    if (cell == NO_CELL || horizon == NULL) {
        return cell;
    }
    const int32_t top_m_q10 = lm_m_q10_of_m_q6(candidate->elevation_m_q6) + lm_m_q10_of_mm(up_mm);
    const int64_t horizon_q38 = horizon->horizon[cell] * ((int64_t)1 << (38 - horizon->bits));
    return lm_target_view_tangent_q38(top_m_q10, s->range_m_q8, &h) > horizon_q38 ? cell : NO_CELL;
}

/* Top of a target without scatterers, above its origin: it is hidden when its top is. */
static int32_t top_mm(const struct lm_signature *s)
{
    return s ? (int32_t)s->height_mm : 0;
}

/* Echo of a target without scatterers. Its cross section is computed only if the line holds it: few
 * of the candidates that the line may meet are in it. */
static void make_point_echo(struct echo *e, const struct lm_target_line *line,
                            const struct lm_target_horizon *horizon,
                            const struct lm_target_set *set,
                            const struct lm_target_candidate *candidate,
                            const struct apparent_position *seen)
{
    const struct lm_target_body *body = &candidate->body;
    e->count = 1;
    e->returns[0] = (struct lm_return){.up_mm = top_mm(lm_target_signature(set, body))};
    e->cell[0] = lit_cell(line, horizon, candidate, seen, e->returns[0].up_mm);
    if (e->cell[0] != NO_CELL) {
        const struct lm_target_view v = view_of(line, candidate, seen->range_m_q8);
        e->returns[0].rcs_dbsm_q8 =
            lm_target_view_rcs_dbsm_q8(set, body, &v, line->scan, line->pulse) +
            share_db_q8(line, seen) + seen->gain_db_q8;
    }
}

static void make_scatterers_echo(struct echo *e, const struct lm_target_line *line,
                                 const struct lm_target_horizon *horizon, const struct lm_target *t,
                                 const struct lm_target_candidate *candidate,
                                 const struct apparent_position *seen)
{
    const struct lm_target_view v = view_of(line, candidate, seen->range_m_q8);
    e->count = lm_target_returns(t, &v, line->wavelength_um, e->returns);
    for (uint32_t i = 0; i < e->count; i++) {
        const struct apparent_position s = beside(seen, &e->returns[i]);
        e->cell[i] = lit_cell(line, horizon, candidate, &s, e->returns[i].up_mm);
        if (e->cell[i] != NO_CELL) {
            e->returns[i].rcs_dbsm_q8 += share_db_q8(line, &s) + s.gain_db_q8;
        }
    }
}

/* Add a level to a cell and, if the line stretches echoes, to those before and behind it. */
static void add_level(const struct lm_target_line *line, int32_t cell, int32_t gamma_db_q8,
                      int16_t *level_db_q8)
{
    const int32_t stretch = (int32_t)line->stretch_cells;
    const int32_t first = fx_max_i32(cell - stretch, (int32_t)line->first);
    const int32_t end = fx_min_i32(cell + stretch + 1, (int32_t)line->cells);
    for (int32_t k = first; k < end; k++) {
        level_db_q8[k] = fx_sat_i16(fx_db_q8_sum_vec(level_db_q8[k], gamma_db_q8));
    }
}

/* Add a phasor sum to each cell that holds some of the returns. */
static uint32_t add_echo(const struct echo *e, const struct lm_target_line *line,
                         int16_t *level_db_q8)
{
    uint32_t cells = 0, done = 0;
    for (uint32_t i = 0; i < e->count; i++) {
        const int32_t cell = e->cell[i];
        if (cell == NO_CELL || done >> i & 1) {
            continue;
        }
        uint32_t mask = 0;
        for (uint32_t k = i; k < e->count; k++) {
            mask |= (uint32_t)(e->cell[k] == cell) << k;
        }
        done |= mask;
        const int32_t gamma_db_q8 =
            lm_returns_sum_dbsm_q8(e->returns, mask) - area_dbm2_q8(line, (uint32_t)cell);
        add_level(line, cell, gamma_db_q8, level_db_q8);
        cells++;
    }
    return cells;
}

/* True if the line sees the top of a target that is drawn by its chip. The test is at the cell of
 * the target's range, on any of the lines that the chip covers. */
static bool sees_top(const struct lm_target_line *line, const struct lm_target_horizon *horizon,
                     const struct lm_target_set *set, const struct lm_target_candidate *candidate,
                     const struct apparent_position *seen)
{
    const int32_t up_mm = top_mm(lm_target_signature(set, &candidate->body));
    const struct apparent_position ahead = {.range_m_q8 = seen->range_m_q8,
                                            .azimuth = line->azimuth};
    return lit_cell(line, horizon, candidate, &ahead, up_mm) != NO_CELL;
}

/* Draw a target by its chip. */
static uint32_t add_chip(const struct lm_target_line *line,
                         const struct lm_target_candidate *candidate,
                         const struct apparent_position *seen, int16_t *level_db_q8)
{
    const uint32_t cell =
        (seen->range_m_q8 - line->first_m_q8 + line->cell_m_q8 / 2) / line->cell_m_q8;
    const int32_t clutter_db_q8 = area_dbm2_q8(line, cell) - seen->gain_db_q8;
    const struct lm_chip_sector_origin at = {
        .range_m_q8 = seen->range_m_q8,
        .off_bam = (int32_t)(line->azimuth - seen->azimuth),
        .shadow_off_bam = (int32_t)(line->azimuth - seen->true_azimuth),
    };
    return lm_chip_sector_add(candidate, &at, line, clutter_db_q8, level_db_q8);
}

static uint32_t add_target(const struct lm_target_candidates *candidates,
                           const struct lm_target_candidate *candidate,
                           const struct lm_target_line *line,
                           const struct lm_target_horizon *horizon,
                           const struct apparent_position *seen, int16_t *level_db_q8)
{
    struct echo echo;
    if (lm_chip_of(candidate) && line->stretch_cells == 0) {
        int16_t *ground_db_q8 = line->clutter_db_q8 ? line->clutter_db_q8 : level_db_q8;
        return sees_top(line, horizon, &candidates->set, candidate, seen)
                   ? add_chip(line, candidate, seen, ground_db_q8)
                   : 0;
    }
    if (candidate->scatterer_count == 0) {
        make_point_echo(&echo, line, horizon, &candidates->set, candidate, seen);
    } else {
        make_scatterers_echo(&echo, line, horizon, &candidates->set.items[candidate->index],
                             candidate, seen);
    }
    return add_echo(&echo, line, level_db_q8);
}

uint32_t lm_target_line_add(const struct lm_target_candidates *candidates,
                            const struct lm_target_line *line,
                            const struct lm_target_horizon *horizon, int16_t *level_db_q8)
{
    uint32_t cells = 0;
    for (uint32_t left = find_in_reach(candidates, line); left != 0; left &= left - 1) {
        const struct lm_target_candidate *candidate = &candidates->candidate[fx_ctz64(left)];
        struct apparent_position seen;
        if (find_apparent(line, candidate, &seen)) {
            cells += add_target(candidates, candidate, line, horizon, &seen, level_db_q8);
        }
    }
    return cells;
}

uint32_t lm_target_line_replies(const struct lm_target_candidates *candidates,
                                const struct lm_target_line *line,
                                const struct lm_target_horizon *horizon,
                                struct lm_target_reply reply[LM_TARGET_CANDIDATES_MAX])
{
    uint32_t replies = 0;
    for (uint32_t left = find_in_reach(candidates, line); left != 0; left &= left - 1) {
        const struct lm_target_candidate *candidate = &candidates->candidate[fx_ctz64(left)];
        struct apparent_position seen;
        if ((candidate->body.flags & LM_TARGET_IS_BEACON) == 0 ||
            !find_apparent(line, candidate, &seen)) {
            continue;
        }
        const int32_t cell = lit_cell(line, horizon, candidate, &seen, 0);
        if (cell != NO_CELL) { /* it is less than a width off */
            const uint64_t near = line->width - off_line(line, &seen);
            reply[replies++] =
                (struct lm_target_reply){.range_m_q8 = seen.range_m_q8,
                                         .cell = (uint32_t)cell,
                                         .share_q24 = (uint32_t)((near << 24) / line->width),
                                         .code = candidate->body.signature};
        }
    }
    return replies;
}
