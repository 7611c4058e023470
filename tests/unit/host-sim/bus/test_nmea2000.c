/* NMEA 2000 by the table of the tree, beside canboat's decodes of the same traffic (data set
 * can_nmea2000). */
#include "bus/table_text.h"
#include "check.h"
#include "drv/can_log.h"
#include "lm/bus.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct bus_table table;

static FILE *open_data(const char *name)
{
    char path[512], whole[600];
    snprintf(whole, sizeof whole, "can_nmea2000/%s", name);
    FILE *in = support_data_path(whole, path, sizeof path) ? fopen(path, "r") : NULL;
    if (in == NULL) {
        printf("# skipped: the data set can_nmea2000 is not here\n");
        skip();
    }
    assert_int_equal(bus_table_load(&table, "host-sim/bus/nmea2000.bus"), 0);
    return in;
}

static double value_of(const struct lm_bus_event *e)
{
    const struct lm_bus_scale *s = lm_bus_scale_of((enum lm_bus_field)e->field);
    return e->value / (ldexp(s->multiplier, s->frac_bits) / s->divisor);
}

/* A field of ours, by the name that canboat has for it, and what its decode is rounded to. */
static const struct {
    const char *name;
    uint8_t field;
    double within;
} fields[] = {{"Latitude", LM_BUS_LATITUDE, 1.5e-7},
              {"Longitude", LM_BUS_LONGITUDE, 1.5e-7},
              {"SOG", LM_BUS_GROUND_SPEED, 0.0051},
              {"Heading", LM_BUS_MAGNETIC_HEADING, 0.051},
              {"Pitch", LM_BUS_PITCH, 0.051},
              {"Roll", LM_BUS_ROLL, 0.051},
              {"Altitude", LM_BUS_ELLIPSOID_HEIGHT, 0.01}};
enum { FIELDS = sizeof fields / sizeof *fields, VALUES = 1000 };

struct list {
    double value[VALUES];
    int count;
};

TEST(a_vessel_s_traffic_says_what_canboat_says)
{
    static struct list ours[FIELDS], theirs[FIELDS];
    FILE *in = open_data("candumpSample3.txt");
    struct drv_can_log log;
    struct lm_bus bus;
    drv_can_log_init(&log, in, NULL, NULL);
    drv_can_log_set_now(&log, UINT64_MAX);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    lm_bus_init(&bus, &table.profile);
    while (port.receive(port.ctx, &frame) == 1) {
        struct lm_bus_event events[LM_BUS_EVENTS];
        const uint32_t count = lm_bus_take(&bus, &frame, events);
        for (uint32_t k = 0; k < count; k++) {
            for (int i = 0; i < FIELDS; i++) {
                if (fields[i].field == events[k].field && ours[i].count < VALUES) {
                    ours[i].value[ours[i].count++] = value_of(&events[k]);
                }
            }
        }
    }
    fclose(in);
    char line[200], name[40];
    double value;
    in = open_data("derived_candumpSample3_decoded.csv");
    while (fgets(line, sizeof line, in) != NULL) {
        if (sscanf(line, "%*[^,],%*d,%*d,%39[^,],%lf", name, &value) == 2) {
            for (int i = 0; i < FIELDS; i++) {
                if (strcmp(fields[i].name, name) == 0 && theirs[i].count < VALUES) {
                    theirs[i].value[theirs[i].count++] = value;
                }
            }
        }
    }
    fclose(in);
    assert_int_equal(theirs[0].count, 165);
    assert_int_equal(theirs[3].count, 175);
    for (int i = 0; i < FIELDS; i++) {
        assert_int_equal(ours[i].count, theirs[i].count);
        for (int k = 0; k < ours[i].count; k++) {
            assert_true(fabs(ours[i].value[k] - theirs[i].value[k]) <= fields[i].within);
        }
    }
}

/* A line "time,priority,group,source,destination,bytes,data" as a frame. */
static bool read_plain(const char *line, struct lm_can_frame *f)
{
    unsigned priority, group, source, length, byte[8];
    const int read = sscanf(line, "%*[^,],%u,%u,%u,%*u,%u,%x,%x,%x,%x,%x,%x,%x,%x", &priority,
                            &group, &source, &length, &byte[0], &byte[1], &byte[2], &byte[3],
                            &byte[4], &byte[5], &byte[6], &byte[7]);
    *f = (struct lm_can_frame){
        .id = priority << 26 | group << 8 | source, .is_extended = true, .length = (uint8_t)length};
    for (int i = 0; i < 8 && read == 12; i++) {
        f->data[i] = (uint8_t)byte[i];
    }
    return read == 12;
}

/* canboat's own test of joining. It also keeps frames that come before frame 0, which one sender on
 * one bus cannot do: its fourth case is not joined here. */
TEST(fast_packets_are_joined_as_canboat_joins_them)
{
    FILE *in = open_data("tests_recombine-frames.in");
    struct lm_bus bus;
    int cases = 0, joined[8] = {0};
    double place[3] = {0};
    char line[300];
    bool was_remark = false;
    while (fgets(line, sizeof line, in) != NULL) {
        struct lm_can_frame frame;
        struct lm_bus_event events[LM_BUS_EVENTS];
        const bool is_remark = line[0] == '#';
        if (is_remark && !was_remark) {
            cases++;
            lm_bus_init(&bus, &table.profile); /* the cases share time and sequence */
        }
        was_remark = is_remark;
        if (is_remark || !read_plain(line, &frame)) {
            continue;
        }
        const uint32_t count = lm_bus_take(&bus, &frame, events);
        if (count == 0) {
            continue;
        }
        assert_int_equal(count, 3);
        joined[cases]++;
        for (int i = 0; i < 3; i++) {
            place[i] = value_of(&events[i]);
        }
        assert_true(fabs(place[0] - 42.4967684) < 3e-7);
        assert_true(fabs(place[1] - -71.5836637) < 3e-7);
        assert_true(fabs(place[2] - 90.984603) < 0.01);
    }
    fclose(in);
    assert_int_equal(cases, 6);
    assert_int_equal(joined[1], 1);
    assert_int_equal(joined[2], 1);
    assert_int_equal(joined[3], 1);
    assert_int_equal(joined[4], 0);
    assert_int_equal(joined[6], 1);
}

/* 106 frames are 14 messages, as the data set counts them. */
TEST(every_message_of_a_gateway_is_whole)
{
    FILE *in = open_data("actisense-522.candump.log");
    struct drv_can_log log;
    struct lm_fast_packet fast = {0};
    drv_can_log_init(&log, in, NULL, NULL);
    drv_can_log_set_now(&log, UINT64_MAX);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    int frames = 0;
    while (port.receive(port.ctx, &frame) == 1) {
        frames++;
        (void)lm_fast_packet_take(&fast, &frame);
    }
    fclose(in);
    assert_int_equal(frames, 106);
    assert_int_equal(fast.count.whole, 14);
    assert_int_equal(fast.count.torn + fast.count.stray, 0);
}
