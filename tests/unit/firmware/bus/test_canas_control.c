/* Control frames: what one display tells, another one obeys, to the last bit that the bus has; and
 * no frame can command what no hand could. */
#include "check.h"
#include "hs/rng.h"
#include "lm/canas.h"
#include "lm/canas_control.h"

#include <string.h>

enum { NODE = 20, INSTRUCTOR = 5, WIRE = 4096 };

struct wire {
    struct lm_can_frame frame[WIRE];
    int count, room, answer;
};

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct wire *w = ctx;
    if (w->room-- <= 0) {
        return LM_BUSY;
    }
    if (w->answer == LM_OK) {
        w->frame[w->count++ % WIRE] = *frame;
    }
    return w->answer;
}

static struct wire wire;
static const struct lm_can can = {.ctx = &wire, .send = send_frame};

static struct lm_canas_control begin(uint8_t node, bool is_obeying)
{
    struct lm_canas_control c;
    memset(&wire, 0, sizeof wire);
    wire.room = 1 << 20;
    lm_canas_control_init(&c, node, is_obeying);
    return c;
}

/* Tell a control, and hand what was sent to another display. */
static void carry(struct lm_canas_control *from, struct lm_canas_control *to,
                  const struct lm_control *control)
{
    wire.count = 0;
    lm_canas_control_tell(from, control, 1234567);
    for (int i = 0; i < 4; i++) {
        lm_canas_control_send(from, &can);
    }
    for (int i = 0; i < wire.count; i++) {
        lm_canas_control_take(to, &wire.frame[i]);
    }
}

static const struct lm_position places[] = {
    {0, 0}, {0x20000001, 0x7fffffff}, {0xe0000003, 0x80000000}, {FX_BAM_90, 12345}};

static void assert_near(fx_bam_t got, fx_bam_t wanted)
{
    assert_in_range(got - wanted + 1, 0, 2); /* 1e-7 degree is 1.2 of 2^-32 turn */
}

TEST(every_control_goes_over_the_bus)
{
    const struct lm_control exact[] = {
        lm_control_button(true, 1),
        lm_control_button(false, 28),
        lm_control_designate(),
        lm_control_drop(),
        {.kind = LM_CONTROL_TRACK},
        {.kind = LM_CONTROL_RANGING},
        {.kind = LM_CONTROL_FREEZE, .is_frozen = true},
        {.kind = LM_CONTROL_FREEZE, .is_frozen = false},
        lm_control_knob(-1000),
        lm_control_slew(1000, -999),
        {.kind = LM_CONTROL_SECTOR, .sector = {.mode = 2, .fov = 3}},
        {.kind = LM_CONTROL_RANGE, .range_nm = 80},
        {.kind = LM_CONTROL_AZIMUTH, .azimuth_index = 2},
        {.kind = LM_CONTROL_GAIN, .gain_db = -30},
    };
    struct lm_canas_control from = begin(NODE, false), to = begin(21, true);
    for (size_t i = 0; i < sizeof exact / sizeof *exact; i++) {
        struct lm_control got;
        carry(&from, &to, &exact[i]);
        assert_true(lm_canas_control_next(&to, &got));
        assert_int_equal(got.kind, exact[i].kind);
        const bool is_switch = got.kind >= LM_CONTROL_DESIGNATE;
        if (got.kind == LM_CONTROL_FREEZE) {
            assert_int_equal(got.is_frozen, exact[i].is_frozen);
        } else if (!is_switch) {
            assert_int_equal(got.slew.x, exact[i].slew.x);
        }
        if (got.kind == LM_CONTROL_SLEW || got.kind == LM_CONTROL_SECTOR) {
            assert_int_equal(got.slew.y, exact[i].slew.y);
        }
        assert_false(lm_canas_control_next(&to, &got));
    }
    assert_int_equal(from.count.told, sizeof exact / sizeof *exact);
    assert_int_equal(to.count.heard, sizeof exact / sizeof *exact);
    assert_int_equal(to.count.bad + to.count.torn + to.count.refused, 0);
}

