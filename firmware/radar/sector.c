#include "lm/sector.h"

#include "fx/const.h"
#include "fx/mem.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/beacon.h"
#include "lm/chips.h"
#include "lm/dbs.h"
#include "lm/environment.h"
#include "lm/kernels_radar.h"
#include "lm/units.h"

_Static_assert(LM_RADAR_CELLS_MAX * 23 / 16 <= LM_CELLS_MAX, "the lines of a window");

enum {
    /* Tiles are requested this many display lines ahead of the beam, and for every eighth line
     * only. Two such lines are at most 17 cells apart. */
    LINES_AHEAD = 32,
    LINES_APART = 8,
    /* At the start of a picture they are requested for all of its sweep, along rays that are so
     * many cells apart at the far end. A tile has 64 cells, so that one between two rays meets one
     * of them within half that distance beyond the end: its corner is square. Rays are longer by
     * twice as much, for what the aircraft comes to in a sweep. */
    RAYS_APART_CELLS = 16,
    RAY_MORE_CELLS = 16,
    RAYS_WAIT = 16,      /* requests that wait when no more are made: a line's own come soon */
    CHIP_SIDE_MOST = 32, /* most pixels of a row of a chip: it bounds the cost of a line */
    WINDOW_LINES_MIN = 32,
    WINDOW_LINES_ENOUGH = 256,             /* for beams that need no more */
    FOREGROUND_LEAST_M_Q8 = LM_M_Q8(2000), /* a window that begins nearer starts at the antenna */
    UNLIT_LEAST = FX_BAM_DEG(1) / 2 /* a beam that hardly looks down lights ground as if by this */
};

static const struct lm_fov_row *fov_of(const struct lm_sector *s)
{
    return &s->radar->fov[s->command.fov];
}

static const struct lm_sector_mode_row *mode_of(const struct lm_sector *s)
{
    return lm_radar_mode(s->radar, s->command.mode);
}

static bool is_for_beacons(const struct lm_sector *s)
{
    return s->command.mode == LM_SECTOR_BEACON;
}

static uint32_t rate_of(const struct lm_sector *s)
{
    const uint32_t own = fov_of(s)->bam_per_s;
    return own ? own : mode_of(s)->bam_per_s;
}

void lm_sector_start(struct lm_sector *s, const struct lm_radar *radar,
                     const struct lm_sector_command *command, uint32_t epoch)
{
    s->radar = radar;
    s->environment = NULL;
    s->targets = NULL;
    s->chips = NULL;
    s->is_shared = false;
    s->malfunctions = NULL;
    s->command = *command;
    s->is_begun = s->is_leftward = s->is_asked_for = false;
    s->asked_bam = 0;
    s->taps[0] = s->taps[1] = (struct lm_sector_taps){.is_kept = false};
    s->line = 0;
    s->sweep = epoch;
    s->grid.cells = 0; /* no geometry yet */
    s->candidates.is_chosen = false;
    s->samples = 0;
    lm_antenna_pattern_set(&s->pattern, &radar->antenna);
    lm_beam_clear(&s->beam);
    lm_sector_floor_clear(&s->floor);
}

void lm_sector_begin_again(struct lm_sector *s)
{
    s->is_begun = s->has_taps = s->has_foreground = s->is_asked_for = false;
    s->asked_bam = 0;
    s->line = s->is_leftward && s->lines > 0 ? s->lines - 1 : 0;
    lm_beam_clear(&s->beam);
}

uint32_t lm_sector_line_us(const struct lm_sector *s)
{
    return (uint32_t)((uint64_t)s->width * 1000000 / rate_of(s));
}

int32_t lm_sector_edge_bam(const struct lm_sector *s, uint32_t line)
{
    return s->left + (int32_t)(line * s->width);
}

/* ---- what a sweep looks at ---- */

/* Set the edges of the whole sector, in lines of the table's width. */
static void set_sector(struct lm_sector *s)
{
    const uint32_t half_lines = s->radar->azimuth_half[s->command.azimuth_index] / s->radar->line;
    s->width = s->radar->line;
    s->lines = 2 * half_lines;
    s->left = -(int32_t)(half_lines * s->width);
    s->edge_m_q8 = 0;
}

/* Half the angle under which a window is seen: asin of half its diagonal over the range. A right
 * angle from inside it. */
static fx_bam_t half_angle_of(uint32_t half_m, uint32_t range_m)
{
    const uint32_t diagonal_m = half_m * 3 / 2; /* 1.5 for the root of 2 */
    const uint64_t range2 = (uint64_t)range_m * range_m, off2 = (uint64_t)diagonal_m * diagonal_m;
    return range2 <= off2 ? FX_BAM_90
                          : fx_atan2((int32_t)diagonal_m, (int32_t)fx_sqrt_u64(range2 - off2));
}

/* Number of lines over a turn of the antenna. Two lines across the beam, as sharp as the field of
 * view makes it, miss nothing: the two-way beam is seven tenths as wide. There are no more than can
 * be drawn in the time of the turn. */
