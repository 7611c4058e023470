#include "lm/target_patch.h"

#include "fx/bits.h"
#include "fx/log.h"
#include "fx/mem.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/illumination.h"
#include "lm/units.h"

/* ---- positions of the scatterers ---- */

/* Position of a target in the patch: range from the antenna along the line of sight through the
 * centre, and offset to the right of it. `aside` is the direction of the target's own ray, from
 * that line of sight. The other members are counted where the patch's lines are a cell apart, at
 * the centre's range: `shift` is its displacement by Doppler. */
struct patch_position {
    int32_t range_m_q8, across_m_q8;
    fx_bam_t aside;
    int32_t shift_m_q8;
    int64_t smear_across_m_q8,
        walk_m_q8; /* change over the dwell: across where it appears, and along */
};

/* Length across at a range, as it is at the centre's range: x S / s. Ranges are below 2^27. Lengths
 * are held to 2^35 before and to 2^26 behind: both are far outside of any patch. */
static int32_t at_centre_m_q8(const struct lm_patch_geometry *g, int64_t length_m_q8,
                              int32_t range_m_q8)
{
    const int64_t most = (int64_t)1 << 35, limit = 1 << 26;
    const int64_t held_m_q8 = fx_clamp_i64(length_m_q8, -most, most);
    return (int32_t)fx_clamp_i64(held_m_q8 * g->centre_m_q8 / fx_max_i32(range_m_q8, 1), -limit,
                                 limit);
}

/* Area of a clutter cell at a range, where lines are s / S cells apart. */
static int32_t area_dbm2_q8(const struct lm_patch_geometry *g, int32_t range_m_q8)
{
    const uint32_t held_m_q8 = (uint32_t)fx_max_i32(range_m_q8, 1);
    const uint64_t width_m_q8 = (uint64_t)g->cell_m_q8 * held_m_q8 / g->centre_m_q8;
    return lm_clutter_area_dbm2_q8(width_m_q8 != 0 ? width_m_q8 : 1, g->cell_m_q8, held_m_q8,
                                   held_m_q8 - fx_min_u32(held_m_q8, g->cell_m_q8), &g->heights);
}

/* Displace a mover and compute its smear. With v the closing speed, v' its speed to the right, V
 * the radar's speed across and s the range:
 *
 *     displacement          s v / V across
 *     smear over the dwell  (2 v' - v'^2 / V) T across, -v T along
 *
 * Both times S / s, as all lengths across.
 * The radar flies by it at V - v' instead of V, so its displacement drifts while the dwell lasts.
 */
static void put_mover(const struct lm_patch_geometry *g, const struct lm_mover_state *state,
                      struct patch_position *position)
{
    /* Speeds are below 2^20, ranges below 2^27, the dwell below 2^17: products are below 2^58. A
     * displacement beyond 2^26 is far outside of any patch. */
    const fx_bam_t ray = g->look + position->aside;
    const int64_t closing_mm_s =
        lm_mover_closing_mm_s(state->speed_mm_s, state->course, ray + FX_BAM_180);
    const int64_t right_mm_s =
        lm_mover_closing_mm_s(state->speed_mm_s, state->course, ray + FX_BAM_90);
    const int64_t shift_m_q8 = g->centre_m_q8 * closing_mm_s / g->across_mm_s, limit = 1 << 26;
    const int64_t drift_mm_s = 2 * right_mm_s - right_mm_s * right_mm_s / g->across_mm_s;
    position->shift_m_q8 = (int32_t)fx_clamp_i64(shift_m_q8, -limit, limit);
    position->smear_across_m_q8 =
        at_centre_m_q8(g, lm_m_q8_of_um(drift_mm_s * g->dwell_ms), position->range_m_q8);
    position->walk_m_q8 = lm_m_q8_of_um(-closing_mm_s * g->dwell_ms);
}

static bool find_position(const struct lm_patch_geometry *g,
                          const struct lm_target_candidate *candidate,
                          struct patch_position *position)
{
    uint32_t distance_m_q8;
    fx_bam_t azimuth;
    if (!lm_target_view_locate(g->centre, candidate->state.position, &distance_m_q8, &azimuth)) {
        return false;
    }
    const fx_bam_t off = azimuth - g->look;
    const int64_t along_m_q8 = (int64_t)distance_m_q8 * fx_cos_q30(off) >> 30;
    position->range_m_q8 = fx_max_i32((int32_t)(g->centre_m_q8 + along_m_q8), 0);
    position->across_m_q8 = (int32_t)((int64_t)distance_m_q8 * fx_sin_q30(off) >> 30);
    position->aside = fx_atan2(position->across_m_q8, fx_max_i32(position->range_m_q8, 1));
    position->shift_m_q8 = 0;
    position->smear_across_m_q8 = position->walk_m_q8 = 0;
    if (candidate->is_mover && g->across_mm_s != 0) {
        put_mover(g, &candidate->state, position);
    }
    return true;
}