TEST(places_and_patches_go_over_the_bus_to_a_centimetre)
{
    struct lm_canas_control from = begin(NODE, false), to = begin(0, true);
    for (uint32_t i = 0; i < 64; i++) {
        const struct lm_position p = places[i % 4];
        struct lm_control got;
        const struct lm_control cursor = {.kind = LM_CONTROL_CURSOR, .cursor = p};
        carry(&from, &to, &cursor);
        assert_true(lm_canas_control_next(&to, &got));
        assert_int_equal(got.kind, LM_CONTROL_CURSOR);
        assert_near(got.cursor.latitude, p.latitude);
        assert_near(got.cursor.longitude, p.longitude);
        const struct lm_control steer = {.kind = LM_CONTROL_STEERPOINT,
                                         .steerpoint = {.is_set = i & 1, .position = p}};
        carry(&from, &to, &steer);
        assert_true(lm_canas_control_next(&to, &got));
        assert_int_equal(got.kind, LM_CONTROL_STEERPOINT);
        assert_int_equal(got.steerpoint.is_set, i & 1);
        assert_near(got.steerpoint.position.longitude, p.longitude);
        const struct lm_control patch = {.kind = LM_CONTROL_SAR,
                                         .sar = {.centre = p,
                                                 .cell_mm = 700 + i,
                                                 .is_plan = i & 2,
                                                 .is_steady = i & 4,
                                                 .is_from_ownship = i & 8,
                                                 .look_azimuth = 0x12345678,
                                                 .range_m = 30000,
                                                 .height_m_q6 = -64}};
        carry(&from, &to, &patch);
        assert_int_equal(wire.count, i & 8 ? 4 : 7);
        assert_true(lm_canas_control_next(&to, &got));
        assert_int_equal(got.kind, LM_CONTROL_SAR);
        assert_near(got.sar.centre.latitude, p.latitude);
        assert_int_equal(got.sar.cell_mm, 700 + i);
        assert_int_equal(got.sar.is_plan, (i & 2) != 0);
        assert_int_equal(got.sar.is_steady, (i & 4) != 0);
        assert_int_equal(got.sar.is_from_ownship, (i & 8) != 0);
        if (!got.sar.is_from_ownship) {
            assert_near(got.sar.look_azimuth, 0x12345678);
            assert_int_equal(got.sar.range_m, 30000);
            assert_int_equal(got.sar.height_m_q6, -64);
        }
    }
}

TEST(a_key_is_told_with_the_time_of_its_step_and_the_set_has_one_code)
{
    struct lm_canas_control from = begin(NODE, false);
    const struct lm_control key = lm_control_button(true, 7);
    lm_canas_control_tell(&from, &key, 0x1122334455ULL);
    lm_canas_control_send(&from, &can);
    assert_int_equal(wire.count, 2);
    assert_int_equal(wire.frame[0].id, 1530);
    assert_int_equal(wire.frame[0].length, 8);
    assert_memory_equal(wire.frame[0].data, "\x14\x04\x01\x01\x22\x33\x44\x55", 8);
    assert_int_equal(wire.frame[1].id, 1531);
    assert_int_equal(wire.frame[1].length, 5);
    assert_memory_equal(wire.frame[1].data, "\x14\x0a\x01\x01\x07", 5);
}

TEST(a_full_bus_delays_controls_and_a_full_ring_is_counted)
{
    struct lm_canas_control from = begin(NODE, false);
    wire.room = 0;
    for (int32_t i = 0; i < LM_CONTROL_RING + 3; i++) {
        const struct lm_control knob = lm_control_knob(i);
        lm_canas_control_tell(&from, &knob, 0);
        lm_canas_control_send(&from, &can);
    }
    assert_int_equal(wire.count, 0);
    assert_int_equal(from.count.lost, 3);
    wire.room = 1000;
    for (int i = 0; i < 20; i++) {
        lm_canas_control_send(&from, &can);
    }
    assert_int_equal(wire.count, 2 * LM_CONTROL_RING);
    for (int i = 0; i < LM_CONTROL_RING; i++) {
        assert_int_equal(wire.frame[2 * i + 1].data[7], i);
    }
    const struct lm_control next = lm_control_knob(0);
    lm_canas_control_tell(&from, &next, 0);
    lm_canas_control_send(&from, &can);
    assert_int_equal(wire.frame[wire.count - 1].data[3], LM_CONTROL_RING + 4); /* the gap shows */
}

static struct lm_can_frame knob_frame(void)
{
    return (struct lm_can_frame){.id = LM_CONTROL_ID + LM_CONTROL_ITEM_KNOB,
                                 .length = 8,
                                 .data = {INSTRUCTOR, LM_CANAS_LONG, 0, 1, 0, 0, 1, 0}};
}

TEST(nobody_is_obeyed_unless_the_board_says_so)
{
    struct lm_canas_control c = begin(NODE, false);
    struct lm_control control;
    const struct lm_can_frame frame = knob_frame();
    lm_canas_control_take(&c, &frame);
    assert_int_equal(c.count.refused, 1);
    assert_false(lm_canas_control_next(&c, &control));
}

TEST(own_frames_and_those_of_other_kinds_of_identifier_are_passed_over)
{
    struct lm_canas_control c = begin(NODE, true);
    struct lm_can_frame frame = knob_frame();
    frame.data[0] = NODE;
    lm_canas_control_take(&c, &frame);
    for (int i = 0; i < 3; i++) {
        frame = knob_frame();
        frame.is_extended = i == 0;
        frame.is_remote = i == 1;
        frame.is_error = i == 2;
        lm_canas_control_take(&c, &frame);
    }
    frame = knob_frame();
    frame.id = LM_CONTROL_ID + LM_CONTROL_ITEMS;
    lm_canas_control_take(&c, &frame);
    frame.id = LM_CONTROL_ID - 1;
    lm_canas_control_take(&c, &frame);
    assert_int_equal(c.heard.head + c.count.bad + c.count.refused + c.count.torn, 0);
}

