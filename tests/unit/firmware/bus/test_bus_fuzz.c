/* Noise on the bus and in a log, under the sanitizers: nothing is read or written out of bounds,
 * nothing overflows, every frame is accounted for, and what comes out is always a possible
 * aircraft. */
#include "bus_frames.h"
#include "can_log_check.h"
#include "check.h"
#include "hs/rng.h"
#include "lm/bus.h"
#include "lm/nav.h"
#include "lm/status.h"
#include "lm/weather_bus.h"

#include <stdio.h>
#include <stdlib.h>

/* Anything at all, but often enough an identifier and a type that are taken. */
static struct lm_can_frame random_frame(struct hs_rng *rng, uint64_t time_us)
{
    static const uint8_t types[] = {2, 3, 12, 15, 30, 31, 0, 1};
    static const uint32_t words[] = {0,          0x80000000, 0x7fffffff, 0xffffffff, 0x7fc00000,
                                     0x7f800000, 0x7f7fffff, 0x00000001, 0x40567fff, 0xc0568000};
    const uint64_t dice = hs_rng_u64(rng);
    struct lm_can_frame frame = {.id = (uint32_t)hs_rng_u64(rng), .time_us = time_us};
    const uint64_t payload = hs_rng_u64(rng);
    memcpy(frame.data, &payload, sizeof frame.data);
    frame.length = (uint8_t)hs_rng_u64(rng);
    frame.is_extended = (dice & 0x100) != 0;
    if ((dice & 7) != 0) {
        frame.id = lm_bus_canas17.rows[hs_rng_below(rng, lm_bus_canas17.row_count)].id;
        frame.is_extended = (dice & 0xf00) == 0;
        frame.length = 8;
        frame.data[0] = (uint8_t)((dice >> 13 & 31) == 0 ? 0 : 9 + (dice >> 12 & 1));
        frame.data[1] = types[dice >> 18 & 7];
        frame.data[2] = (uint8_t)(dice >> 40 & 7);
        frame.data[3] = (uint8_t)(dice >> 21 & 3);
    }
    if ((dice >> 24 & 3) == 0) {
        const uint32_t word = words[hs_rng_below(rng, sizeof words / sizeof *words)];
        memcpy(frame.data + 4, &word, 4);
    }
    frame.is_error = (dice >> 28 & 63) == 0;
    frame.is_remote = (dice >> 34 & 63) == 0;
    return frame;
}

/* A whole set of weather, now and then with a wrong frame in it. */
static struct lm_can_frame set_frame(struct hs_rng *rng, uint32_t set, uint32_t part,
                                     uint64_t time_us)
{
    static const double values[] = {46, 11, 5000, 30, 46, 11, 20};
    const uint32_t kind = set % 3 == 0 ? 4 : 0, at = kind + part % (kind ? 3 : 4);
    struct lm_can_frame frame = bus_frame(1800 + at, LM_CANAS_FLOAT, (uint8_t)(set / 8),
                                          bus_float_bits(values[at]), time_us);
    frame.data[0] = (uint8_t)(9 + (set % 7 == 0));
    frame.data[2] = (uint8_t)(set % 5);
    if (hs_rng_below(rng, 30) == 0) {
        const uint32_t place = hs_rng_below(rng, 8);
        frame.data[place] = (uint8_t)hs_rng_u64(rng);
    }
    return frame;
}

static void assert_possible(const struct lm_ownship *o)
{
    const int32_t quarter = (int32_t)FX_BAM_90;
    assert_true((int32_t)o->latitude <= quarter && (int32_t)o->latitude >= -quarter);
    assert_true(o->pitch <= quarter && o->pitch >= -quarter);
    assert_true(o->height_m_q6 >= (-1000 - 2500) * 64 && o->height_m_q6 <= (30000 + 2500) * 64);
    assert_true(abs(o->velocity_north_mm_s) <= 1500000 && abs(o->velocity_east_mm_s) <= 1500000);
    assert_true(o->utc_s >= 0 && o->utc_s < 86400);
    assert_true(o->position_quality != LM_NAV_DEAD || (o->latitude == 0 && o->longitude == 0));
}