static uint32_t window_lines(const struct lm_sector *s, uint32_t turn)
{
    /* Turns are below 2^31, rates and beams above 2^23 (0.7 degree), and sharpening is at most 256:
     * products are below 2^41. */
    const uint64_t in_beams =
        (uint64_t)turn * 2 * fov_of(s)->sharpening / s->radar->antenna.azimuth_beam;
    const uint32_t in_time = (uint32_t)((uint64_t)turn * LM_SECTOR_LINES_PER_S / rate_of(s));
    const uint32_t wanted = fx_max_u32((uint32_t)in_beams, WINDOW_LINES_ENOUGH);
    return fx_max_u32(fx_min_u32(fx_min_u32(wanted, in_time), LM_SECTOR_LINES_MAX),
                      WINDOW_LINES_MIN);
}

/* Set the edges of a window's lines, as far as the antenna turns. */
static void set_window_lines(struct lm_sector *s, int32_t bearing, fx_bam_t half_angle)
{
    const int32_t limit = (int32_t)s->radar->antenna.azimuth_limit;
    const int32_t half = (int32_t)fx_min_u32(half_angle, fov_of(s)->azimuth_half_max);
    const int64_t wanted_left = (int64_t)bearing - half, wanted_right = (int64_t)bearing + half;
    const int32_t least = (int32_t)s->radar->line;
    s->left = (int32_t)fx_clamp_i64(wanted_left, -limit, limit - least);
    const int32_t right = (int32_t)fx_clamp_i64(wanted_right, s->left + least, limit);
    const uint32_t turn = (uint32_t)(right - s->left);
    s->lines = window_lines(s, turn);
    s->width = turn / s->lines;
}

/* Set the edges of a window: all that lies within half its diagonal of its centre. */
static void set_window(struct lm_sector *s, const struct lm_platform *platform, int32_t above_m_q10)
{
    uint32_t distance_m_q8;
    fx_bam_t azimuth;
    lm_geo_inverse(platform->position, s->command.centre, &distance_m_q8, &azimuth);
    const uint32_t reach_m_q8 =
        lm_m_q8_of_m(s->half_m) / 16 * 23; /* 23/16 is a little more than the root of 2 */
    /* Centres farther than any radar range count as 250 km: the window is empty there. */
    const uint32_t ground_m_q8 = fx_min_u32(distance_m_q8, LM_M_Q8(250000u));
    const uint32_t slant_m_q8 = lm_slant_of_ground_m_q8(ground_m_q8, above_m_q10);
    s->edge_m_q8 = slant_m_q8 > reach_m_q8 ? slant_m_q8 - reach_m_q8 : 0;
    set_window_lines(s, (int32_t)(azimuth - s->up),
                     half_angle_of(s->half_m, lm_m_of_m_q8(ground_m_q8)));
}

/* ---- its geometry in range ---- */

/* Elevation of the flat ground that the receiver's gain assumes. It is the terrain below the
 * aircraft, but at most the mean of the map's land: a mountain below must not raise the gain over
 * the plains around it. */
static int32_t reference_m_q10_of(struct lm_tile_cache *tiles, uint8_t lod,
                                  struct lm_position position)
{
    return fx_min_i32(lm_scan_elevation(tiles, lod, position, 0),
                      lm_m_q10_of_m_q6(tiles->db->mean_elevation_m_q6));
}

static void set_foreground(struct lm_sector *s, const struct lm_db *db)
{
    s->has_foreground = false;
    s->foreground.grid.cells = 0;
    if (s->ground_edge_m_q8 >= FOREGROUND_LEAST_M_Q8) {
        lm_foreground_set(&s->foreground, db, &s->radar->illumination, s->ground_edge_m_q8,
                          &s->grid);
    }
}

/* Set the bins of slant range, the cells of ground under them, and all that depends on both. */
static void set_ranges(struct lm_sector *s, struct lm_tile_cache *tiles, int32_t height_m_q10,
                       int32_t reference_m_q10)
{
    const uint32_t range_m = s->radar->range[s->command.range_index].range_m;
    const uint32_t bins = lm_sector_is_window(s) ? s->radar->cells * 23u / 16 : s->radar->cells;
    const uint32_t bin_m_q8 =
        lm_m_q8_of_m(lm_sector_is_window(s) ? 2 * s->half_m : range_m) / s->radar->cells;
    const int32_t above_m_q10 = height_m_q10 - reference_m_q10;
    const uint32_t end_m_q8 = lm_ground_of_slant_m_q8(s->edge_m_q8 + bins * bin_m_q8, above_m_q10);
    s->ground_edge_m_q8 = lm_ground_of_slant_m_q8(s->edge_m_q8, above_m_q10);
    const uint32_t cell_m_q8 =
        fx_max_u32((end_m_q8 - s->ground_edge_m_q8 + bins - 1) / bins, bin_m_q8);
    const uint32_t first_m_q8 = s->ground_edge_m_q8 + cell_m_q8 / 2;
    lm_range_grid_set(&s->grid, &s->radar->illumination, first_m_q8, cell_m_q8, bins, height_m_q10,
                      reference_m_q10);
    lm_slant_set(&s->slant, s->edge_m_q8 + bin_m_q8 / 2, bin_m_q8, bins, &s->grid, first_m_q8);
    lm_receiver_set(&s->receiver, s->radar, &s->slant, above_m_q10, s->command.range_index,
                    (enum lm_fov)s->command.fov);
    lm_receiver_impair(&s->receiver, lm_malfunction_loss_db_q8(s->malfunctions),
                       lm_malfunction_q8(s->malfunctions, LM_MALFUNCTION_NOISE));
    set_foreground(s, tiles->db);
    lm_beam_clear(&s->beam);
}

