/* SocketCAN as far as it can be tried without a CAN controller: a local socket stands in for the
 * bus. */
#include "check.h"
#include "drv/can_socket.h"
#include "hs/rng.h"
#include "lm/bus.h"
#include "lm/bus_filters.h"
#include "lm/canas_service.h"

#include <errno.h>
#include <linux/can/error.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

/* As landmass opens it: the filters of canas17. */
static int open_canas17(struct drv_can_socket *s, const char *interface)
{
    struct lm_can_filter filters[LM_BUS_FILTERS_MAX];
    const uint32_t count = lm_bus_filters(&lm_bus_canas17, filters);
    return drv_can_socket_open(s, interface, filters, count, 0);
}

TEST(an_interface_that_does_not_exist_is_named_in_the_error)
{
    struct drv_can_socket s;
    assert_int_equal(open_canas17(&s, "nocan7"), LM_ERR_IO);
    assert_int_equal(s.fd, -1);
    assert_non_null(strstr(s.error, "nocan7: no such interface"));
    assert_non_null(strstr(s.error, "ip link"));
    drv_can_socket_close(&s);
}

/* Whether the kernel has no CAN at all, or has it and sees that lo is no CAN interface. */
TEST(more_filters_than_the_kernel_takes_are_refused_and_not_tried_again)
{
    static const struct lm_can_filter filters[DRV_CAN_SOCKET_FILTERS + 1];
    struct drv_can_socket s;
    assert_int_equal(drv_can_socket_open(&s, "lo", filters, DRV_CAN_SOCKET_FILTERS + 1, 0),
                     LM_ERR_IO);
    assert_non_null(strstr(s.error, "513 filters"));
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f;
    assert_int_equal(port.receive(port.ctx, &f), 0);
    drv_can_socket_close(&s);
}

TEST(what_is_no_can_interface_cannot_be_opened)
{
    struct drv_can_socket s;
    if (if_nametoindex("lo") == 0) {
        print_message("# skipped: no interface lo here\n");
        skip();
    }
    assert_int_equal(open_canas17(&s, "lo"), LM_ERR_IO);
    assert_int_equal(s.fd, -1);
    print_message("# %s\n", s.error);
    assert_non_null(strstr(s.error, "lo: "));
    assert_true(strstr(s.error, "CONFIG_CAN") != NULL || strstr(s.error, "CAN interface") != NULL);
    drv_can_socket_close(&s);
}

TEST(flags_and_bytes_are_carried_over)
{
    static const struct {
        canid_t raw;
        uint32_t id;
        bool is_extended, is_remote, is_error;
    } tests[] = {
        {0x40c, 0x40c, false, false, false},
        {0x1040c | CAN_EFF_FLAG, 0x1040c, true, false, false},
        {0x1fffffff | CAN_EFF_FLAG, 0x1fffffff, true, false, false},
        {0x40c | CAN_RTR_FLAG, 0x40c, false, true, false},
        {0x44 | CAN_ERR_FLAG, 0x44, false, false, true},
        {0x1000 | CAN_ERR_FLAG, 0x1000, false, false, true},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        const struct can_frame raw = {
            .can_id = tests[i].raw, .can_dlc = 5, .data = {1, 2, 3, 4, 5}};
        struct lm_can_frame f;
        assert_true(drv_can_socket_convert(&raw, &f));
        assert_true(f.id == tests[i].id && f.is_extended == tests[i].is_extended &&
                    f.is_remote == tests[i].is_remote && f.is_error == tests[i].is_error);
        assert_int_equal(f.length, 5);
        assert_memory_equal(f.data, "\1\2\3\4\5\0\0\0", 8);
    }
    const struct can_frame fd_length = {.can_id = 1, .can_dlc = 9};
    struct lm_can_frame f;
    assert_false(drv_can_socket_convert(&fd_length, &f));
}

/* The kernel's rule (Documentation/networking/can.rst, 4.1.1): received & mask == filter & mask. */
struct filters {
    struct lm_can_filter list[LM_BUS_FILTERS_MAX];
    size_t count;
    const struct lm_bus_profile *profile;
};

static bool passes(const struct filters *f, canid_t id)
{
    for (size_t i = 0; i < f->count; i++) {
        const struct can_filter kernels = drv_can_socket_filter(&f->list[i]);
        if ((id & kernels.can_mask) == (kernels.can_id & kernels.can_mask)) {
            return true;
        }
    }
    return false;
}

