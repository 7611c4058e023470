#include "lm/patch_rain.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/mem.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/const.h"
#include "lm/radar.h"
#include "lm/units.h"
#include "shower.h"

enum {
    RAYS = 20,            /* rays that sample the beam, an eighth of its width apart */
    STATIONS = 16,        /* in a beam's width, where the veil is computed */
    HALF_BEAM_Q8 = -1086, /* 10 log10(sqrt(pi / (8 ln 2)) / 2) */
    BEAM_LEAST = 1 << 16,
    NOTHING_Q8 = LM_DB_Q8(-100),
    RANGE_MOST_Q8 = 1 << 27
};

/* Cells on the ray in direction `aside`, by their range along it: 1 / cos(aside) times that along
 * the line of sight to the centre. Rays to a patch are within 75 degrees of that. */
static struct lm_shower_cells reach_of(const struct lm_patch_geometry *g, fx_bam_t aside)
{
    const uint32_t before_m_q8 = (g->cells - 1) * g->cell_m_q8 / 2;
    const uint32_t cos_q30 = (uint32_t)fx_max_i32(fx_cos_q30(aside), 1 << 28);
    const uint64_t first_m_q8 = g->centre_m_q8 - before_m_q8;
    return (struct lm_shower_cells){(uint32_t)((first_m_q8 << 30) / cos_q30),
                                    (uint32_t)(((uint64_t)g->cell_m_q8 << 30) / cos_q30), g->cells};
}

/* Azimuth of line `line`, from the line of sight to the centre, right positive. */
static fx_bam_t aside_of(const struct lm_patch_geometry *g, int32_t line)
{
    const int64_t across_m_q8 = (2 * (int64_t)line + 1 - g->lines) * g->cell_m_q8 / 2;
    const int64_t most = RANGE_MOST_Q8;
    const int64_t held_m_q8 = fx_clamp_i64(across_m_q8, -most, most);
    return fx_atan2((int32_t)held_m_q8, (int32_t)g->centre_m_q8);
}

/* Shower with its loss for each metre along the ground. The loss of a level ray is below 2^26. No
 * ray to a patch is 32 times as long as its way on the ground: 30 km down over 1 km. */
static struct lm_shower slanted(const struct lm_patch_rain *p, uint32_t n)
{
    struct lm_shower s = p->shower[n];
    s.loss_db_per_m_q32 = (uint32_t)((uint64_t)s.loss_db_per_m_q32 * p->slant_q16 >> 16);
    return s;
}

void lm_patch_rain_find(struct lm_patch_rain *p, const struct lm_environment *e,
                        const struct lm_radar *radar, struct lm_position antenna, fx_bam_t azimuth)
{
    const uint32_t count = e ? fx_min_u32(e->rain_count, LM_RAINS_MAX) : 0;
    p->count = 0;
    for (uint32_t n = 0; n < count; n++) {
        struct lm_shower *s = &p->shower[p->count];
        if (lm_bearing_find(antenna, e->rain[n].centre, azimuth, &s->at)) {
            s->radius_m = e->rain[n].radius_m;
            lm_shower_set_rate(s, e->rain[n].mm_per_h, radar->wavelength_um);
            p->count++;
        }
    }
}

/* True if a ray within `most` of the line of sight, on either side, meets the circle before the
 * patch's far end. If any does, the one nearest to its centre does. */
static bool is_met(const struct lm_shower *s, int32_t most, const struct lm_shower_cells *reach)
{
    struct lm_chord chord;
    const int32_t nearest = fx_clamp_i32((int32_t)s->at.off, -most, most);
    const uint32_t end_m_q8 = reach->first_m_q8 + reach->cells * reach->cell_m_q8;
    return lm_shower_chord(s, (fx_bam_t)nearest, &chord) && chord.from_m_q8 < (int32_t)end_m_q8;
}

static void keep_met(struct lm_patch_rain *p, const struct lm_patch_geometry *g)
{
    const fx_bam_t outermost = aside_of(g, (int32_t)g->lines);
    const struct lm_shower_cells reach = reach_of(g, outermost);
    const int32_t most = (int32_t)outermost + p->beam / 2 * 3;
    uint32_t kept = 0;
    for (uint32_t n = 0; n < p->count; n++) {
        if (is_met(&p->shower[n], most, &reach)) {
            p->shower[kept++] = p->shower[n];
        }
    }
    p->count = kept;
}

/* Compute the loss along a ray, into p->loss_db_q8. */
static void set_loss(struct lm_patch_rain *p, fx_bam_t aside, const struct lm_shower_cells *reach)
{
    struct lm_chord chord;
    memset(p->loss_db_q8, 0, reach->cells * sizeof *p->loss_db_q8);
    for (uint32_t n = 0; n < p->count; n++) {
        if (lm_shower_chord(&p->shower[n], aside, &chord)) {
            const struct lm_shower s = slanted(p, n);
            lm_shower_add_loss(&s, &chord, reach, p->loss_db_q8);
        }
    }
}

