#include "lm/sar.h"

#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"

static uint32_t metres_q8_of_mm(uint32_t mm)
{
    return (uint32_t)(((uint64_t)mm * 256 + 500) / 1000);
}

static uint32_t mm_of_metres_q8(uint32_t metres_q8)
{
    return (uint32_t)((uint64_t)metres_q8 * 1000 / 256);
}

/* The part of the velocity that lies across the line of sight, to the right of it, mm/s. */
static int32_t speed_across_mm_s(const struct lm_sar_flight *f)
{
    return (int32_t)((int64_t)f->speed_mm_s * fx_sin_q30(f->track - f->bearing) >> 30);
}

/* T = l R / (2 V d sin o), R the slant range, V sin o the speed across. In these units the
 * numerator is below 2^20 * 2^18.1 * 10^6 = 2^58. */
static uint64_t dwell_us(const struct lm_radar *radar, const struct lm_sar_command *c,
                         int32_t reference_q10, uint32_t across_mm_s)
{
    const int32_t above_m = c->height_q6 / 64 - reference_q10 / 1024;
    const uint64_t slant_m = fx_hypot_u32((int32_t)c->range_m, above_m);
    return (uint64_t)radar->wavelength_um * slant_m * 1000000u /
           ((uint64_t)2 * c->cell_mm * fx_max_u32(across_mm_s, 1));
}

static bool is_within(fx_bam_t angle, fx_bam_t limit)
{
    return fx_abs_u32((int32_t)angle) <= limit;
}

/* Whether an aircraft in flight can make a patch there in that time. */
static bool can_be_made(const struct lm_radar *radar, const struct lm_sar_flight *f,
                        uint64_t patch_us)
{
    const fx_bam_t squint = f->track - f->bearing, least = radar->sar.squint_min;
    const bool is_off_the_track =
        fx_abs_u32((int32_t)squint) >= least && fx_abs_u32((int32_t)(squint + FX_BAM_180)) >= least;
    return is_off_the_track && is_within(f->bearing - f->heading, radar->antenna.azimuth_limit) &&
           patch_us <= (uint64_t)radar->sar.dwell_max_ms * 1000;
}

static bool command_is_sound(const struct lm_radar *radar, const struct lm_sar_command *c)
{
    const int32_t highest_q6 = 30000 * 64;
    const uint32_t before_centre_q8 =
        (radar->sar.cells / 2u + LM_SAR_GUARD) * metres_q8_of_mm(c->cell_mm);
    return c->cell_mm >= radar->sar.cell_min_mm && c->cell_mm <= radar->sar.cell_max_mm &&
           c->range_m >= 1000 && c->range_m <= 250000 && c->height_q6 >= -highest_q6 &&
           c->height_q6 <= highest_q6 &&
           c->range_m * 256u >= before_centre_q8 + ((uint32_t)LM_RANGE_MIN_M << 12);
}

static void set_grids(struct lm_sar *s, const struct lm_db *db, int32_t reference_q10)
{
    const struct lm_radar *radar = s->radar;
    const struct lm_sar_command *c = &s->command;
    const uint32_t cell_q8 = metres_q8_of_mm(c->cell_mm);
    const uint32_t near_q8 = c->range_m * 256u - (radar->sar.cells / 2u + LM_SAR_GUARD) * cell_q8;
    const int32_t height_q10 = c->height_q6 * 16;
    lm_ground_patch_set(&s->ground, c->centre, c->look_azimuth, radar->sar.cells * cell_q8 / 2);
    s->sampling = lm_sampling_for(db, c->cell_mm, s->epoch);
    lm_range_grid_set(&s->grid, &radar->aspect, near_q8 + cell_q8 / 2, cell_q8,
                      radar->sar.cells + LM_SAR_GUARD, height_q10, reference_q10);
    const uint32_t runup_cell_q8 = (near_q8 - near_q8 / 16) / LM_SAR_RUNUP;
    s->runup_sampling = lm_sampling_for(db, mm_of_metres_q8(runup_cell_q8), s->epoch);
    lm_range_grid_set(&s->runup_grid, &radar->aspect, near_q8 / 16 + runup_cell_q8 / 2,
                      runup_cell_q8, LM_SAR_RUNUP, height_q10, reference_q10);
}

int lm_sar_start(struct lm_sar *s, const struct lm_radar *radar, const struct lm_db *db,
                 const struct lm_sar_command *command, const struct lm_sar_scene *scene)
{
    const struct lm_sar_flight *flight = scene->flight;
    if (!command_is_sound(radar, command)) {
        return LM_ERR_RANGE;
    }
    const int32_t across_mm_s =
        flight ? speed_across_mm_s(flight) : -(int32_t)radar->sar.reference_speed_mm_s;
    const uint64_t patch_us =
        dwell_us(radar, command, scene->reference_q10, fx_abs_u32(across_mm_s));
    if (flight && !can_be_made(radar, flight, patch_us)) {
        return LM_ERR_RANGE;
    }
    const uint64_t line_us = patch_us / radar->sar.cells;
    s->radar = radar;
    s->command = *command;
    s->line_us = line_us < LM_SAR_LINE_MIN_US ? LM_SAR_LINE_MIN_US : line_us;
    s->targets = scene->targets;
    s->time_us = scene->time_us;
    s->near.is_chosen = false;
    s->epoch = scene->epoch;
    s->horizon = LM_HORIZON_OPEN;
    s->line = 0;
    lm_texture_set(&s->texture, &radar->texture, &db->classes, scene->sea_state);
    set_grids(s, db, scene->reference_q10);
    return LM_OK;
}

