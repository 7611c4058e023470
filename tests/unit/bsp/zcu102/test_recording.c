/* The recording of a board without files: what its serial line brings is shown again, a line that
 * is too slow ends it and says so, and no damage on the way passes unseen. */
#include "check.h"
#include "recording.h"
#include "replay.h"
#include "support.h"
#include "unit_rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WORDS = 32,
    SR = 0x2C / 4,
    TX_FULL = 1 << 4, /* the driver puts nothing into the FIFO: the test is the line */
    LOG_MAX = 1 << 22
};

struct flight {
    struct rig *rig;
    struct lm_board board; /* the unit's */
    struct zcu102_recording recording;
    struct drv_uart line, console;
    uint32_t line_registers[WORDS], console_registers[WORDS];
    char *log; /* what has come over the line */
    size_t bytes;
};

static struct flight *take_off(void)
{
    struct flight *f = calloc(1, sizeof *f);
    f->log = malloc(LOG_MAX);
    f->rig = make_rig();
    f->board = f->rig->board.lent;
    f->line_registers[SR] = TX_FULL;
    f->line.base = f->line_registers;
    f->console.base = f->console_registers;
    zcu102_recording_begin(&f->recording, &f->line, &f->console, &f->board);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    return f;
}

static void land(struct flight *f)
{
    free_rig(f->rig);
    free(f->log);
    free(f);
}

/* All that waits comes over the line. */
static void listen(struct flight *f)
{
    for (; f->line.out.tail != f->line.out.head; f->line.out.tail++) {
        assert_true(f->bytes < LOG_MAX);
        f->log[f->bytes++] = (char)f->line.out.bytes[f->line.out.tail & (f->line.out.size - 1)];
    }
}

static void fly(struct flight *f, double seconds, bool is_heard)
{
    struct rig *r = f->rig;
    const uint64_t end_us = r->now_us + (uint64_t)(seconds * 1e6);
    for (; r->now_us < end_us; r->now_us += STEP_US) {
        r->bus.now_us = r->now_us;
        zcu102_recording_step(&f->recording, r->now_us);
        lm_unit_step(&r->unit, r->now_us);
        if (is_heard) {
            listen(f);
        }
    }
}

static void fly_about(struct flight *f, bool is_heard)
{
    command(f->rig, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 10});
    fly(f, 1, is_heard);
    command(f->rig, lm_control_slew(300, -300));
    fly(f, 1, is_heard);
    command(f->rig, lm_control_designate());
    fly(f, 1, is_heard);
}

/* What a log of so many bytes shows; the caller has no picture to compare: the checks do. */
static struct replay again(const struct flight *f, const char *log, size_t bytes)
{
    static struct replay p;
    static struct lm_unit unit;
    char path[200];
    snprintf(path, sizeof path, "%s/tmp/zcu102-recording.log", support_build_dir());
    support_run("mkdir -p %s/tmp", support_build_dir());
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(log, 1, bytes, file), bytes);
    fclose(file);
    if (replay_open(&p, path) != 0) {
        return p;
    }
    struct lm_board board = f->rig->board.lent;
    uint64_t now_us;
    assert_int_equal(replay_wrap(&p, &board), 0);
    assert_int_equal(lm_unit_init(&unit, &board), LM_OK);
    while (replay_step(&p, &now_us)) {
        lm_unit_step(&unit, now_us);
    }
    replay_close(&p);
    return p;
}

TEST(what_the_line_brings_is_shown_again_bit_for_bit)
{
    struct flight *f = take_off();
    fly_about(f, true);
    const struct replay p = again(f, f->log, f->bytes);
    assert_string_equal(p.error, "");
    assert_in_range(p.count.checks, 60, 200); /* a row of every picture */
    assert_int_equal(p.count.checks, p.pictures);
    assert_int_equal(p.count.checks_failed + p.count.departures + p.count.reads_differ, 0);
    assert_in_range(p.steps, 1480, 1500); /* the last ones wait for a line of their own */
    assert_false(p.has_ended);
    assert_int_equal(f->recording.lines_lost, 0);
    land(f);
}

TEST(a_line_that_is_too_slow_ends_the_recording_and_the_unit_flies_on)
{
    struct flight *f = take_off();
    fly_about(f, true);
    for (int i = 0; i < 20 && f->recording.lines_lost == 0; i++) {
        fly_about(f, false);
    }
    assert_true(f->recording.lines_lost > 0);
    assert_false(f->recording.is_over); /* there is no room for the word yet */
    listen(f);
    fly(f, 1, true);
    assert_true(f->recording.is_over);
    const uint32_t lost = f->recording.lines_lost, frames = f->rig->unit.count.frames;
    const size_t bytes = f->bytes;
    fly_about(f, true);
    assert_int_equal(f->recording.lines_lost, lost);
    assert_int_equal(f->bytes, bytes);
    assert_true(f->rig->unit.count.frames > frames);
    const struct replay p = again(f, f->log, f->bytes);
    assert_string_equal(p.error, "");
    assert_int_equal(p.ceased, RECORD_BEHIND);
    assert_false(p.has_ended);
    assert_true(p.steps > 1500);
    assert_int_equal(p.count.checks_failed + p.count.departures, 0);
    land(f);
}

/* The start of line `number`, from 0. */
static char *line_of(const struct flight *f, size_t number)
{
    char *at = f->log;
    for (; number > 0; number--) {
        at = memchr(at, '\n', (size_t)(f->log + f->bytes - at));
        at++;
    }
    return at;
}

TEST(a_line_that_is_lost_or_damaged_on_the_way_is_told)
{
    struct flight *f = take_off();
    fly_about(f, true);
    char *copy = malloc(f->bytes);
    for (size_t number = 13; number < 400; number += 3) {
        char *const line = line_of(f, number), *const next = line_of(f, number + 1);
        const size_t rest = (size_t)(f->log + f->bytes - next);
        memcpy(copy, f->log, (size_t)(line - f->log));
        memcpy(copy + (line - f->log), next, rest);
        struct replay p = again(f, copy, f->bytes - (size_t)(next - line));
        if (p.error[0] == '\0') {
            fail_msg("line %zu was lost and not missed", number);
        }
        memcpy(copy, f->log, f->bytes);
        copy[next - f->log - 2] = copy[next - f->log - 2] == '0' ? '1' : '0';
        p = again(f, copy, f->bytes);
        if (p.error[0] == '\0') {
            fail_msg("line %zu was damaged and not found", number);
        }
    }
    free(copy);
    land(f);
}

TEST(a_restart_begins_another_recording)
{
    struct flight *f = take_off();
    fly_about(f, true);
    free_rig(f->rig);
    f->rig = make_rig();
    f->board = f->rig->board.lent;
    f->board.restart = "HUNG STEP";
    f->bytes -= 7; /* a line that was cut */
    zcu102_recording_begin(&f->recording, &f->line, &f->console, &f->board);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    const size_t second = f->bytes + 1;
    fly_about(f, true);
    assert_non_null(strstr(again(f, f->log, f->bytes).error, "line "));
    const struct replay p = again(f, f->log + second, f->bytes - second);
    assert_string_equal(p.error, "");
    assert_string_equal(p.head.restart, "HUNG STEP");
    assert_int_equal(p.count.checks_failed + p.count.departures, 0);
    land(f);
}
