/* Recorded traffic of simulators that others wrote, against what tshark's dissector and PROJ made
 * of it (the derived_* files beside the recordings). */
#include "check.h"
#include "dis/capture.h"
#include "dis/earth.h"
#include "dis/pdu.h"
#include "dis/reckon.h"
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a recording holds, and its states one after the other. */
struct walk {
    struct dis_capture capture;
    struct dis_packet packet;
    struct dis_datagram datagram;
    int64_t first_us;
    unsigned datagrams, of_type[256], broken[DIS_FAULT_COUNT];
};

static void open_walk(struct walk *w, const char *name)
{
    char path[512];
    if (!support_data_path(name, path, sizeof path)) {
        skip();
    }
    *w = (struct walk){.datagrams = 0};
    assert_int_equal(dis_capture_open(&w->capture, path), 0);
}

static bool next_state(struct walk *w, struct dis_entity_state *s)
{
    struct dis_pdu pdu;
    enum dis_fault fault;
    for (;;) {
        const enum dis_step step = dis_datagram_next(&w->datagram, &pdu, &fault);
        if (step == DIS_STEP_PDU) {
            w->of_type[pdu.type]++;
            if (pdu.type == DIS_ENTITY_STATE) {
                assert_int_equal(dis_entity_state_read(&pdu, s), DIS_FAULT_NONE);
                return true;
            }
            continue;
        }
        if (step == DIS_STEP_BROKEN) {
            w->broken[fault]++;
        }
        if (dis_capture_next(&w->capture, &w->packet) != 1) {
            return false;
        }
        w->first_us = w->datagrams++ == 0 ? w->packet.time_us : w->first_us;
        dis_datagram_begin(&w->datagram, w->packet.bytes, w->packet.length);
    }
}

/* A row of the peers' list. */
struct row {
    double time_s, velocity[3], place[3], angles[3], latitude_deg, longitude_deg, height_m;
};

static bool read_row(FILE *csv, struct row *r)
{
    char line[512];
    return fgets(line, sizeof line, csv) != NULL &&
           sscanf(line,
                  "%*d,%lf,%*d,%*d,%*d,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%*[^,],%lf,%lf,%lf",
                  &r->time_s, &r->velocity[0], &r->velocity[1], &r->velocity[2], &r->place[0],
                  &r->place[1], &r->place[2], &r->angles[0], &r->angles[1], &r->angles[2],
                  &r->latitude_deg, &r->longitude_deg, &r->height_m) == 13;
}

/* The peers print six figures of a float, all of a double, and 8 decimals of a degree. */
static void check_row(const struct dis_entity_state *s, const struct row *r)
{
    const double angles[3] = {s->motion.psi_rad, s->motion.theta_rad, s->motion.phi_rad};
    const struct dis_place place = dis_place_of(s->motion.place_m);
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(s->motion.place_m[i] - r->place[i]) < 1e-7);
        assert_true(fabs(s->motion.velocity_m_s[i] - r->velocity[i]) < 1e-4);
        assert_true(fabs(angles[i] - r->angles[i]) < 1e-5);
    }
    assert_true(fabs(place.latitude_deg - r->latitude_deg) < 0.6e-8);
    assert_true(fabs(place.longitude_deg - r->longitude_deg) < 0.6e-8);
    assert_true(fabs(place.height_m - r->height_m) < 0.6e-3);
    assert_string_equal(s->marking, "UtilVeh 1");
}

static void compare_with_peers(struct walk *w, const char *recording, const char *list)
{
    char path[512], head[512];
    struct dis_entity_state s;
    struct row r;
    open_walk(w, recording);
    assert_true(support_data_path(list, path, sizeof path));
    FILE *csv = fopen(path, "r");
    assert_non_null(csv);
    assert_non_null(fgets(head, sizeof head, csv));
    while (next_state(w, &s)) {
        assert_true(read_row(csv, &r));
        check_row(&s, &r);
        assert_true(fabs((double)(w->packet.time_us - w->first_us) * 1e-6 - r.time_s) < 2e-6);
    }
    assert_false(read_row(csv, &r));
    fclose(csv);
    dis_capture_close(&w->capture);
}

#define HAWAII "dis_hawaii_vehicle/derived_"

TEST(a_drive_round_blocks_is_where_tshark_and_gdal_have_it)
{
    struct walk w;
    compare_with_peers(&w, HAWAII "GAZ69MultipleBlocksBase64.pcap",
                       HAWAII "GAZ69MultipleBlocksBase64_entity_state.csv");
    assert_int_equal(w.datagrams, 1280);
    assert_true(w.of_type[1] == 716 && w.of_type[72] == 829 && w.of_type[20] == 78);
    assert_true(w.of_type[25] == 79 && w.of_type[41] == 404 && w.of_type[27] == 3);
    for (int fault = 1; fault < DIS_FAULT_COUNT; fault++) {
        assert_int_equal(w.broken[fault], 0);
    }
}