TEST(frames_of_a_wrong_type_length_sender_or_act_are_counted)
{
    struct lm_canas_control c = begin(NODE, true);
    for (int i = 0; i < 4; i++) {
        struct lm_can_frame frame = knob_frame();
        frame.data[0] = i == 0 ? 0 : INSTRUCTOR;
        frame.data[1] = i == 1 ? LM_CANAS_FLOAT : LM_CANAS_LONG;
        frame.length = i == 2 ? 7 : 8;
        if (i == 3) {
            frame = (struct lm_can_frame){.id = LM_CONTROL_ID + LM_CONTROL_ITEM_SWITCH,
                                          .length = 5,
                                          .data = {INSTRUCTOR, LM_CANAS_UCHAR, 0, 1, 7}};
        }
        lm_canas_control_take(&c, &frame);
    }
    assert_int_equal(c.count.bad, 4);
    assert_int_equal(c.heard.head, 0);
}

TEST(what_the_board_says_of_itself_is_not_told)
{
    static const enum lm_control_kind kinds[] = {LM_CONTROL_ENVIRONMENT, LM_CONTROL_SLOTS,
                                                 LM_CONTROL_IMAGE};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct lm_canas_control c = begin(NODE, true);
        const struct lm_control control = {.kind = kinds[i]};
        lm_canas_control_tell(&c, &control, 0);
        lm_canas_control_send(&c, &can);
        assert_int_equal(c.count.told + c.count.lost, 0);
        assert_int_equal(wire.count, 0);
    }
}

TEST(a_display_without_a_node_or_a_bus_tells_nothing)
{
    struct lm_canas_control c = begin(0, true);
    const struct lm_control designate = {.kind = LM_CONTROL_DESIGNATE};
    lm_canas_control_tell(&c, &designate, 0);
    assert_int_equal(c.count.told, 0);
    c = begin(NODE, true);
    lm_canas_control_tell(&c, &designate, 0);
    const struct lm_can deaf = {.ctx = &wire};
    lm_canas_control_send(&c, &deaf);
    assert_int_equal(wire.count, 0);
    lm_canas_control_send(&c, &can); /* told, when there is a bus */
    assert_true(wire.count > 0);
}

TEST(a_set_needs_one_code_one_sender_and_a_second_and_comes_in_any_order)
{
    struct lm_canas_control from = begin(INSTRUCTOR, false), to = begin(NODE, true);
    const struct lm_control cursor = {.kind = LM_CONTROL_CURSOR, .cursor = places[1]};
    struct lm_control got;
    lm_canas_control_tell(&from, &cursor, 0);
    lm_canas_control_send(&from, &can);
    struct lm_can_frame latitude = wire.frame[1], longitude = wire.frame[2];
    lm_canas_control_take(&to, &longitude);
    lm_canas_control_take(&to, &latitude);
    assert_true(lm_canas_control_next(&to, &got));
    for (int i = 0; i < 3; i++) {
        struct lm_can_frame other = longitude;
        other.data[3] = (uint8_t)(other.data[3] + (i == 0));
        other.data[0] = (uint8_t)(other.data[0] + (i == 1));
        other.time_us += i == 2 ? LM_CONTROL_SET_US + 1 : 0;
        lm_canas_control_take(&to, &latitude);
        lm_canas_control_take(&to, &other);
        assert_false(lm_canas_control_next(&to, &got));
    }
    assert_int_equal(to.count.torn, 5);
}

TEST(any_bytes_at_all_are_safe_and_make_only_kinds_that_exist)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 1530);
    struct lm_canas_control c = begin(NODE, true);
    uint32_t obeyed = 0;
    for (uint32_t i = 0; i < 400000; i++) {
        const uint64_t dice = hs_rng_u64(&rng), payload = hs_rng_u64(&rng);
        const uint32_t item = hs_rng_below(&rng, LM_CONTROL_ITEMS + 1);
        struct lm_can_frame frame = {
            .id = LM_CONTROL_ID + item, .length = (uint8_t)(dice & 15), .time_us = dice >> 60};
        memcpy(frame.data, &payload, 8);
        if ((dice & 0x700) != 0 && item < LM_CONTROL_ITEMS) {
            const uint8_t type = lm_control_type((enum lm_control_item)item);
            frame.data[0] = INSTRUCTOR;
            frame.data[1] = type;
            frame.data[3] &= 1;
            frame.length =
                (uint8_t)(4 + lm_canas_types[type].element_bytes * lm_canas_types[type].elements);
        }
        lm_canas_control_take(&c, &frame);
        struct lm_control control;
        while ((dice & 0x30000) == 0 && lm_canas_control_next(&c, &control)) {
            assert_in_range(control.kind, 0, LM_CONTROL_KINDS - 1);
            assert_int_not_equal(control.kind, LM_CONTROL_ENVIRONMENT);
            obeyed++;
        }
    }
    assert_in_range(obeyed, 1000, 400000);
}
