/* The display as a node of CANaerospace: what it answers, when, and what it refuses. */
#include "bus_frames.h"
#include "check.h"
#include "drv/can_log.h"
#include "lm/canas_service.h"
#include "support.h"

#include <stdio.h>
#include <zlib.h>

/* A bus that keeps what is sent. */
struct wire {
    struct lm_can_frame sent[64];
    int count;
    int answer; /* what send says */
};

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct wire *w = ctx;
    if (w->answer == LM_OK) {
        assert_in_range(w->count, 0, 63);
        w->sent[w->count++] = *frame;
    }
    return w->answer;
}

static struct lm_can port_of(struct wire *w)
{
    return (struct lm_can){.ctx = w, .send = send_frame};
}

enum { NODE = 20 };

static struct lm_canas_service begin(void)
{
    struct lm_canas_service s;
    lm_canas_service_init(&s, NODE, 3, 0x12);
    return s;
}

static struct lm_can_frame request(uint8_t node, uint8_t service, uint64_t time_us)
{
    return (struct lm_can_frame){
        .id = 128, .length = 4, .data = {node, 0, service, 0}, .time_us = time_us};
}

static void ask(struct lm_canas_service *s, uint8_t node, uint8_t service, uint64_t time_us)
{
    const struct lm_can_frame frame = request(node, service, time_us);
    lm_canas_service_take(s, &frame);
}

TEST(identification_is_answered_at_once_to_itself_and_to_all)
{
    const uint8_t nodes[] = {NODE, 0};
    for (int i = 0; i < 2; i++) {
        struct lm_canas_service s = begin();
        struct wire w = {.answer = LM_OK};
        const struct lm_can can = port_of(&w);
        ask(&s, nodes[i], LM_CANAS_IDS, 1000);
        lm_canas_service_answer(&s, &can, 0, 1000);
        assert_int_equal(w.count, 1);
        assert_true(w.sent[0].id == 129 && w.sent[0].length == 8 && !w.sent[0].is_extended);
        assert_memory_equal(w.sent[0].data, "\x14\x10\0\0\x03\x12\0\0", 8);
        lm_canas_service_answer(&s, &can, 0, 50000);
        assert_int_equal(w.count, 1);
    }
}

/* The other library's own request and answer, on the wire. */
TEST(the_answer_has_the_form_of_another_librarys)
{
    char path[512];
    if (!support_data_path("can_peer/peer_frames_3s.log.gz", path, sizeof path)) {
        skip();
    }
    struct lm_canas_service s;
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    lm_canas_service_init(&s, 9, 12, 22); /* as that node calls itself */
    gzFile file = gzopen(path, "rb");
    char line[256];
    int answers = 0;
    while (gzgets(file, line, sizeof line) != NULL && answers == 0) {
        struct lm_can_frame frame;
        assert_null(drv_can_log_parse(strtok(line, "\n"), &frame));
        if (frame.id == 129) {
            lm_canas_service_answer(&s, &can, 0, frame.time_us);
            assert_int_equal(w.count, 1);
            assert_int_equal(w.sent[0].length, frame.length);
            assert_memory_equal(w.sent[0].data, frame.data, 8);
            answers++;
        }
        lm_canas_service_take(&s, &frame);
    }
    gzclose(file);
    assert_int_equal(answers, 1);
    assert_true(s.has_sync && s.sync_stamp == 305419896 && s.count.elsewhere == 1);
}

TEST(state_transmission_sends_the_state_with_a_rising_code)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    for (uint64_t i = 0; i < 3; i++) {
        ask(&s, 0, LM_CANAS_STS, i * 20000);
        lm_canas_service_answer(&s, &can, 0x01020304, i * 20000);
    }
    assert_int_equal(w.count, 3);
    for (uint8_t i = 0; i < 3; i++) {
        const uint8_t bytes[8] = {NODE, 5, 0, i, 1, 2, 3, 4};
        assert_true(w.sent[i].id == 1500 && w.sent[i].length == 8);
        assert_memory_equal(w.sent[i].data, bytes, 8);
    }
}

TEST(a_time_stamp_is_taken_and_not_answered)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    struct lm_can_frame sync = {.id = 128,
                                .length = 8,
                                .data = {0, 4, LM_CANAS_NSS, 0, 0x12, 0x34, 0x56, 0x78},
                                .time_us = 5000};
    lm_canas_service_take(&s, &sync);
    assert_true(s.has_sync && s.sync_stamp == 0x12345678 && s.sync_us == 5000);
    sync.length = 7;
    lm_canas_service_take(&s, &sync);
    sync.length = 8;
    sync.data[1] = 3;
    lm_canas_service_take(&s, &sync);
    assert_int_equal(s.count.malformed, 2);
    lm_canas_service_answer(&s, &can, 0, 5000);
    assert_int_equal(w.count, 0);
}

TEST(every_other_service_is_refused_in_silence_and_counted)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    const struct lm_canas_service before = s;
    uint32_t refused = 0;
    for (int service = 0; service < 256; service++) {
        if (service != LM_CANAS_IDS && service != LM_CANAS_NSS && service != LM_CANAS_STS) {
            ask(&s, NODE, (uint8_t)service, 0);
            refused++;
        }
    }
    lm_canas_service_answer(&s, &can, 0, 0);
    assert_int_equal(s.count.refused, refused);
    assert_int_equal(w.count, 0);
    s.count = before.count;
    assert_memory_equal(&s, &before, sizeof s); /* nothing else has changed */
}

