#include "commands.h"

#include "fx/sat.h"
#include "ownship.h"
#include "swap.h"
#include "tracking.h"

enum { CONTROLS_A_STEP = 8, UNABLE_SHOWN_US = 2000000 };

/* Put a cursor that nobody has moved home again when the operator changes the scale. With an
 * automatic range the scale follows the cursor, so the cursor stays. */
static void follow_scale(struct lm_unit *u)
{
    if (u->cursor.is_placed && u->cursor.is_home && !u->page.is_auto_range &&
        lm_ownship_is_known(&u->ownship)) {
        const struct lm_cursor_scene scene = lm_picture_cursor_scene(&u->picture);
        lm_cursor_zero(&u->cursor, &scene);
    }
}

/* Count a control that was refused. */
static void note_refusal(struct lm_unit *u, enum lm_refusal reason)
{
    u->count.commands_refused++;
    u->refusal = reason;
}

/* Show LM_FLAG_UNABLE with its reason for a while, or end it. Returns the reason. */
static enum lm_refusal show_unable(struct lm_unit *u, enum lm_refusal reason, uint64_t now_us)
{
    u->unable.until_us = reason == LM_REFUSED_NOT ? 0 : now_us + UNABLE_SHOWN_US;
    u->unable.reason = reason;
    return reason;
}

void lm_refuse(struct lm_unit *u, enum lm_refusal reason, uint64_t now_us)
{
    note_refusal(u, show_unable(u, reason, now_us));
}

/* Start a patch, or show why not. */
static enum lm_refusal try_patch(struct lm_unit *u, const struct lm_sar_command *command,
                                 uint64_t now_us)
{
    return show_unable(u, lm_picture_start(&u->picture, LM_PICTURE_PATCH, command, now_us), now_us);
}

static void restart_patch(struct lm_unit *u, uint64_t now_us)
{
    struct lm_sar_command command = u->picture.sar.command;
    command.cell_mm = u->page.cell_mm;
    command.is_plan = u->page.is_plan;
    const enum lm_refusal reason = try_patch(u, &command, now_us);
    if (reason != LM_REFUSED_NOT) {
        note_refusal(u, reason);
    }
}

/* The track key ends a track, or designates one; held, it ranges. */
static void apply_track_key(struct lm_unit *u, uint32_t effects, uint64_t now_us)
{
    if (effects & LM_EFFECT_TRACK && lm_tracking_drop(u, now_us)) {
        return;
    }
    const enum lm_refusal reason =
        effects & LM_EFFECT_TRACK ? lm_tracking_designate(u, now_us) : lm_tracking_range(u, now_us);
    if (show_unable(u, reason, now_us) != LM_REFUSED_NOT) {
        note_refusal(u, reason);
    }
}

void lm_apply_effects(struct lm_unit *u, uint32_t effects, uint64_t now_us)
{
    if (effects & LM_EFFECT_RANGE) {
        follow_scale(u);
    }
    if (effects & LM_EFFECT_SECTOR) {
        lm_picture_start(&u->picture, LM_PICTURE_SECTOR, NULL, now_us);
    }
    if (effects & LM_EFFECT_PATCH) {
        restart_patch(u, now_us);
    }
    if (effects & LM_EFFECT_TONE) {
        lm_picture_set_tone(&u->picture);
    }
    if (effects & LM_EFFECT_BEAM) {
        lm_picture_set_beam(&u->picture);
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
        u->cursor.is_placed = false; /* the next step places it */
    }
    if (effects & LM_EFFECT_SWAP) {
        lm_swap_ask(u, now_us);
    }
    if (effects & (LM_EFFECT_TRACK | LM_EFFECT_RANGING)) {
        apply_track_key(u, effects, now_us);
    }
}

static bool has_cursor(const struct lm_unit *u)
{
    return u->page.format != LM_FORMAT_BIT && u->page.format != LM_FORMAT_TEST;
}

/* Target management switch up: stabilise a snowplow cursor, otherwise start a patch at the
 * cursor. */
