/* PDUs made from the standard's tables are read field by field, and what is odd is refused by name.
 */
#include "check.h"
#include "dis/pdu.h"
#include "make_pdu.h"

#include <math.h>
#include <string.h>

/* Read the only PDU of a datagram as an entity's state. */
static enum dis_fault read_state(const struct made *m, struct dis_entity_state *state)
{
    struct dis_datagram d;
    struct dis_pdu pdu;
    enum dis_fault fault = DIS_FAULT_NONE;
    dis_datagram_begin(&d, m->bytes, m->length);
    assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_PDU);
    return dis_entity_state_read(&pdu, state);
}

static enum dis_fault fault_of(const struct made_entity *e)
{
    struct made m = {.length = 0};
    struct dis_entity_state state;
    made_entity_state(&m, e);
    return read_state(&m, &state);
}

TEST(an_entity_state_is_144_bytes_and_each_field_is_read_from_its_place)
{
    struct made m = {.length = 0};
    struct dis_entity_state s;
    const struct made_entity e = {.version = 6,
                                  .exercise = 9,
                                  .id = {258, 772, 1286},
                                  .force = 3,
                                  .kind = 1,
                                  .domain = 2,
                                  .country = 513,
                                  .category = 4,
                                  .subcategory = 5,
                                  .specific = 6,
                                  .extra = 7,
                                  .velocity = {1.5F, -2.5F, 3.5F},
                                  .place = {4374082.8, 1667679.9, 4318284.3},
                                  .orientation = {0.25F, 0.5F, 0.75F},
                                  .appearance = 1U << 21,
                                  .algorithm = 8,
                                  .acceleration = {0.5F, 0.25F, 0.125F},
                                  .turn = {-0.5F, -0.25F, -0.125F},
                                  .marking = "UtilVeh 1"};
    made_entity_state(&m, &e);
    assert_int_equal(m.length, 144);
    assert_int_equal(read_state(&m, &s), DIS_FAULT_NONE);
    assert_true(s.id.site == 258 && s.id.application == 772 && s.id.entity == 1286);
    assert_int_equal(s.force, 3);
    assert_true(s.type.kind == 1 && s.type.domain == 2 && s.type.country == 513);
    assert_true(s.type.category == 4 && s.type.subcategory == 5 && s.type.specific == 6 &&
                s.type.extra == 7);
    for (int i = 0; i < 3; i++) {
        assert_true(s.motion.velocity_m_s[i] == (double)e.velocity[i]);
        assert_true(s.motion.place_m[i] == e.place[i]);
        assert_true(s.motion.acceleration_m_s2[i] == (double)e.acceleration[i]);
        assert_true(s.motion.turn_rad_s[i] == (double)e.turn[i]);
    }
    assert_true(s.motion.psi_rad == 0.25 && s.motion.theta_rad == 0.5 && s.motion.phi_rad == 0.75);
    assert_true(s.motion.algorithm == 8 && s.motion.is_frozen && !s.is_deactivated && !s.is_update);
    assert_string_equal(s.marking, "UtilVeh 1");
}

TEST(an_update_has_the_motion_and_not_the_type)
{
    struct made m = {.length = 0};
    struct dis_entity_state s;
    struct made_entity e = made_vehicle(5);
    e.velocity[1] = 7;
    e.appearance = 1U << 23;
    made_update(&m, &e);
    assert_int_equal(m.length, 72);
    assert_int_equal(read_state(&m, &s), DIS_FAULT_NONE);
    assert_true(s.is_update && s.is_deactivated && s.id.entity == 5);
    assert_true(s.motion.velocity_m_s[1] == 7.0 && s.motion.place_m[0] == 6378137.0);
}

