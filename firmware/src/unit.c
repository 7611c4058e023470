#include "lm/unit.h"

#include "fx/mem.h"

enum {
    CONTROLS_A_STEP = 8,
    TILE_READS_A_STEP = 16,
    PATCH_LINES_BETWEEN_PREFETCHES = 8,
    TILE_FAULT_SHOWN_US = 3000000,
    NONE_SAMPLE_CELLS = 16
};

static void set_tone(struct lm_tone *tone, const struct lm_tone_config *table, int16_t gain_db)
{
    struct lm_tone_config config = *table;
    config.black_q8 = (int16_t)(config.black_q8 - gain_db * 256);
    config.white_q8 = (int16_t)(config.white_q8 - gain_db * 256);
    lm_tone_set(tone, &config);
}

/* Begin a picture of another kind, place or scale: nothing of the last one stays. */
static void begin_picture(struct lm_unit *u, enum lm_mode mode, uint64_t now_us)
{
    u->mode = mode;
    u->next_line_us = now_us;
    u->cells_none = u->cells_seen = 0;
    u->is_off_map = false;
    lm_plane_clear(&u->plane, &u->frame);
}

int lm_unit_init(struct lm_unit *u, const struct lm_board *board)
{
    const struct lm_display *display = board->display;
    memset(u, 0, sizeof *u);
    if (display->width_px < 256 || display->width_px > 1024 || display->height_px < 256 ||
        display->height_px > 1024) {
        return LM_ERR_RANGE;
    }
    u->board = board;
    u->plane = (struct lm_plane){board->plane, display->width_px, display->height_px};
    u->frame = lm_frame_of_display(display->width_px, display->height_px);
    memset(board->plane, 0, (size_t)display->width_px * display->height_px);
    lm_nav_init(&u->nav);
    set_tone(&u->gm_tone, &board->radar->gm_tone, 0);
    set_tone(&u->sar_tone, &board->radar->sar_tone, 0);
    lm_ground_map_start(&u->ground_map, board->radar, 2, 0, board->noise_seed);
    begin_picture(u, LM_MODE_GM, 0);

    u->has_db = lm_db_open(&u->db, board->flash, board->flash_poll_limit) == LM_OK;
    if (!u->has_db) {
        return LM_OK;
    }
    return lm_tile_cache_init(&u->tiles, &u->db, board->tile_pool, board->tile_pool_bytes,
                              board->flash_poll_limit);
}

static void take_bus(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_can *can = u->board->can;
    struct lm_can_frame frame;
    for (uint32_t i = 0; i < LM_STEP_FRAMES; i++) {
        const int status = can->receive(can->ctx, &frame);
        if (status != 1) {
            u->count.bus_errors += status < 0;
            break;
        }
        u->count.bus_frames++;
        u->last_bus_us = now_us;
        lm_nav_take(&u->nav, &frame);
    }
    lm_nav_at(&u->nav, now_us, &u->ownship);
}

/* Above mean sea level, as the map's elevations are: satellites measure from the ellipsoid. */
static int32_t antenna_height_q6(const struct lm_unit *u)
{
    const bool is_ellipsoidal = u->ownship.height_source == LM_CANAS_GPS_HEIGHT;
    return u->ownship.height_q6 - (is_ellipsoidal ? u->db.geoid_q6 : 0);
}

/* The command with the geometry of this moment, when it is to be seen from the ownship. */
static bool resolve_command(const struct lm_unit *u, struct lm_sar_command *command)
{
    if (!command->is_from_ownship) {
        return true;
    }
    if (u->ownship.position_quality != LM_NAV_GOOD || u->ownship.height_quality != LM_NAV_GOOD) {
        return false;
    }
    uint32_t distance_q8;
    const struct lm_place here = {u->ownship.latitude, u->ownship.longitude};
    lm_geo_inverse(here, command->centre, &distance_q8, &command->look_azimuth);
    /* The line of sight turns on its way: at the patch it is the way back, turned round. */
    fx_bam_t back;
    lm_geo_inverse(command->centre, here, &distance_q8, &back);
    command->look_azimuth = back + FX_BAM_180;
    command->range_m = distance_q8 / 256;
    command->height_q6 = antenna_height_q6(u);
    return true;
}

static bool start_patch(struct lm_unit *u, struct lm_sar_command command, uint64_t now_us)
{
    if (!u->has_db || !resolve_command(u, &command)) {
        return false;
    }
    const struct lm_sampling sampling = lm_sampling_for(&u->db, command.cell_mm, 0);
    const int32_t ground_q10 =
        lm_scan_elevation(&u->tiles, sampling.level, command.centre, u->db.mean_elevation_q6 * 16);
    if (lm_sar_start(&u->sar, u->board->radar, &u->db, &command, ground_q10,
                     u->board->noise_seed) != LM_OK) {
        return false;
    }
    begin_picture(u, LM_MODE_SAR, now_us);
    for (uint32_t line = 0; line < u->board->radar->sar_cells;
         line += PATCH_LINES_BETWEEN_PREFETCHES) {
        lm_sar_prefetch(&u->sar, &u->tiles, line);
    }
    u->is_acquiring = true;
    u->acquire_until_us = now_us + LM_SAR_ACQUIRE_US;
    return true;
}

