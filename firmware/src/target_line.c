#include "lm/target_line.h"

#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/aspect.h"
#include "lm/chip_line.h"

enum { NO_CELL = -1 };

/* ---- where a target is from the line ---- */

struct spot {
    uint32_t range_q8;     /* ground range from the antenna, metres * 256 */
    fx_bam_t azimuth;      /* from the antenna, where it appears */
    fx_bam_t back;         /* from the target to the antenna */
    fx_bam_t true_azimuth; /* where it is */
    int32_t gain_q8;       /* of the beam, dB: 0 or less */
};

/* The farthest that a mover is displaced: beyond, the beam that points where it appears leaves less
 * than -37 dB of it. */
static uint32_t shift_most(const struct lm_target_line *line)
{
    return line->beam + line->beam / 4;
}

/* Can the line meet the target at all, as far as was known when it was chosen? */
static bool may_meet(const struct lm_target_line *line, const struct lm_target *t,
                     const struct lm_target_item *item)
{
    const int32_t off = (int32_t)(item->azimuth - line->azimuth);
    /* What target and antenna may have moved, as an angle: 2^32 / (2 pi) a radian, twice for the
     * arc against its sine and for the antenna's way towards it. */
    const uint64_t moved_q8 = (LM_TARGET_DRIFT_M + LM_TARGET_EXTENT_M) * 256u;
    const uint64_t slack = moved_q8 * 2u * 683565276u / fx_max_u32(item->distance_q8, 1);
    const uint32_t shift = line->is_doppler && t->speed_mm_s != 0 ? shift_most(line) : 0;
    return fx_abs_u32(off) <= slack + line->width + shift;
}

/* Whether a closing speed is one of those that are shown. */
static bool is_in_gate(const struct lm_target_line *line, int32_t closing_mm_s)
{
    const uint32_t either_way_mm_s = fx_abs_u32(closing_mm_s);
    return line->gate_mm_s[1] == 0 ||
           (either_way_mm_s >= line->gate_mm_s[0] && either_way_mm_s <= line->gate_mm_s[1]);
}

/* Put a target where Doppler has it, with what is left of it by the beam, which points there: the
 * two-way pattern 2^(-8 x^2), x in beams. False when it is nowhere. */
static bool displace(const struct lm_target_line *line, int32_t closing_mm_s, struct spot *spot)
{
    int32_t shift;
    const fx_bam_t off = line->track - spot->azimuth;
    if (!lm_mover_shift(closing_mm_s, line->speed_mm_s, off, &shift) ||
        fx_abs_u32(shift) > shift_most(line)) {
        return false;
    }
    /* x in Q12 is at most 5/4; 80 log10(2) dB are 6165 / 256. */
    const uint64_t x_q12 = ((uint64_t)fx_abs_u32(shift) << 12) / fx_max_u32(line->beam, 1);
    spot->azimuth += (fx_bam_t)shift;
    spot->gain_q8 = -(int32_t)(x_q12 * x_q12 * 6165 >> 24);
    return true;
}

static bool find_spot(const struct lm_target_line *line, const struct lm_target *t,
                      const struct lm_target_item *item, struct spot *spot)
{
    uint32_t distance_q8;
    if (!lm_target_locate(line->place, item->pose.place, &spot->range_q8, &spot->azimuth)) {
        return false;
    }
    spot->true_azimuth = spot->azimuth;
    lm_geo_inverse(item->pose.place, line->place, &distance_q8, &spot->back);
    spot->gain_q8 = 0;
    const int32_t closing_mm_s = lm_closing_mm_s(t->speed_mm_s, item->pose.heading, spot->back);
    return is_in_gate(line, closing_mm_s) &&
           (!line->is_doppler || displace(line, closing_mm_s, spot));
}

/* The spot of a scatterer, `along_mm` farther and `across_mm` to the right. */
static struct spot beside(const struct spot *target, const struct lm_return *r)
{
    const int32_t along_q8 = (int32_t)target->range_q8 + (int32_t)((int64_t)r->along_mm * 32 / 125);
    const int32_t across_q8 = (int32_t)((int64_t)r->across_mm * 32 / 125);
    return (struct spot){.range_q8 = fx_hypot_u32(along_q8, across_q8),
                         .azimuth = target->azimuth + fx_atan2(across_q8, along_q8),
                         .gain_q8 = target->gain_q8};
}

static uint32_t off_line(const struct lm_target_line *line, const struct spot *s)
{
    return fx_abs_u32((int32_t)(s->azimuth - line->azimuth));
}

/* What the line takes of a spot's power, 1/256 dB: a spot is shared by the two lines that it lies
 * between, by its nearness to each, so that what the beam makes of both has its middle at the spot.
 * Only for a spot less than a line's width off. */
static int32_t share_q8(const struct lm_target_line *line, const struct spot *s)
{
    return fx_db_q8(line->width - off_line(line, s)) - fx_db_q8(line->width);
}

/* The cell of the line that holds a spot, or NO_CELL. Half-open, so that no two cells share one. */
static int32_t cell_of(const struct lm_target_line *line, const struct spot *s)
{
    const int32_t half_q8 = (int32_t)(line->cell_q8 / 2);
    const int64_t past_q8 = (int64_t)s->range_q8 - line->first_q8 + half_q8;
    if (off_line(line, s) >= line->width || past_q8 < 0) {
        return NO_CELL;
    }
    const uint32_t cell = (uint32_t)past_q8 / line->cell_q8;
    return cell >= line->first && cell < line->cells ? (int32_t)cell : NO_CELL;
}

/* ---- how it is seen ---- */

static struct lm_target_heights heights_of(const struct lm_target_line *line)
{
    return (struct lm_target_heights){line->height_q10, line->reference_q10};
}

