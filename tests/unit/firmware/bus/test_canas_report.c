/* What the display tells unasked: when, in which frames, and what happens on a bus that is full or
 * down. */
#include "check.h"
#include "lm/canas.h"
#include "lm/canas_report.h"

#include <string.h>

enum { NODE = 20, FRAMES_MAX = 2000, STEP_US = 4000 };

struct wire {
    struct lm_can_frame sent[FRAMES_MAX];
    uint64_t at_us[FRAMES_MAX];
    uint64_t now_us;
    int count;
    int room; /* frames that it still takes; then LM_BUSY */
    int answer;
};

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct wire *w = ctx;
    if (w->answer == LM_OK && w->room-- <= 0) {
        return LM_BUSY;
    }
    if (w->answer == LM_OK) {
        assert_in_range(w->count, 0, FRAMES_MAX - 1);
        w->at_us[w->count] = w->now_us;
        w->sent[w->count++] = *frame;
    }
    return w->answer;
}

static struct lm_report all_known(void)
{
    struct lm_report values = {.known = (1u << LM_REPORT_ITEMS) - 1};
    for (uint32_t i = 0; i < LM_REPORT_ITEMS; i++) {
        values.word[i] = 0x01020304u + i;
    }
    return values;
}

/* Run steps to before `end_us`, each with so much room on the bus. */
static void run_until(struct lm_canas_report *r, struct wire *w, const struct lm_report *values,
                      uint64_t end_us, int room)
{
    const struct lm_can can = {.ctx = w, .send = send_frame};
    for (; w->now_us < end_us; w->now_us += STEP_US) {
        const uint32_t sets = lm_canas_report_due(r, w->now_us);
        const int before = w->count;
        if (sets != 0) {
            lm_canas_report_begin(r, sets, values, w->now_us);
        }
        w->room = room;
        lm_canas_report_send(r, &can);
        assert_in_range(w->count - before, 0, LM_REPORT_FRAMES_A_STEP);
    }
}

/* A display that tells everything, and a bus on which nothing was said. */
static void begin(struct lm_canas_report *r, struct wire *w)
{
    memset(w, 0, sizeof *w);
    lm_canas_report_init(r, NODE);
}

static uint32_t count_of(const struct wire *w, uint32_t id)
{
    uint32_t count = 0;
    for (int i = 0; i < w->count; i++) {
        count += w->sent[i].id == id;
    }
    return count;
}

TEST(every_item_has_an_identifier_of_its_own_that_is_free_to_use_and_stands_with_its_set)
{
    for (uint32_t i = 0; i < LM_REPORT_ITEMS; i++) {
        const struct lm_report_row *row = &lm_report_rows[i];
        assert_in_range(row->id, 1501, 1799); /* section 2.1; 1500 is the state word */
        for (uint32_t k = 0; k < i; k++) {
            assert_int_not_equal(lm_report_rows[k].id, row->id);
        }
        assert_true(i == 0 || row->set == lm_report_rows[i - 1].set ||
                    row->set == lm_report_rows[i - 1].set + 1);
        uint32_t words = 1;
        for (const char *c = row->unit; *c; c++) {
            words += *c == ' ';
        }
        assert_int_equal(words, lm_canas_types[row->type].elements);
    }
    assert_int_equal(lm_report_rows[0].set, 0);
    assert_int_equal(lm_report_rows[LM_REPORT_ITEMS - 1].set, LM_REPORT_SETS - 1);
}

TEST(each_item_is_told_at_its_rate_with_a_code_that_counts_its_sets)
{
    static struct wire w;
    struct lm_canas_report r;
    const struct lm_report values = all_known();
    begin(&r, &w);
    run_until(&r, &w, &values, 10000000, 100);
    for (uint32_t i = 0; i < LM_REPORT_ITEMS; i++) {
        const struct lm_report_row *row = &lm_report_rows[i];
        const uint32_t period_us = lm_report_period_us[row->set];
        assert_int_equal(count_of(&w, row->id), 10000000 / period_us);
        uint8_t code = 0;
        uint64_t set = 0;
        for (int k = 0; k < w.count; k++) {
            if (w.sent[k].id == row->id) {
                assert_int_equal(w.sent[k].data[3], ++code);
                assert_in_range(w.at_us[k], set * period_us, set * period_us + 6 * STEP_US);
                set++;
            }
        }
    }
    assert_int_equal(r.count.sent, w.count);
    assert_int_equal(r.count.cut + r.count.lost, 0);
}