/* Metres * 256 in cells * 256. */
static int32_t in_cells(const struct lm_patch_geometry *g, int64_t length_m_q8)
{
    return (int32_t)lm_cells_q8_of_m_q8(length_m_q8, g->cell_m_q8);
}

/* Range of a target along its own ray, at least 1. */
static uint32_t ray_range_m_q8(const struct patch_position *position)
{
    return fx_max_u32(fx_hypot_u32(position->range_m_q8, position->across_m_q8), 1);
}

/* Range of the middle of cell 0. */
static int64_t near_m_q8_of(const struct lm_patch_geometry *g)
{
    return g->centre_m_q8 - ((int64_t)g->cells - 1) * g->cell_m_q8 / 2;
}

/* Scatterer of one return. A return lies along and across its target's ray. s is its range, x its
 * offset across, both along the line of sight through the centre; y is its height above the
 * reference, v the displacement by Doppler. In cells from the middle of cell 0 of line 0:
 *
 *     across = x S / s + v + half the lines
 *     along  = s - near end - y tan(psi)        the last term is layover
 *
 * Its level is its cross section over the area of a clutter cell. Lengths are below 2^29; times 256
 * they need 64 bits. */
static struct lm_patch_scatterer scatterer_of(const struct lm_patch_geometry *g,
                                              const struct lm_target_candidate *candidate,
                                              const struct patch_position *position,
                                              const struct lm_return *r)
{
    const int64_t sin_q30 = fx_sin_q30(position->aside), cos_q30 = fx_cos_q30(position->aside);
    const int64_t out_m_q8 = lm_m_q8_of_mm(r->along_mm), right_m_q8 = lm_m_q8_of_mm(r->across_mm);
    const int32_t range_m_q8 =
        position->range_m_q8 + (int32_t)((out_m_q8 * cos_q30 - right_m_q8 * sin_q30) >> 30);
    const int64_t across_m_q8 = at_centre_m_q8(
        g, position->across_m_q8 + ((right_m_q8 * cos_q30 + out_m_q8 * sin_q30) >> 30), range_m_q8);
    const int32_t top_m_q10 =
        lm_m_q10_of_m_q6(candidate->elevation_m_q6) + lm_m_q10_of_mm(r->up_mm);
    /* Coordinates count from the middle of the first line and of its first cell. */
    const int64_t left_m_q8 = (int64_t)(g->lines - 1) * g->cell_m_q8 / 2;
    const int64_t near_m_q8 = near_m_q8_of(g);
    const int64_t nearer_m_q8 =
        (int64_t)(top_m_q10 - g->heights.reference_m_q10) * g->lean_q16 >> 18;
    const uint32_t held_m_q8 = (uint32_t)fx_max_i32(range_m_q8, 1);
    struct lm_patch_scatterer p = {
        .across_cells_q8 = in_cells(g, across_m_q8 + position->shift_m_q8 + left_m_q8),
        .along_cells_q8 = in_cells(g, range_m_q8 - near_m_q8 - nearer_m_q8),
        .level_db_q8 = r->rcs_dbsm_q8 - area_dbm2_q8(g, range_m_q8),
        .phase = r->phase,
        .tangent_q38 = lm_target_view_tangent_q38(top_m_q10, held_m_q8, &g->heights),
        .line = lm_cells_of_cells_q8(in_cells(g, across_m_q8 + left_m_q8)),
        .cell = lm_cells_of_cells_q8(in_cells(g, range_m_q8 - near_m_q8)),
        .is_displaced = position->shift_m_q8 != 0,
    };
    return p;
}

/* Add a scatterer for each return of a target. All pulses of the dwell make one picture, so every
 * Swerling case is drawn once for it. A target with a signature is hidden when its top is. */
static void add_returns(struct lm_target_patch *p, const struct lm_target_set *set,
                        const struct lm_target_candidate *candidate,
                        const struct lm_patch_geometry *g, const struct patch_position *position,
                        uint8_t target)
{
    const struct lm_signature *s = lm_target_signature(set, &candidate->body);
    struct lm_return returns[LM_SCATTERERS_MAX];
    struct lm_target_view v;
    uint32_t count = 1;
    lm_target_view_of(&v, candidate, g->look + position->aside + FX_BAM_180,
                      ray_range_m_q8(position), &g->heights);
    if (candidate->scatterer_count != 0) {
        count = lm_target_returns(&set->items[candidate->index], &v, g->wavelength_um, returns);
    } else {
        returns[0] = (struct lm_return){
            .rcs_dbsm_q8 = lm_target_view_rcs_dbsm_q8(set, &candidate->body, &v, g->epoch, 0)};
    }
    for (uint32_t k = 0; k < count; k++) {
        struct lm_patch_scatterer *scatterer = &p->scatterer[p->scatterer_count++];
        *scatterer = scatterer_of(g, candidate, position, &returns[k]);
        scatterer->target = target;
        if (s) {
            scatterer->tangent_q38 = lm_target_view_tangent_q38(
                lm_m_q10_of_m_q6(candidate->elevation_m_q6) + lm_m_q10_of_mm((int32_t)s->height_mm),
                (uint32_t)fx_max_i32(position->range_m_q8, 1), &g->heights);
        }
    }
}

