/* SocketCAN as far as it can be tried without a CAN controller: a local socket stands in for the
 * bus. */
#include "drv/can_socket.h"
#include "hs/rng.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

static void an_interface_that_does_not_exist_is_named_in_the_error(void **state)
{
    (void)state;
    struct drv_can_socket s;
    assert_int_equal(drv_can_socket_open(&s, "nocan7", 0), LM_ERR_IO);
    assert_int_equal(s.fd, -1);
    assert_non_null(strstr(s.error, "nocan7: no such interface"));
    assert_non_null(strstr(s.error, "ip link"));
    drv_can_socket_close(&s);
}

/* Whether the kernel has no CAN at all, or has it and sees that lo is no CAN interface. */
static void what_is_no_can_interface_cannot_be_opened(void **state)
{
    (void)state;
    struct drv_can_socket s;
    if (if_nametoindex("lo") == 0) {
        print_message("# skipped: no interface lo here\n");
        skip();
    }
    assert_int_equal(drv_can_socket_open(&s, "lo", 0), LM_ERR_IO);
    assert_int_equal(s.fd, -1);
    print_message("# %s\n", s.error);
    assert_non_null(strstr(s.error, "lo: "));
    assert_true(strstr(s.error, "CONFIG_CAN") != NULL || strstr(s.error, "CAN interface") != NULL);
    drv_can_socket_close(&s);
}

static void flags_and_bytes_are_carried_over(void **state)
{
    (void)state;
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
static bool passes(const struct can_filter *filters, canid_t id)
{
    for (size_t i = 0; i < DRV_CAN_SOCKET_FILTERS; i++) {
        if ((id & filters[i].can_mask) == (filters[i].can_id & filters[i].can_mask)) {
            return true;
        }
    }
    return false;
}

static void assert_filtered_as_decoded(const struct can_filter *filters, canid_t id)
{
    const struct can_frame raw = {.can_id = id, .can_dlc = 8, .data = {9, 2}};
    struct lm_can_frame frame;
    struct lm_canas canas;
    struct lm_canas_event event;
    lm_canas_init(&canas);
    assert_true(drv_can_socket_convert(&raw, &frame));
    const enum lm_canas_outcome outcome = lm_canas_take(&canas, &frame, &event);
    const bool is_wanted =
        outcome != LM_CANAS_NOT_DATA && outcome != LM_CANAS_FOREIGN && outcome != LM_CANAS_UNUSED;
    /* The one difference: 29 bits on channel 0 are left to the decoder, which counts them as
     * foreign. */
    const bool is_long_channel_0 = (id & CAN_EFF_FLAG) != 0 && (id & CAN_EFF_MASK) <= 0x7ff;
    if (passes(filters, id) != is_wanted && !is_long_channel_0) {
        fail_msg("identifier %08X: outcome %d", (unsigned)id, (int)outcome);
    }
}

static void the_filters_pass_what_the_decoder_takes_and_nothing_else(void **state)
{
    (void)state;
    struct can_filter filters[DRV_CAN_SOCKET_FILTERS];
    drv_can_socket_filters(filters);
    assert_true(DRV_CAN_SOCKET_FILTERS <= 512); /* CAN_RAW_FILTER_MAX */
    for (canid_t id = 0; id <= CAN_SFF_MASK; id++) {
        assert_filtered_as_decoded(filters, id);
        assert_filtered_as_decoded(filters, id | CAN_RTR_FLAG);
        for (canid_t channel = 0; channel <= 3; channel++) {
            assert_filtered_as_decoded(filters, channel << 16 | id | CAN_EFF_FLAG);
            assert_filtered_as_decoded(filters, channel << 16 | id | 0xf000 | CAN_EFF_FLAG);
            assert_filtered_as_decoded(filters, channel << 16 | id | CAN_EFF_FLAG | CAN_RTR_FLAG);
        }
    }
    struct hs_rng rng;
    hs_rng_seed(&rng, 41);
    for (int i = 0; i < 100000; i++) {
        assert_filtered_as_decoded(filters,
                                   ((canid_t)hs_rng_u64(&rng) & CAN_EFF_MASK) | CAN_EFF_FLAG);
    }
}

static void a_stamp_is_an_age_whatever_the_clock_on_the_wall_does(void **state)
{
    (void)state;
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
    return (struct drv_can_socket){.fd = ends[0]};
}

static uint64_t monotonic_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

static void frames_come_in_order_and_bad_ones_are_counted_and_skipped(void **state)
{
    (void)state;
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

static void a_flood_of_bad_frames_cannot_hold_the_caller(void **state)
{
    (void)state;
    int other;
    struct drv_can_socket s = stand_in(&other);
    const struct lm_can port = drv_can_socket_port(&s);
    struct can_frame raw = {.can_id = 1, .can_dlc = 15};
    for (int i = 0; i < 40; i++) {
        assert_true(send(other, &raw, sizeof raw, 0) > 0);
    }
    struct lm_can_frame f;
    assert_int_equal(port.receive(port.ctx, &f), 0);
    assert_int_equal(s.count.malformed, 16);
    close(other);
    drv_can_socket_close(&s);
}

static void a_bus_that_goes_away_is_an_error_with_a_remedy(void **state)
{
    (void)state;
    struct drv_can_socket s = {.fd = -1}; /* EBADF stands for whatever the kernel may say */
    const struct lm_can port = drv_can_socket_port(&s);
    struct lm_can_frame f;
    assert_int_equal(port.receive(port.ctx, &f), LM_ERR_IO);
    assert_non_null(strstr(s.error, "the bus is lost"));
    assert_non_null(strstr(s.error, "open it again"));
    assert_int_equal(s.count.down, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_interface_that_does_not_exist_is_named_in_the_error),
        cmocka_unit_test(what_is_no_can_interface_cannot_be_opened),
        cmocka_unit_test(flags_and_bytes_are_carried_over),
        cmocka_unit_test(the_filters_pass_what_the_decoder_takes_and_nothing_else),
        cmocka_unit_test(a_stamp_is_an_age_whatever_the_clock_on_the_wall_does),
        cmocka_unit_test(frames_come_in_order_and_bad_ones_are_counted_and_skipped),
        cmocka_unit_test(a_flood_of_bad_frames_cannot_hold_the_caller),
        cmocka_unit_test(a_bus_that_goes_away_is_an_error_with_a_remedy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
