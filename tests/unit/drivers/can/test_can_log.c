/* Recorded traffic: frames come when their time comes, and a bad line loses nothing but itself. */
#include "check.h"
#include "drv/can_log.h"
#include "support.h"

#include <string.h>
#include <zlib.h>

static struct lm_can_frame parsed(const char *line)
{
    struct lm_can_frame frame;
    const char *cause = drv_can_log_parse(line, &frame);
    if (cause != NULL) {
        fail_msg("%s: %s", line, cause);
    }
    return frame;
}

TEST(every_form_that_candump_writes_is_read)
{
    struct lm_can_frame f = parsed("(1436509052.249713) vcan0 40C#091E000040459E04");
    assert_int_equal(f.id, 0x40c);
    assert_true(f.time_us == 1436509052249713u);
    assert_false(f.is_extended || f.is_remote || f.is_error);
    assert_int_equal(f.length, 8);
    const uint8_t data[8] = {0x09, 0x1e, 0, 0, 0x40, 0x45, 0x9e, 0x04};
    assert_memory_equal(f.data, data, 8);

    f = parsed("(0.000001) can1 0001040c#10030000");
    assert_true(f.is_extended && f.id == 0x1040c && f.length == 4 && f.time_us == 1);
    f = parsed("(1.000000) can1 0000040C#");
    assert_true(f.is_extended && f.id == 0x40c && f.length == 0);
    f = parsed("(1.000000) can1 7FF#R");
    assert_true(f.is_remote && f.id == 0x7ff && f.length == 0);
    f = parsed("(1.000000) can1 1FFFFFFF#R8");
    assert_true(f.is_remote && f.is_extended && f.length == 8);
    f = parsed("(1.000000) can1 20000004#0001000000000000");
    assert_true(f.is_error && !f.is_extended && f.id == 4);
    f = parsed("(1.123456789) can1 123#00 T");
    assert_true(f.time_us == 1123456 && f.length == 1);
    parsed("  (1.000000)  slcan0\t123#0011 R\r");
}

TEST(every_other_line_is_refused_with_its_cause)
{
    static const struct {
        const char *line, *cause;
    } tests[] = {
        {"vcan0  40C   [8]  09 1E 00 00 40 45 9E 04", "no time stamp"},
        {"1.000000 can0 123#00", "no time stamp"},
        {"(1.00000) can0 123#00", "no time stamp"},
        {"(1) can0 123#00", "no time stamp"},
        {"(.000000) can0 123#00", "no time stamp"},
        {"(-1.000000) can0 123#00", "no time stamp"},
        {"(1.000000 can0 123#00", "no time stamp"},
        {"(1234567890123.000000) can0 123#00", "no time stamp"},
        {"(1.000000)can0 123#00", "no interface"},
        {"(1.000000) 123#00", "no interface"},
        {"(1.000000)", "no interface"},
        {"(1.000000) can0 ", "3 or 8"},
        {"(1.000000) can0 12#00", "3 or 8"},
        {"(1.000000) can0 1234#00", "3 or 8"},
        {"(1.000000) can0 012345678#00", "3 or 8"},
        {"(1.000000) can0 12G#00", "3 or 8"},
        {"(1.000000) can0 123", "3 or 8"},
        {"(1.000000) can0 800#00", "11 or 29"},
        {"(1.000000) can0 40000123#00", "11 or 29"},
        {"(1.000000) can0 80000123#00", "11 or 29"},
        {"(1.000000) can0 123##1112233", "CAN FD"},
        {"(1.000000) can0 123#0", "half a data byte"},
        {"(1.000000) can0 123#001", "half a data byte"},
        {"(1.000000) can0 123#112233445566778899", "more than 8"},
        {"(1.000000) can0 123#1122334455667788_A", "something follows"},
        {"(1.000000) can0 123#11.22", "something follows"},
        {"(1.000000) can0 123#R9", "something follows"},
        {"(1.000000) can0 123#11 X", "something follows"},
        {"(1.000000) can0 123#11 RT", "something follows"},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        struct lm_can_frame frame;
        const char *cause = drv_can_log_parse(tests[i].line, &frame);
        if (cause == NULL || strstr(cause, tests[i].cause) == NULL) {
            fail_msg("%s: %s", tests[i].line, cause ? cause : "taken");
        }
    }
}

struct reports {
    uint32_t line[8];
    size_t count;
};

static void note(void *ctx, uint32_t line, const char *cause)
{
    struct reports *r = ctx;
    assert_non_null(cause);
    assert_true(r->count < 8);
    r->line[r->count++] = line;
}

/* Open `text` for reading; its lifetime is the caller's. */
static FILE *file_of(const char *text)
{
    FILE *file = fmemopen((void *)(uintptr_t)text, strlen(text), "r");
    assert_non_null(file);
    return file;
}

TEST(bad_lines_are_reported_by_number_and_lose_only_themselves)
{
    static char text[2000];
    char long_name[600];
    memset(long_name, 'x', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = '\0';
    snprintf(text, sizeof text,
             "\n"
             "(5.000000) can0 001#\n"
             "garbage\n"
             "(5.000001) can0 002#00\r\n"
             "   \n"
             "(5.000002) %s 003#00\n"
             "(5.000003) can0 004##100\n"
             "(5.000004) can0 005#00",
             long_name);
    FILE *file = file_of(text);
    struct reports reports = {0};
    struct drv_can_log log;
    drv_can_log_init(&log, file, note, &reports);
    drv_can_log_set_now(&log, 1000000);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    const uint32_t ids[] = {1, 2, 5};
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(port.receive(port.ctx, &frame), 1);
        assert_int_equal(frame.id, ids[i]);
    }
    assert_false(drv_can_log_is_over(&log));
    assert_int_equal(port.receive(port.ctx, &frame), 0);
    assert_int_equal(port.receive(port.ctx, &frame), 0);
    assert_true(drv_can_log_is_over(&log));
    assert_int_equal(reports.count, 3);
    assert_int_equal(reports.line[0], 3);
    assert_int_equal(reports.line[1], 6);
    assert_int_equal(reports.line[2], 7);
    assert_int_equal(log.count.malformed, 3);
    assert_int_equal(log.count.frames, 3);
    assert_int_equal(log.count.lines, 8);
    fclose(file);
}

