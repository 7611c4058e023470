/* The frames are byte for byte what an independent CANaerospace library sends for the same values.
 */
#include "check.h"
#include "decode.h"
#include "nav/canas.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One row of the peer's list of what its frames carry. */
struct expected {
    int64_t time_us;
    double value;
    char type[16];
    uint32_t id;
    unsigned node, code;
};

static bool read_expected(const char *line, struct expected *e)
{
    long long seconds, micros;
    char field[32], unit[16];
    unsigned service, channel;
    /* The unit may be empty, which %[ would not match; such rows carry no value either. */
    if (sscanf(line, "%lld.%6lld,%31[^,],%lf,%15[^,],%15[^,],%u,%u,%u,%u,%u", &seconds, &micros,
               field, &e->value, unit, e->type, &e->id, &e->node, &service, &e->code,
               &channel) != 11) {
        return false;
    }
    e->time_us = seconds * 1000000 + micros;
    return true;
}

static FILE *open_peer(const char *name)
{
    char path[512], command[600];
    if (!support_data_path(name, path, sizeof path)) {
        skip();
    }
    snprintf(command, sizeof command, "gzip -dc '%s'", path);
    FILE *f = popen(command, "r");
    assert_non_null(f);
    return f;
}

static const struct decoded_frame *find(const struct decoded_log *log, int64_t time_us, uint32_t id)
{
    for (int i = 0; i < log->count; i++) {
        if (log->frame[i].time_us == time_us && log->frame[i].id == id) {
            return &log->frame[i];
        }
    }
    fail_msg("the peer's log has no frame of identifier %u then", id);
    return NULL;
}

/* What we send for the peer's value. The redundancy channel is in the identifier's upper bits,
 * which we do not send, and leaves the data alone. */
static struct canas_frame ours(const struct expected *e, const struct decoded_frame *theirs)
{
    struct canas_codes codes = {{0}};
    const uint16_t id = (uint16_t)(e->id % 65536);
    const uint8_t node = (uint8_t)e->node;
    codes.next[id] = (uint8_t)e->code;
    if (strcmp(e->type, "FLOAT") == 0) {
        return canas_float(&codes, id, node, e->value);
    }
    if (strcmp(e->type, "LONG_1E-7") == 0) {
        return canas_long(&codes, id, node, (int32_t)lround(e->value * 1e7));
    }
    if (strcmp(e->type, "SHORT2") == 0) {
        return canas_short2(&codes, id, node, e->value,
                            (int16_t)(theirs->data[6] << 8 | theirs->data[7]));
    }
    const int n = (int)e->value;
    const uint8_t clock[4] = {(uint8_t)(n / 3600), (uint8_t)(n / 60 % 60), (uint8_t)(n % 60), 0};
    const uint8_t date[4] = {(uint8_t)(n % 100), (uint8_t)(n / 100 % 100), (uint8_t)(n / 1000000),
                             (uint8_t)(n / 10000 % 100)};
    return canas_char4(&codes, id, node, id == CANAS_UTC ? clock : date);
}

TEST(our_frames_are_the_peers_byte_for_byte)
{
    struct decoded_log log;
    FILE *frames = open_peer("can_peer/peer_frames_3s.log.gz");
    assert_true(decode_log(frames, &log));
    pclose(frames);
    FILE *rows = open_peer("can_peer/peer_expected_3s.csv.gz");
    char line[256];
    struct expected e;
    int floats = 0, longs = 0, shorts = 0, chars = 0;
    while (fgets(line, sizeof line, rows)) {
        if (!read_expected(line, &e) || strcmp(e.type, "DOUBLEH+L") == 0) {
            continue;
        }
        const struct decoded_frame *theirs = find(&log, e.time_us, e.id);
        const struct canas_frame f = ours(&e, theirs);
        assert_int_equal(f.length, theirs->length);
        assert_memory_equal(f.data, theirs->data, f.length);
        floats += e.type[0] == 'F';
        longs += e.type[0] == 'L';
        shorts += e.type[0] == 'S';
        chars += e.type[0] == 'C';
    }
    pclose(rows);
    decode_free(&log);
    assert_in_range(floats, 2800, 3500);
    assert_int_equal(longs, 60);
    assert_int_equal(shorts, 60);
    assert_int_equal(chars, 6);
}

/* The list prints doubles to twelve digits only, so that the bytes come from the peer's own pairs
 * and the list tells that they were joined the right way round. */
TEST(our_pairs_of_doubles_are_the_peers)
{
    struct decoded_log log;
    FILE *frames = open_peer("can_peer/peer_frames_3s.log.gz");
    assert_true(decode_log(frames, &log));
    pclose(frames);
    int pairs = 0;
    for (int i = 0; i + 1 < log.count; i++) {
        double value;
        const struct decoded_frame *theirs = &log.frame[i];
        if (theirs->data[1] != CANAS_DOUBLEH || !decode_pair(theirs, theirs + 1, &value)) {
            continue;
        }
        struct canas_codes codes = {{0}};
        struct canas_frame pair[2];
        codes.next[theirs->id] = theirs->data[3];
        canas_double(&codes, (uint16_t)theirs->id, theirs->data[0], value, pair);
        assert_memory_equal(pair[0].data, theirs[0].data, 8);
        assert_memory_equal(pair[1].data, theirs[1].data, 8);
        assert_true(theirs->id == CANAS_GPS_LATITUDE ? fabs(value - 47.25) < 0.01
                                                     : fabs(value - 11.39) < 0.1);
        pairs++;
    }
    decode_free(&log);
    assert_int_equal(pairs, 60);
}

/* The specification's own example: $4000 at a scale of 1500 is 750 K. */
TEST(a_short_pair_carries_the_specifications_example)
{
    struct canas_codes codes = {{0}};
    const struct canas_frame f = canas_short2(&codes, 324, 2, 750.0229, 1500);
    const uint8_t wanted[8] = {2, 12, 0, 0, 0x40, 0x00, 0x05, 0xDC};
    assert_memory_equal(f.data, wanted, 8);
    const struct canas_frame over = canas_short2(&codes, 324, 2, -9000, 1500);
    assert_int_equal(over.data[4] << 8 | over.data[5], 0x8001);
}

TEST(message_codes_count_for_each_identifier_and_begin_again_after_255)
{
    struct canas_codes codes = {{0}};
    for (int i = 0; i < 600; i++) {
        assert_int_equal(canas_float(&codes, 311, 1, 0).data[3], i % 256);
        if (i % 3 == 0) {
            assert_int_equal(canas_float(&codes, 312, 1, 0).data[3], i / 3 % 256);
        }
    }
    struct canas_frame pair[2];
    codes.next[1036] = 255;
    canas_double(&codes, 1036, 9, 1, pair);
    assert_int_equal(pair[0].data[3], 255);
    assert_int_equal(pair[1].data[3], 0);
}

TEST(a_line_is_what_candump_writes)
{
    char line[CANAS_LINE_MAX];
    const struct canas_frame f = {
        .id = 0x40C, .length = 8, .data = {9, 2, 0, 0, 0x12, 0x34, 0x56, 0x78}};
    const size_t n = canas_candump_line(line, &f, INT64_C(1436509052249713), "can0");
    assert_string_equal(line, "(1436509052.249713) can0 40C#0902000012345678");
    assert_int_equal(n, strlen(line));
    canas_candump_line(line, &f, 7, "a23456789012345");
    assert_string_equal(line, "(0.000007) a23456789012345 40C#0902000012345678");
}
