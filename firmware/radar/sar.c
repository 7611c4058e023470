#include "lm/sar.h"

#include "fx/hash.h"
#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/const.h"
#include "lm/crests.h"
#include "lm/units.h"
#include "lm/weather.h"

enum {
    LEFT_OUT_BELOW_FLOOR_Q8 = LM_DB_Q8(10),
    DWELL_MOST_MS = (1 << 17) - 1,
    RELIEF_ROWS = 3,  /* in which the relief of a patch is read at either edge */
    RELIEF_PLACES = 5 /* of such a row */
};

/* Component of the velocity across the line of sight, to the right. */
static int32_t speed_across_mm_s(const struct lm_sar_flight *f)
{
    return (int32_t)((int64_t)f->speed_mm_s * fx_sin_q30(f->track - f->bearing) >> 30);
}

/* Dwell T = l R / (2 V d sin o), with R the slant range and V sin o the speed across. In these
 * units the numerator is below 2^20 * 2^18.1 * 10^6 = 2^58. */
static uint64_t dwell_us(const struct lm_radar *radar, const struct lm_sar_command *c,
                         int32_t reference_m_q10, uint32_t across_mm_s)
{
    const int32_t above_m = lm_m_of_m_q6(c->height_m_q6) - lm_m_of_m_q10(reference_m_q10);
    const uint64_t slant_m = fx_hypot_u32((int32_t)c->range_m, above_m);
    return (uint64_t)radar->wavelength_um * slant_m * 1000000u /
           ((uint64_t)2 * c->cell_mm * fx_max_u32(across_mm_s, 1));
}

static bool is_within(fx_bam_t angle, fx_bam_t limit)
{
    return fx_abs_u32((int32_t)angle) <= limit;
}

/* Judge whether an aircraft in flight can make a patch there in that time. */
static enum lm_refusal judge_flight(const struct lm_radar *radar, const struct lm_sar_flight *f,
                                    uint64_t patch_us)
{
    const fx_bam_t squint = f->track - f->bearing, least = radar->sar.squint_min;
    const bool is_off_the_track =
        fx_abs_u32((int32_t)squint) >= least && fx_abs_u32((int32_t)(squint + FX_BAM_180)) >= least;
    if (!is_off_the_track) {
        return LM_REFUSED_SQUINT;
    }
    if (!is_within(f->bearing - f->heading, radar->antenna.azimuth_limit)) {
        return LM_REFUSED_GIMBAL;
    }
    return patch_us <= lm_us_of_ms(radar->sar.dwell_max_ms) ? LM_REFUSED_NOT : LM_REFUSED_DWELL;
}

/* Ground range where the patch begins; below 0 if that is behind the antenna. */
static int64_t near_edge_m_q8(const struct lm_radar *radar, const struct lm_sar_command *c)
{
    const uint32_t before_centre = radar->sar.cells / 2u;
    return (int64_t)lm_m_q8_of_m(c->range_m) -
           (int64_t)before_centre * lm_m_q8_of_mm_nearest(c->cell_mm);
}

/* Lines that cover the square at its near edge, an even number: there line k of n is
 * (k + 1/2 - n/2) ds (S - C) / S aside, with C half a side. S is below 2^26 and there are at most
 * 2^10 cells. The near edge is behind the antenna or on it: no number is enough. */
static uint64_t lines_needed(const struct lm_radar *radar, const struct lm_sar_command *c)
{
    const uint32_t cell_m_q8 = lm_m_q8_of_mm_nearest(c->cell_mm);
    const int64_t range_m_q8 = lm_m_q8_of_m(c->range_m);
    const int64_t near_m_q8 = range_m_q8 - (int64_t)radar->sar.cells * cell_m_q8 / 2;
    const uint64_t cells_m_q8 = (uint64_t)radar->sar.cells * (uint64_t)range_m_q8;
    return near_m_q8 <= 0
               ? UINT64_MAX
               : (cells_m_q8 + 2 * (uint64_t)near_m_q8 - 1) / (2 * (uint64_t)near_m_q8) * 2;
}

static enum lm_refusal judge_command(const struct lm_radar *radar, const struct lm_sar_command *c)
{
    const int32_t highest_m_q6 = lm_m_q6_of_m(30000);
    if (c->cell_mm < radar->sar.cell_min_mm || c->cell_mm > radar->sar.cell_max_mm) {
        return LM_REFUSED_CELL;
    }
    if (lm_geo_is_polar(c->centre)) {
        return LM_REFUSED_POLE;
    }
    if (c->range_m > 250000) {
        return LM_REFUSED_FAR;
    }
    if (c->range_m < 1000 || near_edge_m_q8(radar, c) < LM_M_Q8(16 * LM_RANGE_MIN_M) ||
        lines_needed(radar, c) > LM_PATCH_LINES_MAX) {
        return LM_REFUSED_NEAR;
    }
    return c->height_m_q6 >= -highest_m_q6 && c->height_m_q6 <= highest_m_q6 ? LM_REFUSED_NOT
                                                                             : LM_REFUSED_HEIGHT;
}