static enum lm_refusal designate(struct lm_unit *u, uint64_t now_us)
{
    if (!has_cursor(u)) {
        return LM_REFUSED_PAGE;
    }
    if (u->cursor.is_snowplow) {
        lm_cursor_stabilise(&u->cursor);
        return LM_REFUSED_NOT;
    }
    const struct lm_sar_command command = {.centre = u->cursor.position,
                                           .cell_mm = u->page.cell_mm,
                                           .is_from_ownship = true,
                                           .is_plan = u->page.is_plan};
    if (!u->cursor.is_placed || u->page.is_override) {
        return show_unable(u, u->cursor.is_placed ? LM_REFUSED_SILENT : LM_REFUSED_CURSOR, now_us);
    }
    u->cursor.is_home = false; /* a change of scale must not move it now */
    return try_patch(u, &command, now_us);
}

static enum lm_refusal refused_unless(bool is_sound)
{
    return is_sound ? LM_REFUSED_NOT : LM_REFUSED_VALUE;
}

/* Carry out the effects of a direct command. The page returns none if it refused the command. */
static enum lm_refusal apply_any(struct lm_unit *u, uint32_t effects, uint64_t now_us)
{
    lm_apply_effects(u, effects, now_us);
    return refused_unless(effects != 0);
}

static bool is_on_earth(struct lm_position position)
{
    return fx_abs_u32((int32_t)position.latitude) <= FX_BAM_90;
}

static enum lm_refusal put_cursor(struct lm_unit *u, struct lm_position position)
{
    if (!is_on_earth(position)) {
        return LM_REFUSED_VALUE;
    }
    if (!has_cursor(u)) {
        return LM_REFUSED_PAGE;
    }
    lm_cursor_put(&u->cursor, position);
    return LM_REFUSED_NOT;
}

static bool apply_steerpoint(struct lm_unit *u, const struct lm_control *control)
{
    if (!is_on_earth(control->steerpoint.position)) {
        return false;
    }
    u->steerpoint.is_commanded = control->steerpoint.is_set;
    u->steerpoint.position = control->steerpoint.position;
    return true;
}

static bool apply_button(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    if (!fx_is_within_i32(control->button, 1, LM_BUTTONS)) {
        return false;
    }
    const uint8_t button = (uint8_t)control->button;
    if (lm_malfunction_q8(&u->malfunctions.now, LM_MALFUNCTION_KEY) == button * 256) {
        return true; /* as if nobody had touched it */
    }
    const bool acts =
        control->kind == LM_CONTROL_DOWN
            ? lm_keys_down(&u->keys, button, lm_page_key_style(&u->page, button), now_us)
            : lm_keys_up(&u->keys, button, now_us);
    if (acts) {
        lm_apply_effects(u, lm_page_press(&u->page, (struct lm_press){button, false}), now_us);
    }
    return true;
}

static bool is_deflection(int32_t value)
{
    return fx_is_within_i32(value, -LM_FULL_DEFLECTION, LM_FULL_DEFLECTION);
}

static bool apply_slew(struct lm_unit *u, const struct lm_control *control)
{
    if (!is_deflection(control->slew.x) || !is_deflection(control->slew.y)) {
        return false;
    }
    u->cursor.slew_x = control->slew.x;
    u->cursor.slew_y = control->slew.y;
    return true;
}

/* 0..most; a negative number is large. */
static bool is_up_to(int32_t value, uint32_t most)
{
    return (uint32_t)value <= most;
}

int lm_unit_tell_slots(struct lm_unit *u, const struct lm_slots_state *s)
{
    if (!is_up_to(s->flown, 2) || !is_up_to(s->damaged, 3) || !is_up_to(s->cut_off, 3) ||
        !is_up_to(s->load, LM_LOADS - 1) || !is_up_to(s->percent, 100)) {
        return LM_ERR_RANGE;
    }
    u->slots = *s;
    return LM_OK;
}

/* What is drawn goes on over the new map; a patch half drawn begins anew, or gives way to the
 * sector. */
static void draw_on(struct lm_unit *u, uint32_t shift_was, uint64_t now_us)
{
    const struct lm_sar_command command = u->picture.sar.command;
    if (lm_picture_change_map(&u->picture, shift_was) &&
        try_patch(u, &command, now_us) != LM_REFUSED_NOT) {
        lm_apply_effects(u, LM_EFFECT_SECTOR, now_us);
    }
}