/* Set the LOD of the sector: map cells about as large as the bins of the display. */
static void set_lod(struct lm_sector *s, const struct lm_db *db)
{
    const uint32_t side_m =
        lm_sector_is_window(s) ? 2 * s->half_m : s->radar->range[s->command.range_index].range_m;
    const uint32_t bin_mm = lm_mm_of_m(side_m) / s->radar->cells;
    s->lod = lm_scan_lod(db, bin_mm);
    lm_scan_blend_set(&s->blend, db, bin_mm);
}

static bool differs(int32_t a_m_q10, int32_t b_m_q10)
{
    return fx_abs_u32(a_m_q10 - b_m_q10) > fx_abs_u32(a_m_q10) / 128 + 1024;
}

/* A height in steps of 1/128 to 1/256 of itself, at least of a metre, below 2^31: it hangs on no
 * other height. */
static int32_t coarse_m_q10(int32_t height_m_q10)
{
    const uint32_t size = fx_abs_u32(height_m_q10) | 1u << 17;
    const uint32_t log2 = 31u - (uint32_t)__builtin_clz(size) - 7;
    return (int32_t)((uint32_t)(height_m_q10 + (1 << log2 >> 1)) >> log2 << log2);
}

static bool has_same_receiver(const struct lm_sector *s)
{
    return s->receiver.loss_db_q8 == lm_malfunction_loss_db_q8(s->malfunctions) &&
           s->receiver.rise_db_q8 == lm_malfunction_q8(s->malfunctions, LM_MALFUNCTION_NOISE);
}

/* Recompute the ranges if the height has changed by a hundredth and a metre, or the window has
 * changed. Until then all stages keep the old height, gain and horizon alike. */
static void refresh_ranges(struct lm_sector *s, struct lm_tile_cache *tiles, int32_t height_m_q10,
                           int32_t reference_m_q10, uint32_t old_edge_m_q8)
{
    const bool has_height = s->is_shared ? height_m_q10 == s->grid.height_m_q10 &&
                                               reference_m_q10 == s->grid.reference_m_q10
                                         : !differs(height_m_q10, s->grid.height_m_q10) &&
                                               !differs(reference_m_q10, s->grid.reference_m_q10);
    const bool is_same =
        s->grid.cells != 0 && s->edge_m_q8 == old_edge_m_q8 && has_height && has_same_receiver(s);
    if (!is_same) {
        set_ranges(s, tiles, height_m_q10, reference_m_q10);
    }
}

/* ---- sweeps ---- */

/* Set the first bin into which ground leaks: that of flat ground at the beam's lower half-power
 * edge, `down` below the horizon. Nearer ground is not lit, nor is what has its range beside it.
 * Bars and a malfunction can bring the axis to 135 degrees below the horizon, and the edge to 225:
 * more than 32 bits hold. Heights are below 2^26, and the sine is above 2^23: the quotient is below
 * 2^31. */
static void set_unlit(struct lm_sector *s, int64_t down)
{
    const int32_t above_m_q10 = fx_max_i32(s->grid.height_m_q10 - s->grid.reference_m_q10, 0);
    const int64_t held = fx_clamp_i64(down, UNLIT_LEAST, FX_BAM_90);
    const uint32_t slant_m_q8 =
        (uint32_t)(((uint64_t)above_m_q10 << 28) / (uint32_t)fx_sin_q30((fx_bam_t)held));
    const uint32_t past_m_q8 = fx_max_u32(slant_m_q8, s->edge_m_q8) - s->edge_m_q8;
    const uint32_t bins = (past_m_q8 + s->slant.cell_m_q8 / 2) / s->slant.cell_m_q8;
    s->receiver.unlit = fx_max_u32(fx_min_u32(bins, s->slant.cells), s->slant.hole);
}

/* Set the tilt of the beam's axis: as commanded, or at the far end of the display; then the offset
 * of its bar. */
static void set_tilt(struct lm_sector *s)
{
    const struct lm_antenna_table *antenna = &s->radar->antenna;
    const int32_t above_m = lm_m_of_m_q10(s->grid.height_m_q10 - s->grid.reference_m_q10);
    const uint32_t far_m = lm_m_of_m_q8(s->edge_m_q8 + s->slant.cells * s->slant.cell_m_q8);
    const struct lm_beam_setting *set = &s->command.beam;
    const int32_t axis =
        set->is_tilt_manual ? set->tilt : lm_antenna_auto_tilt(above_m, fx_max_u32(far_m, 1));
    const int32_t bars = mode_of(s)->bars, bar = (int32_t)(s->sweep % (uint32_t)bars);
    s->tilt = axis + (2 * bar - bars + 1) * (int32_t)(antenna->bar_spacing / 2);
    const int32_t tilt = s->tilt + lm_malfunction_bam(s->malfunctions, LM_MALFUNCTION_TILT);
    const fx_bam_t fan = set->is_pencil ? 0 : antenna->fan;
    s->fan = lm_antenna_fan_at(tilt, fan);
    set_unlit(s, (int64_t)fan + antenna->elevation_beam / 2 - tilt);
}