/* Velocity to the right of the line of sight: that of the flight, or the table's to the left. */
static int32_t across_mm_s_of(const struct lm_radar *radar, const struct lm_sar_flight *flight)
{
    return flight ? speed_across_mm_s(flight) : -(int32_t)radar->sar.reference_speed_mm_s;
}

enum lm_refusal lm_sar_judge(const struct lm_radar *radar, const struct lm_sar_command *command,
                             const struct lm_sar_setup *setup)
{
    const enum lm_refusal reason = judge_command(radar, command);
    const uint32_t across_mm_s = fx_abs_u32(across_mm_s_of(radar, setup->flight));
    if (reason != LM_REFUSED_NOT || !setup->flight) {
        return reason;
    }
    return judge_flight(radar, setup->flight,
                        dwell_us(radar, command, setup->relief.reference_m_q10, across_mm_s));
}

/* What the relief of a patch is read by. */
struct relief_reader {
    struct lm_tile_cache *tiles;
    struct lm_geo_origin centre;
    fx_bam_t look_azimuth;
    uint8_t lod;
};

/* Elevation of the map at a place of a patch: so far beyond its centre, along the ray that is so
 * far to the right there, on both sides of it. */
static int32_t elevation_m_q10(const struct relief_reader *r, int32_t beyond_m_q8,
                               int32_t right_m_q8)
{
    const fx_bam_t azimuth = r->look_azimuth + fx_atan2(right_m_q8, beyond_m_q8);
    const struct lm_position place =
        lm_geo_direct(&r->centre, azimuth, fx_hypot_u32(right_m_q8, beyond_m_q8));
    return lm_scan_elevation(r->tiles, r->lod, place,
                             lm_m_q10_of_m_q6(r->tiles->db->mean_elevation_m_q6));
}

struct lm_sar_relief lm_sar_relief_of(struct lm_tile_cache *tiles, const struct lm_radar *radar,
                                      const struct lm_sar_command *c)
{
    struct relief_reader reader = {
        .tiles = tiles, .look_azimuth = c->look_azimuth, .lod = lm_scan_lod(tiles->db, c->cell_mm)};
    lm_geo_set_origin(&reader.centre, c->centre);
    const int32_t half_m_q8 = (int32_t)(radar->sar.cells * lm_m_q8_of_mm_nearest(c->cell_mm) / 2);
    struct lm_sar_relief relief = {.reference_m_q10 = elevation_m_q10(&reader, 0, 0)};
    for (int32_t n = 0; n < RELIEF_ROWS * RELIEF_PLACES && !c->is_plan; n++) {
        const int32_t right_m_q8 =
            half_m_q8 / (RELIEF_PLACES / 2) * (n % RELIEF_PLACES - RELIEF_PLACES / 2);
        /* At the edge, and 1/8 and 1/4 of a half behind it. */
        const int32_t beyond_m_q8 = half_m_q8 + half_m_q8 / 8 * (n / RELIEF_PLACES);
        const int32_t rise_m_q10 =
            elevation_m_q10(&reader, beyond_m_q8, right_m_q8) - relief.reference_m_q10;
        const int32_t fall_m_q10 =
            relief.reference_m_q10 - elevation_m_q10(&reader, -beyond_m_q8, right_m_q8);
        relief.far_rise_m_q10 =
            fx_max_u32(relief.far_rise_m_q10, (uint32_t)fx_max_i32(rise_m_q10, 0));
        relief.near_fall_m_q10 =
            fx_max_u32(relief.near_fall_m_q10, (uint32_t)fx_max_i32(fall_m_q10, 0));
    }
    return relief;
}

/* Grazing of flat ground at the centre, tan psi = (H - z0) / S - S / 2a, 0 where layover is not
 * wanted. No ground is seen more steeply than 63 degrees, tangent 2. */
static uint32_t lean_q16(const struct lm_sar_command *c, int32_t reference_m_q10)
{
    const uint32_t range_m_q8 = lm_m_q8_of_m(c->range_m);
    const int64_t above_m_q10 = (int64_t)lm_m_q10_of_m_q6(c->height_m_q6) - reference_m_q10;
    /* The height is below 2^26 in Q10, times 2^14, over a range in Q8. */
    const int64_t grazing_q16 =
        above_m_q10 * (1 << 14) / range_m_q8 - ((int64_t)range_m_q8 * LM_CURVATURE_Q48 >> 40);
    return c->is_plan ? 0 : (uint32_t)fx_clamp_i64(grazing_q16, 0, (1 << 17) - 1);
}

/* Cells that ground so high is displaced by, and two more for what is between the places that the
 * relief was read at. Heights are below 2^25. */