TEST(a_frame_has_sender_type_code_and_the_number_with_its_highest_byte_first)
{
    static struct wire w;
    struct lm_canas_report r;
    struct lm_report values = all_known();
    begin(&r, &w);
    values.word[LM_REPORT_CURSOR_LATITUDE] = (uint32_t)-123456789;
    values.word[LM_REPORT_GAIN] = (uint32_t)-7 & 0xff;
    run_until(&r, &w, &values, 7 * STEP_US, 100);
    assert_int_equal(w.count, LM_REPORT_ITEMS);
    for (int i = 0; i < w.count; i++) {
        assert_int_equal(w.sent[i].id, lm_report_rows[i].id);
        assert_false(w.sent[i].is_extended || w.sent[i].is_remote || w.sent[i].is_error);
    }
    /* -123456789 is F8A432EB. */
    assert_int_equal(w.sent[0].length, 8);
    assert_memory_equal(w.sent[0].data, "\x14\x03\0\x01\xf8\xa4\x32\xeb", 8);
    assert_int_equal(w.sent[LM_REPORT_GAIN].length, 5);
    assert_memory_equal(w.sent[LM_REPORT_GAIN].data, "\x14\x09\0\x01\xf9", 5);
    assert_int_equal(w.sent[LM_REPORT_SETTINGS].length, 6);
    assert_int_equal(w.sent[LM_REPORT_PATCH].length, 7);
}

TEST(what_is_not_known_is_told_as_no_data_and_what_is_old_as_old)
{
    static struct wire w;
    struct lm_canas_report r;
    struct lm_report values = all_known();
    begin(&r, &w);
    values.known &= ~(1u << LM_REPORT_CURSOR_ELEVATION);
    values.is_stale = true;
    run_until(&r, &w, &values, 7 * STEP_US, 100);
    for (int i = 0; i < w.count; i++) {
        assert_int_equal(w.sent[i].data[2], 1);
    }
    assert_int_equal(w.sent[LM_REPORT_CURSOR_ELEVATION].length, 4);
    assert_memory_equal(w.sent[LM_REPORT_CURSOR_ELEVATION].data, "\x14\0\x01\x01", 4);
    assert_int_equal(w.sent[LM_REPORT_CURSOR_BEARING].length, 8);
}

TEST(a_set_holds_values_of_one_moment_however_slowly_the_bus_takes_it)
{
    static struct wire w;
    struct lm_canas_report r;
    struct lm_report values = all_known();
    begin(&r, &w);
    run_until(&r, &w, &values, STEP_US, 1);
    for (uint32_t i = 0; i < LM_REPORT_ITEMS; i++) {
        values.word[i] = 0;
    }
    run_until(&r, &w, &values, 24 * STEP_US, 1);
    assert_int_equal(w.count, LM_REPORT_ITEMS);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(w.sent[i].data[7], (4 + i) & 0xff);
    }
    assert_int_equal(r.count.cut, 0);
}

TEST(a_bus_that_takes_too_little_cuts_sets_short_and_they_are_counted)
{
    static struct wire w;
    struct lm_canas_report r;
    const struct lm_report values = all_known();
    begin(&r, &w);
    run_until(&r, &w, &values, 2000000, 0);
    assert_int_equal(w.count, 0);
    /* 20 of the cursor, 4 places, 10 states and 20 tracks were begun; the last of each waits. */
    assert_int_equal(r.count.cut, 20 + 4 + 10 + 20 - LM_REPORT_SETS);
    run_until(&r, &w, &values, 2100000, 100);
    assert_int_equal(w.sent[0].data[3], 21); /* the cursor as it is now, not as it was */
}

TEST(a_bus_that_is_down_loses_frames_and_holds_nothing_up)
{
    static struct wire w;
    struct lm_canas_report r;
    const struct lm_report values = all_known();
    begin(&r, &w);
    w.answer = LM_ERR_IO;
    run_until(&r, &w, &values, 1000000, 100);
    assert_int_equal(r.count.lost, 10 * 6 + 2 * 3 + 5 * 6 + 10 * 9);
    assert_int_equal(r.count.sent + r.count.cut, 0);
}

TEST(without_a_number_or_on_a_board_that_only_listens_nothing_is_told)
{
    static struct wire w;
    struct lm_canas_report r;
    const struct lm_report values = all_known();
    memset(&w, 0, sizeof w);
    lm_canas_report_init(&r, 0);
    assert_int_equal(lm_canas_report_due(&r, 1000000), 0);
    lm_canas_report_init(&r, NODE);
    lm_canas_report_begin(&r, lm_canas_report_due(&r, 0), &values, 0);
    lm_canas_report_send(&r, &(struct lm_can){.ctx = &w});
    assert_int_equal(r.count.sent + r.count.lost, 0);
}