static void start_ground_map(struct lm_unit *u, uint8_t range, uint8_t azimuth, uint64_t now_us)
{
    lm_ground_map_start(&u->ground_map, u->board->radar, range, azimuth, u->board->noise_seed);
    begin_picture(u, LM_MODE_GM, now_us);
}

static bool obey(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    const uint8_t range = u->ground_map.range, azimuth = u->ground_map.azimuth;
    switch (control->kind) {
    case LM_CONTROL_GM:
        start_ground_map(u, range, azimuth, now_us);
        return true;
    case LM_CONTROL_SAR:
        return start_patch(u, control->sar, now_us);
    case LM_CONTROL_RANGE:
        if (control->value < 0 || control->value >= LM_RANGES) {
            return false;
        }
        start_ground_map(u, (uint8_t)control->value, azimuth, now_us);
        return true;
    case LM_CONTROL_AZIMUTH:
        if (control->value < 0 || control->value >= LM_AZIMUTHS) {
            return false;
        }
        start_ground_map(u, range, (uint8_t)control->value, now_us);
        return true;
    case LM_CONTROL_GAIN:
        if (control->value < -30 || control->value > 30) {
            return false;
        }
        u->gain_db = (int16_t)control->value;
        set_tone(&u->gm_tone, &u->board->radar->gm_tone, u->gain_db);
        set_tone(&u->sar_tone, &u->board->radar->sar_tone, u->gain_db);
        return true;
    case LM_CONTROL_FREEZE:
        u->is_frozen = control->value != 0;
        return true;
    }
    return false;
}

static void take_controls(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_controls *controls = u->board->controls;
    struct lm_control control;
    for (uint32_t i = 0; i < CONTROLS_A_STEP && controls->next(controls->ctx, &control) == 1; i++) {
        u->count.commands_refused += !obey(u, &control, now_us);
    }
}

/* The aircraft is somewhere else at once: lines drawn from there and from here must not stand side
 * by side. */
static void heed_jump(struct lm_unit *u, uint64_t now_us)
{
    if (u->nav.position_jumps != u->jumps_seen) {
        u->jumps_seen = u->nav.position_jumps;
        if (u->mode == LM_MODE_GM) {
            begin_picture(u, LM_MODE_GM, now_us);
        }
    }
}

/* What is wrong, in one word for each. */
static void judge(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t faults = u->tiles.count.io_errors + u->tiles.count.corrupt;
    if (faults != u->tile_faults_seen) {
        u->tile_faults_seen = faults;
        u->tile_fault_us = now_us;
    }
    const bool is_tile_fault = faults != 0 && now_us - u->tile_fault_us < TILE_FAULT_SHOWN_US;
    u->flags = (u->has_db ? 0u : LM_FLAG_DB) | (is_tile_fault ? LM_FLAG_TILE : 0u) |
               (u->is_frozen ? LM_FLAG_FROZEN : 0u) | (u->is_off_map ? LM_FLAG_OFF_MAP : 0u);
    if (now_us - u->last_bus_us > LM_BUS_SILENT_US) {
        u->flags |= LM_FLAG_BUS;
    }
    const bool is_commanded = u->mode == LM_MODE_SAR && !u->sar.command.is_from_ownship;
    const struct lm_ownship *own = &u->ownship;
    if (is_commanded) {
        return;
    }
    if (own->position_quality == LM_NAV_DEAD || own->height_quality == LM_NAV_DEAD ||
        own->heading_quality == LM_NAV_DEAD) {
        u->flags |= LM_FLAG_NAV_DEAD;
    } else if (own->position_quality != LM_NAV_GOOD || own->height_quality != LM_NAV_GOOD ||
               own->heading_quality != LM_NAV_GOOD) {
        u->flags |= LM_FLAG_NAV_STALE;
    }
}

/* Count how much of the line lies outside the map, a cell in sixteen. */
static void sample_coverage(struct lm_unit *u, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i += NONE_SAMPLE_CELLS) {
        u->cells_seen++;
        u->cells_none += u->line.ground.cell[i] == LM_CELL_NONE;
    }
}

static void draw_ground_map_line(struct lm_unit *u)
{
    struct lm_ground_map *g = &u->ground_map;
    const struct lm_antenna antenna = {
        .place = {u->ownship.latitude, u->ownship.longitude},
        .height_q10 = antenna_height_q6(u) * 16,
        .heading = u->ownship.heading,
    };
    const uint32_t sweep = g->sweep, cells = g->radar->gm_cells;
    const uint32_t drawn = lm_ground_map_draw_line(g, &u->tiles, &antenna, &u->gm_tone, &u->line);
    lm_ppi_paint(&u->plane, &u->frame, (fx_bam_t)lm_ground_map_edge_bam(g, drawn),
                 (fx_bam_t)lm_ground_map_edge_bam(g, drawn + 1), u->line.grey, cells);
    sample_coverage(u, cells);
    if (g->sweep != sweep) {
        u->is_off_map = 2 * u->cells_none > u->cells_seen;
        u->cells_none = u->cells_seen = 0;
    }
    u->next_line_us += lm_ground_map_line_us(g);
}