static uint32_t overscan_cells(const struct lm_sar *s, uint32_t height_m_q10, uint32_t most)
{
    const uint64_t cells =
        ((uint64_t)height_m_q10 * s->lean_q16 >> 18) / lm_m_q8_of_mm_nearest(s->command.cell_mm);
    return cells == 0 ? 0 : (uint32_t)fx_clamp_i64((int64_t)cells + 2, 0, most);
}

/* Set how many cells are traced on both sides of the patch, because layover brings them in. */
static void set_overscan(struct lm_sar *s, const struct lm_sar_relief *relief)
{
    const uint32_t room = (uint32_t)(LM_CELLS_MAX - s->radar->sar.cells) / 2;
    const uint32_t most = fx_min_u32(LM_SAR_OVERSCAN_MAX, room);
    const int64_t near_m_q8 = near_edge_m_q8(s->radar, &s->command) - LM_M_Q8(16 * LM_RANGE_MIN_M);
    const uint64_t behind_us = (uint64_t)near_m_q8 / lm_m_q8_of_mm_nearest(s->command.cell_mm);
    s->lean_q16 = lean_q16(&s->command, relief->reference_m_q10);
    const uint32_t before = overscan_cells(s, relief->near_fall_m_q10, most);
    s->overscan = before < behind_us ? before : (uint32_t)behind_us;
    s->traced = s->overscan + s->radar->sar.cells + overscan_cells(s, relief->far_rise_m_q10, most);
}

/* Ground range where the first traced cell begins. */
static uint32_t traced_from_m_q8(const struct lm_sar *s)
{
    return (uint32_t)near_edge_m_q8(s->radar, &s->command) -
           s->overscan * lm_m_q8_of_mm_nearest(s->command.cell_mm);
}

static void set_grid(struct lm_sar *s, const struct lm_db *db, int32_t reference_m_q10)
{
    const struct lm_sar_command *c = &s->command;
    const uint32_t cell_m_q8 = lm_m_q8_of_mm_nearest(c->cell_mm), near_m_q8 = traced_from_m_q8(s);
    const int32_t before = (int32_t)(s->radar->sar.cells * cell_m_q8 / 2 + s->overscan * cell_m_q8);
    const struct lm_ground_extent extent = {.near_m_q8 = -before,
                                            .far_m_q8 = (int32_t)(s->traced * cell_m_q8) - before,
                                            .side_m_q8 = (int32_t)(s->lines * cell_m_q8 / 2),
                                            .apex_m_q8 = lm_m_q8_of_m(c->range_m)};
    lm_ground_patch_set(&s->ground, c->centre, c->look_azimuth, &extent);
    s->lod = lm_scan_lod(db, c->cell_mm);
    lm_scan_blend_set(&s->blend, db, c->cell_mm);
    s->has_crests = lm_crests_are_wanted(db, s->lod, s->blend.is_on, c->cell_mm);
    lm_range_grid_set(&s->grid, &s->radar->illumination, near_m_q8 + cell_m_q8 / 2, cell_m_q8,
                      s->traced, lm_m_q10_of_m_q6(c->height_m_q6), reference_m_q10);
    lm_sea_set_cells(&s->sea, &s->grid, near_m_q8 + cell_m_q8 / 2);
}

/* Set the foreground: the terrain before the first traced cell. */
static void set_foreground(struct lm_sar *s, const struct lm_db *db)
{
    const struct lm_sar_command *c = &s->command;
    struct lm_foreground *f = &s->foreground;
    lm_foreground_set(f, db, &s->radar->illumination, traced_from_m_q8(s), &s->grid);
    const int32_t near_m_q8 = (int32_t)f->start_m_q8 - (int32_t)lm_m_q8_of_m(c->range_m);
    const struct lm_ground_extent extent = {
        .near_m_q8 = near_m_q8,
        .far_m_q8 = near_m_q8 + (int32_t)(LM_FOREGROUND_CELLS * f->cell_m_q8),
        .side_m_q8 = (int32_t)(s->lines * s->grid.cell_m_q8 / 2),
        .apex_m_q8 = lm_m_q8_of_m(c->range_m)};
    lm_ground_patch_set(&s->foreground_ground, c->centre, c->look_azimuth, &extent);
}

static void set_layover(struct lm_sar *s, const struct lm_classes *classes)
{
    const struct lm_layover_view view = {.reference_m_q10 = s->grid.reference_m_q10,
                                         .lean_q16 = s->lean_q16,
                                         .cell_m_q8 = s->grid.cell_m_q8,
                                         .first = s->grid.first,
                                         .cells = s->grid.cells};
    lm_layover_set(&s->layover, classes, &view);
}