void lm_sector_set_beam(struct lm_sector *s, const struct lm_beam_setting *setting)
{
    s->command.beam = *setting;
    if (s->is_begun) {
        set_tilt(s);
    }
}

static void set_class_gain(struct lm_sector *s, const struct lm_classes *classes)
{
    const uint8_t sea_state = s->environment ? s->environment->sea_state : LM_SEA_STATE_OF_IMAGE;
    lm_class_gain_set(&s->class_gain, &s->radar->facing, classes, s->lod, sea_state,
                      mode_of(s)->clutter_db_q8);
}

static void set_sea(struct lm_sector *s, const struct lm_classes *classes)
{
    const struct lm_environment *e = s->environment;
    lm_sea_set(&s->sea, s->radar, classes, e ? e->sea_state : LM_SEA_STATE_OF_IMAGE,
               e && e->has_wind ? &e->wind_from : NULL);
    lm_sea_set_cells(&s->sea, &s->grid, s->ground_edge_m_q8 + s->grid.cell_m_q8 / 2);
}

static void set_floor(struct lm_sector *s)
{
    const struct lm_sector_floor_setting setting = {.leak_db_q8 = fov_of(s)->ground_leak_db_q8,
                                                    .most_db_q8 =
                                                        s->radar->sar.ground_leak_most_db_q8,
                                                    .beam = s->radar->antenna.azimuth_beam,
                                                    .line = s->width,
                                                    .cell_m_q8 = s->slant.cell_m_q8};
    lm_sector_floor_set(&s->floor, &setting);
}

void lm_sector_begin(struct lm_sector *s, struct lm_tile_cache *tiles,
                     const struct lm_platform *platform)
{
    const uint32_t old_edge_m_q8 = s->edge_m_q8;
    s->half_m = s->radar->range[s->command.range_index].range_m * fov_of(s)->window_permille / 1000;
    set_lod(s, tiles->db);
    int32_t height_m_q10 = platform->height_m_q10,
            reference_m_q10 = reference_m_q10_of(tiles, s->lod, platform->position);
    if (s->is_shared) {
        height_m_q10 = coarse_m_q10(height_m_q10);
        reference_m_q10 = coarse_m_q10(reference_m_q10);
    }
    s->look_off = 0 - (fx_bam_t)lm_malfunction_bam(s->malfunctions, LM_MALFUNCTION_DRIFT);
    s->up = platform->heading;
    s->platform = *platform;
    lm_geo_set_origin(&s->origin, platform->position);
    if (lm_sector_is_window(s)) {
        set_window(s, platform, height_m_q10 - reference_m_q10);
    } else {
        set_sector(s);
    }
    refresh_ranges(s, tiles, height_m_q10, reference_m_q10, old_edge_m_q8);
    if (lm_sector_is_window(s)) {
        s->has_foreground = false;
        lm_beam_clear(&s->beam); /* its samples were traced from another position */
    }
    set_tilt(s);
    set_floor(s);
    lm_class_lut_set(&s->class_lut, &s->radar->illumination, &tiles->db->classes);
    set_class_gain(s, &tiles->db->classes);
    set_sea(s, &tiles->db->classes);
    s->line = s->is_leftward ? s->lines - 1 : 0;
    s->is_begun = true;
    s->has_taps = false;
    s->grain = (struct lm_grain_stretch){.start = lm_grain_start(LM_GRAIN_SPECKLE, s->sweep)};
}

void lm_sector_join(struct lm_sector *s, const struct lm_sector_turn *turn)
{
    const bool is_leftward = turn->sweep % 2 != 0;
    if (turn->skipped != 0 || s->sweep != turn->sweep || s->is_leftward != is_leftward) {
        lm_beam_clear(&s->beam);
    }
    lm_sector_floor_clear(&s->floor);
    s->sweep = turn->sweep;
    s->is_leftward = is_leftward;
    s->line = is_leftward ? s->lines - 1 - turn->skipped : turn->skipped;
    s->platform.time_us = turn->time_us;
    s->grain.start = lm_grain_start(LM_GRAIN_SPECKLE, s->sweep);
    set_tilt(s);
}

static void move_on(struct lm_sector *s)
{
    s->has_taps = false;
    const bool at_edge = s->is_leftward ? s->line == 0 : s->line + 1 >= s->lines;
    if (at_edge) {
        s->is_leftward = !s->is_leftward;
        s->is_begun = false;
        s->sweep++;
    } else {
        s->line += s->is_leftward ? UINT32_MAX : 1;
    }
}

/* Line that the beam will be on `ahead` lines from now, after a turn at the edge if there is one.
 * `ahead` is less than a sweep. */
static uint32_t line_ahead(const struct lm_sector *s, uint32_t ahead)
{
    const uint32_t last = s->lines - 1;
    const uint32_t to_edge = s->is_leftward ? s->line : last - s->line;
    if (ahead <= to_edge) {
        return s->is_leftward ? s->line - ahead : s->line + ahead;
    }
    const uint32_t beyond = ahead - to_edge - 1;
    return s->is_leftward ? beyond : last - beyond;
}

static int32_t middle_of(const struct lm_sector *s, uint32_t line)
{
    return lm_sector_edge_bam(s, line) + (int32_t)(s->width / 2);
}

/* ---- samples ---- */