/* Half the angle of the part of a ring at `range_m_q8` that lies in the circle: cos = (D^2 + r^2 -
 * rho^2) / 2 D r. Squares are below 2^58. */
static fx_bam_t half_angle(const struct lm_shower *s, uint32_t range_m_q8)
{
    const int64_t d = s->at.distance_m_q8, r = range_m_q8, radius = lm_m_q8_of_m(s->radius_m);
    int64_t x = d * d + r * r - radius * radius, one = 2 * d * r;
    if (x >= one || x <= -one) {
        return x >= one ? 0 : FX_BAM_180;
    }
    while (one >= (int64_t)1 << 31) { /* at most 26 times */
        one /= 2;
        x /= 2;
    }
    /* Both factors are below 2^32. */
    const uint32_t y = fx_sqrt_u64((uint64_t)(one - x) * (uint64_t)(one + x));
    return fx_atan2((int32_t)y, (int32_t)x);
}

/* Compute where the circle begins and ends at each range, as angles off the line of sight. */
static void find_edges(struct lm_patch_rain *p, const struct lm_shower *s,
                       const struct lm_shower_cells *reach)
{
    const int64_t off = (int32_t)s->at.off;
    for (uint32_t i = 0; i < reach->cells; i++) {
        const int64_t half = half_angle(s, reach->first_m_q8 + i * reach->cell_m_q8);
        const int64_t left = off - half, right = off + half, most = FX_BAM_90;
        p->left[i] = (int32_t)fx_clamp_i64(left, -most, most);
        p->right[i] = (int32_t)fx_clamp_i64(right, -most, most);
    }
}

/* Add the echo of a circle along one ray of the beam around `axis`. It is weighted by
 * - the part of the ray's width that the circle fills, and
 * - the two-way pattern 2^(-8 x^2) at the middle of that part, x in beam widths.
 *
 * The pattern's integral, sqrt(pi / (8 ln 2)), is 6.0217 rays wide: 1996 is that in dB * 256. */
static void add_ray(struct lm_patch_rain *p, const struct lm_shower *s, int32_t axis, int32_t ray,
                    const struct lm_shower_cells *reach)
{
    const int32_t width = p->beam / 8, begin = axis + (ray - RAYS / 2) * width, end = begin + width;
    const int32_t echo_db_q8 = s->echo_db_q8 - 1996 - 32 * FX_DB_PER_OCTAVE_Q14 / 64;
    const uint32_t all_q32 = UINT32_MAX / (uint32_t)width;
    const int64_t in_beams_q40 = ((int64_t)1 << 40) / p->beam;
    set_loss(p, (fx_bam_t)(begin + width / 2), reach);
    for (uint32_t i = 0; i < reach->cells; i++) {
        const int32_t from = fx_clamp_i32(p->left[i], begin, end);
        const int32_t to = fx_clamp_i32(p->right[i], begin, end);
        const int32_t x_q9 = (int32_t)(((from + to) / 2 - axis) * in_beams_q40 >> 31);
        /* The square is 2^10 at most. */
        const int32_t off_db_q8 = (x_q9 * x_q9 >> 8) * LM_BEAM_TWO_WAY_DB_Q8 >> 10;
        const int32_t filled_q8 = fx_db_q8_vec((uint32_t)(to - from) * all_q32);
        const int32_t level_db_q8 =
            p->volume_db_q8[i] + echo_db_q8 + filled_q8 - off_db_q8 - p->loss_db_q8[i];
        p->power_q32[i] += fx_power_q32_vec(fx_max_i32(level_db_q8, NOTHING_Q8));
    }
}

/* Volume of a cell's rain over its clutter area w ds g, as 10 log10: s w ds b sqrt(pi / 8 ln 2) /
 * 2. A beam in BAM is 2 pi / 2^32 of it in radians. */
static int32_t volume_db_q8(const struct lm_radar *radar, const struct lm_patch_geometry *g,
                            uint32_t range_m_q8)
{
    const int32_t log2_q16 = fx_log2_q16(radar->antenna.elevation_beam) + FX_LOG2_TWO_PI_Q16 -
                             (32 << 16) + fx_log2_q16(range_m_q8) + 2 * fx_log2_q16(g->cell_m_q8) -
                             (24 << 16);
    return fx_db_q8_of_log2_q16(log2_q16) + HALF_BEAM_Q8 -
           lm_clutter_area_dbm2_q8(g->cell_m_q8, g->cell_m_q8, range_m_q8,
                                   range_m_q8 - fx_min_u32(range_m_q8, g->cell_m_q8), &g->heights);
}