static void set_geometry(struct lm_sar *s)
{
    s->geometry = (struct lm_patch_geometry){
        .centre = s->command.centre,
        .look = s->command.look_azimuth,
        .centre_m_q8 = lm_m_q8_of_m(s->command.range_m),
        .cell_m_q8 = s->grid.cell_m_q8,
        .lines = s->lines,
        .cells = s->radar->sar.cells,
        .overscan = s->overscan,
        .traced = s->traced,
        .first = fx_max_u32(s->grid.first, s->overscan) - s->overscan,
        .heights = {s->grid.height_m_q10, s->grid.reference_m_q10},
        .wavelength_um = s->radar->wavelength_um,
        .across_mm_s = s->across_mm_s,
        .lean_q16 = (int32_t)s->lean_q16,
        .dwell_ms = s->dwell_ms,
        .epoch = s->epoch,
    };
}

/* Position below the antenna. */
static struct lm_position antenna_of(const struct lm_sar_command *c)
{
    struct lm_geo_origin centre;
    lm_geo_set_origin(&centre, c->centre);
    return lm_geo_direct(&centre, c->look_azimuth + FX_BAM_180, lm_m_q8_of_m(c->range_m));
}

/* Compute noise and rain of a patch for an antenna that points at its centre all along. A jammer
 * therefore raises the noise of the whole patch alike. */
static void find_weather(struct lm_sar *s, const struct lm_sar_setup *setup)
{
    const struct lm_environment *environment = setup->environment;
    const struct lm_sar_command *c = &s->command;
    uint32_t distance_m_q8;
    fx_bam_t azimuth;
    s->floor_db_q8 = s->radar->sar.noise_floor_db_q8 + setup->noise_rise_db_q8;
    s->rain.count = 0;
    if (!environment || environment->rain_count + environment->jammer_count == 0) {
        return;
    }
    const struct lm_position antenna = antenna_of(c);
    lm_geo_inverse(antenna, c->centre, &distance_m_q8, &azimuth);
    s->floor_db_q8 += lm_noise_rise_db_q8(environment, s->radar, antenna, azimuth);
    lm_patch_rain_find(&s->rain, environment, s->radar, antenna, azimuth);
}

/* Where the patch lies in the grain: a hash of centre and command. Without it every patch would
 * show the same grain, like a dirty glass. The same patch made again shows the same grain. */
static struct lm_grain_place grain_of(const struct lm_sar_command *c, uint32_t epoch)
{
    const uint32_t of_place = fx_hash3(c->centre.latitude, c->centre.longitude, epoch);
    return lm_grain_start(LM_GRAIN_SPECKLE, fx_hash3(of_place, c->look_azimuth, c->cell_mm));
}

static void set_sea(struct lm_sar *s, const struct lm_classes *classes,
                    const struct lm_sar_setup *setup)
{
    const struct lm_environment *e = setup->environment;
    lm_sea_set(&s->sea, s->radar, classes, setup->sea_state,
               e && e->has_wind ? &e->wind_from : NULL);
    lm_sea_look(&s->sea, s->command.look_azimuth);
}

int lm_sar_start(struct lm_sar *s, const struct lm_radar *radar, const struct lm_db *db,
                 const struct lm_sar_command *command, const struct lm_sar_setup *setup)
{
    const struct lm_sar_flight *flight = setup->flight;
    if (lm_sar_judge(radar, command, setup) != LM_REFUSED_NOT) {
        return LM_ERR_RANGE;
    }
    const int32_t across_mm_s = across_mm_s_of(radar, flight);
    const uint64_t patch_us =
        dwell_us(radar, command, setup->relief.reference_m_q10, fx_abs_u32(across_mm_s));
    s->radar = radar;
    s->command = *command;
    s->lines = (uint32_t)lines_needed(radar, command);
    const uint64_t line_us = patch_us / s->lines;
    s->line_us = line_us < LM_SAR_LINE_MIN_US ? LM_SAR_LINE_MIN_US : line_us;
    s->targets = setup->targets;
    s->chips = setup->chips;
    s->time_us = setup->time_us;
    s->epoch = setup->epoch;
    s->grain = grain_of(command, setup->epoch);
    lm_grain_curve_set(&s->speckle, 256u << radar->sar.speckle.looks_log2);
    s->across_mm_s = across_mm_s;
    find_weather(s, setup);
    s->defocus_lines_q8 =
        flight && !command->is_steady
            ? lm_defocus_lines_q8(flight->lateral_mm_s2, radar->sar.mocomp_residual_permille,
                                  radar->wavelength_um, patch_us)
            : 256;
    lm_class_lut_set(&s->class_lut, &radar->illumination, &db->classes);
    lm_class_gain_set(&s->class_gain, &radar->facing, &db->classes,
                      lm_scan_lod(db, command->cell_mm), setup->sea_state, 0);
    lm_class_gain_look(&s->class_gain, command->look_azimuth);
    set_sea(s, &db->classes, setup);
    const uint64_t patch_ms = lm_ms_of_us(patch_us);
    s->dwell_ms = (uint32_t)(patch_ms < DWELL_MOST_MS ? patch_ms : DWELL_MOST_MS);
    lm_sar_set_relief(s, db, &setup->relief);
    const bool is_finer = s->lod == db->finest && command->cell_mm < lm_db_cell_mm(db, db->finest);
    s->detail_state = is_finer && db->detail_size != 0 ? LM_SAR_DETAIL_WANTED : LM_SAR_DETAIL_NONE;
    return LM_OK;
}

