/* A recording in the browser: the unit runs on the recording's settings, times and answers
 * (bsp/record/replay.h), and on the bytes of the image. */
#include "fx/mem.h"
#include "web.h"

static enum replay_line next_line(struct replay *p, char *line)
{
    (void)p;
    const int length = web_recording_line(line, REPLAY_LINE_BYTES - 1);
    if (length >= 0 && length < REPLAY_LINE_BYTES) {
        line[length] = '\0';
        return REPLAY_LINE;
    }
    return length == WEB_LINE_OVER   ? REPLAY_LINE_OVER
           : length == WEB_LINE_TORN ? REPLAY_LINE_TORN
                                     : REPLAY_LINE_BAD;
}

/* Fails with a word in the replay's error. */
static int refuse(const char *cause)
{
    size_t at = 0;
    for (; cause[at] != '\0' && at + 1 < sizeof web.replay.error; at++) {
        web.replay.error[at] = cause[at];
    }
    web.replay.error[at] = '\0';
    return LM_ERR_RANGE;
}

static const char *difference_of(const struct lm_board *board)
{
    struct record_head mine;
    record_describe(&mine, board, 0);
    return replay_difference(&web.replay, &mine);
}

/* Of the tables that are built in, none or one that is heard beside the first, on either interface.
 * Returns what differs with each of them, or NULL: *board has the one that fits. */
static const char *choose_second(struct lm_board *board)
{
    board->tables[0] = (struct lm_board_table){0};
    const char *difference = difference_of(board);
    for (const struct lm_bus_named_profile *named = lm_bus_profiles; difference && named->name;
         named++) {
        for (uint8_t interface = 0; difference && interface < 2; interface++) {
            board->tables[0] = (struct lm_board_table){named->profile, interface};
            difference = difference_of(board);
        }
    }
    return difference;
}

/* What differs between the recording and this board, whatever table it is given. */
static const char *choose_tables(struct lm_board *board)
{
    const struct record_head *h = &web.replay.head;
    static const struct lm_can second;
    board->radar = h->radar_crc != 0 ? &lm_radar_default : NULL;
    board->can_2 = (h->switches & RECORD_HAS_SECOND) != 0 ? &second : NULL;
    if ((h->switches & RECORD_HAS_TABLE) == 0) {
        return choose_second(board);
    }
    const char *difference = NULL;
    for (const struct lm_bus_named_profile *named = lm_bus_profiles; named->name; named++) {
        board->bus_profile = named->profile;
        difference = choose_second(board);
        if (!difference) {
            return NULL;
        }
    }
    return difference;
}

WEB_EXPORT("replay_open") int web_replay_open(double flash_bytes, bool is_any)
{
    if (!(flash_bytes >= 0 && flash_bytes < 9007199254740992.0)) {
        return LM_ERR_RANGE;
    }
    memset(&web, 0, sizeof web);
    web.is_replay = true;
    memcpy(web.replay.path, "recording", sizeof "recording");
    web.flash = (struct lm_flash){&web, (uint64_t)flash_bytes, web_read_start, web_read_poll};
    if (replay_begin(&web.replay, next_line) != 0) {
        return LM_ERR_RANGE;
    }
    const struct record_head *h = &web.replay.head;
    web.display =
        (struct lm_display){.width_px = (uint16_t)h->width_px, .height_px = (uint16_t)h->height_px};
    web.board = (struct lm_board){.flash = &web.flash,
                                  .display = &web.display,
                                  .tile_pool = web_pool,
                                  .plane = web_plane,
                                  .flash_poll_limit = 1};
    const char *difference = choose_tables(&web.board);
    if (difference && !is_any) {
        return refuse(difference);
    }
    replay_wrap_with(&web.replay, &web.board, web_surface[0]);
    return lm_unit_init(&web.unit, &web.board);
}

WEB_EXPORT("replay_step") double web_replay_step(void)
{
    const struct lm_rectangle glass = {0, 0, web.display.width_px, web.display.height_px};
    uint64_t now_us;
    if (!web.is_replay || !replay_step(&web.replay, &now_us)) {
        return -1;
    }
    lm_unit_step(&web.unit, now_us);
    if (web.pictures != web.replay.pictures) {
        web.pictures = web.replay.pictures;
        lm_damage_mark(&web.stale, &glass);
    }
    return (double)now_us;
}

WEB_EXPORT("replay_error") const char *web_replay_error(void)
{
    return web.replay.error;
}

double web_replay_value(enum web_value which)
{
    const struct replay *p = &web.replay;
    switch (which) {
    case WEB_WIDTH_PX:
        return web.display.width_px;
    case WEB_HEIGHT_PX:
        return web.display.height_px;
    case WEB_STEPS:
        return (double)p->steps;
    case WEB_STEPS_READ:
        return p->ticks.count - p->ticks.at;
    case WEB_DEPARTURES:
        return p->count.departures;
    case WEB_CHECKS:
        return p->count.checks;
    case WEB_CHECKS_FAILED:
        return p->count.checks_failed;
    case WEB_READS_DIFFER:
        return p->count.reads_differ;
    case WEB_HAS_ENDED:
        return p->has_ended;
    case WEB_IS_OTHER_BUILD:
        return replay_is_other_build(p);
    case WEB_CEASED:
        return p->ceased;
    default:
        return -1;
    }
}