static void assert_filtered_as_decoded(const struct filters *f, canid_t id)
{
    const struct can_frame raw = {.can_id = id, .can_dlc = 8, .data = {9, 2}};
    struct lm_can_frame frame;
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&bus, f->profile);
    assert_true(drv_can_socket_convert(&raw, &frame));
    lm_bus_take(&bus, &frame, events);
    const uint32_t *outcome = bus.count.outcome;
    const bool is_unwanted = outcome[LM_BUS_NOT_DATA] || outcome[LM_BUS_FOREIGN] ||
                             outcome[LM_BUS_UNUSED] || outcome[LM_BUS_OTHER_CHANNEL] ||
                             outcome[LM_BUS_SERVICE];
    /* Of the services only requests on channel 0 are heard; of controls all but the step; and what
     * a partner says. */
    const bool is_for_the_unit = id == LM_CANAS_REQUEST_ID || id == LM_BUS_SWAP_ID ||
                                 (id > LM_CONTROL_ID && id < LM_CONTROL_ID + LM_CONTROL_ITEMS);
    const bool is_wanted =
        !is_unwanted || (f->profile->framing == LM_BUS_CANAEROSPACE && is_for_the_unit);
    /* The one difference: 29 bits on channel 0 are left to the decoder, which counts them as
     * foreign. */
    const bool is_long_channel_0 = (id & CAN_EFF_FLAG) != 0 && (id & CAN_EFF_MASK) <= 0x7ff;
    if (passes(f, id) != is_wanted && !(is_long_channel_0 && !is_wanted)) {
        fail_msg("identifier %08X is %s", (unsigned)id, is_wanted ? "filtered out" : "let in");
    }
}

static void assert_filters_of(const struct lm_bus_profile *profile)
{
    struct filters f = {.profile = profile};
    f.count = lm_bus_filters(profile, f.list);
    assert_in_range(f.count, 1, 512); /* CAN_RAW_FILTER_MAX */
    for (canid_t id = 0; id <= CAN_SFF_MASK; id++) {
        assert_filtered_as_decoded(&f, id);
        assert_filtered_as_decoded(&f, id | CAN_RTR_FLAG);
        for (canid_t channel = 0; channel <= 9; channel++) {
            assert_filtered_as_decoded(&f, channel << 16 | id | CAN_EFF_FLAG);
            assert_filtered_as_decoded(&f, channel << 16 | id | 0xf000 | CAN_EFF_FLAG);
            assert_filtered_as_decoded(&f, channel << 16 | id | CAN_EFF_FLAG | CAN_RTR_FLAG);
        }
    }
    struct hs_rng rng;
    hs_rng_seed(&rng, 41);
    for (int i = 0; i < 100000; i++) {
        const uint64_t dice = hs_rng_u64(&rng);
        const struct lm_bus_row *row = &profile->rows[(dice >> 32) % profile->row_count];
        const canid_t any = (canid_t)dice & CAN_EFF_MASK;
        /* Half of them are near a row of 29 bits. */
        const canid_t near = (row->id & row->packing.mask) | (any & ~row->packing.mask);
        assert_filtered_as_decoded(&f, (dice >> 63 ? any : near) | CAN_EFF_FLAG);
    }
}

TEST(the_filters_pass_what_the_decoder_takes_and_nothing_else)
{
    for (const struct lm_bus_named_profile *p = lm_bus_profiles; p->name != NULL; p++) {
        assert_filters_of(p->profile);
    }
    /* 127257 of NMEA 2000 from anybody, and one item of ARINC 825's shape with a condition. */
    static const struct lm_bus_row packed[] = {
        {.id = 0x01f11900, .packing = {.mask = 0x03ffff00, .bits = {8, 16}, .multiplier = 1}},
        {.id = 0x01f11900, .packing = {.mask = 0x03ffff00, .bits = {24, 16}, .multiplier = 1}},
        {.id = 0x08680160,
         .packing = {.mask = 0x1ff8fffc, .bits = {0, 32}, .type = LM_BUS_FLOAT, .multiplier = 1}},
    };
    const struct lm_bus_profile profile = {
        .rows = packed, .row_count = 3, .framing = LM_BUS_PACKED};
    assert_filters_of(&profile);
    struct lm_can_filter list[LM_BUS_FILTERS_MAX];
    assert_int_equal(lm_bus_filters(&profile, list), 2);
}