TEST(a_turn_is_too_and_the_pdu_that_its_recorder_cut_is_refused)
{
    struct walk w;
    compare_with_peers(&w, HAWAII "Entity90DegreesTurnBase64.pcap",
                       HAWAII "Entity90DegreesTurnBase64_entity_state.csv");
    assert_true(w.datagrams == 197 && w.of_type[1] == 100);
    assert_int_equal(w.broken[DIS_FAULT_TRUNCATED], 1);
}

static double apart_m(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* The sender itself sends a new state when its own dead reckoning is off by more than its
 * threshold. Ours, of the same model, must not be further off at that moment. */
TEST(dead_reckoning_meets_the_senders_next_state_of_a_moving_vehicle)
{
    struct walk w;
    struct dis_entity_state s, before;
    int64_t before_us = 0;
    double worst_m = 0, worst_still_m = 0;
    unsigned moving = 0;
    open_walk(&w, HAWAII "GAZ69MultipleBlocksBase64.pcap");
    for (bool has_before = false; next_state(&w, &s); has_before = true) {
        if (has_before && !before.motion.is_frozen) {
            const double after_s = (double)(w.packet.time_us - before_us) * 1e-6;
            const struct dis_state there = dis_reckon(&before.motion, after_s);
            worst_m = fmax(worst_m, apart_m(there.place_m, s.motion.place_m));
            worst_still_m = fmax(worst_still_m, apart_m(before.motion.place_m, s.motion.place_m));
            moving++;
        }
        before = s;
        before_us = w.packet.time_us;
    }
    dis_capture_close(&w.capture);
    print_message("# %u moving: at most %.2f m off, %.2f m without\n", moving, worst_m,
                  worst_still_m);
    assert_true(moving > 500 && worst_m < 1.5 && worst_still_m > 5 * worst_m);
}

static size_t read_raw(const char *name, uint8_t *bytes, size_t room)
{
    char relative[200], path[512];
    snprintf(relative, sizeof relative, "dis_single_pdus/%s.raw", name);
    if (!support_data_path(relative, path, sizeof path)) {
        skip();
    }
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    const size_t length = fread(bytes, 1, room, in);
    fclose(in);
    return length;
}

static void read_single(const char *name, struct dis_entity_state *s)
{
    uint8_t bytes[2048];
    struct dis_datagram d;
    struct dis_pdu pdu;
    enum dis_fault fault;
    dis_datagram_begin(&d, bytes, read_raw(name, bytes, sizeof bytes));
    assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_PDU);
    assert_int_equal(dis_entity_state_read(&pdu, s), DIS_FAULT_NONE);
    assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_END);
}

TEST(single_pdus_of_two_simulators_are_what_their_collectors_say)
{
    struct dis_entity_state s;
    read_single("EntityStatePdu-26", &s);
    struct dis_place place = dis_place_of(s.motion.place_m);
    assert_true(s.id.site == 42 && s.id.application == 4 && s.id.entity == 26 && s.force == 1);
    assert_true(s.type.country == 39 && s.type.category == 7 && s.type.subcategory == 2);
    assert_true(fabs(place.latitude_deg - 42.8824810) < 1e-7 &&
                fabs(place.longitude_deg - 20.8700441) < 1e-7 &&
                fabs(place.height_m - 499.384) < 1e-3);
    assert_string_equal(s.marking, "26");
    read_single("EntityStatePdu-vbs-articulated-parameters", &s);
    place = dis_place_of(s.motion.place_m);
    assert_true(s.id.site == 1425 && s.id.application == 2850 && s.id.entity == 1);
    assert_true(s.type.country == 20000 && s.type.specific == 3 && s.type.extra == 243);
    assert_true(fabs(place.latitude_deg - 51.2287099) < 1e-7 &&
                fabs(place.longitude_deg + 2.1456368) < 1e-7 &&
                fabs(place.height_m - 201.070) < 1e-3);
}

TEST(valid_pdus_that_are_no_entities_are_stepped_over)
{
    static const char *const names[] = {"AggregateStatePduVrForces",
                                        "ElectromagneticEmissionPdu",
                                        "ReceiverPdu",
                                        "SetDataPdu-vbs-script-cmd",
                                        "SetDataPdu-multi-variable-datums",
                                        "SignalPdu",
                                        "TransmitterPdu",
                                        "TransmitterPdu-HAVEQUICK"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        uint8_t bytes[2048];
        struct dis_datagram d;
        struct dis_pdu pdu;
        enum dis_fault fault;
        dis_datagram_begin(&d, bytes, read_raw(names[i], bytes, sizeof bytes));
        assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_PDU);
        assert_true(pdu.type != DIS_ENTITY_STATE && pdu.length == d.length);
    }
}
