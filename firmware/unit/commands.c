#include "fx/sat.h"
#include "unit_internal.h"

enum {
    CONTROLS_A_STEP = 8,
    UNABLE_SHOWN_US = 2000000,
    ELEVATION_CELL_MM = 30000 /* the map's detail that the cursor's elevation comes from */
};

void lm_begin_picture(struct lm_unit *u, uint64_t now_us)
{
    u->next_line_us = now_us;
    u->cells_none = u->cells_seen = 0;
    u->is_off_map = false;
    u->is_view_held = false;
    lm_plane_clear(&u->plane, &u->frame);
}

static struct lm_beam_setting beam_of(const struct lm_page *p)
{
    return (struct lm_beam_setting){
        .is_tilt_manual = p->is_tilt_manual,
        .is_pencil = p->is_pencil,
        .tilt = (int32_t)(p->tilt_tenths * (1LL << 32) / 3600),
    };
}

static struct lm_cursor_scene scene_of(const struct lm_unit *u)
{
    const struct lm_radar *radar = u->board->radar;
    return (struct lm_cursor_scene){
        .view = &u->view,
        .ownship = lm_ownship_place(u),
        .heading = u->ownship.heading,
        .scale_m = radar->range[u->page.range].range_m,
        .half_px = (int32_t)fx_min_u32(u->plane.width_px, u->plane.height_px) / 2,
        .slew_percent = u->page.picture == LM_PICTURE_PATCH
                            ? 100
                            : radar->field[u->sector.command.field].slew_percent,
    };
}

/* A cursor that nobody has moved belongs to the scale: when the operator changes that, the cursor
 * goes where it would have been put. One that the range follows stays. */
static void follow_scale(struct lm_unit *u)
{
    if (u->cursor.is_placed && u->cursor.is_home && !u->page.is_auto_range && lm_has_ownship(u)) {
        const struct lm_cursor_scene scene = scene_of(u);
        lm_cursor_zero(&u->cursor, &scene);
    }
}

/* A window needs a cursor: until there is one, the whole sector. */
static void start_sector(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_page *p = &u->page;
    u->is_cursor_awaited = p->field != LM_FIELD_NORM && !u->cursor.is_placed;
    const struct lm_sector_command command = {
        .mode = p->mode,
        .field = u->is_cursor_awaited ? (uint8_t)LM_FIELD_NORM : p->field,
        .range = p->range,
        .azimuth = p->azimuth,
        .centre = u->cursor.place,
        .beam = beam_of(p),
    };
    lm_sector_start(&u->sector, u->board->radar, &command, u->board->noise_seed);
    u->sector.targets = &u->map.target_set;
    u->sector.chips = &u->map.chips;
    u->sector.environment = &u->environment;
    lm_page_show_picture(&u->page, LM_PICTURE_SECTOR);
    lm_begin_picture(u, now_us);
}

/* Rate of turn times speed: below 2^31 / 2^29.3 rad/s times 2^21 mm/s. */
static uint32_t lateral_mm_s2(const struct lm_ownship *own)
{
    const uint64_t turn_bam_s = fx_abs_u32(own->turn_bam_s);
    return (uint32_t)(turn_bam_s * (uint32_t)own->ground_speed_mm_s / 683565276u);
}

/* The command with the geometry of this moment, and how the aircraft flies, when the patch is to be
 * seen from the ownship. */
static bool resolve_command(const struct lm_unit *u, struct lm_sar_command *command,
                            struct lm_sar_flight *flight)
{
    const struct lm_ownship *own = &u->ownship;
    if (own->position_quality != LM_NAV_GOOD || own->height_quality != LM_NAV_GOOD ||
        own->heading_quality != LM_NAV_GOOD || own->velocity_quality != LM_NAV_GOOD) {
        return false;
    }
    /* The line of sight turns on its way: at the patch it is the way back, turned round. */
    uint32_t distance_q8;
    fx_bam_t back, bearing;
    lm_geo_inverse(command->centre, lm_ownship_place(u), &distance_q8, &back);
    lm_geo_inverse(lm_ownship_place(u), command->centre, &distance_q8, &bearing);
    command->look_azimuth = back + FX_BAM_180;
    command->range_m = distance_q8 / 256;
    command->height_q6 = lm_antenna_height_q6(u);
    *flight = (struct lm_sar_flight){.speed_mm_s = (uint32_t)own->ground_speed_mm_s,
                                     .track = own->track,
                                     .bearing = bearing,
                                     .heading = own->heading,
                                     .lateral_mm_s2 = lateral_mm_s2(own)};
    return true;
}