/* Path of `cells` equal cells outwards from `from_m_q8` to `to_m_q8`. */
static struct lm_ground_path path_of(const struct lm_geo_ray *ray, uint32_t from_m_q8,
                                     uint32_t to_m_q8, uint32_t cells)
{
    struct lm_ground_path path;
    const struct lm_position points[3] = {
        from_m_q8 ? lm_geo_along(ray, from_m_q8) : ray->origin->position,
        lm_geo_along(ray, from_m_q8 + (to_m_q8 - from_m_q8) / 2),
        lm_geo_along(ray, to_m_q8),
    };
    lm_ground_path_fit(&path, points, cells);
    return path;
}

/* Ground range of the far end of the last cell. */
static uint32_t far_end_m_q8(const struct lm_sector *s)
{
    return s->ground_edge_m_q8 + s->grid.cells * s->grid.cell_m_q8;
}

static struct lm_ground_path sample_path(const struct lm_sector *s, const struct lm_geo_ray *ray)
{
    return path_of(ray, s->ground_edge_m_q8, far_end_m_q8(s), s->grid.cells);
}

/* Path of the foreground of a window. */
static struct lm_ground_path foreground_path(const struct lm_sector *s,
                                             const struct lm_geo_ray *ray)
{
    return path_of(ray, s->foreground.start_m_q8, s->ground_edge_m_q8, LM_FOREGROUND_CELLS);
}

/* Horizon behind the foreground of a window. All azimuths within one line of the table share that
 * of its middle, and the order in which they are traced does not matter. */
static lm_horizon_q40_t horizon_at(struct lm_sector *s, struct lm_tile_cache *tiles,
                                   fx_bam_t azimuth, struct lm_line *line)
{
    if (s->foreground.grid.cells == 0) {
        return LM_HORIZON_OPEN;
    }
    const fx_bam_t width = s->radar->line, from_left = azimuth - s->up + FX_BAM_90;
    const uint32_t part = from_left / width;
    if (!s->has_foreground || part != s->foreground_part) {
        struct lm_geo_ray ray;
        lm_geo_set_ray(&ray, &s->origin, s->up - FX_BAM_90 + part * width + width / 2);
        const struct lm_ground_path path = foreground_path(s, &ray);
        s->foreground_horizon =
            lm_foreground_horizon(&s->foreground, &s->class_lut, tiles, &path, &line->ground);
        s->foreground_part = part;
        s->has_foreground = true;
    }
    return s->foreground_horizon;
}

/* Select the live targets that a sample may meet. */
static void find_live(struct lm_sector *s, const struct lm_target_query *query, fx_bam_t azimuth)
{
    const struct lm_live_line line = {.azimuth = azimuth,
                                      .width = lm_beam_spacing(&s->beam, s->radar),
                                      .begin_m_q8 = s->ground_edge_m_q8,
                                      .end_m_q8 = far_end_m_q8(s),
                                      .is_doppler = s->beam.fineness != 0,
                                      .is_of_beacons = is_for_beacons(s),
                                      .speed_mm_s = s->platform.speed_mm_s,
                                      .track = s->platform.track,
                                      .beam = s->radar->antenna.azimuth_beam};
    lm_target_candidates_of_line(&s->live, s->targets, query, &line);
}

/* Select the targets in range, and for a window their chips. */
static void find_targets(struct lm_sector *s, struct lm_tile_cache *tiles, fx_bam_t azimuth)
{
    const struct lm_target_query query = {.position = s->platform.position,
                                          .reach_m =
                                              s->radar->range[s->command.range_index].range_m,
                                          .time_us = s->platform.time_us,
                                          .tiles = tiles,
                                          .lod = s->lod};
    if (lm_target_set_is_live(s->targets)) {
        find_live(s, &query, azimuth);
    }
    if (!lm_target_candidates_refresh(&s->candidates, s->targets, &query) ||
        !lm_sector_is_window(s) || !s->chips) {
        return;
    }
    const struct lm_chip_query chip_query = {
        .centre = s->command.centre,
        .reach_m = s->half_m * 3 / 2,
        .radar = s->platform.position,
        .heights = {s->grid.height_m_q10, s->grid.reference_m_q10},
        .cell_mm = lm_mm_of_m_q8(s->grid.cell_m_q8),
        .side_most = CHIP_SIDE_MOST,
    };
    lm_chips_choose(s->chips, &s->candidates, &chip_query);
}

/* Replies of the beacons that the sample meets. */
static void take_replies(struct lm_sector *s, const struct lm_line_targets *targets,
                         struct lm_line *line, uint32_t *power_q24)
{
    const struct lm_beacon_sample sample = {.targets = targets,
                                            .grid = &s->grid,
                                            .slant = &s->slant,
                                            .pattern = &s->pattern,
                                            .fan = &s->fan,
                                            .loss_db_q8 = s->receiver.loss_db_q8};
    lm_beacon_sample(&sample, line, power_q24);
}

/* Find the targets that the sample meets. False if there are none. In beacon mode `replies_q24` is
 * the slot that takes the replies; else NULL. */