TEST(what_is_for_others_or_no_request_is_left_alone)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    ask(&s, 21, LM_CANAS_IDS, 0);
    assert_int_equal(s.count.elsewhere, 1);
    struct lm_can_frame f[7];
    for (int i = 0; i < 7; i++) {
        f[i] = request(NODE, LM_CANAS_IDS, 0);
    }
    f[0].is_remote = true;
    f[1].is_error = true;
    f[2].is_extended = true;
    f[3].id = 130; /* service channel 1 */
    f[4].length = 3;
    f[5].data[1] = LM_CANAS_FLOAT; /* a request with data */
    f[6].length = 9;               /* more than CAN carries */
    for (int i = 0; i < 7; i++) {
        lm_canas_service_take(&s, &f[i]);
    }
    lm_canas_service_answer(&s, &can, 0, 0);
    assert_int_equal(w.count, 0);
    assert_int_equal(s.count.malformed, 3);
    struct lm_can_frame with_data = request(NODE, LM_CANAS_STS, 0);
    with_data.data[1] = LM_CANAS_FLOAT;
    lm_canas_service_take(&s, &with_data);
    assert_int_equal(s.count.malformed, 4);
    const struct lm_can deaf = {.ctx = &w};
    ask(&s, NODE, LM_CANAS_IDS, 0);
    lm_canas_service_answer(&s, &deaf, 0, 0); /* a display without a bus */
    assert_int_equal(w.count, 0);

    struct lm_canas_service silent;
    lm_canas_service_init(&silent, 0, 0, 0);
    ask(&silent, 0, LM_CANAS_IDS, 0);
    lm_canas_service_answer(&silent, &can, 0, 0);
    assert_int_equal(w.count, 0);
    lm_canas_service_tell_state(&silent, 0); /* no node has no state to tell */
    lm_canas_service_answer(&silent, &can, 0, 0);
    assert_int_equal(w.count, 0);
}

TEST(a_state_is_told_unasked_and_once)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    lm_canas_service_tell_state(&s, 1000);
    lm_canas_service_answer(&s, &can, 7, 1000);
    assert_int_equal(w.count, 1);
    assert_int_equal(w.sent[0].id, LM_CANAS_STATE_ID);
    assert_memory_equal(w.sent[0].data, "\x14\5\0\0\0\0\0\7", 8);
    lm_canas_service_answer(&s, &can, 7, 50000);
    assert_int_equal(w.count, 1);
    assert_int_equal(s.count.asked[2], 0); /* nobody has asked */
}

TEST(an_answer_waits_100_ms_for_the_bus_and_no_longer)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_BUSY};
    const struct lm_can can = port_of(&w);
    ask(&s, 0, LM_CANAS_IDS, 1000);
    for (uint64_t t = 1000; t <= 100000; t += 3000) {
        lm_canas_service_answer(&s, &can, 0, t);
    }
    w.answer = LM_OK;
    lm_canas_service_answer(&s, &can, 0, 101000);
    assert_int_equal(w.count, 1);

    w.answer = LM_ERR_IO;
    ask(&s, 0, LM_CANAS_IDS, 200000);
    lm_canas_service_answer(&s, &can, 0, 200000);
    w.answer = LM_OK;
    lm_canas_service_answer(&s, &can, 0, 300001);
    assert_int_equal(w.count, 1);
    assert_int_equal(s.count.late, 1);
    /* A request from a clock that was set back does not wait for ever. */
    ask(&s, 0, LM_CANAS_IDS, 900000000);
    lm_canas_service_answer(&s, &can, 0, 400000);
    assert_int_equal(s.count.late, 2);
    const struct lm_can deaf = {.ctx = &w};
    ask(&s, 0, LM_CANAS_IDS, 500000);
    lm_canas_service_answer(&s, &deaf, 0, 500000); /* a board that cannot send */
    assert_int_equal(w.count, 1);
}

TEST(a_clock_that_was_set_back_does_not_silence_the_display)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    ask(&s, 0, LM_CANAS_IDS, 900000000);
    lm_canas_service_answer(&s, &can, 0, 900000000);
    assert_int_equal(w.count, 1);
    ask(&s, 0, LM_CANAS_IDS, 1000);
    lm_canas_service_answer(&s, &can, 0, 1000);
    assert_int_equal(w.count, 2);
    ask(&s, 0, LM_CANAS_IDS, 1001);
    lm_canas_service_answer(&s, &can, 0, 1001); /* from here on the pause counts again */
    assert_int_equal(w.count, 2);
}

TEST(a_flood_of_requests_is_no_flood_of_answers)
{
    struct lm_canas_service s = begin();
    struct wire w = {.answer = LM_OK};
    const struct lm_can can = port_of(&w);
    for (uint64_t t = 0; t < 200000; t += 125) {
        ask(&s, 0, t % 250 ? LM_CANAS_IDS : LM_CANAS_STS, t);
        if (t % 2000 == 0) {
            lm_canas_service_answer(&s, &can, 0, t);
        }
    }
    assert_int_equal(w.count, 20); /* one each 10 ms */
    assert_int_equal(s.count.asked[0] + s.count.asked[2], 1600);
    assert_int_equal(s.count.late, 0);
    int identities = 0;
    for (int i = 0; i < w.count; i++) {
        identities += w.sent[i].id == 129;
    }
    assert_in_range(identities, 1, 19); /* neither keeps the other from being answered */
}