/* Mark lines first..end - 1, as far as they exist, as touched by a target. */
static void note_lines(struct lm_target_patch *p, uint32_t target, int32_t first, int32_t end,
                       const struct lm_patch_geometry *g)
{
    const int32_t last = fx_min_i32(end, (int32_t)g->lines);
    for (int32_t line = fx_max_i32(first, 0); line < last; line++) {
        p->on_line[line] |= (uint32_t)1 << target;
    }
}

/* Mark the lines from one coordinate to another, and up to `reach_cells_q8` beyond the ends of the
 * smear. */
static void note_around(struct lm_target_patch *p, uint32_t target, int32_t left_cells_q8,
                        int32_t right_cells_q8, uint32_t reach_cells_q8,
                        const struct lm_patch_geometry *g)
{
    const struct lm_smear *smear = &p->target[target].smear;
    const int32_t aside_cells_q8 =
        (int32_t)(fx_abs_u32(smear->across_cells_q8) * smear->slices / 2 + reach_cells_q8);
    note_lines(p, target, (left_cells_q8 - aside_cells_q8) >> 8,
               ((right_cells_q8 + aside_cells_q8) >> 8) + 1, g);
}

/* Mark the lines that a target's scatterers may touch, and those that hold their true positions. */
static void note_scatterers(struct lm_target_patch *p, uint32_t target,
                            const struct lm_patch_geometry *g)
{
    struct lm_patch_target *t = &p->target[target];
    int32_t left_cells_q8 = INT32_MAX, right_cells_q8 = INT32_MIN;
    for (uint32_t i = t->begin; i < t->end; i++) {
        const struct lm_patch_scatterer *scatterer = &p->scatterer[i];
        note_lines(p, target, scatterer->line, scatterer->line + 1, g);
        if (!scatterer->is_chip) {
            left_cells_q8 = fx_min_i32(left_cells_q8, scatterer->across_cells_q8);
            right_cells_q8 = fx_max_i32(right_cells_q8, scatterer->across_cells_q8);
        }
    }
    t->has_scatterers = left_cells_q8 <= right_cells_q8;
    /* The response's width is rounded by at most 1/256, less than a cell in all. */
    note_around(p, target, left_cells_q8, right_cells_q8,
                (LM_RESPONSE_REACH + 1) * t->smear.across_stretch_q8, g);
}

/* Replace the target's single scatterer by its chip. */
static void add_chip(struct lm_target_patch *p, const struct lm_target_candidate *candidate,
                     const struct lm_patch_geometry *g, const struct patch_position *position)
{
    struct lm_patch_scatterer *scatterer = &p->scatterer[p->scatterer_count - 1];
    struct lm_patch_chip *chip = &p->chip[scatterer->target];
    const struct lm_chip_cells cells_there = {
        .cell_mm = lm_mm_of_m_q8(g->cell_m_q8),
        .wide_q16 =
            (uint32_t)(((uint64_t)fx_max_i32(position->range_m_q8, 1) << 16) / g->centre_m_q8),
        .aside = position->aside,
    };
    chip->scatterer = p->scatterer_count - 1;
    chip->shadow_across_cells_q8 = scatterer->across_cells_q8 - in_cells(g, position->shift_m_q8);
    chip->shadow_along_cells_q8 = in_cells(g, position->range_m_q8 - near_m_q8_of(g));
    chip->area_dbm2_q8 = area_dbm2_q8(g, position->range_m_q8);
    chip->range_m_q8 = position->range_m_q8;
    lm_chip_slope_set(&chip->slope, lm_m_q10_of_m_q6(candidate->elevation_m_q6),
                      (uint32_t)fx_max_i32(position->range_m_q8, 1), g->cell_m_q8, &g->heights);
    lm_chip_patch_set(&chip->patch, candidate->chip, candidate->chip_turn, &cells_there,
                      &p->target[scatterer->target].smear);
    scatterer->is_chip = p->target[scatterer->target].has_chip = true;
    const struct lm_chip_reach *lit = &chip->patch.lit, *dark = &chip->patch.dark;
    const uint32_t cells = fx_max_u32(fx_abs_u32(lit->right), fx_abs_u32(lit->right_end)) + 1;
    const int32_t shadow = lm_cells_of_cells_q8(chip->shadow_across_cells_q8);
    note_around(p, scatterer->target, scatterer->across_cells_q8, scatterer->across_cells_q8,
                (uint32_t)lm_cells_q8_of_cells((int32_t)cells), g);
    note_lines(p, scatterer->target, shadow + dark->right, shadow + dark->right_end, g);
}