void lm_patch_rain_set(struct lm_patch_rain *p, const struct lm_radar *radar,
                       const struct lm_patch_geometry *g, int32_t noise_db_q8)
{
    if (p->count == 0) {
        return;
    }
    const struct lm_shower_cells middle = reach_of(g, 0);
    p->beam = fx_max_i32((int32_t)radar->antenna.azimuth_beam, BEAM_LEAST);
    p->noise_db_q8 = noise_db_q8;
    keep_met(p, g);
    if (p->count == 0) {
        return;
    }
    /* Heights are below 2^26 in Q10, so 2^24 in Q8. A ray is below 2^28, times 2^16. */
    const int32_t above_m_q8 =
        lm_m_q8_of_m_q10(g->heights.antenna_m_q10 - g->heights.reference_m_q10);
    p->slant_q16 = (uint32_t)(((uint64_t)fx_hypot_u32((int32_t)g->centre_m_q8, above_m_q8) << 16) /
                              g->centre_m_q8);
    for (uint32_t i = 0; i < g->cells; i++) {
        p->volume_db_q8[i] = volume_db_q8(radar, g, middle.first_m_q8 + i * middle.cell_m_q8);
    }
    p->veil[0].is_set = p->veil[1].is_set = false;
}

/* Veil at a station, computed when it is first asked for. Lines go from left to right, so two
 * stations are kept: the even and the odd one. */
static const int32_t *veil_at(struct lm_patch_rain *p, const struct lm_patch_geometry *g,
                              int32_t station)
{
    struct lm_rain_veil *v = &p->veil[station & 1];
    if (v->is_set && v->station == station) {
        return v->level_db_q8;
    }
    const int32_t one_q8 = fx_db_q8_u64((uint64_t)1 << 32), axis = station * (p->beam / STATIONS);
    const struct lm_shower_cells reach = reach_of(g, (fx_bam_t)axis);
    v->is_set = true;
    v->station = station;
    memset(p->power_q32, 0, reach.cells * sizeof *p->power_q32);
    for (uint32_t n = 0; n < p->count; n++) {
        find_edges(p, &p->shower[n], &reach);
        for (int32_t ray = 0; ray < RAYS; ray++) {
            add_ray(p, &p->shower[n], axis, ray, &reach);
        }
    }
    for (uint32_t i = 0; i < reach.cells; i++) {
        v->level_db_q8[i] =
            fx_db_q8_sum_vec(p->noise_db_q8, fx_db_q8_u64(p->power_q32[i]) - one_q8);
    }
    return v->level_db_q8;
}

void lm_patch_rain_run(struct lm_patch_rain *p, const struct lm_patch_geometry *g, uint32_t line,
                       const int16_t *clutter_db_q8, int16_t *level_db_q8)
{
    const fx_bam_t aside = aside_of(g, (int32_t)line);
    const struct lm_shower_cells reach = reach_of(g, aside);
    const int32_t apart = p->beam / STATIONS, rest = (int32_t)aside % apart;
    const int32_t station = (int32_t)aside / apart - (rest < 0);
    const int32_t part_q8 = (int32_t)((int64_t)(rest < 0 ? rest + apart : rest) * 256 / apart);
    const int32_t *before_db_q8 = veil_at(p, g, station);
    const int32_t *after_db_q8 = veil_at(p, g, station + 1);
    set_loss(p, aside, &reach);
    for (uint32_t i = 0; i < g->cells; i++) {
        const int32_t veil_db_q8 =
            before_db_q8[i] + ((after_db_q8[i] - before_db_q8[i]) * part_q8 >> 8);
        level_db_q8[i] =
            fx_sat_i16(fx_db_q8_sum_vec(clutter_db_q8[i] - p->loss_db_q8[i], veil_db_q8));
    }
}

/* Loss of a scatterer: the rain on the ray of its line before its true range, in metres * 256,
 * times the loss a metre in Q32. */
void lm_patch_rain_weaken(const struct lm_patch_rain *p, const struct lm_patch_geometry *g,
                          struct lm_target_patch *target_patch)
{
    struct lm_chord chord;
    for (uint32_t n = 0; n < p->count; n++) {
        const struct lm_shower s = slanted(p, n);
        for (uint32_t i = 0; i < target_patch->scatterer_count; i++) {
            struct lm_patch_scatterer *scatterer = &target_patch->scatterer[i];
            const fx_bam_t aside = aside_of(g, scatterer->line);
            const struct lm_shower_cells reach = reach_of(g, aside);
            const int64_t range_m_q8 =
                reach.first_m_q8 + (int64_t)scatterer->cell * reach.cell_m_q8;
            if (lm_shower_chord(&s, aside, &chord)) {
                const int32_t at_m_q8 =
                    range_m_q8 < RANGE_MOST_Q8 ? (int32_t)range_m_q8 : RANGE_MOST_Q8;
                const uint32_t before_m_q8 = (uint32_t)lm_chord_before_m_q8(chord, at_m_q8);
                scatterer->level_db_q8 -=
                    (int32_t)((uint64_t)before_m_q8 * s.loss_db_per_m_q32 >> 32);
            }
        }
    }
}