TEST(a_stamp_is_an_age_whatever_the_clock_on_the_wall_does)
{
    const uint64_t mono = 5000000, wall = 1700000000000000;
    assert_true(drv_can_socket_arrival_us(mono, wall, wall) == mono);
    assert_true(drv_can_socket_arrival_us(mono, wall, wall - 2500) == mono - 2500);
    assert_true(drv_can_socket_arrival_us(mono, wall, wall + 3600000000u) == mono);
    assert_true(drv_can_socket_arrival_us(mono, wall, 0) == mono - 1000000);
    assert_true(drv_can_socket_arrival_us(10, wall, wall - 500) == 0);
}

/* A socket whose other end the test holds. */
static struct drv_can_socket stand_in(int *other)
{
    int ends[2];
    assert_int_equal(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
    *other = ends[1];
    return (struct drv_can_socket){.fd = ends[0], .interface = "can0"};
}

static uint64_t monotonic_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

TEST(frames_come_in_order_and_bad_ones_are_counted_and_skipped)
{
    int other;
    struct drv_can_socket s = stand_in(&other);
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f;
    assert_int_equal(port.receive(port.ctx, &f), 0);

    const uint64_t before_us = monotonic_us();
    s.time_zero_us = before_us - 1000;
    struct can_frame raw = {.can_id = 0x40c, .can_dlc = 8, .data = {9, 2, 0, 1, 0x42}};
    struct canfd_frame fd = {.can_id = 0x40c, .len = 8};
    assert_true(send(other, &raw, sizeof raw, 0) > 0);
    assert_true(send(other, &fd, sizeof fd, 0) > 0); /* too large for a classic frame */
    assert_true(send(other, &raw, 7, 0) > 0);        /* cut off */
    raw.can_dlc = 9;
    assert_true(send(other, &raw, sizeof raw, 0) > 0);
    raw.can_dlc = 8;
    raw.can_id = 0x40d;
    assert_true(send(other, &raw, sizeof raw, 0) > 0);

    assert_int_equal(port.receive(port.ctx, &f), 1);
    assert_int_equal(f.id, 0x40c);
    assert_int_equal(f.data[4], 0x42);
    assert_true(f.time_us >= 1000 && f.time_us <= monotonic_us() - s.time_zero_us);
    assert_int_equal(port.receive(port.ctx, &f), 1);
    assert_int_equal(f.id, 0x40d);
    assert_int_equal(port.receive(port.ctx, &f), 0);
    assert_int_equal(s.count.frames, 2);
    assert_int_equal(s.count.malformed, 3);
    close(other);
    drv_can_socket_close(&s);
}

TEST(a_flood_of_bad_frames_cannot_hold_the_caller)
{
    int other;
    struct drv_can_socket s = stand_in(&other);
    const struct lm_can port = drv_can_socket_port(&s);
    struct can_frame raw = {.can_id = 1, .can_dlc = 15};
    for (int i = 0; i < 100; i++) {
        assert_true(send(other, &raw, sizeof raw, 0) > 0);
    }
    struct lm_can_frame f;
    assert_int_equal(port.receive(port.ctx, &f), 0);
    assert_int_equal(s.count.malformed, DRV_CAN_SOCKET_BATCH);
    close(other);
    drv_can_socket_close(&s);
}

TEST(frames_of_several_batches_come_in_order_and_none_is_lost)
{
    int other;
    struct drv_can_socket s = stand_in(&other);
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f;
    for (canid_t i = 0; i < 200; i++) {
        const struct can_frame raw = {.can_id = i, .can_dlc = 8};
        assert_true(send(other, &raw, sizeof raw, 0) > 0);
    }
    for (canid_t i = 0; i < 200; i++) {
        assert_int_equal(port.receive(port.ctx, &f), 1);
        assert_int_equal(f.id, i);
    }
    assert_int_equal(port.receive(port.ctx, &f), 0);
    close(other);
    drv_can_socket_close(&s);
}

static void send_report(int other, canid_t class, uint8_t controller)
{
    const struct can_frame raw = {
        .can_id = CAN_ERR_FLAG | class, .can_dlc = 8, .data = {0, controller}};
    assert_true(send(other, &raw, sizeof raw, 0) > 0);
}

TEST(the_controllers_reports_are_counted_and_bus_off_is_said_once)
{
    int other;
    struct drv_can_socket s = stand_in(&other);
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f;
    send_report(other, CAN_ERR_ACK, 0);
    send_report(other, CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
    send_report(other, CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
    send_report(other, CAN_ERR_TX_TIMEOUT, CAN_ERR_CRTL_RX_OVERFLOW); /* not of that class */
    send_report(other, CAN_ERR_BUSOFF, 0);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(port.receive(port.ctx, &f), 1);
        assert_true(f.is_error);
    }
    assert_int_equal(port.receive(port.ctx, &f), LM_ERR_IO);
    assert_non_null(strstr(s.error, "bus-off"));
    assert_non_null(strstr(s.error, "restart-ms"));
    assert_int_equal(port.receive(port.ctx, &f), 0);
    assert_true(s.is_bus_off);
    assert_true(s.count.no_ack == 1 && s.count.overruns == 1 && s.count.passive == 1 &&
                s.count.tx_timeout == 1 && s.count.bus_off == 1 && s.count.restarts == 0);
    send_report(other, CAN_ERR_RESTARTED, 0);
    assert_int_equal(port.receive(port.ctx, &f), 1);
    assert_false(s.is_bus_off);
    assert_int_equal(s.count.restarts, 1);

    /* A controller that comes back without saying so is heard all the same. */
    const struct can_frame data = {.can_id = 0x40c, .can_dlc = 8};
    send_report(other, CAN_ERR_BUSOFF, 0);
    assert_true(send(other, &data, sizeof data, 0) > 0);
    assert_int_equal(port.receive(port.ctx, &f), 1);
    assert_int_equal(port.receive(port.ctx, &f), 1);
    assert_false(s.is_bus_off);
    close(other);
    drv_can_socket_close(&s);
}

TEST(a_full_queue_drops_the_oldest_frames_and_counts_them)
{
    int other;
    struct drv_can_socket s = stand_in(&other);
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f = {.id = 0x81, .length = 8, .data = {20, 16}};
    /* The stand-in holds a good many frames before it says EAGAIN. */
    uint32_t offered = 0;
    while (s.count.unsent == 0 && offered < 100000) {
        f.id = offered & 0x7ff;
        assert_int_equal(port.send(port.ctx, &f), LM_OK);
        offered++;
    }
    assert_int_equal(s.count.unsent, 1);
    assert_int_equal(s.queue_count, DRV_CAN_SOCKET_QUEUE);
    assert_int_equal(s.count.sent + s.count.unsent + s.queue_count, offered);
    /* What had been sent comes in order, then one is missing, then the others: sent by the next
     * calls, here of receive. */
    struct can_frame raw;
    struct lm_can_frame none;
    const uint32_t sent = s.count.sent;
    for (uint32_t i = 0; i < offered - 1; i++) {
        while (recv(other, &raw, sizeof raw, MSG_DONTWAIT) < 0) {
            assert_int_equal(port.receive(port.ctx, &none), 0);
        }
        assert_int_equal(raw.can_id, (i < sent ? i : i + 1) & 0x7ff);
        assert_true(raw.can_dlc == 8 && raw.data[0] == 20 && raw.data[1] == 16);
    }
    assert_int_equal(s.queue_count, 0);
    close(other);
    drv_can_socket_close(&s);
}

TEST(an_interface_that_is_missing_at_start_is_looked_for_now_and_then)
{
    struct drv_can_socket s;
    assert_int_equal(open_canas17(&s, "nocan7"), LM_ERR_IO);
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f = {.id = 0x81, .length = 8};
    assert_true(s.retry_us <= monotonic_us() + DRV_CAN_SOCKET_RETRY_US);
    s.retry_us = UINT64_MAX;
    assert_int_equal(port.receive(port.ctx, &f), 0);
    assert_int_equal(port.send(port.ctx, &f), LM_ERR_IO);
    s.retry_us = 0;
    assert_int_equal(port.receive(port.ctx, &f), LM_ERR_IO);
    assert_non_null(strstr(s.error, "nocan7: no such interface"));
    assert_int_equal(s.count.unsent, 1);
    assert_int_equal(s.count.reopened, 0);
}

TEST(a_bus_that_goes_away_is_an_error_with_a_remedy)
{
    int other;
    struct drv_can_socket s = stand_in(&other);
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f = {.id = 0x81, .length = 8};
    close(s.fd);
    s.fd = other; /* ENOTCONN or ECONNRESET stands for whatever the kernel may say */
    assert_int_equal(port.send(port.ctx, &f), LM_ERR_IO);
    assert_non_null(strstr(s.error, "the bus is lost"));
    assert_non_null(strstr(s.error, "until it is back"));
    assert_int_equal(s.fd, -1);
    assert_int_equal(s.count.gone, 1);
    assert_int_equal(s.count.unsent, 1);
    s.retry_us = UINT64_MAX;
    assert_int_equal(port.receive(port.ctx, &f), 0); /* said once */
}