void lm_target_patch_clear(struct lm_target_patch *p)
{
    p->scatterer_count = p->target_count = 0;
    memset(p->on_line, 0, sizeof p->on_line);
}

void lm_target_patch_set(struct lm_target_patch *p, const struct lm_target_candidates *candidates,
                         const struct lm_patch_geometry *g)
{
    memset(p, 0, sizeof *p);
    for (uint32_t i = 0; i < candidates->count; i++) {
        const struct lm_target_candidate *candidate = &candidates->candidate[i];
        struct lm_patch_target *t = &p->target[p->target_count];
        struct patch_position position;
        if (find_position(g, candidate, &position)) {
            t->smear = lm_smear_of(lm_cells_q8_of_m_q8(position.smear_across_m_q8, g->cell_m_q8),
                                   lm_cells_q8_of_m_q8(position.walk_m_q8, g->cell_m_q8));
            t->begin = p->scatterer_count;
            add_returns(p, &candidates->set, candidate, g, &position, (uint8_t)p->target_count);
            if (lm_chip_of(candidate)) {
                add_chip(p, candidate, g, &position);
            }
            t->end = p->scatterer_count;
            note_scatterers(p, p->target_count, g);
            p->target_count++;
        }
    }
}

/* ---- one line ---- */

/* Next target of a set of bits, which is taken out of it. */
static uint32_t take_next(uint32_t *targets)
{
    const uint32_t next = (uint32_t)fx_ctz64(*targets);
    *targets &= *targets - 1;
    return next;
}

void lm_target_patch_mark_hidden(struct lm_target_patch *p, uint32_t line, const int32_t *horizon,
                                 uint32_t bits, uint32_t cells)
{
    for (uint32_t left = p->on_line[line]; left != 0;) {
        const struct lm_patch_target *t = &p->target[take_next(&left)];
        for (uint32_t i = t->begin; i < t->end; i++) {
            struct lm_patch_scatterer *scatterer = &p->scatterer[i];
            if (scatterer->line == (int32_t)line && scatterer->cell >= 0) {
                /* Behind the last cell, the whole line may hide it. */
                const uint32_t before = fx_min_u32((uint32_t)scatterer->cell, cells);
                scatterer->is_hidden =
                    scatterer->is_shaded ||
                    scatterer->tangent_q38 <= horizon[before] * ((int64_t)1 << (38 - bits));
            }
        }
    }
}

/* Cells of a line that were traced: from the overscan before cell 0 to that behind the patch. */
static int32_t traced_cell(const struct lm_patch_geometry *g, int64_t cell)
{
    return (int32_t)fx_clamp_i64(cell, -(int64_t)g->overscan, (int64_t)g->traced - g->overscan - 1);
}

/* Take the slope between the two ends of what a chip shows. Boxes of pixels are as much longer as
 * they are farther from each other. */
static void lean(struct lm_patch_chip *chip, int32_t cell, const int32_t *elevation_m_q14,
                 const struct lm_patch_geometry *g)
{
    struct lm_chip_patch *patch = &chip->patch;
    const int32_t near = traced_cell(g, (int64_t)cell + patch->lit.beyond);
    const int32_t far = traced_cell(g, (int64_t)cell + patch->lit.beyond_end);
    if (far <= near) {
        return;
    }
    lm_chip_slope_lean(&chip->slope, elevation_m_q14[traced_cell(g, cell)],
                       elevation_m_q14[far] - elevation_m_q14[near],
                       (uint32_t)(far - near) * g->cell_m_q8, g->lean_q16);
    const int64_t stretch_q16 = chip->slope.stretch_q16;
    patch->lit.beyond = (int32_t)((int64_t)patch->lit.beyond * 65536 / stretch_q16) - 1;
    patch->lit.beyond_end = (int32_t)((int64_t)patch->lit.beyond_end * 65536 / stretch_q16) + 1;
    patch->half_px_q8[1] = (int32_t)(patch->half_px_q8[1] * stretch_q16 >> 16);
}

