#include "shown.h"

#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "fx/crc32c.h"

void shown_note(struct shown *s, const uint32_t *pixels, uint32_t count)
{
    assert_true(s->count < SHOWN_MAX);
    s->sum[s->count++] = fx_crc32c(0, pixels, count * sizeof *pixels);
}

static void fly(struct replay *p, struct lm_unit *unit, const struct shown *shown,
                struct shown_again *again)
{
    const uint32_t pixels = p->head.width_px * p->head.height_px;
    uint64_t now_us;
    while (replay_step(p, &now_us)) {
        const uint32_t before = p->pictures;
        lm_unit_step(unit, now_us);
        if (p->pictures != before) {
            const uint32_t sum = fx_crc32c(0, replay_glass(p), pixels * sizeof(uint32_t));
            again->wrong += before >= shown->count || shown->sum[before] != sum;
        }
    }
}

struct shown_again show_again(const char *path, const struct lm_flash *flash,
                              const struct lm_radar *radar, const struct shown *shown)
{
    struct shown_again again = {0};
    struct replay *p = calloc(1, sizeof *p);
    struct lm_unit *unit = calloc(1, sizeof *unit);
    assert_int_equal(replay_open(p, path), 0);
    struct lm_board board = {.flash = flash, .radar = radar};
    assert_int_equal(replay_wrap(p, &board), 0);
    board.tile_pool = calloc(1, board.tile_pool_bytes);
    board.plane = calloc(p->head.width_px, p->head.height_px);
    assert_int_equal(lm_unit_init(unit, &board), LM_OK);
    fly(p, unit, shown, &again);
    again.pictures = p->pictures;
    again.has_ended = p->has_ended;
    again.ceased = p->ceased;
    again.departures = p->count.departures;
    again.checks = p->count.checks;
    again.checks_failed = p->count.checks_failed + p->count.reads_differ;
    again.torn = p->count.torn;
    snprintf(again.error, sizeof again.error, "%s", p->error);
    replay_close(p);
    free(board.tile_pool);
    free(board.plane);
    free(unit);
    free(p);
    return again;
}