static bool add_targets(struct lm_sector *s, struct lm_tile_cache *tiles, fx_bam_t azimuth,
                        struct lm_line *line, uint32_t *replies_q24)
{
    const struct lm_sector_mode_row *mode = mode_of(s);
    find_targets(s, tiles, azimuth);
    const struct lm_line_targets targets = {
        .candidates = &s->candidates,
        .live = &s->live,
        .where = {.position = s->platform.position,
                  .azimuth = azimuth,
                  .width = lm_beam_spacing(&s->beam, s->radar),
                  .first_m_q8 = s->ground_edge_m_q8 + s->grid.cell_m_q8 / 2,
                  .cell_m_q8 = s->grid.cell_m_q8,
                  .cells = s->grid.cells,
                  .first = s->grid.first,
                  .height_m_q10 = s->grid.height_m_q10,
                  .reference_m_q10 = s->grid.reference_m_q10,
                  .wavelength_um = s->radar->wavelength_um,
                  .is_doppler =
                      s->beam.fineness != 0, /* sharpened: azimuth is measured by Doppler */
                  .beam = s->radar->antenna.azimuth_beam,
                  .speed_mm_s = s->platform.speed_mm_s,
                  .track = s->platform.track,
                  .gate_mm_s = {mode->gate_mm_s[0], mode->gate_mm_s[1]},
                  .stretch_cells = mode->stretch_cells,
                  .scan = s->sweep,
                  .pulse = s->samples},
    };
    if (replies_q24) {
        take_replies(s, &targets, line, replies_q24);
        return true;
    }
    return lm_line_add_targets(line, &s->grid, &targets);
}

static void trace(struct lm_sector *s, struct lm_tile_cache *tiles, fx_bam_t azimuth,
                  struct lm_line *line)
{
    const struct lm_line_setup setup = {.grid = &s->grid,
                                        .class_lut = &s->class_lut,
                                        .class_gain = &s->class_gain,
                                        .sea = &s->sea,
                                        .blend = &s->blend,
                                        .lod = s->lod};
    struct lm_geo_ray ray;
    lm_geo_set_ray(&ray, &s->origin, azimuth);
    const lm_horizon_q40_t horizon = horizon_at(s, tiles, azimuth, line);
    const struct lm_ground_path path = sample_path(s, &ray);
    lm_class_gain_look(&s->class_gain, azimuth);
    lm_sea_look(&s->sea, azimuth);
    lm_line_trace(line, tiles, &setup, &path, horizon);
}

/* Azimuths of a sample. Sharpened samples lie closer together and need fewer. */
static uint32_t azimuths_log2_of(const struct lm_sector *s)
{
    const uint32_t log2 = fov_of(s)->azimuths_log2, finer_log2 = s->beam.fineness;
    return log2 > finer_log2 ? fx_min_u32(log2 - finer_log2, LM_AZIMUTH_AVERAGE_LOG2_MAX) : 0;
}

/* Trace the azimuths of a sample. The line's levels become those of the mean power; everything else
 * in it is that of the last azimuth. */
static void trace_average(struct lm_sector *s, struct lm_tile_cache *tiles, fx_bam_t azimuth,
                          struct lm_line *line)
{
    const fx_bam_t spacing = lm_beam_spacing(&s->beam, s->radar);
    const uint32_t log2 = azimuths_log2_of(s);
    if (log2 == 0) {
        trace(s, tiles, azimuth, line);
        return;
    }
    const uint32_t last = (1u << log2) - 1;
    for (uint32_t turn = 0; turn <= last; turn++) {
        const fx_bam_t off = (fx_bam_t)lm_azimuth_average_offset(spacing, log2, turn);
        trace(s, tiles, azimuth + off, line);
        if (turn == 0) {
            lm_azimuth_average_begin(&s->average, line->lit.level_db_q8, s->grid.cells);
        } else if (turn < last) {
            lm_azimuth_average_add(&s->average, line->lit.level_db_q8, s->grid.cells);
        }
    }
    lm_azimuth_average_mean(&s->average, log2, line->lit.level_db_q8, s->grid.cells);
}

/* Move the origin to the present position of the aircraft. */
static void follow(struct lm_sector *s)
{
    const struct lm_position position = s->platform.position, old = s->origin.position;
    if (position.latitude != old.latitude || position.longitude != old.longitude) {
        lm_geo_set_origin(&s->origin, position);
    }
}

/* Take one sample in beacon mode: the ground hides, and does not answer. */
static void interrogate(struct lm_sector *s, struct lm_tile_cache *tiles, int32_t sample,
                        fx_bam_t azimuth, struct lm_line *line)
{
    uint32_t *replies_q24 = lm_beam_slot(&s->beam, sample);
    memset(replies_q24, 0, s->slant.cells * sizeof *replies_q24);
    if (s->targets && lm_target_set_has_any(s->targets)) {
        trace(s, tiles, azimuth, line);
        add_targets(s, tiles, azimuth, line, replies_q24);
    }
    s->samples++;
}