static enum lm_refusal change_image(struct lm_unit *u, const struct lm_image_change *change,
                                    uint64_t now_us)
{
    const uint32_t place = (uint32_t)change->place - 1, shift_was = u->map.db.shift0;
    const uint32_t tracked = lm_tracking_listed(u);
    if (LM_IMAGES_MAX == 1 || place >= LM_IMAGES_MAX) {
        return LM_REFUSED_VALUE;
    }
    const struct lm_flash_part part = {u->board->images[place].offset, change->bytes};
    if (lm_unit_map_mount(&u->map, place, &part, u->board->flash_poll_limit) != LM_OK) {
        return LM_REFUSED_MAP;
    }
    lm_tracking_renumber(u, tracked, now_us);
    u->unsigned_places &= ~(1u << place);
    u->unsigned_places |= (uint32_t)change->is_unsigned << place;
    draw_on(u, shift_was, now_us);
    return LM_REFUSED_NOT;
}

static enum lm_refusal apply_control(struct lm_unit *u, const struct lm_control *control,
                                     uint64_t now_us)
{
    switch (control->kind) {
    case LM_CONTROL_SECTOR:
        return apply_any(
            u, lm_page_select_sector(&u->page, control->sector.mode, control->sector.fov), now_us);
    case LM_CONTROL_ENVIRONMENT:
        return refused_unless(lm_unit_weather_command(&u->weather, &control->environment, now_us) ==
                              LM_OK);
    case LM_CONTROL_STEERPOINT:
        return refused_unless(apply_steerpoint(u, control));
    case LM_CONTROL_CURSOR:
        return put_cursor(u, control->cursor);
    case LM_CONTROL_DROP:
        lm_apply_effects(u, lm_tracking_drop(u, now_us) ? 0 : LM_EFFECT_SECTOR, now_us);
        return LM_REFUSED_NOT;
    case LM_CONTROL_TRACK:
        return show_unable(u, lm_tracking_designate(u, now_us), now_us);
    case LM_CONTROL_RANGING:
        return show_unable(u, lm_tracking_range(u, now_us), now_us);
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
        return LM_REFUSED_NOT;
    case LM_CONTROL_DOWN:
    case LM_CONTROL_UP:
        return refused_unless(apply_button(u, control, now_us));
    case LM_CONTROL_KNOB:
        return apply_any(u, lm_page_set_knob(&u->page, control->knob), now_us);
    case LM_CONTROL_SLEW:
        return refused_unless(apply_slew(u, control));
    case LM_CONTROL_DESIGNATE:
        return designate(u, now_us);
    case LM_CONTROL_SLOTS:
        return refused_unless(lm_unit_tell_slots(u, &control->slots) == LM_OK);
    case LM_CONTROL_IMAGE:
        return change_image(u, &control->image, now_us);
    }
    return LM_REFUSED_VALUE;
}

/* Apply a control. True if the unit acted on it. */
static bool take_control(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    const enum lm_refusal reason = apply_control(u, control, now_us);
    if (reason != LM_REFUSED_NOT) {
        note_refusal(u, reason);
    }
    return reason == LM_REFUSED_NOT;
}

/* A control of the board is told on the bus, and its source learns if the unit refused it or the
 * press that it is. */
static void take_board_control(struct lm_unit *u, const struct lm_control *control, uint64_t now_us)
{
    const struct lm_controls *source = u->board->controls;
    const uint32_t refused = u->count.commands_refused;
    if (take_control(u, control, now_us)) {
        lm_canas_control_tell(&u->control_bus, control, now_us);
    }
    if (u->count.commands_refused != refused && source->refused) {
        source->refused(source->ctx, u->refusal);
    }
}

void lm_take_controls(struct lm_unit *u, uint64_t now_us)
{
    struct lm_press press; /* each button has one in a step at most */
    for (uint32_t i = 0; i < LM_BUTTONS && lm_keys_held(&u->keys, now_us, &press); i++) {
        lm_apply_effects(u, lm_page_press(&u->page, press), now_us);
    }
    const struct lm_controls *controls = u->board->controls;
    struct lm_control control;
    for (uint32_t i = 0; i < CONTROLS_A_STEP && lm_canas_control_next(&u->control_bus, &control);
         i++) {
        take_control(u, &control, now_us);
    }
    for (uint32_t i = 0; i < CONTROLS_A_STEP && controls->next(controls->ctx, &control) == 1; i++) {
        take_board_control(u, &control, now_us);
    }
}