int32_t lm_patch_elevation_q10(struct lm_unit *u, const struct lm_sar_command *command)
{
    const uint8_t level = lm_scan_level(&u->map.db, command->cell_mm);
    return lm_scan_elevation(&u->map.tiles, level, command->centre,
                             u->map.db.mean_elevation_q6 * 16);
}

static bool start_patch(struct lm_unit *u, struct lm_sar_command command, uint64_t now_us)
{
    struct lm_sar_flight flight;
    const bool is_in_flight = command.is_from_ownship;
    if (!u->map.is_usable || (is_in_flight && !resolve_command(u, &command, &flight))) {
        return false;
    }
    const struct lm_sar_scene scene = {.flight = is_in_flight ? &flight : NULL,
                                       .targets = &u->map.target_set,
                                       .chips = &u->map.chips,
                                       .reference_q10 = lm_patch_elevation_q10(u, &command),
                                       .epoch = u->board->noise_seed,
                                       .sea_state = u->environment.sea_state,
                                       .environment = &u->environment,
                                       .time_us = now_us};
    if (lm_sar_start(&u->sar, u->board->radar, &u->map.db, &command, &scene) != LM_OK) {
        return false;
    }
    lm_page_show_picture(&u->page, LM_PICTURE_PATCH);
    lm_begin_picture(u, now_us);
    lm_sar_prefetch_targets(&u->sar, &u->map.tiles);
    u->is_acquiring = true;
    u->lines_asked_for = 0;
    u->acquire_until_us = now_us + LM_SAR_ACQUIRE_US;
    return true;
}

/* Start a patch, or say on the glass that it cannot be. */
static bool try_patch(struct lm_unit *u, const struct lm_sar_command *command, uint64_t now_us)
{
    const bool is_started = start_patch(u, *command, now_us);
    u->unable_until_us = is_started ? 0 : now_us + UNABLE_SHOWN_US;
    return is_started;
}

static void restart_patch(struct lm_unit *u, uint64_t now_us)
{
    struct lm_sar_command command = u->sar.command;
    command.cell_mm = lm_page_cell_mm(&u->page);
    command.has_layover = u->page.is_slant;
    u->count.commands_refused += !try_patch(u, &command, now_us);
}

static void set_tones(struct lm_unit *u)
{
    const struct lm_radar *radar = u->board->radar;
    struct lm_tone_config config = lm_page_tone(&u->page, &radar->mode[u->page.mode].tone);
    lm_tone_set(&u->sector_tone, &config);
    config = lm_page_tone(&u->page, &radar->sar.tone);
    lm_tone_set(&u->sar_tone, &config);
}

void lm_apply(struct lm_unit *u, uint32_t effects, uint64_t now_us)
{
    if (effects & LM_EFFECT_RANGE) {
        follow_scale(u);
    }
    if (effects & LM_EFFECT_SECTOR) {
        start_sector(u, now_us);
    }
    if (effects & LM_EFFECT_PATCH) {
        restart_patch(u, now_us);
    }
    if (effects & LM_EFFECT_TONE) {
        set_tones(u);
    }
    if (effects & LM_EFFECT_BEAM) {
        const struct lm_beam_setting beam = beam_of(&u->page);
        lm_sector_set_beam(&u->sector, &beam);
    }
    if (effects & LM_EFFECT_HEIGHT) {
        u->nav.is_baro_preferred = u->page.is_baro;
    }
    if (effects & LM_EFFECT_PALETTE) {
        lm_palette_set(&u->palette, &u->page.palette);
    }
    if (effects & (LM_EFFECT_CURSOR_HOME | LM_EFFECT_SNOWPLOW)) {
        u->cursor.is_snowplow = u->page.is_snowplow;
    }
    if (effects & LM_EFFECT_CURSOR_HOME) {
        u->cursor.is_placed = false; /* the next step puts it where it belongs */
    }
    u->count.swaps += (effects & LM_EFFECT_SWAP) != 0;
}