/* Take one sample, from the map to the power of the bins, into its slot of the ring. */
static void take_sample(struct lm_sector *s, struct lm_tile_cache *tiles, int32_t sample,
                        struct lm_line *line)
{
    const fx_bam_t azimuth =
        s->up + s->look_off + (fx_bam_t)lm_beam_azimuth(&s->beam, s->radar, sample);
    if (s->is_shared) { /* the number chooses a draw: no sweep has 2^12 samples */
        s->samples = (s->sweep << 12) + (uint32_t)sample;
    }
    follow(s);
    s->live.count = s->live.left_out = 0;
    if (is_for_beacons(s)) {
        interrogate(s, tiles, sample, azimuth, line);
        return;
    }
    trace_average(s, tiles, azimuth, line);
    const bool has_steady = s->targets && lm_target_set_has_any(s->targets) &&
                            add_targets(s, tiles, azimuth, line, NULL);
    lm_antenna_pattern_apply(&s->pattern, &s->fan, &s->grid, &line->lit);
    lm_slant_run(&s->slant, &s->grid, line->lit.level_db_q8, lm_beam_slot(&s->beam, sample));
    if (has_steady) {
        lm_antenna_pattern_apply(&s->pattern, &s->fan, &s->grid, &line->steady);
        lm_slant_run(&s->slant, &s->grid, line->steady.level_db_q8,
                     lm_beam_steady_slot(&s->beam, sample));
    }
    s->samples++;
}

/* ---- lines of the display ---- */

/* Sharpening ratio used at an azimuth, and looks: what the dwell offers and sharpening leaves. */
static uint32_t ratio_q8_of(const struct lm_sector *s, const struct lm_platform *platform,
                            int32_t azimuth, uint32_t *looks_q8)
{
    const struct lm_fov_row *fov = fov_of(s);
    const struct lm_dbs_scan scan = {rate_of(s), platform->speed_mm_s, s->width};
    const fx_bam_t off = s->up + (fx_bam_t)azimuth - platform->track;
    const uint32_t used_q8 =
        fov->sharpening > 1 ? lm_dbs_sharpening_q8(s->radar, &scan, fov->sharpening, off) : 256;
    *looks_q8 = fx_max_u32(lm_dbs_ratio_q8(s->radar, &scan, off) * 256 / used_q8, 256);
    return used_q8;
}

/* Taps of the next line, once has_taps is true. */
static struct lm_sector_taps *taps_of_line(struct lm_sector *s)
{
    return &s->taps[s->line % 2];
}

/* Set the next line's taps. In NORM a line lies between its samples as the line before the last
 * did: its taps are the same, of samples further on. */
static void set_taps(struct lm_sector *s, int32_t azimuth, uint32_t ratio_q8)
{
    struct lm_sector_taps *line_taps = taps_of_line(s);
    const int32_t spacing = (int32_t)s->radar->sample, moved = azimuth - line_taps->azimuth;
    const bool is_sharpened = ratio_q8 != 256 || s->beam.fineness != 0;
    if (line_taps->is_kept && !is_sharpened && moved % spacing == 0) {
        line_taps->taps.first += moved / spacing;
    } else {
        lm_beam_set_taps(&s->beam, s->radar, azimuth, ratio_q8, &line_taps->taps);
        lm_beam_weaken(&line_taps->taps,
                       lm_dbs_scallop_q16(s->radar, fov_of(s), ratio_q8, azimuth));
    }
    line_taps->azimuth = azimuth;
    line_taps->ratio_q8 = ratio_q8;
    line_taps->is_kept = ratio_q8 == 256;
}

/* Begin the sweep if it is due, and set the next line's taps once. NORM is seen from the present
 * position of the aircraft; a window is seen from where its sweep began. */
static void prepare_line(struct lm_sector *s, struct lm_tile_cache *tiles,
                         const struct lm_platform *platform)
{
    if (!s->is_begun) {
        lm_sector_begin(s, tiles, platform);
    }
    if (!lm_sector_is_window(s)) {
        s->up = platform->heading;
        s->platform.position = platform->position;
    }
    if (!s->has_taps) {
        const int32_t azimuth = middle_of(s, s->line);
        uint32_t looks_q8;
        set_taps(s, azimuth, ratio_q8_of(s, platform, azimuth, &looks_q8));
        taps_of_line(s)->looks_q8 = looks_q8;
        s->has_taps = true;
    }
}

bool lm_sector_sample_ahead(struct lm_sector *s, struct lm_tile_cache *tiles,
                            const struct lm_platform *platform, uint32_t *azimuths,
                            struct lm_line *line)
{
    int32_t sample;
    prepare_line(s, tiles, platform);
    while (lm_beam_next_missing(&s->beam, &taps_of_line(s)->taps, &sample)) {
        if (*azimuths == 0) {
            return false;
        }
        take_sample(s, tiles, sample, line);
        /* Two live targets cost as much as an azimuth. */
        const uint32_t cost = (1u << azimuths_log2_of(s)) + (s->live.count + 1) / 2;
        *azimuths -= fx_min_u32(cost, *azimuths);
    }
    return true;
}

/* Request the tiles along a ray: those of the sweep and of what lies a little before and behind it,
 * and those of the foreground. */
static void request(const struct lm_sector *s, struct lm_tile_cache *tiles, fx_bam_t azimuth)
{
    struct lm_geo_ray ray;
    const uint32_t more_m_q8 = RAY_MORE_CELLS * s->grid.cell_m_q8;
    const uint32_t from_m_q8 = s->ground_edge_m_q8 - fx_min_u32(more_m_q8, s->ground_edge_m_q8);
    const uint32_t to_m_q8 = far_end_m_q8(s) + more_m_q8;
    lm_geo_set_ray(&ray, &s->origin, s->up + azimuth);
    const struct lm_ground_path path = path_of(&ray, from_m_q8, to_m_q8, s->grid.cells);
    lm_scan_line_prefetch(tiles, s->lod, &path, s->grid.cells);
    if (s->foreground.grid.cells != 0) {
        const struct lm_ground_path before = foreground_path(s, &ray);
        lm_scan_line_prefetch(tiles, s->foreground.lod, &before, LM_FOREGROUND_CELLS);
    }
}

