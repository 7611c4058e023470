/* The rows of the BIT page that tell of the database and of the faults that stand. The rows of
 * counters are read off the glass in test_page. */
#include "check.h"
#include "glass_text.h"
#include "lm/bit.h"
#include "lm/overlay.h"
#include "unit_rig.h"

#include <stdio.h>
#include <string.h>

enum { ROW_VERSION = 0, ROW_DATABASE = 1, ROW_NOW = 16, ROW_RESTART = 21 };

TEST(a_row_of_the_bit_page_names_the_database)
{
    struct rig *r = start_rig();
    strcpy(r->unit.map.db.title, "ALPS EAST");
    assert_string_equal(lm_bit_row(&r->unit, ROW_DATABASE).words, "DB ALPS EAST");
    free_rig(r);
}

TEST(the_row_of_the_database_says_that_it_failed)
{
    struct rig *r = make_rig();
    r->image.bytes[100] ^= 1;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    assert_string_equal(lm_bit_row(&r->unit, ROW_DATABASE).words, "DB FAIL");
    free_rig(r);
}

static const char *behind_the_version(struct rig *r)
{
    static struct lm_text row;
    row = lm_bit_row(&r->unit, ROW_VERSION);
    const char *image = strstr(row.words, "IMAGE V");
    assert_non_null(image);
    return image + strcspn(image, "0123456789") + strspn(image + strlen("IMAGE V"), "0123456789");
}

TEST(the_bit_page_says_what_the_board_knows_of_the_slots)
{
    static const struct {
        struct lm_slots_state state;
        const char *version, *restart;
    } rows[] = {
        {{.flown = 0}, "", "RESTART  HUNG STEP"},
        {{.flown = 1}, "  SLOT A", "RESTART  HUNG STEP"},
        {{.flown = 2, .damaged = 1}, "  SLOT B", "RESTART  HUNG STEP  SLOT A BAD"},
        {{.flown = 1, .cut_off = 2}, "  SLOT A", "RESTART  HUNG STEP  SLOT B CUT OFF"},
        {{.damaged = 3}, "", "RESTART  HUNG STEP  SLOT A BAD  SLOT B BAD"},
        {{.flown = 1, .load = LM_LOAD_RUNS}, "  LOAD 0", "RESTART  HUNG STEP"},
        {{.flown = 1, .load = LM_LOAD_RUNS, .percent = 100}, "  LOAD 100", "RESTART  HUNG STEP"},
        {{.flown = 1, .load = LM_LOAD_DONE}, "  LOADED", "RESTART  HUNG STEP"},
        {{.flown = 1, .load = LM_LOAD_FAILED}, "  LOAD FAIL", "RESTART  HUNG STEP"},
    };
    struct rig *r = start_rig();
    r->board.lent.restart = "HUNG STEP";
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(lm_unit_tell_slots(&r->unit, &rows[i].state), LM_OK);
        assert_string_equal(behind_the_version(r), rows[i].version);
        assert_string_equal(lm_bit_row(&r->unit, ROW_RESTART).words, rows[i].restart);
        assert_true(lm_bit_row(&r->unit, ROW_VERSION).length <= 34); /* of the smallest glass */
    }
    r->board.lent.restart = NULL;
    const struct lm_slots_state bad = {.flown = 2, .damaged = 1};
    assert_int_equal(lm_unit_tell_slots(&r->unit, &bad), LM_OK);
    assert_string_equal(lm_bit_row(&r->unit, ROW_RESTART).words, "SLOT A BAD");
    free_rig(r);
}

TEST(a_number_of_the_slots_outside_its_range_changes_nothing)
{
    static const struct lm_slots_state bad[] = {
        {.flown = 3},    {.flown = -1},      {.damaged = 4}, {.damaged = -1},  {.cut_off = 4},
        {.cut_off = -1}, {.load = LM_LOADS}, {.load = -1},   {.percent = 101}, {.percent = -1},
    };
    struct rig *r = start_rig();
    const struct lm_slots_state sound = {.flown = 2, .load = LM_LOAD_RUNS, .percent = 42};
    assert_int_equal(lm_unit_tell_slots(&r->unit, &sound), LM_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(lm_unit_tell_slots(&r->unit, &bad[i]), LM_ERR_RANGE);
        assert_string_equal(behind_the_version(r), "  LOAD 42");
    }
    free_rig(r);
}