void lm_sar_set_relief(struct lm_sar *s, const struct lm_db *db, const struct lm_sar_relief *relief)
{
    s->relief = *relief;
    set_overscan(s, relief);
    set_grid(s, db, relief->reference_m_q10);
    set_foreground(s, db);
    set_layover(s, &db->classes);
    set_geometry(s);
    lm_patch_rain_set(&s->rain, s->radar, &s->geometry, s->floor_db_q8);
    lm_sar_restart(s);
}

uint64_t lm_sar_time_to_go_us(const struct lm_sar *s)
{
    return (s->lines - s->line) * s->line_us;
}

/* Path of a line over the traced cells. */
static void set_path(struct lm_ground_path *path, const struct lm_sar *s, uint32_t line)
{
    lm_ground_patch_path(path, &s->ground, line, s->lines, s->grid.cells);
}

/* Path of a line over the foreground. */
static void set_foreground_path(struct lm_ground_path *path, const struct lm_sar *s,
                                uint32_t number)
{
    lm_ground_patch_path(path, &s->foreground_ground, number * LM_SAR_FOREGROUND_LINES, s->lines,
                         LM_FOREGROUND_CELLS);
}

void lm_sar_prefetch(const struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t line)
{
    const uint32_t first = line / LM_SAR_FOREGROUND_LINES;
    struct lm_ground_path path;
    set_path(&path, s, line);
    lm_scan_line_prefetch(tiles, s->lod, &path, s->grid.cells);
    for (uint32_t number = first; number <= first + 1; number++) {
        set_foreground_path(&path, s, number);
        lm_scan_line_prefetch(tiles, s->foreground.lod, &path, LM_FOREGROUND_CELLS);
    }
}

/* Displacement by Doppler is s v / (V sin o): metres for each mm/s at the patch's far end, Q16.
 * Ranges are below 2^18 m. */
static uint32_t displaced_q16(const struct lm_sar *s, uint32_t half_diagonal_m)
{
    const uint64_t far_m = (uint64_t)s->command.range_m + half_diagonal_m;
    const uint64_t most = 1 << 30;
    const uint64_t each = (far_m << 16) / fx_max_u32(fx_abs_u32(s->across_mm_s), 1);
    return (uint32_t)(each < most ? each : most);
}

/* Greatest displacement of a candidate, at most 200 km. Targets outside of the patch may appear in
 * it. Speeds are below 2^20.1. */
static uint32_t displaced_most_m(const struct lm_target_candidates *candidates, uint32_t each_q16)
{
    uint32_t fastest_mm_s = 0;
    for (uint32_t i = 0; i < candidates->count; i++) {
        fastest_mm_s = fx_max_u32(fastest_mm_s, candidates->candidate[i].state.speed_mm_s);
    }
    const uint64_t most_m = (uint64_t)fastest_mm_s * each_q16 >> 16;
    return most_m < 200000 ? (uint32_t)most_m : 200000;
}

void lm_sar_prefetch_targets(struct lm_sar *s, struct lm_tile_cache *tiles)
{
    s->candidates.count = s->candidates.left_out = 0;
    if (!s->targets || !lm_target_set_has_any(s->targets)) {
        return;
    }
    /* Half the diagonal; 1.5 is more than the root of 2. */
    const uint32_t half_diagonal_m = s->radar->sar.cells * s->grid.cell_m_q8 / 512 * 3 / 2 + 1;
    const struct lm_target_query query = {.position = s->command.centre,
                                          .reach_m = half_diagonal_m,
                                          .displaced_q16 = displaced_q16(s, half_diagonal_m),
                                          .time_us = s->time_us,
                                          .tiles = tiles,
                                          .lod = s->lod};
    lm_target_candidates_select(&s->candidates, s->targets, &query);
    lm_target_candidates_add_live(&s->candidates, &query);
    if (s->chips) {
        const uint32_t displaced_m = displaced_most_m(&s->candidates, query.displaced_q16);
        const struct lm_chip_query chip_query = {.centre = s->command.centre,
                                                 .reach_m = query.reach_m + displaced_m,
                                                 .radar = antenna_of(&s->command),
                                                 .heights = s->geometry.heights,
                                                 .cell_mm = s->command.cell_mm,
                                                 .side_most = LM_CHIP_SIDE};
        lm_chips_choose(s->chips, &s->candidates, &chip_query);
    }
}

/* Box of the tiles that may hold detail of the patch: around a circle that holds the patch, and
 * 200 m wider, because an item belongs to the tile of its middle. */
