#include "lm/unit.h"

#include "commands.h"
#include "flags.h"
#include "follow.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/radar_check.h"
#include "lm/version.h"
#include "ownship.h"
#include "pacing.h"
#include "present.h"
#include "report.h"
#include "settings.h"
#include "swap.h"
#include "tracking.h"

/* Priorities of a further table's rows: four tables share the 256 of an event. */
enum { PRIORITIES_A_TABLE = 64 };

static void init_picture(struct lm_unit *u)
{
    const struct lm_board *board = u->board;
    const struct lm_picture_lent lent = {
        .radar = u->map.radar,
        .map = &u->map,
        .environment = &u->weather.now,
        .ownship = &u->ownship,
        .page = &u->page,
        .cursor = &u->cursor,
        .exercise = &u->exercise,
        .malfunctions = &u->malfunctions.now,
        .options = board->options,
    };
    const struct lm_plane plane = {board->plane, board->display->width_px,
                                   board->display->height_px, &u->composer.changed};
    lm_composer_init(&u->composer, plane.width_px, plane.height_px);
    lm_picture_init(&u->picture, &lent, &plane);
}

int lm_unit_init(struct lm_unit *u, const struct lm_board *board)
{
    const struct lm_display *display = board->display;
    memset(u, 0, sizeof *u);
    if (board->radar && lm_radar_check(board->radar, NULL) != LM_OK) {
        return LM_ERR_TABLE;
    }
    if (display->width_px < 256 || display->width_px > 1024 || display->height_px < 256 ||
        display->height_px > 1024) {
        return LM_ERR_RANGE;
    }
    u->board = board;
    const struct lm_unit_map_lent map = {
        board->flash, board->tile_pool,           board->tile_pool_bytes, board->flash_poll_limit,
        board->radar, board->bus_profile != NULL, board->images};
    const int status = lm_unit_map_open(&u->map, &map);
    if (status != LM_OK) {
        return status;
    }
    u->map.target_set.live = &u->live.live;
    const struct lm_bus_profile *bus = board->bus_profile ? board->bus_profile
                                       : u->map.bus       ? u->map.bus
                                                          : &lm_bus_canas17;
    lm_bus_init(&u->bus, bus);
    lm_bus_hear_only(&u->bus, board->bus_nodes);
    for (uint32_t t = 0; t < LM_BUS_TABLES_MORE && board->tables[t].profile; t++) {
        lm_bus_init(&u->more[t], board->tables[t].profile);
        lm_bus_hear_only(&u->more[t], board->bus_nodes);
    }
    lm_nav_init(&u->nav);
    u->nav.is_heading_magnetic = board->is_heading_magnetic;
    const uint8_t node = bus->framing == LM_BUS_CANAEROSPACE ? board->bus_node : 0;
    lm_canas_service_init(&u->service, node, board->hardware_revision, LM_VERSION_NUMBER);
    lm_canas_report_init(&u->report, board->tells_reports ? node : 0);
    lm_swap_init(u, node);
    lm_canas_control_init(&u->control_bus, board->tells_reports ? node : 0,
                          board->obeys_controls && bus->framing == LM_BUS_CANAEROSPACE);
    lm_unit_weather_init(&u->weather);
    lm_exercise_init(&u->exercise, board->noise_seed);
    lm_page_init(&u->page, u->map.radar);
    u->ground_m_q10 = LM_NO_ELEVATION;
    init_picture(u);
    lm_apply_effects(u, LM_EFFECT_SECTOR | LM_EFFECT_TONE | LM_EFFECT_PALETTE, 0);
    lm_settings_restore(u);
    return LM_OK;
}

/* Where the exercise's time steps, or begins, live targets stay where they are. Once in a step of
 * the unit: a sender that steps in every frame must not take the time of a line. */
static void take_exercise(struct lm_unit *u, const struct lm_bus_event *event)
{
    const uint64_t was_us = lm_exercise_clock(&u->exercise, event->time_us);
    const uint32_t steps = u->exercise.count.steps;
    const bool was_told = u->exercise.is_told;
    lm_exercise_take(&u->exercise, event);
    const bool has_stepped = u->exercise.count.steps != steps || u->exercise.is_told != was_told;
    if (has_stepped && !u->is_clock_stepped) {
        u->is_clock_stepped = true;
        lm_live_bus_step_clock(&u->live, was_us, lm_exercise_clock(&u->exercise, event->time_us));
    }
}

static void take_events(struct lm_unit *u, const struct lm_bus_event *events, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        lm_nav_take(&u->nav, &events[i]);
        lm_weather_bus_take(&u->weather.bus, &events[i]);
        take_exercise(u, &events[i]);
        lm_live_bus_take(&u->live, &events[i], lm_exercise_clock(&u->exercise, events[i].time_us));
        lm_malfunction_bus_take(&u->malfunctions, &events[i]);
    }
}