void lm_target_patch_lean(struct lm_target_patch *p, uint32_t line, const int32_t *elevation_m_q14,
                          const struct lm_patch_geometry *g)
{
    for (uint32_t left = p->on_line[line]; left != 0;) {
        const uint32_t target = take_next(&left);
        struct lm_patch_chip *chip = &p->chip[target];
        const struct lm_patch_scatterer *at = &p->scatterer[chip->scatterer];
        if (p->target[target].has_chip && at->line == (int32_t)line && !chip->slope.is_known) {
            lean(chip, at->cell, elevation_m_q14, g);
        }
    }
}

/* Is a place on a chip's line more than half in its shadow? It is where a ray over it meets the
 * level of the foot. */
static bool is_dark(const struct lm_patch_chip *chip, int32_t right_cells_q8, int64_t level_q8)
{
    return level_q8 >= lm_cells_q8_of_cells(chip->patch.dark.beyond) &&
           level_q8 < lm_cells_q8_of_cells(chip->patch.dark.beyond_end) &&
           lm_chip_patch_shadow(&chip->patch, right_cells_q8, (int32_t)level_q8) >
               LM_CHIP_SHADOW_ALL / 2;
}

/* A target behind the hider is in its shadow if the ray over its top meets the level of the hider's
 * foot in the dark. Cells are within 2^23 either way, and their difference within 2^24; that far
 * the range is within 2^40, and is held to 2^27. Tangents at one range differ by less than 2^63 /
 * range, so cut by 2^12 and times the range the difference is below 2^51; a height is 2^30 in Q14.
 */
static bool is_below_shadow(const struct lm_patch_chip *chip, const struct lm_patch_scatterer *from,
                            const struct lm_patch_scatterer *at, const struct lm_patch_geometry *g)
{
    const int32_t right_cells_q8 = lm_cells_q8_of_cells(at->line) - chip->shadow_across_cells_q8;
    const int32_t beyond = at->cell - from->cell;
    const uint32_t range_m_q8 = (uint32_t)fx_clamp_i64(
        chip->range_m_q8 + (int64_t)beyond * g->cell_m_q8, 1, (int64_t)1 << 27);
    const int64_t above_q38 =
        at->tangent_q38 -
        lm_target_view_tangent_q38(chip->slope.foot_m_q14 / 16, range_m_q8, &g->heights);
    const int32_t rise_m_q14 =
        (int32_t)fx_clamp_i64((above_q38 >> 12) * range_m_q8 >> 20, INT32_MIN, INT32_MAX);
    return beyond > 0 && is_dark(chip, right_cells_q8,
                                 lm_chip_slope_level_cells_q8(
                                     &chip->slope, lm_cells_q8_of_cells(beyond), rise_m_q14));
}

bool lm_target_patch_mark_shaded(struct lm_target_patch *p, uint32_t number,
                                 const struct lm_patch_geometry *g)
{
    struct lm_patch_scatterer *at = &p->scatterer[number];
    bool is_looked_at = false;
    if (at->line < 0 || at->line >= (int32_t)g->lines) {
        return false;
    }
    for (uint32_t left = p->on_line[at->line]; left != 0 && !at->is_shaded;) {
        const uint32_t target = take_next(&left);
        const struct lm_patch_chip *chip = &p->chip[target];
        const struct lm_patch_scatterer *from = &p->scatterer[chip->scatterer];
        if (p->target[target].has_chip && target != at->target &&
            (from->is_shaded || !from->is_hidden)) {
            at->is_shaded = is_below_shadow(chip, from, at, g);
            is_looked_at = true;
        }
    }
    at->is_hidden |= at->is_shaded;
    return is_looked_at;
}

/* Slice of the dwell: its offset from the scatterer, its share of the power, and its stretch.
 * thin_q16 and flat_q16 are the inverse stretch across and along. */
struct slice {
    int32_t across_cells_q8, along_cells_q8, share_db_q8;
    int32_t thin_q16, flat_q16;
    uint32_t deep_q8;
};

static struct slice slice_of(const struct lm_smear *s, uint32_t number)
{
    const int32_t from_middle = 2 * (int32_t)number + 1 - (int32_t)s->slices;
    return (struct slice){.across_cells_q8 = from_middle * s->across_cells_q8 / 2,
                          .along_cells_q8 = from_middle * s->along_cells_q8 / 2,
                          .share_db_q8 = lm_smear_share_db_q8(s, number),
                          .thin_q16 = (int32_t)((256u << 16) / s->across_stretch_q8),
                          .flat_q16 = (int32_t)((256u << 16) / s->along_stretch_q8),
                          .deep_q8 = s->along_stretch_q8};
}

/* Distance in units of the stretched response. */
static int32_t squeezed(int32_t x_cells_q8, int32_t inverse_q16)
{
    return (int32_t)((int64_t)x_cells_q8 * inverse_q16 >> 16);
}

