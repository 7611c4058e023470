/* Malfunctions that come over the bus: docs/bus.md, "Malfunctions". */
#include "bus_frames.h"
#include "check.h"
#include "lm/malfunction_bus.h"

#include <math.h>

enum { S = 1000000 };

struct ear {
    struct lm_bus bus;
    struct lm_malfunction_bus broken;
};

static struct ear open_ear(void)
{
    struct ear ear = {0};
    lm_bus_init(&ear.bus, &lm_bus_canas17);
    return ear;
}

static void hear_frame(struct ear *ear, const struct lm_can_frame *frame)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    const uint32_t count = lm_bus_take(&ear->bus, frame, events);
    for (uint32_t i = 0; i < count; i++) {
        lm_malfunction_bus_take(&ear->broken, &events[i]);
    }
}

static void hear(struct ear *ear, uint8_t node, uint8_t kind, double value, uint64_t time_us)
{
    struct lm_can_frame f = bus_frame(1825, LM_CANAS_FLOAT, 0, bus_float_bits(value), time_us);
    f.data[0] = node;
    f.data[2] = kind;
    hear_frame(ear, &f);
}

static void hear_clear(struct ear *ear, uint8_t which, uint64_t time_us)
{
    struct lm_can_frame f = bus_frame(1826, LM_CANAS_UCHAR, 0, (uint32_t)which << 24, time_us);
    f.length = 5;
    f.data[0] = 30;
    hear_frame(ear, &f);
}

static uint32_t set_at(struct ear *ear, uint64_t now_us)
{
    lm_malfunction_bus_at(&ear->broken, now_us);
    return ear->broken.now.set;
}

TEST(each_kind_is_set_by_its_number_with_its_amount)
{
    static const double amounts[LM_MALFUNCTIONS] = {0, 12.5, 60, -170, 3.25, -30, 30, 0, -2, 28};
    struct ear ear = open_ear();
    assert_int_equal(set_at(&ear, 0), 0);
    for (uint8_t kind = 0; kind < LM_MALFUNCTIONS; kind++) {
        hear(&ear, 30, kind, amounts[kind], S);
        assert_int_equal(set_at(&ear, S), (2u << kind) - 1);
        assert_int_equal(ear.broken.now.amount_q8[kind], lround(amounts[kind] * 256));
    }
    const double stuck = lm_malfunction_bam(&ear.broken.now, LM_MALFUNCTION_STUCK);
    assert_true(fabs(stuck * 360 / 4294967296.0 + 170) < 1e-6);
    assert_int_equal(lm_malfunction_loss_db_q8(&ear.broken.now), LM_NO_TRANSMIT_DB_Q8);
    hear_clear(&ear, 0, S);
    assert_int_equal(lm_malfunction_loss_db_q8(&ear.broken.now), 12 * 256 + 128);
    assert_int_equal(lm_malfunction_loss_db_q8(NULL), 0);
}

TEST(they_end_when_cleared_one_by_one_or_all)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1, 10, S);
    hear(&ear, 30, 7, 0, S);
    hear(&ear, 30, 8, 2, S);
    hear_clear(&ear, 7, S);
    assert_int_equal(set_at(&ear, S), 1 << 1 | 1 << 8);
    hear_clear(&ear, 200, S); /* no kind */
    assert_int_equal(set_at(&ear, S), 1 << 1 | 1 << 8);
    assert_int_equal(ear.broken.count.refused, 1);
    hear_clear(&ear, 255, S);
    assert_int_equal(set_at(&ear, S), 0);
}

TEST(they_end_with_the_silence_of_their_sender)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1, 10, S);
    hear(&ear, 30, 2, 10, 3 * S);
    assert_int_equal(set_at(&ear, 4 * S), 6);
    assert_false(ear.broken.is_stale);
    assert_int_equal(set_at(&ear, 4 * S + 1), 6);
    assert_true(ear.broken.is_stale);
    assert_int_equal(set_at(&ear, 11 * S), 6);
    assert_int_equal(set_at(&ear, 11 * S + 1), 4);
    assert_int_equal(set_at(&ear, 13 * S + 1), 0);
    assert_false(ear.broken.is_stale);
}

TEST(what_no_radar_has_is_refused)
{
    static const struct {
        uint8_t kind;
        double value;
    } bad[] = {{1, -1}, {1, 61}, {2, 60.1}, {8, 31}, {9, 0}, {9, 29}, {10, 1}, {255, 1}};
    struct ear ear = open_ear();
    for (uint32_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        hear(&ear, 30, bad[i].kind, bad[i].value, S);
        assert_int_equal(ear.broken.count.refused, i + 1);
    }
    hear(&ear, 30, 3, 181, S); /* by its row already, as NaN is */
    hear(&ear, 30, 1, NAN, S);
    assert_int_equal(set_at(&ear, S), 0);
}

TEST(a_second_sender_is_not_heard_while_the_first_one_is)
{
    struct ear ear = open_ear();
    hear(&ear, 31, 1, 20, 0); /* nothing is in force: whoever comes */
    hear(&ear, 30, 1, 10, S);
    hear_clear(&ear, 255, S);
    assert_int_equal(ear.broken.count.rivals, 2);
    assert_int_equal(ear.broken.now.amount_q8[1], 20 * 256);
    hear(&ear, 30, 1, 10, 3 * S + 1);
    assert_int_equal(ear.broken.now.amount_q8[1], 10 * 256);
}

TEST(only_channel_0_is_heard)
{
    struct ear ear = open_ear();
    struct lm_can_frame f = bus_frame(1825 + 65536, LM_CANAS_FLOAT, 0, bus_float_bits(10), 0);
    f.is_extended = true;
    f.data[2] = 1;
    hear_frame(&ear, &f);
    assert_int_equal(set_at(&ear, 0), 0);
}

TEST(each_kind_has_its_amounts_to_both_ends_and_no_kind_comes_after_the_last)
{
    static const int16_t ends[LM_MALFUNCTIONS][2] = {
        {-180, 180}, {0, 60},     {0, 60},     {-180, 180}, {-180, 180},
        {-180, 180}, {-180, 180}, {-180, 180}, {-30, 30},   {1, 28}};
    struct ear ear = open_ear();
    for (uint8_t kind = 0; kind < LM_MALFUNCTIONS; kind++) {
        for (int end = 0; end < 2; end++) {
            hear(&ear, 30, kind, ends[kind][end], S);
            assert_int_equal(ear.broken.now.amount_q8[kind], ends[kind][end] * 256);
        }
    }
    assert_int_equal(ear.broken.count.refused, 0);
    hear_clear(&ear, LM_MALFUNCTIONS, S);
    assert_int_equal(ear.broken.count.refused, 1);
    hear_clear(&ear, LM_MALFUNCTIONS - 1, S);
    assert_int_equal(ear.broken.count.refused, 1);
}