/* Target management switch up: stabilise a snowplow cursor, else look closely at its place. */
static bool designate(struct lm_unit *u, uint64_t now_us)
{
    if (u->page.format == LM_FORMAT_BIT || u->page.format == LM_FORMAT_TEST) {
        return false; /* there is no cursor to be seen */
    }
    if (u->cursor.is_snowplow) {
        lm_cursor_stabilise(&u->cursor);
        return true;
    }
    const struct lm_sar_command command = {.centre = u->cursor.place,
                                           .cell_mm = lm_page_cell_mm(&u->page),
                                           .is_from_ownship = true,
                                           .has_layover = u->page.is_slant};
    if (!u->cursor.is_placed || u->page.is_override) {
        u->unable_until_us = now_us + UNABLE_SHOWN_US;
        return false;
    }
    u->cursor.is_home = false; /* its place is of interest */
    return try_patch(u, &command, now_us);
}

static bool is_within(int32_t value, int32_t low, int32_t high)
{
    return value >= low && value <= high;
}

/* A command that the page took has effects; one that it refused has none. */
static bool apply_any(struct lm_unit *u, uint32_t effects, uint64_t now_us)
{
    lm_apply(u, effects, now_us);
    return effects != 0;
}

static bool obey_environment(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    if (lm_environment_check(&control->environment) != LM_OK) {
        return false;
    }
    u->commanded = control->environment;
    lm_look_at_weather(u, now_us); /* the next line or patch meets it */
    return true;
}

static bool obey_steerpoint(struct lm_unit *u, const struct lm_control *control)
{
    if (fx_abs_u32((int32_t)control->steerpoint.place.latitude) > FX_BAM_90) {
        return false;
    }
    u->has_own_steerpoint = control->steerpoint.is_set;
    u->own_steerpoint = control->steerpoint.place;
    return true;
}

static bool obey_button(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    if (!is_within(control->button, 1, LM_BUTTONS)) {
        return false;
    }
    const uint8_t button = (uint8_t)control->button;
    const bool acts =
        control->kind == LM_CONTROL_DOWN
            ? lm_keys_down(&u->keys, button, lm_page_key_style(&u->page, button), now_us)
            : lm_keys_up(&u->keys, button, now_us);
    if (acts) {
        lm_apply(u, lm_page_press(&u->page, (struct lm_press){button, false}), now_us);
    }
    return true;
}

static bool is_deflection(int32_t value)
{
    return is_within(value, -LM_FULL_DEFLECTION, LM_FULL_DEFLECTION);
}

static bool obey_slew(struct lm_unit *u, const struct lm_control *control)
{
    if (!is_deflection(control->slew.x) || !is_deflection(control->slew.y)) {
        return false;
    }
    u->cursor.slew_x = control->slew.x;
    u->cursor.slew_y = control->slew.y;
    return true;
}

static bool obey_knob(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    if (!is_deflection(control->knob)) {
        return false;
    }
    lm_apply(u, lm_page_set_knob(&u->page, control->knob), now_us);
    return true;
}

static bool obey(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    switch (control->kind) {
    case LM_CONTROL_SECTOR:
        return apply_any(
            u, lm_page_select_sector(&u->page, control->sector.mode, control->sector.fov), now_us);
    case LM_CONTROL_ENVIRONMENT:
        return obey_environment(u, control, now_us);
    case LM_CONTROL_STEERPOINT:
        return obey_steerpoint(u, control);
    case LM_CONTROL_DROP:
        start_sector(u, now_us);
        return true;
    case LM_CONTROL_SAR:
        return try_patch(u, &control->sar, now_us);
    case LM_CONTROL_RANGE:
        return apply_any(u, lm_page_select_range(&u->page, control->range_nm), now_us);
    case LM_CONTROL_AZIMUTH:
        return apply_any(u, lm_page_select_azimuth(&u->page, control->azimuth_index), now_us);
    case LM_CONTROL_GAIN:
        return apply_any(u, lm_page_set_gain(&u->page, control->gain_db), now_us);
    case LM_CONTROL_FREEZE:
        lm_page_set_frozen(&u->page, control->is_frozen);
        return true;
    case LM_CONTROL_DOWN:
    case LM_CONTROL_UP:
        return obey_button(u, control, now_us);
    case LM_CONTROL_KNOB:
        return obey_knob(u, control, now_us);
    case LM_CONTROL_SLEW:
        return obey_slew(u, control);
    case LM_CONTROL_DESIGNATE:
        return designate(u, now_us);
    }
    return false;
}