static struct lm_detail_box detail_box(const struct lm_sar *s)
{
    struct lm_geo_origin centre;
    /* 3/4 of the width is more than half the diagonal. */
    const uint32_t reach_m_q8 = s->geometry.lines * s->grid.cell_m_q8 / 4 * 3 + LM_M_Q8(200);
    lm_geo_set_origin(&centre, s->command.centre);
    return (struct lm_detail_box){
        .south = lm_geo_direct(&centre, FX_BAM_180, reach_m_q8).latitude,
        .north = lm_geo_direct(&centre, 0, reach_m_q8).latitude,
        .west = lm_geo_direct(&centre, FX_BAM_180 + FX_BAM_90, reach_m_q8).longitude,
        .east = lm_geo_direct(&centre, FX_BAM_90, reach_m_q8).longitude};
}

static void start_detail(struct lm_sar *s, const struct lm_db *db)
{
    const struct lm_detail_box box = detail_box(s);
    lm_detail_reader_start(&s->detail_reader, db, &box);
    lm_detail_patch_clear(&s->detail, db);
    s->detail_state = LM_SAR_DETAIL_LOADING;
}

bool lm_sar_load_detail(struct lm_sar *s, struct lm_tile_cache *tiles, bool is_late)
{
    if (s->detail_state == LM_SAR_DETAIL_WANTED) {
        start_detail(s, tiles->db);
    }
    if (s->detail_state != LM_SAR_DETAIL_LOADING) {
        return true;
    }
    const enum lm_detail_step step = lm_detail_reader_step(&s->detail_reader, tiles);
    if (step == LM_DETAIL_ARRIVED) {
        lm_detail_patch_add(&s->detail, &s->detail_reader, tiles, &s->geometry,
                            s->radar->sar.line_lobe);
    }
    if (step != LM_DETAIL_ENDED && !is_late) {
        return false;
    }
    lm_detail_patch_close(&s->detail);
    s->detail_state = LM_SAR_DETAIL_READY;
    return true;
}

/* Compute the scatterers and chips of the targets that the patch may show. */
static void find_target_patch(struct lm_sar *s, struct lm_tile_cache *tiles)
{
    lm_sar_prefetch_targets(s, tiles);
    if (s->candidates.count != 0) {
        lm_target_patch_set(&s->target_patch, &s->candidates, &s->geometry);
        lm_patch_rain_weaken(&s->rain, &s->geometry, &s->target_patch);
    }
    s->has_target_patch = true;
}

/* Horizon behind the foreground of one line in LM_SAR_FOREGROUND_LINES. */
static lm_horizon_q40_t trace_foreground(const struct lm_sar *s, struct lm_tile_cache *tiles,
                                         uint32_t number, struct lm_line *line)
{
    struct lm_ground_path path;
    set_foreground_path(&path, s, number);
    return lm_foreground_horizon(&s->foreground, &s->class_lut, tiles, &path, &line->ground);
}

/* Horizon at the start of a line: linear between those of the foregrounds traced to its left and
 * right. */
static lm_horizon_q40_t start_horizon(struct lm_sar *s, struct lm_tile_cache *tiles,
                                      uint32_t number, struct lm_line *line)
{
    const uint32_t second = number / LM_SAR_FOREGROUND_LINES + 1;
    if (second != s->second_foreground) {
        const bool goes_on = s->second_foreground != 0 && second == s->second_foreground + 1;
        s->foregrounds[0] =
            goes_on ? s->foregrounds[1] : trace_foreground(s, tiles, second - 1, line);
        s->foregrounds[1] = trace_foreground(s, tiles, second, line);
        s->second_foreground = second;
    }
    /* If no cell of the foreground is traced, both are open. */
    if (s->foregrounds[0] == LM_HORIZON_OPEN) {
        return LM_HORIZON_OPEN;
    }
    /* Tangents have 32 bits, at least 22 of them fractional: below 2^49, times 16 lines. */
    const int64_t rise_q40 = s->foregrounds[1] - s->foregrounds[0];
    return s->foregrounds[0] +
           rise_q40 * (int64_t)(number % LM_SAR_FOREGROUND_LINES) / LM_SAR_FOREGROUND_LINES;
}

static void trace_line(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t number,
                       struct lm_line *line)
{
    const bool has_detail = s->detail_state == LM_SAR_DETAIL_READY;
    struct lm_scan_blend blend = s->blend;
    /* Detail takes the map's structures away, and their codes' heights with them. */
    blend.flat = has_detail ? s->detail.structures : 0;
    blend.tells_runs = has_detail;
    const struct lm_line_setup setup = {.grid = &s->grid,
                                        .class_lut = &s->class_lut,
                                        .class_gain = &s->class_gain,
                                        .sea = &s->sea,
                                        .blend = &blend,
                                        .lod = s->lod,
                                        .has_crests = s->has_crests,
                                        .detail = has_detail ? &s->detail : NULL,
                                        .number = number};
    struct lm_ground_path path;
    set_path(&path, s, number);
    s->horizon = start_horizon(s, tiles, number, line);
    lm_line_trace(line, tiles, &setup, &path, s->horizon);
}