static void prefetch(const struct lm_sector *s, struct lm_tile_cache *tiles)
{
    const uint32_t ahead = fx_min_u32(LINES_AHEAD, s->lines - 1);
    request(s, tiles, (fx_bam_t)middle_of(s, line_ahead(s, ahead)));
}

void lm_sector_prefetch(struct lm_sector *s, struct lm_tile_cache *tiles)
{
    if (s->is_asked_for || !s->is_begun || lm_tile_cache_waiting(tiles) >= RAYS_WAIT) {
        return;
    }
    /* A line takes samples to both sides, at most 6 degrees apart, and a sweep is half a turn at
     * most: the sum is below 2^32. Cells are below 2^24, and 64 or more: the quotient is below
     * 2^28. */
    const uint32_t beside = LM_BEAM_TAPS / 2 * lm_beam_spacing(&s->beam, s->radar);
    const uint32_t all = s->lines * s->width + 2 * beside;
    const uint32_t apart = (uint32_t)((uint64_t)RAYS_APART_CELLS * FX_BAM_PER_RADIAN *
                                      s->grid.cell_m_q8 / far_end_m_q8(s));
    request(s, tiles, (fx_bam_t)s->left + s->asked_bam - beside);
    s->is_asked_for = s->asked_bam == all;
    s->asked_bam = fx_min_u32(s->asked_bam + apart, all);
}

/* Fill the line's ground with what it leaks, fade it, and move on in the grain: a row of it is a
 * two-way beam wide, B / (N root 2). 362 is 256 root 2; a line is below 2^31, times 2^16 and 2^9.
 */
static void fade_line(struct lm_sector *s)
{
    const struct lm_sector_taps *taps = taps_of_line(s);
    struct lm_grain_curve curve;
    uint32_t speckle_q24[LM_CELLS_ROOM];
    s->grain.step_q16 = s->receiver.grain_step_q16;
    lm_grain_curve_set(&curve, taps->looks_q8);
    lm_grain_powers(&curve, &s->grain, speckle_q24, s->slant.cells);
    const uint32_t unlit = s->receiver.unlit;
    lm_sector_floor_run(&s->floor, s->line, s->power_q24 + unlit, s->slant.cells - unlit);
    lm_k_fade(speckle_q24, s->power_q24, s->slant.cells);
    s->grain.row_q16 += (uint64_t)s->width * taps->ratio_q8 * 362 / s->radar->antenna.azimuth_beam;
}

/* The display line's power: ground behind beam, pulse and speckle, and scatterers behind beam and
 * pulse. */
static void sum_powers(struct lm_sector *s)
{
    const struct lm_beam_taps *taps = &taps_of_line(s)->taps;
    uint32_t steady_q24[LM_CELLS_ROOM];
    lm_beam_sum(&s->beam, taps, s->power_q24, s->slant.cells);
    lm_receiver_pulse(&s->receiver, s->power_q24);
    fade_line(s);
    if (lm_beam_steady_sum(&s->beam, taps, steady_q24, s->slant.cells)) {
        lm_receiver_pulse(&s->receiver, steady_q24);
        lm_receiver_join(&s->receiver, steady_q24, s->power_q24);
    }
}

/* Levels of the display line, behind the receiver. */
static void detect(struct lm_sector *s)
{
    sum_powers(s);
    const struct lm_weather *weather = NULL;
    if (s->environment) {
        lm_weather_line(&s->weather, s->environment, &s->receiver, s->radar, s->platform.position,
                        s->up + s->look_off + (fx_bam_t)middle_of(s, s->line));
        weather = &s->weather;
    }
    lm_receiver_run(&s->receiver, weather, s->line, s->sweep, s->power_q24, s->level_db_q8);
}

/* The same in beacon mode. What is not a reply does not pass: no noise, rain or jammer. */
static void detect_replies(struct lm_sector *s)
{
    lm_beam_sum(&s->beam, &taps_of_line(s)->taps, s->power_q24, s->slant.cells);
    lm_beacon_show(s->power_q24, s->slant.cells, mode_of(s)->tone.white_db_q8, s->level_db_q8);
}

uint32_t lm_sector_draw_line(struct lm_sector *s, struct lm_tile_cache *tiles,
                             const struct lm_platform *platform, const struct lm_tone *tone,
                             struct lm_line *line)
{
    uint32_t azimuths = UINT32_MAX;
    lm_sector_sample_ahead(s, tiles, platform, &azimuths, line);
    const uint32_t drawn = s->line, cells = s->slant.cells;
    if (is_for_beacons(s)) {
        detect_replies(s);
    } else {
        detect(s);
    }
    lm_tone_run(tone, s->level_db_q8, line->grey, cells);
    if (drawn % LINES_APART == 0) {
        prefetch(s, tiles);
    }
    move_on(s);
    return drawn;
}