TEST(row_now_names_each_standing_fault)
{
    static const struct {
        uint32_t flags;
        const char *words;
    } rows[] = {
        {0, "NOW  NO FAULT"},
        {LM_FLAG_NAV_STALE, "NOW  NAV"},
        {LM_FLAG_NAV_DEAD, "NOW  NAV FAIL"},
        {LM_FLAG_DB, "NOW  DB FAIL"},
        {LM_FLAG_TILE, "NOW  TILE"},
        {LM_FLAG_BUS, "NOW  BUS"},
        {LM_FLAG_FROZEN, "NOW  FZ"},
        {LM_FLAG_OFF_MAP, "NOW  OFF MAP"},
        {LM_FLAG_SILENT, "NOW  NO RAD"},
        {LM_FLAG_UNABLE, "NOW  UNABLE"},
        {LM_FLAG_WEATHER, "NOW  WX"},
        {LM_FLAG_EXERCISE, "NOW  EXC"},
        {LM_FLAG_UNSIGNED, "NOW  UNSIGNED"},
        {LM_FLAG_NAV_DEAD | LM_FLAG_BUS | LM_FLAG_WEATHER, "NOW  NAV FAIL  BUS  WX"},
    };
    struct rig *r = start_rig();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        r->unit.flags = rows[i].flags;
        assert_string_equal(lm_bit_row(&r->unit, ROW_NOW).words, rows[i].words);
    }
    free_rig(r);
}

TEST(without_a_database_the_bit_page_counts_no_levels_and_no_records)
{
    struct rig *r = start_rig();
    char words[40];
    snprintf(words, sizeof words, "LEVELS   %-8u RECORDS  %u", r->unit.map.db.lod_count,
             r->unit.map.db.record_count);
    assert_string_equal(lm_bit_row(&r->unit, ROW_DATABASE + 1).words, words);
    r->image.bytes[100] ^= 1;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    assert_string_equal(lm_bit_row(&r->unit, ROW_DATABASE + 1).words,
                        "LEVELS   0        RECORDS  0");
    free_rig(r);
}

TEST(the_cause_of_a_restart_is_on_the_glass_for_ten_seconds)
{
    struct rig *r = make_rig();
    r->board.lent.restart = "HUNG STEP";
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 9.9);
    const struct lm_surface glass = glass_of(r);
    assert_true(glass_find(&glass, "RESTART", r->unit.palette.warning, r->unit.palette.ink, NULL));
    run(r, 0.2);
    assert_false(glass_find(&glass, "RESTART", r->unit.palette.warning, r->unit.palette.ink, NULL));
    free_rig(r);
}

static bool says_unsigned(bool is_unsigned)
{
    struct rig *r = make_rig();
    r->board.lent.is_database_unsigned = is_unsigned;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 1);
    const struct lm_surface glass = glass_of(r);
    const bool is_on_glass =
        glass_find(&glass, "UNSIGNED", r->unit.palette.warning, r->unit.palette.ink, NULL);
    assert_int_equal(is_on_glass, (r->unit.flags & LM_FLAG_UNSIGNED) != 0);
    for (uint32_t age = 0; lm_fault_log_at(&r->unit.faults, age); age++) {
        assert_string_not_equal(lm_flag_word(lm_fault_log_at(&r->unit.faults, age)->flag),
                                "UNSIGNED");
    }
    free_rig(r);
    return is_on_glass;
}

/* It is no fault: the owner of the board allowed it. */
TEST(the_glass_says_that_nobody_signed_the_database_if_the_board_says_so)
{
    assert_true(says_unsigned(true));
    assert_false(says_unsigned(false));
}