TEST(every_random_frame_is_accounted_for_and_the_ownship_stays_possible)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 21);
    /* On the heap, where the sanitizer watches their ends. */
    struct lm_bus *bus = malloc(sizeof *bus);
    struct lm_nav *nav = malloc(sizeof *nav);
    struct lm_weather_bus *weather = calloc(1, sizeof *weather);
    uint8_t nodes[LM_BUS_NODE_BYTES] = {0};
    memset(nodes, 0xff, sizeof nodes / 2); /* half of all nodes are heard */
    lm_bus_init(bus, &lm_bus_canas17);
    lm_bus_hear_only(bus, nodes);
    lm_nav_init(nav);
    uint64_t now_us = 0;
    for (int i = 0; i < 400000; i++) {
        const uint32_t kind = hs_rng_below(&rng, 1000);
        now_us = kind == 0 ? hs_rng_u64(&rng) : kind == 1 ? 0 : now_us + hs_rng_below(&rng, 3000);
        const struct lm_can_frame frame =
            i % 3 != 0 ? random_frame(&rng, now_us)
                       : set_frame(&rng, (uint32_t)i / 12, (uint32_t)i / 3 % 4, now_us);
        struct lm_bus_event events[LM_BUS_EVENTS];
        const uint32_t count = lm_bus_take(bus, &frame, events);
        for (uint32_t k = 0; k < count; k++) {
            lm_nav_take(nav, &events[k]);
            lm_weather_bus_take(weather, &events[k]);
        }
        struct lm_environment e = {0};
        lm_weather_bus_at(weather, now_us, &e);
        assert_int_equal(lm_environment_check(&e), LM_OK);
        struct lm_ownship ownship;
        lm_nav_at(nav, kind == 2 ? hs_rng_u64(&rng) : now_us, &ownship);
        assert_possible(&ownship);
    }
    uint32_t sum = 0;
    for (int i = 0; i < LM_BUS_OUTCOMES; i++) {
        assert_true(bus->count.outcome[i] > 0);
        sum += bus->count.outcome[i];
    }
    assert_int_equal(sum, 400000);
    assert_int_equal(bus->count.frames, 400000);
    print_message("# weather: %u sets, %u torn, %u of no slot, %u of rivals\n", weather->count.sets,
                  weather->count.torn, weather->count.numbers, weather->count.rivals);
    assert_true(weather->count.sets > 1000 && weather->count.torn > 1000 &&
                weather->count.numbers > 1000 && weather->count.rivals > 1000);
    free(weather);
    free(nav);
    free(bus);
}

/* Change, drop or double some characters of a good line. */
static size_t damage(struct hs_rng *rng, const char *line, char *out)
{
    static const char spice[] = "()#.RT 0f9GZ_\r\t\0##";
    size_t length = 0;
    for (const char *c = line; *c != '\0'; c++) {
        const uint32_t dice = hs_rng_below(rng, 200);
        if (dice == 0) {
            out[length++] = spice[hs_rng_below(rng, sizeof spice)];
        } else if (dice == 1) {
            out[length++] = (char)hs_rng_u64(rng);
        } else if (dice != 2) {
            out[length++] = *c;
        }
        if (dice == 3) {
            out[length++] = *c;
        }
    }
    if (hs_rng_below(rng, 100) == 0) { /* about as long as the reader's buffer */
        const size_t longer = 250 + hs_rng_below(rng, 10);
        memset(out + length, ' ', longer - length);
        length = longer;
    }
    out[length] = '\n';
    return length + 1;
}

TEST(a_damaged_log_is_read_to_its_end_and_every_line_is_counted)
{
    static const char *const lines[] = {
        "(1700006380.038625) vcan0 40C#091E00004047A001",
        "(1700006380.038750) can1 0001040C#1003000012345678",
        "(1700006380.038875) can0 20000004#0000000000000000",
        "(1700006380.039000) can0 123#R8",
        "(1700006380.039125) can0 123##1112233",
    };
    enum { LINES = 50000 };
    struct hs_rng rng;
    hs_rng_seed(&rng, 22);
    char *text = malloc((size_t)LINES * 264);
    size_t size = 0, line_feeds = 0;
    for (int i = 0; i < LINES; i++) {
        size += damage(&rng, lines[i % 5], text + size);
    }
    for (size_t i = 0; i < size; i++) {
        line_feeds += text[i] == '\n';
    }
    struct drv_can_log log;
    const char *wrong = can_log_check(text, size, &log);
    if (wrong) {
        fail_msg("%s", wrong);
    }
    assert_int_equal(log.count.lines, line_feeds);
    assert_true(log.count.frames > LINES / 8 && log.count.malformed > LINES / 8);
    free(text);
}