TEST(a_bundle_is_stepped_through_by_the_length_of_each_pdu)
{
    struct made m = {.length = 0};
    struct made_entity e = made_vehicle(1);
    e.records = 3;
    made_entity_state(&m, &e);
    made_other(&m, 72, 720); /* an Attribute PDU behind it, as VR-Forces sends */
    e.id[2] = 2;
    made_entity_state(&m, &e);
    memset(m.bytes + m.length, 0, 4); /* filled up */
    struct dis_datagram d;
    struct dis_pdu pdu;
    enum dis_fault fault;
    static const uint8_t types[] = {1, 72, 1};
    dis_datagram_begin(&d, m.bytes, m.length + 4);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_PDU);
        assert_int_equal(pdu.type, types[i]);
    }
    assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_END);
}

/* The fate of the first step into these bytes. */
static enum dis_fault first_fault(const uint8_t *bytes, size_t length)
{
    struct dis_datagram d;
    struct dis_pdu pdu;
    enum dis_fault fault = DIS_FAULT_NONE;
    dis_datagram_begin(&d, bytes, length);
    return dis_datagram_next(&d, &pdu, &fault) == DIS_STEP_BROKEN ? fault : DIS_FAULT_NONE;
}

TEST(every_datagram_that_ends_within_a_pdu_is_broken)
{
    struct made m = {.length = 0};
    const struct made_entity e = made_vehicle(1);
    made_entity_state(&m, &e);
    for (size_t length = 1; length < 144; length++) {
        assert_int_equal(first_fault(m.bytes, length),
                         length < 12 ? DIS_FAULT_HEADER : DIS_FAULT_TRUNCATED);
    }
    assert_int_equal(first_fault(m.bytes, 144), DIS_FAULT_NONE);
}

TEST(a_length_that_is_less_than_a_header_does_not_stop_the_reader_at_its_place)
{
    struct made m = {.length = 0};
    const struct made_entity e = made_vehicle(1);
    made_entity_state(&m, &e);
    for (uint8_t length = 0; length < 12; length++) {
        m.bytes[8] = 0;
        m.bytes[9] = length;
        assert_int_equal(first_fault(m.bytes, 144), DIS_FAULT_HEADER);
    }
}

TEST(a_pdu_that_names_more_records_than_it_has_is_refused)
{
    struct made m = {.length = 0};
    struct dis_entity_state s;
    const struct made_entity e = made_vehicle(1);
    made_entity_state(&m, &e);
    m.bytes[19] = 1;
    assert_int_equal(read_state(&m, &s), DIS_FAULT_SHORT);
    m.bytes[19] = 255;
    assert_int_equal(read_state(&m, &s), DIS_FAULT_SHORT);
    struct made small = {.length = 0};
    made_other(&small, 1, 143);
    assert_int_equal(read_state(&small, &s), DIS_FAULT_SHORT);
}

TEST(versions_1_to_5_are_stepped_over_and_others_are_no_dis)
{
    for (unsigned version = 0; version < 256; version++) {
        struct made m = {.length = 0};
        struct made_entity e = made_vehicle(1);
        struct dis_datagram d;
        struct dis_pdu pdu;
        enum dis_fault fault;
        e.version = (uint8_t)version;
        made_entity_state(&m, &e);
        dis_datagram_begin(&d, m.bytes, m.length);
        const enum dis_step step = dis_datagram_next(&d, &pdu, &fault);
        assert_int_equal(step, version == 6 || version == 7  ? DIS_STEP_PDU
                               : version >= 1 && version < 6 ? DIS_STEP_VERSION
                                                             : DIS_STEP_BROKEN);
    }
}

TEST(numbers_that_are_not_finite_are_refused_wherever_they_stand)
{
    for (int place = 0; place < 15; place++) {
        for (int kind = 0; kind < 3; kind++) {
            struct made_entity e = made_vehicle(1);
            float *singles[] = {e.velocity, e.orientation, e.acceleration, e.turn};
            const float odd = kind == 0 ? NAN : kind == 1 ? INFINITY : -INFINITY;
            if (place < 12) {
                singles[place / 3][place % 3] = odd;
            } else {
                e.place[place - 12] = (double)odd;
            }
            assert_int_equal(fault_of(&e), DIS_FAULT_NUMBER);
        }
    }
}

