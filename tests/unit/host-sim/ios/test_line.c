/* Lines of a page: what is a frame, what an instructor may send, and what comes back. */
#include "check.h"
#include "ios/line.h"

#include <string.h>

static const char *read_line(const char *line, struct lm_can_frame *frame)
{
    return ios_line_read(line, strlen(line), frame);
}

TEST(a_frame_survives_the_way_to_a_line_and_back)
{
    const struct lm_can_frame frames[] = {
        {.id = 0x712, .length = 8, .data = {30, 3, 0, 1, 0xde, 0xad, 0xbe, 0xef}},
        {.id = 0x1fffffff, .is_extended = true, .length = 4, .data = {1, 2, 3, 4}},
        {.id = 0, .length = 8},
    };
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        char line[IOS_LINE_MAX];
        struct lm_can_frame back;
        const size_t length = ios_line_write(line, "can0", 1436509052249713, &frames[i]);
        assert_int_equal(strlen(line), length);
        assert_int_equal(line[length - 1], '\n');
        assert_int_equal(strncmp(line, "(1436509052.249713) can0 ", 25), 0);
        assert_null(ios_line_read(line, length - 1, &back));
        assert_int_equal(back.id, frames[i].id);
        assert_int_equal(back.is_extended, frames[i].is_extended);
        assert_int_equal(back.length, frames[i].length);
        assert_memory_equal(back.data, frames[i].data, frames[i].length);
        assert_int_equal(back.time_us, 0);
    }
}

TEST(the_longest_line_fits)
{
    const struct lm_can_frame frame = {.id = 0x1fffffff, .is_extended = true, .length = 255};
    char line[IOS_LINE_MAX];
    const size_t length = ios_line_write(line, "a-name-that-is-too-long", UINT64_MAX, &frame);
    assert_true(length < IOS_LINE_MAX);
    assert_non_null(strstr(line, " a-name-that-is- 1FFFFFFF#0000000000000000\n"));
}

TEST(what_is_no_frame_of_a_page_is_refused_with_a_cause)
{
    static const char *const lines[] = {"",
                                        "712#1E030001",
                                        "(0.000000) p 712#R",
                                        "(0.000000) p 712#1E0300",
                                        "(0.000000) p 712##1E030001",
                                        "(0.000000) p 20000004#0000000000000000",
                                        "(0.000000) p 712#1E030001000000001",
                                        "(0.000000) p xyz#1E030001"};
    struct lm_can_frame frame;
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        assert_non_null(read_line(lines[i], &frame));
    }
    char full[IOS_LINE_MAX + 1];
    memset(full, 'x', sizeof full);
    assert_non_null(ios_line_read(full, sizeof full, &frame));
    assert_non_null(ios_line_read("(0.000000) p 712#1E030001\0abc", 29, &frame));
    assert_null(read_line("(0.000000) p 712#1E030001", &frame));
}

TEST(only_the_instructors_identifiers_have_a_slot_and_each_its_own)
{
    int found = 0;
    for (uint32_t id = 0; id < 0x800; id++) {
        const struct lm_can_frame frame = {.id = id, .length = 8};
        const bool is_named = (id >= 1530 && id <= 1549) || (id >= 1800 && id <= 1829);
        const int slot = ios_instructor_slot(&frame);
        assert_int_equal(slot, is_named ? found : -1);
        found += is_named;
    }
    assert_int_equal(found, IOS_INSTRUCTOR_IDS);
    const struct lm_can_frame others[] = {{.id = 1810, .is_extended = true},
                                          {.id = 1810, .is_remote = true},
                                          {.id = 1810, .is_error = true}};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(ios_instructor_slot(&others[i]), -1);
    }
}