/* Cells of the response on either side that a scatterer of this level reaches, on a line
 * `dx_cells_q8` beside it. -1 if it does not reach the line. The envelope is the peak of the
 * response within each cell. */
static int32_t reach_of(int32_t level_db_q8, int32_t dx_cells_q8, int32_t least_db_q8)
{
    const uint32_t away_cells_q8 = fx_abs_u32(dx_cells_q8);
    if (away_cells_q8 >= (uint32_t)lm_cells_q8_of_cells(LM_RESPONSE_REACH)) {
        return -1;
    }
    const int32_t most_db_q8 = level_db_q8 + lm_response_envelope_db_q8[away_cells_q8 / 256];
    int32_t reach = LM_RESPONSE_REACH - 1;
    /* The cell `reach` cells away is at least half a cell nearer than that. */
    while (reach > 0 && most_db_q8 + lm_response_envelope_db_q8[reach - 1] < least_db_q8) {
        reach--;
    }
    return most_db_q8 + lm_response_envelope_db_q8[0] < least_db_q8 ? -1 : reach;
}

/* Cells of a line, first..end - 1. */
struct span {
    int32_t first, end;
};

/* Add a slice of a scatterer to the cells of line `line`: A h(x) h(y) exp(j phi), with h the point
 * response and A relative to `reference_db_q8`. Amplitudes are at most 2^24 and a target has 16
 * scatterers: sums are below 2^28. What stays below `least_db_q8` is left out. */
static void spread(struct lm_target_patch *work, const struct lm_patch_scatterer *p,
                   const struct slice *slice, uint32_t line, int32_t least_db_q8,
                   int32_t reference_db_q8, struct span within, struct span *touched)
{
    const int32_t dx_cells_q8 =
        squeezed(lm_cells_q8_of_cells((int32_t)line) - p->across_cells_q8 - slice->across_cells_q8,
                 slice->thin_q16);
    const int32_t level_db_q8 = p->level_db_q8 + slice->share_db_q8;
    const int32_t reach = reach_of(level_db_q8, dx_cells_q8, least_db_q8);
    if (reach < 0) {
        return;
    }
    const int64_t amplitude_q24 =
        (int64_t)fx_power_q16_from_db_q8((level_db_q8 - reference_db_q8) / 2) << 8;
    const int64_t line_q24 = amplitude_q24 * lm_response(dx_cells_q8) >> 15;
    const int64_t re_q24 = line_q24 * fx_cos_q30(p->phase) >> 30;
    const int64_t im_q24 = line_q24 * fx_sin_q30(p->phase) >> 30;
    const int32_t along_cells_q8 = p->along_cells_q8 + slice->along_cells_q8,
                  middle = lm_cells_of_cells_q8(along_cells_q8);
    const int32_t cells = (int32_t)((uint32_t)reach * slice->deep_q8 / 256);
    const int32_t first = fx_max_i32(middle - cells, within.first);
    const int32_t end = fx_min_i32(middle + cells + 1, within.end);
    for (int32_t i = first; i < end; i++) {
        const int32_t response_q15 =
            lm_response(squeezed(lm_cells_q8_of_cells(i) - along_cells_q8, slice->flat_q16));
        work->re_q24[i] += (int32_t)(re_q24 * response_q15 >> 15);
        work->im_q24[i] += (int32_t)(im_q24 * response_q15 >> 15);
    }
    if (first < end) {
        touched->first = fx_min_i32(touched->first, first);
        touched->end = fx_max_i32(touched->end, end);
    }
}

/* Add the sums to the levels, and clear them. */
static void collect(struct lm_target_patch *work, struct span touched, int32_t reference_db_q8,
                    int16_t *level_db_q8)
{
    const int32_t unit_q8 = fx_db_q8_u64((uint64_t)1 << 48);
    for (int32_t i = touched.first; i < touched.end; i++) {
        const int64_t re_q24 = work->re_q24[i], im_q24 = work->im_q24[i];
        const uint64_t power_q48 = (uint64_t)(re_q24 * re_q24 + im_q24 * im_q24);
        work->re_q24[i] = work->im_q24[i] = 0;
        if (power_q48 != 0) {
            const int32_t echo_db_q8 = reference_db_q8 + fx_db_q8_u64(power_q48) - unit_q8;
            level_db_q8[i] = fx_sat_i16(fx_db_q8_sum_vec(level_db_q8[i], echo_db_q8));
        }
    }
}

/* Add one target: its scatterers as phasors, and the slices of its dwell as powers, because their
 * phases drift apart. */