/* Weaken the line by rain, add its floor, and multiply all of it by the speckle. */
static void add_floor_and_speckle(struct lm_sar *s, uint32_t number, int16_t *clutter_db_q8,
                                  int16_t *level_db_q8)
{
    const uint32_t cells = s->radar->sar.cells;
    const struct lm_grain_place place = {s->grain.row + number, s->grain.column};
    int32_t noise_db_q8 = s->floor_db_q8;
    if (s->rain.count != 0) {
        lm_patch_rain_run(&s->rain, &s->geometry, number, clutter_db_q8, clutter_db_q8);
        noise_db_q8 = LM_LEVEL_SHADOW; /* the rain's veil has it */
    }
    const int32_t leak_db_q8 =
        lm_patch_floor_run(&s->floor, &s->radar->sar, number, clutter_db_q8, cells);
    s->shadow_db_q8 = fx_db_q8_sum_vec(s->floor_db_q8, leak_db_q8);
    lm_grain_floor_run(&s->speckle, place, fx_db_q8_sum_vec(noise_db_q8, leak_db_q8), clutter_db_q8,
                       level_db_q8, cells);
}

void lm_sar_sample_line(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t number,
                        struct lm_line *line, int16_t *level_db_q8)
{
    int16_t *clutter_db_q8 = line->lit.level_db_q8;
    const int32_t *elevation_m_q14 = line->ground.elevation_m_q14 + s->overscan;
    trace_line(s, tiles, number, line);
    const bool has_chips = s->chips && s->target_patch.on_line[number] != 0;
    if (has_chips) {
        lm_target_patch_shade(&s->target_patch, number, &s->geometry, elevation_m_q14,
                              clutter_db_q8 + s->overscan);
    }
    if (s->lean_q16 != 0) {
        clutter_db_q8 =
            lm_layover_run(&s->layover, &line->ground, clutter_db_q8, s->laid_db_q8) + s->overscan;
    }
    if (has_chips) {
        s->chips->count.cells_left_out += lm_target_patch_add_chips(
            &s->target_patch, number, &s->geometry, elevation_m_q14, clutter_db_q8);
    }
    add_floor_and_speckle(s, number, clutter_db_q8, level_db_q8);
}

/* True if a scatterer may be displayed on lines before the one that holds its position. */
static bool is_early(const struct lm_sar *s, const struct lm_patch_scatterer *p)
{
    return (p->is_displaced || p->is_chip) && p->line >= 0 && p->line < (int32_t)s->lines;
}

/* Mark the scatterers of a traced line that its horizon hides. They count cells from the first
 * cell of the patch. */
static void mark_hidden(struct lm_sar *s, uint32_t number, const struct lm_line *line)
{
    lm_target_patch_mark_hidden(&s->target_patch, number, line->lit.horizon + s->overscan,
                                s->grid.tangent_bits, s->traced - s->overscan);
}

static bool is_hidden_known(const struct lm_sar *s)
{
    return s->shaded_known == s->target_patch.scatterer_count;
}

/* Test which chips and displaced movers are hidden before the first line is sampled: they are
 * displayed on earlier lines than the one that holds their position. Then, which scatterers stand
 * in the shadow of others' chips. Traces at most `at_most` lines, or looks at so many scatterers.
 * True when all are tested. */
static bool find_hidden(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t at_most,
                        struct lm_line *line)
{
    uint32_t traced = 0;
    for (; s->hidden_known < s->target_patch.scatterer_count && traced < at_most;
         s->hidden_known++) {
        const struct lm_patch_scatterer *p = &s->target_patch.scatterer[s->hidden_known];
        const bool is_judged = s->hidden_known != 0 && is_early(s, p - 1) && p[-1].line == p->line;
        if (is_early(s, p) && !is_judged) {
            const uint32_t number = (uint32_t)p->line;
            trace_line(s, tiles, number, line);
            mark_hidden(s, number, line);
            lm_target_patch_lean(&s->target_patch, number,
                                 line->ground.elevation_m_q14 + s->overscan, &s->geometry);
            traced++;
        }
    }
    if (s->hidden_known != s->target_patch.scatterer_count) {
        return false;
    }
    for (; !is_hidden_known(s) && traced < at_most; s->shaded_known++) {
        traced += lm_target_patch_mark_shaded(&s->target_patch, s->shaded_known, &s->geometry);
    }
    return is_hidden_known(s);
}

static int16_t *ring_line(struct lm_sar *s, uint32_t number)
{
    return s->ring_db_q8[number % LM_SAR_RING];
}