/* 10 log10 of the cell's area; the line is as wide as its arc. */
static int32_t area_q8(const struct lm_target_line *line, uint32_t cell)
{
    const struct lm_target_heights h = heights_of(line);
    const uint32_t range_q8 = line->first_q8 + cell * line->cell_q8;
    const uint32_t before_q8 = cell == line->first ? range_q8 : range_q8 - line->cell_q8;
    return lm_clutter_area_q8(lm_arc_q8(range_q8, line->width), line->cell_q8, range_q8, before_q8,
                              &h);
}

/* What becomes of the scatterers of one target in one line. */
struct echo {
    struct lm_return returns[LM_SCATTERERS_MAX];
    int32_t cell[LM_SCATTERERS_MAX]; /* or NO_CELL */
    uint32_t count;
};

/* The line's cell of a return at a spot, unless something nearer hides it. */
static int32_t lit_cell(const struct lm_target_line *line, const struct lm_target_sight *sight,
                        const struct lm_target_item *item, const struct spot *s, int32_t up_mm)
{
    const struct lm_target_heights h = heights_of(line);
    const int32_t cell = cell_of(line, s);
    if (cell == NO_CELL || sight == NULL) {
        return cell;
    }
    const int32_t top_q10 = item->elevation_q6 * 16 + up_mm * 128 / 125;
    const int64_t horizon_q38 = sight->horizon[cell] * ((int64_t)1 << (38 - sight->bits));
    return lm_target_tangent_q38(top_q10, s->range_q8, &h) > horizon_q38 ? cell : NO_CELL;
}

/* What of a target without bodies can be hidden last: the top of its signature. */
static int32_t top_mm(const struct lm_signature *s)
{
    return s ? (int32_t)s->height_mm : 0;
}

static void make_echo(struct echo *e, const struct lm_target_line *line,
                      const struct lm_target_sight *sight, const struct lm_target_set *set,
                      const struct lm_target_item *item, const struct spot *spot)
{
    const struct lm_target *t = &set->items[item->index];
    const struct lm_target_heights h = heights_of(line);
    struct lm_target_view v;
    lm_target_view_of(&v, item, spot->back, spot->range_q8, &h);
    if (t->scatterer_count == 0) {
        e->count = 1;
        e->returns[0] =
            (struct lm_return){.rcs_q8 = lm_target_whole_q8(set, t, &v, line->scan, line->pulse),
                               .up_mm = top_mm(lm_target_signature(set, t))};
    } else {
        e->count = lm_target_returns(t, &v, line->wavelength_um, e->returns);
    }
    for (uint32_t i = 0; i < e->count; i++) {
        const struct spot s = beside(spot, &e->returns[i]);
        e->cell[i] = lit_cell(line, sight, item, &s, e->returns[i].up_mm);
        if (e->cell[i] != NO_CELL) {
            e->returns[i].rcs_q8 += share_q8(line, &s) + s.gain_q8;
        }
    }
}

/* One phasor sum for each cell that has some of the returns. */
static uint32_t add_echo(const struct echo *e, const struct lm_target_line *line, int32_t *level_q8)
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
        const int32_t gamma_q8 =
            lm_returns_sum_q8(e->returns, mask) - area_q8(line, (uint32_t)cell);
        level_q8[cell] = fx_db_q8_sum_of_many(level_q8[cell], gamma_q8);
        cells++;
    }
    return cells;
}

/* Whether the line sees the top of a target that is shown by its chip: over the cell of its range,
 * on whichever line. */
static bool sees_top(const struct lm_target_line *line, const struct lm_target_sight *sight,
                     const struct lm_target_set *set, const struct lm_target_item *item,
                     const struct spot *spot)
{
    const int32_t up_mm = top_mm(lm_target_signature(set, &set->items[item->index]));
    const struct spot ahead = {.range_q8 = spot->range_q8, .azimuth = line->azimuth};
    return lit_cell(line, sight, item, &ahead, up_mm) != NO_CELL;
}

/* Draw a target by its chip. */
static uint32_t add_chip(const struct lm_target_line *line, const struct lm_target_item *item,
                         const struct spot *spot, int32_t *level_q8)
{
    const uint32_t cell = (spot->range_q8 - line->first_q8 + line->cell_q8 / 2) / line->cell_q8;
    const int32_t clutter_q8 = area_q8(line, cell) - spot->gain_q8;
    const struct lm_chip_spot at = {
        .range_q8 = spot->range_q8,
        .off_bam = (int32_t)(line->azimuth - spot->azimuth),
        .shadow_off_bam = (int32_t)(line->azimuth - spot->true_azimuth),
    };
    return lm_chip_line_add(item, &at, line, clutter_q8, level_q8);
}

static uint32_t add_target(const struct lm_targets_near *near, const struct lm_target_item *item,
                           const struct lm_target_line *line, const struct lm_target_sight *sight,
                           const struct spot *spot, int32_t *level_q8)
{
    struct echo echo;
    if (lm_chip_of(item)) {
        return sees_top(line, sight, &near->set, item, spot) ? add_chip(line, item, spot, level_q8)
                                                             : 0;
    }
    make_echo(&echo, line, sight, &near->set, item, spot);
    return add_echo(&echo, line, level_q8);
}

uint32_t lm_target_add(const struct lm_targets_near *near, const struct lm_target_line *line,
                       const struct lm_target_sight *sight, int32_t *level_q8)
{
    uint32_t cells = 0;
    for (uint32_t i = 0; i < near->count; i++) {
        const struct lm_target_item *item = &near->item[i];
        const struct lm_target *t = &near->set.items[item->index];
        struct spot spot;
        if (may_meet(line, t, item) && find_spot(line, t, item, &spot)) {
            cells += add_target(near, item, line, sight, &spot, level_q8);
        }
    }
    return cells;
}