static void add_target(struct lm_target_patch *p, const struct lm_patch_target *t, uint32_t line,
                       int32_t least_db_q8, struct span within, int16_t *level_db_q8)
{
    const struct lm_smear *smear = &t->smear;
    int32_t strongest_db_q8 = p->scatterer[t->begin].level_db_q8;
    for (uint32_t i = t->begin + 1; i < t->end; i++) {
        strongest_db_q8 = fx_max_i32(strongest_db_q8, p->scatterer[i].level_db_q8);
    }
    for (uint32_t number = 0; number < smear->slices; number++) {
        const struct slice slice = slice_of(smear, number);
        struct span touched = {within.end, within.first};
        const int32_t reference_db_q8 = strongest_db_q8 + slice.share_db_q8;
        for (uint32_t i = t->begin; i < t->end; i++) {
            if (!p->scatterer[i].is_hidden && !p->scatterer[i].is_chip) {
                spread(p, &p->scatterer[i], &slice, line, least_db_q8, reference_db_q8, within,
                       &touched);
            }
        }
        collect(p, touched, reference_db_q8, level_db_q8);
    }
}

void lm_target_patch_add_scatterers(struct lm_target_patch *p, uint32_t line, int32_t least_db_q8,
                                    const struct lm_patch_geometry *g, int16_t *level_db_q8)
{
    const struct span within = {(int32_t)g->first, (int32_t)g->cells};
    for (uint32_t left = p->on_line[line]; left != 0;) {
        const struct lm_patch_target *t = &p->target[take_next(&left)];
        if (t->has_scatterers) {
            add_target(p, t, line, least_db_q8, within, level_db_q8);
        }
    }
}

/* ---- chips ---- */

/* Origin of a chip in the patch. */
struct origin {
    int32_t across_cells_q8, along_cells_q8;
};

/* Cells of a line that a chip may reach; none if its target is hidden. */
static struct span cells_under(const struct lm_chip_reach *reach,
                               const struct lm_patch_scatterer *at, const struct origin *origin,
                               uint32_t line, const struct lm_patch_geometry *g)
{
    const int32_t middle = lm_cells_of_cells_q8(origin->along_cells_q8);
    const int32_t aside = (int32_t)line - lm_cells_of_cells_q8(origin->across_cells_q8);
    if (at->is_hidden || aside < reach->right || aside >= reach->right_end) {
        return (struct span){0, 0};
    }
    return (struct span){fx_max_i32(middle + reach->beyond, (int32_t)g->first),
                         fx_min_i32(middle + reach->beyond_end, (int32_t)g->cells)};
}

/* Darken one cell by a part of its clutter. */
static int16_t darkened_db_q8(int16_t level_db_q8, uint32_t dark)
{
    const int32_t lit_q8 = fx_db_q8(LM_CHIP_SHADOW_ALL);
    return dark == LM_CHIP_SHADOW_ALL
               ? LM_LEVEL_SHADOW
               : fx_sat_i16(level_db_q8 + fx_db_q8(LM_CHIP_SHADOW_ALL - dark) - lit_q8);
}

/* Darken the cells of a line that a chip's shadow reaches. Before the origin the ground counts as
 * level, for the target stands on it. Where a ray over the ground is beyond the shadow the rest is
 * lit, or in the shadow of the ground. */
static void shade(const struct lm_target_patch *p, const struct lm_patch_chip *chip, uint32_t line,
                  const struct lm_patch_geometry *g, const int32_t *elevation_m_q14,
                  int16_t *level_db_q8)
{
    const struct lm_chip_reach *dark = &chip->patch.dark;
    const int32_t along_cells_q8 = chip->shadow_along_cells_q8;
    const int32_t right_cells_q8 =
        lm_cells_q8_of_cells((int32_t)line) - chip->shadow_across_cells_q8;
    const int32_t aside = (int32_t)line - lm_cells_of_cells_q8(chip->shadow_across_cells_q8);
    const int64_t first =
        lm_cells_of_cells_q8(along_cells_q8) + (int64_t)fx_min_i32(dark->beyond, 0);
    const int32_t end = (int32_t)(g->traced - g->overscan);
    if (p->scatterer[chip->scatterer].is_hidden || aside < dark->right ||
        aside >= dark->right_end || first >= end) {
        return;
    }
    for (int32_t i = traced_cell(g, first); i < end; i++) {
        const int32_t beyond_cells_q8 = lm_cells_q8_of_cells(i) - along_cells_q8;
        const int32_t rise_m_q14 =
            beyond_cells_q8 > 0 ? elevation_m_q14[i] - chip->slope.foot_m_q14 : 0;
        const int64_t level_q8 =
            lm_chip_slope_level_cells_q8(&chip->slope, beyond_cells_q8, rise_m_q14);
        if (level_q8 >= lm_cells_q8_of_cells(dark->beyond_end)) {
            return;
        }
        if (level_q8 >= lm_cells_q8_of_cells(dark->beyond)) {
            level_db_q8[i] =
                darkened_db_q8(level_db_q8[i], lm_chip_patch_shadow(&chip->patch, right_cells_q8,
                                                                    (int32_t)level_q8));
        }
    }
}