/* Sample lines until `end` are sampled. */
static void sample_lines(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t end,
                         struct lm_line *line)
{
    for (; s->sampled < end; s->sampled++) {
        int16_t *const level_db_q8 = ring_line(s, s->sampled);
        lm_sar_sample_line(s, tiles, s->sampled, line, level_db_q8);
        lm_side_lobes_find(&s->side_lobes, s->sampled, level_db_q8, s->radar->sar.cells,
                           s->shadow_db_q8, s->command.centre.longitude);
        mark_hidden(s, s->sampled, line);
    }
}

/* Add the side lobes of a line's strong cells to the lines around it, which are sampled. Beyond the
 * patch these are places of the ring that hold no line. */
static void add_side_lobes(struct lm_sar *s, uint32_t number)
{
    lm_side_lobes_add(&s->side_lobes, number,
                      s->ring_rows + (number - LM_RESPONSE_REACH) % LM_SAR_RING,
                      s->radar->sar.cells);
}

/* Add side lobes of the ground, and the scatterers, to lines until `end` have them. It is done
 * after speckle and noise, which belong to the clutter: the echo of a target has its own
 * fluctuation. */
static void add_scatterers(struct lm_sar *s, uint32_t end)
{
    const int32_t least_db_q8 = s->radar->sar.noise_floor_db_q8 - LEFT_OUT_BELOW_FLOOR_Q8;
    const uint32_t lobes_end = fx_min_u32(end + LM_RESPONSE_REACH, s->lines);
    for (; s->lobes_added < lobes_end; s->lobes_added++) {
        add_side_lobes(s, s->lobes_added);
    }
    for (; s->summed < end; s->summed++) {
        lm_target_patch_add_scatterers(&s->target_patch, s->summed, least_db_q8, &s->geometry,
                                       ring_line(s, s->summed));
    }
}

/* Levels of the line to be drawn: as sampled, or out of focus, in smeared_db_q8. The patch's first
 * and last lines are repeated beyond its edges. */
static const int16_t *focus_line(struct lm_sar *s, int16_t *smeared_db_q8)
{
    if (s->defocus_lines_q8 <= 256) {
        return ring_line(s, s->line);
    }
    const int16_t *near_lines[2 * LM_DEFOCUS_REACH + 1];
    uint32_t share_q16[2 * LM_DEFOCUS_REACH + 1];
    for (int32_t m = -LM_DEFOCUS_REACH; m <= LM_DEFOCUS_REACH; m++) {
        const int32_t last = (int32_t)s->lines - 1;
        const int32_t number = fx_clamp_i32((int32_t)s->line + m, 0, last);
        near_lines[m + LM_DEFOCUS_REACH] = ring_line(s, (uint32_t)number);
    }
    lm_defocus_shares(s->defocus_lines_q8, share_q16);
    lm_defocus_run(near_lines, share_q16, smeared_db_q8, s->power_q32, s->radar->sar.cells);
    return smeared_db_q8;
}

/* Take at most `at_most` samples, up to line `end`. */
static void sample_some(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t end,
                        uint32_t at_most, struct lm_line *line)
{
    if (!s->has_target_patch) {
        find_target_patch(s, tiles);
    }
    if (is_hidden_known(s) || find_hidden(s, tiles, at_most, line)) {
        sample_lines(s, tiles, fx_min_u32(s->sampled + at_most, end), line);
    }
}

bool lm_sar_sample_ahead(struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t at_most,
                         struct lm_line *line)
{
    const uint32_t end = fx_min_u32(s->line + 1 + LM_SAR_AHEAD, s->lines);
    if (s->sampled < end) {
        sample_some(s, tiles, end, at_most, line);
    }
    return s->sampled >= end;
}

const int16_t *lm_sar_draw_line(struct lm_sar *s, struct lm_tile_cache *tiles,
                                const struct lm_tone *tone, struct lm_line *line)
{
    lm_sar_sample_ahead(s, tiles, LM_PATCH_SCATTERERS_MAX, line);
    add_scatterers(s, fx_min_u32(s->line + 1 + LM_DEFOCUS_REACH, s->lines));
    const int16_t *const level_db_q8 = focus_line(s, line->lit.level_db_q8);
    lm_tone_run(tone, level_db_q8, line->grey, s->radar->sar.cells);
    s->line++;
    return level_db_q8;
}

void lm_sar_restart(struct lm_sar *s)
{
    s->line = s->sampled = s->lobes_added = s->summed = s->second_foreground = 0;
    s->hidden_known = s->shaded_known = 0;
    s->has_target_patch = false;
    lm_side_lobes_clear(&s->side_lobes, &s->radar->sar.side_lobes);
    lm_patch_floor_clear(&s->floor);
    lm_target_patch_clear(&s->target_patch);
    for (uint32_t k = 0; k < sizeof s->ring_rows / sizeof *s->ring_rows; k++) {
        s->ring_rows[k] = s->ring_db_q8[k % LM_SAR_RING];
    }
}
