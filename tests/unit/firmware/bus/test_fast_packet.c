/* Fast packets: every length in any order of its frames, and whatever a bus can do to them. */
#include "check.h"
#include "hs/rng.h"
#include "lm/fast_packet.h"

#include <string.h>

enum { ID = 0x09f80500 };

static uint8_t message[LM_FAST_PACKET_BYTES];

static uint32_t frames_of(uint32_t length)
{
    return length <= 6 ? 1 : 1 + (length - 6 + 6) / 7;
}

/* Frame `number` of the message of this length, padded as senders do. */
static struct lm_can_frame part(uint32_t id, uint8_t sequence, uint32_t length, uint32_t number)
{
    struct lm_can_frame f = {.id = id, .is_extended = true, .length = 8, .time_us = 1000};
    memset(f.data, 0xff, sizeof f.data);
    f.data[0] = (uint8_t)((uint32_t)sequence << 5 | number);
    const uint32_t head = number == 0 ? 2 : 1;
    f.data[1] = number == 0 ? (uint8_t)length : 0xff;
    for (uint32_t i = head; i < 8; i++) {
        const uint32_t at = number == 0 ? i - 2 : 6 + (number - 1) * 7 + i - 1;
        f.data[i] = at < length ? message[at] : 0xff;
    }
    return f;
}

static const struct lm_fast_packet_slot *take(struct lm_fast_packet *f, struct lm_can_frame frame)
{
    return lm_fast_packet_take(f, &frame);
}

TEST(every_length_is_joined_whatever_the_order_behind_frame_0)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    struct lm_fast_packet f = {0};
    for (uint32_t length = 1; length <= LM_FAST_PACKET_BYTES; length++) {
        const uint32_t count = frames_of(length);
        uint32_t order[32];
        for (uint32_t i = 0; i < sizeof message; i++) {
            message[i] = (uint8_t)hs_rng_u64(&rng);
        }
        for (uint32_t i = 0; i < count; i++) {
            order[i] = i;
        }
        for (uint32_t i = count - 1; i > 1 && length % 2 == 0; i--) {
            const uint32_t k = 1 + hs_rng_below(&rng, i), other = order[k];
            order[k] = order[i];
            order[i] = other;
        }
        const struct lm_fast_packet_slot *whole = NULL;
        for (uint32_t i = 0; i < count; i++) {
            assert_null(whole);
            whole = take(&f, part(ID, (uint8_t)(length % 8), length, order[i]));
        }
        assert_non_null(whole);
        assert_int_equal(whole->length, length);
        assert_memory_equal(whole->data, message, length);
    }
    assert_int_equal(f.count.whole, LM_FAST_PACKET_BYTES);
    assert_int_equal(f.count.torn + f.count.stray, 0);
}

TEST(four_messages_are_joined_at_one_time_and_a_fifth_displaces_the_oldest)
{
    struct lm_fast_packet f = {0};
    for (uint32_t number = 0; number < 2; number++) {
        for (uint32_t n = 0; n < LM_FAST_PACKET_SLOTS; n++) {
            struct lm_can_frame frame = part(ID + n / 2, (uint8_t)n, 20, number);
            frame.time_us += 10 * number + n;
            assert_null(lm_fast_packet_take(&f, &frame));
        }
    }
    struct lm_can_frame fifth = part(ID + 9, 0, 20, 0);
    fifth.time_us += 100;
    assert_null(lm_fast_packet_take(&f, &fifth));
    assert_int_equal(f.count.torn, 1);
    for (uint32_t n = 0; n < LM_FAST_PACKET_SLOTS; n++) {
        struct lm_can_frame last = part(ID + n / 2, (uint8_t)n, 20, 2);
        last.time_us += 200;
        const bool is_whole = lm_fast_packet_take(&f, &last) != NULL;
        assert_int_equal(is_whole, n != 0);
    }
    assert_int_equal(f.count.whole, 3);
    assert_int_equal(f.count.stray, 1);
}

TEST(frames_that_fit_no_message_are_counted_and_change_nothing)
{
    struct lm_fast_packet f = {0};
    assert_null(take(&f, part(ID, 0, 20, 1)));  /* nothing was begun */
    assert_null(take(&f, part(ID, 0, 0, 0)));   /* no bytes */
    assert_null(take(&f, part(ID, 0, 224, 0))); /* too many */
    assert_int_equal(f.count.stray, 3);
    assert_null(take(&f, part(ID, 0, 20, 0)));
    assert_null(take(&f, part(ID, 0, 20, 1)));
    assert_null(take(&f, part(ID, 0, 20, 1))); /* twice */
    assert_null(take(&f, part(ID, 0, 20, 3))); /* beyond its end */
    assert_null(take(&f, part(ID, 1, 20, 2))); /* of another message */
    assert_null(take(&f, part(ID + 1, 0, 20, 2)));
    struct lm_can_frame tiny = part(ID, 0, 20, 2), long_one = tiny;
    tiny.length = 1;
    long_one.length = 9;
    assert_null(take(&f, tiny));
    assert_null(take(&f, long_one));
    assert_int_equal(f.count.stray, 9);
    assert_non_null(take(&f, part(ID, 0, 20, 2)));
    assert_int_equal(f.count.torn, 0);
}

TEST(a_message_is_torn_by_its_own_beginning_by_a_pause_and_by_a_short_frame)
{
    struct lm_fast_packet f = {0};
    assert_null(take(&f, part(ID, 0, 20, 0)));
    assert_null(take(&f, part(ID, 0, 20, 1)));
    assert_null(take(&f, part(ID, 0, 20, 0)));
    assert_int_equal(f.count.torn, 1);
    assert_null(take(&f, part(ID, 0, 20, 2)));
    struct lm_can_frame late = part(ID, 0, 20, 1);
    late.time_us += LM_FAST_PACKET_US + 1;
    assert_null(lm_fast_packet_take(&f, &late));
    assert_int_equal(f.count.torn, 2);
    assert_null(take(&f, part(ID, 0, 20, 0)));
    struct lm_can_frame cut = part(ID, 0, 20, 1);
    cut.length = 7;
    assert_null(lm_fast_packet_take(&f, &cut));
    assert_int_equal(f.count.torn, 3);
    assert_null(take(&f, part(ID, 0, 20, 2)));
    assert_int_equal(f.count.whole, 0);
    /* The last frame need not be padded. */
    assert_null(take(&f, part(ID, 0, 8, 0)));
    struct lm_can_frame last = part(ID, 0, 8, 1);
    last.length = 3;
    assert_non_null(lm_fast_packet_take(&f, &last));
}

TEST(a_message_is_torn_by_a_clock_that_is_set_back)
{
    struct lm_fast_packet f = {0};
    assert_null(take(&f, part(ID, 0, 20, 0)));
    struct lm_can_frame early = part(ID, 0, 20, 1);
    early.time_us--;
    assert_null(lm_fast_packet_take(&f, &early));
    assert_int_equal(f.count.torn, 1);
    assert_null(take(&f, part(ID, 0, 20, 2)));
    assert_int_equal(f.count.whole, 0);
}