TEST(what_is_not_near_the_earth_or_faster_than_all_is_refused)
{
    static const double x_m[] = {0, 6300000, 6378137 + 2e6, 1e300};
    for (size_t i = 0; i < sizeof x_m / sizeof *x_m; i++) {
        struct made_entity e = made_vehicle(1);
        e.place[0] = x_m[i];
        assert_int_equal(fault_of(&e), DIS_FAULT_PLACE);
    }
    struct made_entity fast = made_vehicle(1), turning = made_vehicle(1), hard = made_vehicle(1);
    fast.velocity[2] = 13000;
    turning.turn[0] = 1e30F;
    hard.acceleration[0] = -3.4e38F;
    assert_int_equal(fault_of(&fast), DIS_FAULT_SPEED);
    assert_int_equal(fault_of(&turning), DIS_FAULT_SPEED);
    assert_int_equal(fault_of(&hard), DIS_FAULT_SPEED);
}

TEST(an_id_that_means_nobody_or_all_is_no_entity)
{
    struct made_entity e = made_vehicle(0);
    assert_int_equal(fault_of(&e), DIS_FAULT_ID);
    e.id[2] = 65535;
    assert_int_equal(fault_of(&e), DIS_FAULT_ID);
    e.id[2] = 1;
    e.id[0] = 65535;
    assert_int_equal(fault_of(&e), DIS_FAULT_ID);
}

TEST(a_marking_is_printable_whatever_it_is)
{
    struct made m = {.length = 0};
    struct dis_entity_state s;
    struct made_entity e = made_vehicle(1);
    e.marking = "\x1b[2J\x80\xff ok";
    made_entity_state(&m, &e);
    assert_int_equal(read_state(&m, &s), DIS_FAULT_NONE);
    assert_string_equal(s.marking, "?[2J?? ok");
}

TEST(commands_tell_their_sender_and_the_exercises_time)
{
    struct made m = {.length = 0};
    struct dis_datagram d;
    struct dis_pdu pdu;
    struct dis_command c;
    enum dis_fault fault;
    made_start(&m, 4, 2, 1U << 30 | 1); /* two hours and a quarter, absolute */
    made_stop(&m, 4, 2);
    assert_int_equal(m.length, 44 + 40);
    dis_datagram_begin(&d, m.bytes, m.length);
    assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_PDU);
    assert_int_equal(dis_command_read(&pdu, &c), DIS_FAULT_NONE);
    assert_true(c.is_start && c.sender.site == 5 && c.sender.application == 6 &&
                c.sender.entity == 7 && c.receiver.site == 65535);
    assert_true(c.real_s == 3600 && c.exercise_s == 2 * 3600 + 900);
    assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_PDU);
    assert_int_equal(dis_command_read(&pdu, &c), DIS_FAULT_NONE);
    assert_true(!c.is_start && c.real_s == 7200 && c.reason == 1 && c.behaviour == 2);
    struct made small = {.length = 0};
    made_other(&small, 14, 39);
    dis_datagram_begin(&d, small.bytes, small.length);
    assert_int_equal(dis_datagram_next(&d, &pdu, &fault), DIS_STEP_PDU);
    assert_int_equal(dis_command_read(&pdu, &c), DIS_FAULT_SHORT);
}

TEST(a_timestamp_is_a_part_of_the_hour)
{
    bool is_absolute;
    assert_true(dis_timestamp_s(0, &is_absolute) == 0 && !is_absolute);
    assert_true(dis_timestamp_s(0x80000001U, &is_absolute) == 1800 && is_absolute);
    assert_true(fabs(dis_timestamp_s(0xffffffffU, &is_absolute) - 3600) < 2e-6);
}