TEST(a_nul_in_a_line_makes_only_that_line_bad)
{
    static const char text[] = "(1.000000) can0 001#00\0 hidden\n(1.000000) can0 002#00\n";
    FILE *file = fmemopen((void *)(uintptr_t)text, sizeof text - 1, "r");
    assert_non_null(file);
    struct drv_can_log log;
    drv_can_log_init(&log, file, NULL, NULL);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    assert_int_equal(port.receive(port.ctx, &frame), 1);
    assert_int_equal(frame.id, 2);
    assert_int_equal(log.count.malformed, 1);
    fclose(file);
}

TEST(a_frame_comes_when_its_time_has_come_and_not_before)
{
    FILE *file = file_of(
        "(1700000000.500000) can0 001#\n"
        "(1700000000.500000) can0 002#\n"
        "(1700000000.600000) can0 003#\n");
    struct drv_can_log log;
    drv_can_log_init(&log, file, NULL, NULL);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    assert_int_equal(port.receive(port.ctx, &frame), 1);
    assert_true(frame.time_us == 0);
    assert_int_equal(port.receive(port.ctx, &frame), 1);
    assert_int_equal(frame.id, 2);
    drv_can_log_set_now(&log, 99999);
    assert_int_equal(port.receive(port.ctx, &frame), 0);
    assert_int_equal(port.receive(port.ctx, &frame), 0);
    drv_can_log_set_now(&log, 100000);
    assert_int_equal(port.receive(port.ctx, &frame), 1);
    assert_true(frame.id == 3 && frame.time_us == 100000);
    fclose(file);
}

TEST(a_log_can_begin_later)
{
    FILE *file = file_of(
        "(1700000000.500000) can0 001#\n"
        "(1700000000.600000) can0 002#\n"
        "(1700000000.700000) can0 003#\n");
    struct drv_can_log log;
    struct lm_can_frame frame;
    drv_can_log_init(&log, file, NULL, NULL);
    assert_int_equal(drv_can_log_skip(&log, 150000), LM_OK);
    const struct lm_can port = drv_can_log_port(&log);
    drv_can_log_set_now(&log, 49999);
    assert_int_equal(port.receive(port.ctx, &frame), 0);
    drv_can_log_set_now(&log, 50000);
    assert_int_equal(port.receive(port.ctx, &frame), 1);
    assert_true(frame.id == 3 && frame.time_us == 50000);
    rewind(file);
    drv_can_log_init(&log, file, NULL, NULL);
    assert_int_equal(drv_can_log_skip(&log, 200001), LM_OK);
    assert_true(drv_can_log_is_over(&log));
    fclose(file);
}

TEST(time_stamps_never_go_back)
{
    FILE *file = file_of(
        "(10.000000) can0 001#\n"
        "(9.000000) can0 002#\n"
        "(10.500000) can0 003#\n"
        "(10.400000) can1 004#\n"
        "(10.600000) can0 005#\n");
    static const uint64_t expected_us[] = {0, 0, 500000, 500000, 600000};
    struct drv_can_log log;
    drv_can_log_init(&log, file, NULL, NULL);
    drv_can_log_set_now(&log, UINT64_MAX);
    const struct lm_can port = drv_can_log_port(&log);
    for (size_t i = 0; i < 5; i++) {
        struct lm_can_frame frame;
        assert_int_equal(port.receive(port.ctx, &frame), 1);
        assert_int_equal(frame.id, i + 1);
        assert_true(frame.time_us == expected_us[i]);
    }
    assert_int_equal(log.count.backward, 2);
    fclose(file);
}

TEST(a_file_that_cannot_be_read_says_so_once)
{
    FILE *file = fopen("/", "r"); /* a folder opens, but does not read */
    assert_non_null(file);
    struct drv_can_log log;
    drv_can_log_init(&log, file, NULL, NULL);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    assert_int_equal(port.receive(port.ctx, &frame), LM_ERR_IO);
    assert_int_equal(port.receive(port.ctx, &frame), 0);
    assert_true(drv_can_log_is_over(&log));
    fclose(file);
}

TEST(a_log_of_another_program_is_read_whole)
{
    char path[512];
    if (!support_data_path("can_peer/peer_frames_3s.log.gz", path, sizeof path)) {
        skip();
    }
    FILE *file = tmpfile();
    gzFile packed = gzopen(path, "rb");
    assert_true(file != NULL && packed != NULL);
    char buffer[4096];
    for (int n; (n = gzread(packed, buffer, sizeof buffer)) > 0;) {
        assert_int_equal(fwrite(buffer, 1, (size_t)n, file), n);
    }
    gzclose(packed);
    rewind(file);
    struct drv_can_log log;
    drv_can_log_init(&log, file, NULL, NULL);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    uint32_t frames = 0;
    for (uint64_t now_us = 0; !drv_can_log_is_over(&log); now_us += 33333) {
        drv_can_log_set_now(&log, now_us);
        while (port.receive(port.ctx, &frame) == 1) {
            assert_true(frame.time_us <= now_us && frame.time_us + 33333 > now_us);
            frames++;
        }
    }
    assert_int_equal(frames, 3192);
    assert_int_equal(log.count.malformed, 0);
    assert_int_equal(log.count.backward, 0);
    fclose(file);
}