void lm_take_controls(struct lm_unit *u, uint64_t now_us)
{
    struct lm_press press;
    for (uint32_t i = 0; i < LM_BUTTONS && lm_keys_held(&u->keys, now_us, &press); i++) {
        lm_apply(u, lm_page_press(&u->page, press), now_us);
    }
    const struct lm_controls *controls = u->board->controls;
    struct lm_control control;
    for (uint32_t i = 0; i < CONTROLS_A_STEP && controls->next(controls->ctx, &control) == 1; i++) {
        u->count.commands_refused += !obey(u, &control, now_us);
    }
}

static struct lm_view view_of_sector(const struct lm_unit *u)
{
    const struct lm_sector *s = &u->sector;
    const bool has_geometry = s->grid.cells != 0, is_window = has_geometry && s->half_m != 0;
    const struct lm_view_from from = {
        .place = is_window ? s->platform.place : lm_ownship_place(u),
        .up = is_window ? s->up : u->ownship.heading,
        .height_q10 = has_geometry ? s->grid.height_q10 - s->grid.reference_q10 : 0,
    };
    return is_window
               ? lm_view_of_window(&u->frame, &from, s->command.centre, s->half_m)
               : lm_view_of_sector(&u->frame, &from, u->board->radar->range[u->page.range].range_m);
}

static struct lm_view view_of_picture(const struct lm_unit *u)
{
    const struct lm_sar_command *c = &u->sar.command;
    return u->page.picture == LM_PICTURE_PATCH
               ? lm_view_of_patch(&u->frame, c->centre, c->look_azimuth, u->sar.radar->sar.cells,
                                  c->cell_mm)
               : view_of_sector(u);
}

void lm_follow_view(struct lm_unit *u)
{
    const bool is_standing =
        u->page.picture != LM_PICTURE_PATCH && (u->flags & LM_FLAGS_STANDING) != 0;
    if (!is_standing || !u->is_view_held) {
        u->view = view_of_picture(u);
    }
    u->is_view_held = u->page.picture == LM_PICTURE_PATCH ? u->is_view_held : is_standing;
    if (lm_has_ownship(u)) {
        const struct lm_cursor_scene scene = scene_of(u);
        lm_cursor_locate(&u->cursor, &scene);
    }
}

static void read_elevation(struct lm_unit *u)
{
    if (u->map.is_usable) {
        const uint8_t level = lm_scan_level(&u->map.db, ELEVATION_CELL_MM);
        u->cursor_elevation_q10 =
            lm_scan_elevation(&u->map.tiles, level, u->cursor.place, LM_NO_ELEVATION);
    }
}

/* The page's range follows the cursor, when it is to. */
static void follow_range(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t scale_m = u->board->radar->range[u->page.range].range_m;
    if (u->page.picture == LM_PICTURE_PATCH || !u->page.is_auto_range || u->is_view_held) {
        return;
    }
    const int32_t step = lm_cursor_wants_range(&u->cursor, scale_m);
    const uint32_t effects = step != 0 ? lm_page_step_range(&u->page, step) : 0;
    if (effects) {
        lm_apply(u, effects, now_us);
        lm_follow_view(u);
    }
}

void lm_follow_cursor(struct lm_unit *u, uint64_t now_us)
{
    lm_follow_view(u);
    if (!lm_has_ownship(u)) {
        return;
    }
    const struct lm_cursor_scene scene = scene_of(u);
    if (!lm_cursor_step(&u->cursor, &scene, now_us)) {
        return;
    }
    lm_cursor_locate(&u->cursor, &scene);
    read_elevation(u);
    if (u->page.picture == LM_PICTURE_SECTOR && u->is_cursor_awaited && u->cursor.is_placed) {
        lm_apply(u, LM_EFFECT_SECTOR, now_us); /* the window had no cursor to go by until now */
    }
    follow_range(u, now_us);
}
