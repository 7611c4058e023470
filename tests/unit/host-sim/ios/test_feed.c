/* The feed: every page reads the same lines at its own pace, and a slow one is told. */
#include "check.h"
#include "ios/feed.h"

#include <stdlib.h>
#include <string.h>

static struct lm_can_frame frame_of(uint32_t id, uint8_t service, uint8_t last)
{
    return (struct lm_can_frame){.id = id, .length = 8, .data = {30, 3, service, 0, 0, 0, 0, last}};
}

static void put(struct ios_feed *feed, uint32_t id, uint8_t service, uint8_t last)
{
    const struct lm_can_frame frame = frame_of(id, service, last);
    ios_feed_put(feed, "can0", 1000000u + last, &frame);
}

TEST(two_readers_of_any_pace_read_the_same_lines)
{
    struct ios_feed feed;
    static char all[2][1 << 16];
    size_t length[2] = {0, 0};
    uint64_t at[2] = {0, 0};
    assert_int_equal(ios_feed_open(&feed, 1000), 0); /* goes round many times */
    for (int i = 0; i < 500; i++) {
        put(&feed, 0x712, 0, (uint8_t)i);
        for (int r = 0; r < 2; r++) {
            if (r == 0 || i % 7 == 6 || i == 499) {
                long got;
                while ((got = ios_feed_take(&feed, &at[r], all[r] + length[r],
                                            IOS_LINE_MAX + 30u * (unsigned)r)) > 0) {
                    length[r] += (size_t)got;
                    assert_int_equal(all[r][length[r] - 1], '\n');
                }
                assert_int_equal(got, 0);
            }
        }
    }
    assert_int_equal(length[0], length[1]);
    assert_int_equal(length[0], feed.end);
    assert_memory_equal(all[0], all[1], length[0]);
    ios_feed_close(&feed);
    ios_feed_close(&feed);
}

TEST(a_reader_whom_the_ring_has_overtaken_is_told)
{
    struct ios_feed feed;
    uint64_t at = 0;
    char text[200];
    assert_int_equal(ios_feed_open(&feed, 500), 0);
    while (feed.end <= 500) {
        put(&feed, 0x712, 0, 1);
    }
    assert_int_equal(ios_feed_take(&feed, &at, text, sizeof text), -1);
    at = feed.end;
    assert_int_equal(ios_feed_take(&feed, &at, text, sizeof text), 0);
    ios_feed_close(&feed);
}

TEST(what_was_is_the_last_frame_of_each_instructors_identifier_and_number)
{
    struct ios_feed feed;
    size_t bytes;
    assert_int_equal(ios_feed_open(&feed, 4096), 0);
    put(&feed, 1036, 0, 9); /* a latitude of the aircraft is not kept */
    assert_null(ios_feed_past(&feed, &bytes));
    put(&feed, 1810, 0, 1);
    put(&feed, 1810, 1, 2);
    put(&feed, 1829, 0, 3);
    put(&feed, 1810, 0, 4); /* in place of the first, and behind the others */
    char *text = ios_feed_past(&feed, &bytes);
    assert_non_null(text);
    assert_int_equal(bytes, strlen("(1.000002) past 712#1E03010000000002\n") * 3);
    assert_memory_equal(text,
                        "(1.000002) past 712#1E03010000000002\n"
                        "(1.000003) past 725#1E03000000000003\n"
                        "(1.000004) past 712#1E03000000000004\n",
                        bytes);
    free(text);
    ios_feed_close(&feed);
}
