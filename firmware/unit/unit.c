#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/radar_check.h"
#include "lm/version.h"
#include "unit_internal.h"

enum {
    TILE_FAULT_SHOWN_US = 3000000,
    FAULTS = LM_FLAG_NAV_STALE | LM_FLAG_NAV_DEAD | LM_FLAG_DB | LM_FLAG_TILE | LM_FLAG_BUS |
             LM_FLAG_OFF_MAP | LM_FLAG_WEATHER
};

int lm_unit_init(struct lm_unit *u, const struct lm_board *board)
{
    const struct lm_display *display = board->display;
    memset(u, 0, sizeof *u);
    const int table_status = lm_radar_check(board->radar, NULL);
    if (table_status != LM_OK) {
        return table_status;
    }
    if (display->width_px < 256 || display->width_px > 1024 || display->height_px < 256 ||
        display->height_px > 1024) {
        return LM_ERR_RANGE;
    }
    u->board = board;
    u->plane = (struct lm_plane){board->plane, display->width_px, display->height_px};
    u->frame = lm_frame_of_display(display->width_px, display->height_px);
    memset(board->plane, 0, (size_t)display->width_px * display->height_px);
    const struct lm_bus_profile *bus = board->bus_profile ? board->bus_profile : &lm_bus_canas17;
    lm_bus_init(&u->bus, bus);
    lm_nav_init(&u->nav);
    lm_canas_service_init(&u->service, bus->framing == LM_BUS_CANAEROSPACE ? board->bus_node : 0,
                          board->hardware_revision, LM_VERSION_NUMBER);
    u->commanded.sea_state = u->environment.sea_state = LM_SEA_STATE_OF_IMAGE;
    lm_page_init(&u->page, board->radar);
    lm_apply(u, LM_EFFECT_SECTOR | LM_EFFECT_TONE | LM_EFFECT_PALETTE, 0);

    const struct lm_unit_map_lent map = {board->flash, board->tile_pool, board->tile_pool_bytes,
                                         board->flash_poll_limit};
    return lm_unit_map_open(&u->map, &map);
}

static void take_frame(struct lm_unit *u, const struct lm_can_frame *frame)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    const uint32_t count = lm_bus_take(&u->bus, frame, events);
    for (uint32_t i = 0; i < count; i++) {
        lm_nav_take(&u->nav, &events[i]);
        lm_weather_bus_take(&u->weather_bus, &events[i]);
    }
    lm_canas_service_take(&u->service, frame);
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
        if (!frame.is_error) {
            u->last_bus_us = now_us;
        }
        take_frame(u, &frame);
    }
    lm_canas_service_answer(&u->service, can, u->flags, now_us);
    lm_nav_at(&u->nav, now_us, &u->ownship);
}

void lm_look_at_weather(struct lm_unit *u, uint64_t now_us)
{
    u->environment = u->commanded;
    u->is_weather_stale = lm_weather_bus_at(&u->weather_bus, now_us, &u->environment);
}

/* The aircraft is somewhere else at once: lines drawn from there and from here must not stand side
 * by side. */
static void heed_jump(struct lm_unit *u, uint64_t now_us)
{
    const bool is_other_source = u->ownship.position_quality != LM_NAV_DEAD &&
                                 u->ownship.position_origin.rank != u->position_rank_seen;
    if (is_other_source) {
        u->position_rank_seen = u->ownship.position_origin.rank;
    }
    if (is_other_source || u->nav.position_jumps != u->jumps_seen) {
        u->jumps_seen = u->nav.position_jumps;
        u->cursor.is_placed = false;
        if (u->page.picture != LM_PICTURE_PATCH) {
            lm_apply(u, LM_EFFECT_SECTOR, now_us);
        }
    }
}

/* Flags that the aircraft's data raise. */
static uint32_t judge_nav(const struct lm_unit *u)
{
    const struct lm_ownship *own = &u->ownship;
    if (u->page.picture == LM_PICTURE_PATCH && !u->sar.command.is_from_ownship) {
        return 0;
    }
    if (own->position_quality == LM_NAV_DEAD || own->height_quality == LM_NAV_DEAD ||
        own->heading_quality == LM_NAV_DEAD) {
        return LM_FLAG_NAV_DEAD;
    }
    const bool is_good = own->position_quality == LM_NAV_GOOD &&
                         own->height_quality == LM_NAV_GOOD && own->heading_quality == LM_NAV_GOOD;
    return is_good ? 0 : LM_FLAG_NAV_STALE;
}

static void remember_faults(struct lm_unit *u, uint32_t risen, uint64_t now_us)
{
    for (uint32_t i = 0; i < LM_FLAGS; i++) {
        if (risen & FAULTS & 1u << i) {
            u->faults[u->count.faults++ % LM_FAULTS_KEPT] = (struct lm_fault){i, now_us};
        }
    }
}

/* What is wrong, in one word for each. */
static void judge(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t faults = u->map.tiles.count.io_errors + lm_unit_map_corrupt_records(&u->map);
    if (faults != u->tile_faults_seen) {
        u->tile_faults_seen = faults;
        u->tile_fault_us = now_us;
    }
    const bool is_tile_fault = faults != 0 && now_us - u->tile_fault_us < TILE_FAULT_SHOWN_US;
    const uint32_t flags =
        (u->map.is_usable ? 0u : LM_FLAG_DB) | (is_tile_fault ? LM_FLAG_TILE : 0u) |
        (u->page.is_frozen ? LM_FLAG_FROZEN : 0u) | (u->is_off_map ? LM_FLAG_OFF_MAP : 0u) |
        (u->page.is_override ? LM_FLAG_SILENT : 0u) | (u->is_weather_stale ? LM_FLAG_WEATHER : 0u) |
        (now_us < u->unable_until_us ? LM_FLAG_UNABLE : 0u) |
        (now_us - u->last_bus_us > LM_BUS_SILENT_US ? LM_FLAG_BUS : 0u) | judge_nav(u);
    remember_faults(u, flags & ~u->flags, now_us);
    u->flags = flags;
}

void lm_unit_step(struct lm_unit *u, uint64_t now_us)
{
    take_bus(u, now_us);
    heed_jump(u, now_us);
    lm_look_at_weather(u, now_us);
    lm_take_controls(u, now_us);
    judge(u, now_us);
    lm_follow_cursor(u, now_us);
    lm_unit_map_service(&u->map, now_us);
    lm_draw_due_lines(u, now_us);
    if (now_us >= u->next_frame_us) {
        lm_show_frame(u, now_us);
    }
}