/* Decode a frame by the further tables of its interface. */
static void take_by_more(struct lm_unit *u, uint8_t interface, const struct lm_can_frame *frame)
{
    const struct lm_board_table *tables = u->board->tables;
    for (uint32_t t = 0; t < LM_BUS_TABLES_MORE && tables[t].profile; t++) {
        struct lm_bus_event events[LM_BUS_EVENTS];
        if (tables[t].interface != interface) {
            continue;
        }
        const uint32_t count = lm_bus_take(&u->more[t], frame, events);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t priority = fx_min_u32(events[i].priority, PRIORITIES_A_TABLE - 1);
            events[i].priority = (uint8_t)(priority + (t + 1) * PRIORITIES_A_TABLE);
        }
        take_events(u, events, count);
    }
}

static void take_frame(struct lm_unit *u, uint8_t interface, const struct lm_can_frame *frame)
{
    if (interface == 0) {
        struct lm_bus_event events[LM_BUS_EVENTS];
        take_events(u, events, lm_bus_take(&u->bus, frame, events));
        lm_canas_service_take(&u->service, frame);
        if (frame->length > 0 && lm_bus_is_heard(u->board->bus_nodes, frame->data[0])) {
            lm_canas_control_take(&u->control_bus, frame);
            lm_swap_take(u, frame);
        }
    }
    take_by_more(u, interface, frame);
}

/* Take at most `room` frames of an interface. Returns how many more there is room for. */
static uint32_t take_interface(struct lm_unit *u, uint8_t interface, uint32_t room, uint64_t now_us)
{
    const struct lm_can *can = interface == 0 ? u->board->can : u->board->can_2;
    struct lm_can_frame frame;
    for (; room > 0; room--) {
        const int status = can->receive(can->ctx, &frame);
        if (status != 1) {
            u->count.bus_errors += status < 0;
            break;
        }
        u->count.bus_frames++;
        if (!frame.is_error) {
            *(interface == 0 ? &u->last_bus_us : &u->last_bus_2_us) = now_us;
        }
        take_frame(u, interface, &frame);
    }
    return room;
}

static void take_bus(struct lm_unit *u, uint64_t now_us)
{
    u->is_clock_stepped = false;
    const uint32_t room = take_interface(u, 0, LM_STEP_FRAMES, now_us);
    if (u->board->can_2) {
        (void)take_interface(u, 1, room, now_us);
    }
    lm_canas_service_answer(&u->service, u->board->can, u->flags, now_us);
    lm_nav_at(&u->nav, now_us, &u->ownship);
    u->is_polar = u->ownship.position_quality != LM_NAV_DEAD &&
                  lm_geo_is_polar(lm_ownship_position(&u->ownship));
    if (u->is_polar) {
        u->ownship.position_quality = LM_NAV_DEAD; /* nothing is drawn from there */
    }
    lm_exercise_at(&u->exercise, now_us);
    lm_malfunction_bus_at(&u->malfunctions, now_us);
}

/* After a jump of the position or a change of its sender, start the picture again: lines seen from
 * two positions must not stand side by side. */
static void restart_after_jump(struct lm_unit *u, uint64_t now_us)
{
    const bool is_other_source = u->ownship.position_quality != LM_NAV_DEAD &&
                                 u->ownship.position_origin.rank != u->position_seen.rank;
    if (is_other_source) {
        u->position_seen.rank = u->ownship.position_origin.rank;
    }
    if (is_other_source || u->nav.position_jumps != u->position_seen.jumps) {
        u->position_seen.jumps = u->nav.position_jumps;
        u->cursor.is_placed = u->cursor.is_placed && !u->position_seen.is_known;
        if (lm_picture_moves(&u->picture)) {
            lm_picture_start(&u->picture, u->page.picture, NULL, now_us);
        }
    }
    u->position_seen.is_known |= u->ownship.position_quality != LM_NAV_DEAD;
}

/* Draw the lines that are due. Returns how many more the step has time for. */
/* Where a picture takes several steps, no line comes before the first: the glass lights up sooner,
 * with what it warns of. */
static uint32_t draw_lines(struct lm_unit *u, uint64_t now_us)
{
    const bool has_glass = u->board->glass_step_px == 0 || u->count.frames > 0;
    const bool may_draw =
        (u->flags & LM_FLAGS_NO_LINES) == 0 && !lm_tracking_holds_antenna(u) && has_glass;
    const struct lm_paced paced = lm_draw_due_lines(&u->picture, may_draw, now_us);
    u->count.lines += paced.lines;
    u->count.lines_dropped += paced.dropped;
    return paced.left;
}

void lm_unit_step(struct lm_unit *u, uint64_t now_us)
{
    u->now_us = now_us;
    take_bus(u, now_us);
    restart_after_jump(u, now_us);
    lm_unit_weather_at(&u->weather, now_us);
    lm_live_bus_age(&u->live, now_us);
    lm_take_controls(u, now_us);
    if (lm_update_flags(u, now_us) & LM_FLAGS_REMOVING) {
        lm_picture_remove(&u->picture);
    }
    lm_tracking_step(u, now_us);
    lm_follow_cursor(u, now_us);
    const struct lm_position here = lm_ownship_position(&u->ownship);
    const bool is_here = u->ownship.position_quality != LM_NAV_DEAD;
    lm_unit_map_service(&u->map, is_here ? &here : NULL, now_us);
    const uint32_t lines_left = draw_lines(u, now_us);
    lm_send_reports(u, now_us);
    if (now_us >= u->next_frame_us) {
        lm_show_frame(u, lines_left, now_us);
    }
}