void lm_target_patch_shade(const struct lm_target_patch *p, uint32_t line,
                           const struct lm_patch_geometry *g, const int32_t *elevation_m_q14,
                           int16_t *level_db_q8)
{
    for (uint32_t left = p->on_line[line]; left != 0;) {
        const uint32_t target = take_next(&left);
        if (p->target[target].has_chip) {
            shade(p, &p->chip[target], line, g, elevation_m_q14, level_db_q8);
        }
    }
}

/* Cells that a chip is displayed nearer on a line, as the ground across is higher there than below
 * its origin. Ground that rises by more than one in one is a step, and not what it stands on. */
static int32_t nearer_cells_q8(const struct lm_patch_chip *chip,
                               const struct lm_patch_scatterer *at, uint32_t line,
                               const struct lm_patch_geometry *g, const int32_t *elevation_m_q14)
{
    const int32_t cell = traced_cell(g, at->cell);
    if (!chip->slope.is_known || at->is_displaced || cell != at->cell) {
        return 0;
    }
    /* A line is at most 2^11 cells away, of 2^16 m. */
    const int64_t most_m_q14 = (int64_t)fx_abs_u32((int32_t)line - at->line) * g->cell_m_q8 << 6;
    const int64_t rise_m_q14 = fx_clamp_i64(
        (int64_t)elevation_m_q14[cell] - chip->slope.ground_m_q14, -most_m_q14, most_m_q14);
    return in_cells(g, rise_m_q14 * g->lean_q16 >> 22);
}

/* Add one slice of a chip's smear to a line, unless it is more than `room` cells. Returns the
 * number of its cells. */
static uint32_t add_slice(const struct lm_patch_chip *chip, const struct lm_patch_scatterer *at,
                          const struct slice *slice, uint32_t line, uint32_t room,
                          const struct lm_patch_geometry *g, int16_t *level_db_q8)
{
    const struct origin origin = {at->across_cells_q8 + slice->across_cells_q8,
                                  at->along_cells_q8 + slice->along_cells_q8};
    const int64_t stretch_q16 = chip->slope.stretch_q16;
    const struct span under = cells_under(&chip->patch.lit, at, &origin, line, g);
    const uint32_t cells = (uint32_t)fx_max_i32(under.end - under.first, 0);
    const int32_t right_cells_q8 = lm_cells_q8_of_cells((int32_t)line) - origin.across_cells_q8;
    for (int32_t i = under.first; i < under.end && cells <= room; i++) {
        const int64_t shown_cells_q8 = lm_cells_q8_of_cells(i) - origin.along_cells_q8;
        const int32_t rcs_dbsm_q8 = lm_chip_patch_rcs_dbsm_q8(
            &chip->patch, right_cells_q8, (int32_t)(shown_cells_q8 * stretch_q16 >> 16));
        if (rcs_dbsm_q8 > LM_RCS_NONE_DBSM_Q8) {
            const int32_t chip_db_q8 = rcs_dbsm_q8 + slice->share_db_q8 - chip->area_dbm2_q8;
            level_db_q8[i] = fx_sat_i16(fx_db_q8_sum_vec(level_db_q8[i], chip_db_q8));
        }
    }
    return cells;
}

uint32_t lm_target_patch_add_chips(const struct lm_target_patch *p, uint32_t line,
                                   const struct lm_patch_geometry *g,
                                   const int32_t *elevation_m_q14, int16_t *level_db_q8)
{
    uint32_t room = LM_CHIP_CELLS_A_LINE, left_out = 0;
    for (uint32_t targets = p->on_line[line]; targets != 0;) {
        const uint32_t target = take_next(&targets);
        const struct lm_patch_chip *chip = &p->chip[target];
        const struct lm_patch_scatterer *at = &p->scatterer[chip->scatterer];
        const struct lm_smear *smear = &p->target[target].smear;
        const uint32_t slices = p->target[target].has_chip ? smear->slices : 0;
        for (uint32_t number = 0; number < slices; number++) {
            struct slice slice = slice_of(smear, number);
            slice.along_cells_q8 -= nearer_cells_q8(chip, at, line, g, elevation_m_q14);
            const uint32_t cells = add_slice(chip, at, &slice, line, room, g, level_db_q8);
            left_out += cells > room ? cells : 0;
            room -= cells > room ? 0 : cells;
        }
    }
    return left_out;
}