uint64_t lm_sar_time_to_go_us(const struct lm_sar *s)
{
    return (s->radar->sar.cells - s->line) * s->line_us;
}

/* The path of a line over patch and guard cells. */
static struct lm_ground_path patch_path(const struct lm_sar *s, uint32_t line)
{
    struct lm_place points[3];
    struct lm_ground_path path;
    lm_ground_patch_line(&s->ground, line, s->radar->sar.cells, points);
    lm_ground_path_fit(&path, points, s->radar->sar.cells);
    lm_ground_path_skip(&path, -LM_SAR_GUARD);
    return path;
}

/* The path of the run-up: back from the near end of the line towards the antenna, then forward
 * along it. */
static struct lm_ground_path runup_path(const struct lm_sar *s, uint32_t line)
{
    struct lm_place points[3];
    struct lm_geo_origin near_end;
    struct lm_ground_path path;
    lm_ground_patch_line(&s->ground, line, s->radar->sar.cells, points);
    lm_geo_set_origin(&near_end, points[0]);
    const fx_bam_t back = s->command.look_azimuth + FX_BAM_180;
    const uint32_t guard_q8 = LM_SAR_GUARD * s->grid.cell_q8;
    const uint32_t length_q8 = LM_SAR_RUNUP * s->runup_grid.cell_q8;
    for (uint32_t i = 0; i < 3; i++) {
        points[i] = lm_geo_direct(&near_end, back, guard_q8 + length_q8 * (2 - i) / 2);
    }
    lm_ground_path_fit(&path, points, LM_SAR_RUNUP);
    return path;
}

void lm_sar_prefetch(const struct lm_sar *s, struct lm_tile_cache *tiles, uint32_t line)
{
    const struct lm_ground_path path = patch_path(s, line), runup = runup_path(s, line);
    lm_scan_line_prefetch(tiles, &s->sampling, &path, s->grid.cells);
    lm_scan_line_prefetch(tiles, &s->runup_sampling, &runup, LM_SAR_RUNUP);
}

/* The targets that the line at hand may meet. */
static void find_targets(struct lm_sar *s, struct lm_tile_cache *tiles, struct lm_line_targets *t)
{
    const uint32_t cell_q8 = s->grid.cell_q8, range_q8 = s->command.range_m * 256u;
    const uint32_t half_q8 = s->radar->sar.cells * cell_q8 / 2;
    /* Half the diagonal: 1.5 is more than the root of 2. */
    const struct lm_target_scene scene = {.place = s->command.centre,
                                          .reach_m = half_q8 * 3 / 2 / 256 + 1,
                                          .time_us = s->time_us,
                                          .tiles = tiles,
                                          .level = s->sampling.level};
    lm_targets_refresh(&s->near, s->targets, &scene);
    const uint32_t before_centre_q8 = (s->radar->sar.cells / 2u + LM_SAR_GUARD) * cell_q8;
    t->items = s->targets->items;
    t->near = &s->near;
    t->where = (struct lm_target_line){
        .is_patch = true,
        .place = s->command.centre,
        .azimuth = s->command.look_azimuth,
        .across_q8 = (int32_t)(s->line * cell_q8 + cell_q8 / 2) - (int32_t)half_q8,
        .centre_q8 = range_q8,
        .first_q8 = range_q8 - before_centre_q8 + cell_q8 / 2,
        .cell_q8 = cell_q8,
        .cells = s->grid.cells,
        .first = s->grid.first,
        .height_q10 = s->grid.height_q10,
        .reference_q10 = s->grid.reference_q10,
        .wavelength_um = s->radar->wavelength_um,
        .scan = s->epoch,
        .pulse = s->line,
    };
}

void lm_sar_draw_line(struct lm_sar *s, struct lm_tile_cache *tiles, const struct lm_tone *tone,
                      struct lm_line *line)
{
    struct lm_line_setup setup = {.grid = &s->runup_grid,
                                  .aspect = &s->radar->aspect,
                                  .texture = &s->texture,
                                  .sampling = s->runup_sampling};
    if (s->line % LM_SAR_RUNUP_LINES == 0) {
        const struct lm_ground_path path = runup_path(s, s->line);
        lm_scan_line_run(&line->ground, tiles, &setup.sampling, &path, LM_SAR_RUNUP);
        s->horizon = lm_aspect_run(setup.grid, setup.aspect, &tiles->db->classes, &line->ground,
                                   LM_HORIZON_OPEN, &line->sight);
    }
    setup.grid = &s->grid;
    setup.sampling = s->sampling;
    const struct lm_ground_path path = patch_path(s, s->line);
    lm_line_trace(line, tiles, &setup, &path, s->horizon);
    lm_floor_run(s->radar->sar.noise_floor_q8, line->sight.level_q8, s->grid.cells);
    lm_speckle_run(&s->radar->sar.speckle, line->ground.noise, line->sight.level_q8, s->grid.cells);
    if (s->targets && s->targets->count != 0) {
        struct lm_line_targets targets;
        find_targets(s, tiles, &targets);
        lm_line_add_targets(line, &setup, &targets);
    }
    lm_tone_run(tone, line->sight.level_q8, line->grey, s->grid.cells);
    s->line++;
}