static void draw_patch_line(struct lm_unit *u)
{
    const uint32_t cells = u->sar.radar->sar_cells, drawn = u->sar.line;
    lm_sar_draw_line(&u->sar, &u->tiles, &u->sar_tone, &u->line);
    lm_patch_paint(&u->plane, &u->frame, drawn, u->line.grey + LM_SAR_GUARD, cells);
    sample_coverage(u, cells);
    u->is_off_map = 2 * u->cells_none > u->cells_seen;
    u->next_line_us += 1000000u / u->sar.radar->sar_lines_per_s;
}

/* Whether lines may be drawn now; while they may not, time does not owe any. */
static bool is_drawing(struct lm_unit *u, uint64_t now_us)
{
    if (u->flags & (LM_FLAG_DB | LM_FLAG_NAV_DEAD | LM_FLAG_NAV_STALE | LM_FLAG_FROZEN)) {
        return false;
    }
    if (u->mode == LM_MODE_GM) {
        return true;
    }
    if (u->is_acquiring) {
        u->is_acquiring = !lm_tile_cache_is_idle(&u->tiles) && now_us < u->acquire_until_us;
    }
    return !u->is_acquiring && u->sar.line < u->sar.radar->sar_cells;
}

static void draw_due_lines(struct lm_unit *u, uint64_t now_us)
{
    for (uint32_t i = 0; i < LM_STEP_LINES && is_drawing(u, now_us) && u->next_line_us <= now_us;
         i++) {
        u->count.lines++;
        if (u->mode == LM_MODE_GM) {
            draw_ground_map_line(u);
        } else {
            draw_patch_line(u);
        }
    }
    if (u->next_line_us <= now_us) {
        u->count.lines_dropped += is_drawing(u, now_us);
        u->next_line_us = now_us;
    }
}

static struct lm_page describe(const struct lm_unit *u)
{
    static const uint8_t tens[LM_AZIMUTHS] = {6, 3, 1};
    const struct lm_ground_map *g = &u->ground_map;
    const struct lm_sar *s = &u->sar;
    struct lm_page page = {
        .flags = u->flags,
        .is_sar = u->mode == LM_MODE_SAR,
        .is_sweeping =
            !(u->flags & (LM_FLAG_DB | LM_FLAG_NAV_DEAD | LM_FLAG_NAV_STALE | LM_FLAG_FROZEN)),
        .sweep_bam = lm_ground_map_edge_bam(g, g->line),
        .azimuth_half = g->radar->azimuth_half[g->azimuth],
        .range_nm = g->radar->range_nm[g->range],
        .azimuth_tens = tens[g->azimuth],
        .heading = u->ownship.heading,
        .has_heading = u->ownship.heading_quality != LM_NAV_DEAD,
        .frame = u->count.frames,
    };
    if (page.is_sar) {
        page.sar_cell_dm = (uint16_t)(s->command.cell_mm / 100);
        page.sar_percent = (uint16_t)(s->line * 100 / s->radar->sar_cells);
        page.sar_look_deg =
            (uint16_t)((((uint64_t)s->command.look_azimuth * 360 + (1u << 31)) >> 32) % 360);
    }
    return page;
}

static void show_frame(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_display *display = u->board->display;
    struct lm_surface surface;
    const int status = display->acquire(display->ctx, &surface);
    if (status != LM_OK) {
        u->count.display_busy += status == LM_BUSY;
        u->count.display_errors += status < 0;
        return;
    }
    if (u->flags & (LM_FLAG_NAV_DEAD | LM_FLAG_DB)) {
        lm_plane_clear(&u->plane, &u->frame);
        u->sar.line = 0; /* a patch that was removed is drawn anew, not shown as an empty one */
    }
    const struct lm_page page = describe(u);
    lm_overlay_draw(&surface, &u->plane, &u->frame, &page);
    u->count.display_errors += display->present(display->ctx) != LM_OK;
    u->count.frames++;
    /* Frames that were missed are not made up for. */
    u->next_frame_us += LM_FRAME_US;
    if (u->next_frame_us <= now_us) {
        u->next_frame_us = now_us + LM_FRAME_US;
    }
}

void lm_unit_step(struct lm_unit *u, uint64_t now_us)
{
    take_bus(u, now_us);
    heed_jump(u, now_us);
    take_controls(u, now_us);
    judge(u, now_us);
    if (u->has_db) {
        lm_tile_cache_service(&u->tiles, now_us, TILE_READS_A_STEP);
    }
    draw_due_lines(u, now_us);
    if (now_us >= u->next_frame_us) {
        show_frame(u, now_us);
    }
}
