/* The check of devices: what the kernel tells of an interface, and what is wrong on a machine that
 * has none of a panel's devices. */
#include "check.h"
#include "check_bus.h"
#include "check_devices.h"

#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* An answer of the kernel's, built from its end. */
struct answer {
    uint8_t bytes[512];
    size_t size;
};

static size_t open_attribute(struct answer *a, unsigned short kind)
{
    const struct rtattr head = {.rta_type = kind};
    const size_t at = a->size;
    memcpy(a->bytes + at, &head, sizeof head);
    a->size += sizeof head;
    return at;
}

static void close_attribute(struct answer *a, size_t at)
{
    const unsigned short length = (unsigned short)(a->size - at);
    memcpy(a->bytes + at, &length, sizeof length);
    a->size = RTA_ALIGN(a->size);
}

static void put(struct answer *a, unsigned short kind, const void *data, size_t size)
{
    const size_t at = open_attribute(a, kind);
    memcpy(a->bytes + a->size, data, size);
    a->size += size;
    close_attribute(a, at);
}

/* can0 as a controller tells it: 250 kbit/s, bus-off, 100 ms. */
static struct answer controller(void)
{
    struct answer a = {.size = NLMSG_SPACE(sizeof(struct ifinfomsg))};
    const struct ifinfomsg info = {.ifi_type = ARPHRD_CAN, .ifi_flags = IFF_UP, .ifi_index = 3};
    const struct can_bittiming timing = {.bitrate = 250000};
    const uint32_t state = CAN_STATE_BUS_OFF, restart_ms = 100;
    memcpy(a.bytes + NLMSG_HDRLEN, &info, sizeof info);
    put(&a, IFLA_IFNAME, "can0", 5);
    const size_t outer = open_attribute(&a, IFLA_LINKINFO);
    put(&a, IFLA_INFO_KIND, "can", 4);
    const size_t inner = open_attribute(&a, IFLA_INFO_DATA);
    put(&a, IFLA_CAN_BITTIMING, &timing, sizeof timing);
    put(&a, IFLA_CAN_STATE, &state, sizeof state);
    put(&a, IFLA_CAN_RESTART_MS, &restart_ms, sizeof restart_ms);
    close_attribute(&a, inner);
    close_attribute(&a, outer);
    const struct nlmsghdr head = {.nlmsg_type = RTM_NEWLINK, .nlmsg_len = (uint32_t)a.size};
    memcpy(a.bytes, &head, sizeof head);
    return a;
}

TEST(what_the_kernel_tells_of_a_controller_is_read)
{
    const struct answer a = controller();
    struct bus_link link;
    assert_true(bus_link_read(&link, a.bytes, a.size));
    assert_true(link.is_can && link.is_up && link.has_controller);
    assert_int_equal(link.bits_per_s, 250000);
    assert_int_equal(link.restart_ms, 100);
    assert_int_equal(link.state, CAN_STATE_BUS_OFF);
}

TEST(an_answer_that_is_cut_off_or_lies_about_lengths_is_read_within_its_bytes)
{
    const struct answer whole = controller();
    struct bus_link link;
    for (size_t size = 0; size < whole.size; size++) {
        uint8_t *bytes = malloc(size + 1); /* so that valgrind and sanitizers see one too many */
        assert_non_null(bytes);
        memcpy(bytes, whole.bytes, size);
        assert_false(bus_link_read(&link, bytes, size));
        free(bytes);
    }
    for (size_t at = 0; at < whole.size; at++) {
        for (uint32_t value = 0; value < 256; value += 5) {
            struct answer a = whole;
            a.bytes[at] = (uint8_t)value;
            (void)bus_link_read(&link, a.bytes, a.size);
        }
    }
}

TEST(what_is_no_answer_is_none)
{
    struct answer a = controller();
    struct bus_link link;
    a.bytes[4] = NLMSG_ERROR;
    a.bytes[5] = 0;
    assert_false(bus_link_read(&link, a.bytes, a.size));
}

TEST(an_interface_that_is_not_there_or_no_bus_is_a_fault)
{
    assert_true(check_bus("can", ""));
    assert_false(check_bus("can", "nosuch0"));
    assert_false(check_bus("can", "lo"));
}

static char folder[] = "/tmp/check-XXXXXX";

/* A panel without devices, which writes nothing. */
static struct config nothing(void)
{
    struct config c;
    config_defaults(&c);
    c.glass = CONFIG_GLASS_NONE;
    c.can[0] = c.record[0] = c.settings[0] = c.faults[0] = c.database_serial[0] = '\0';
    return c;
}

TEST(what_is_not_configured_is_not_tried)
{
    const struct config c = nothing();
    assert_int_equal(check_devices(&c), 0);
}

TEST(each_device_that_is_not_there_counts)
{
    struct config c = nothing();
    c.glass = CONFIG_GLASS_DRM;
    strcpy(c.glass_card, "/nowhere/card0");
    strcpy(c.backlight, "nowhere");
    strcpy(c.watchdog, "/nowhere/watchdog");
    strcpy(c.can_2, "nosuch1");
    c.stick.choice = CONFIG_STICK_NAMED;
    c.stick.vendor = c.stick.product = 0xfffe;
    assert_int_equal(check_devices(&c), 5);
    strcpy(c.record, "/nowhere/at/all");
    strcpy(c.settings, "/nowhere/settings");
    assert_int_equal(check_devices(&c), 7);
}

TEST(folders_that_can_be_written_are_left_as_they_were)
{
    struct config c = nothing();
    strcpy(folder + sizeof folder - 7, "XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(c.record, sizeof c.record, "%s/recordings", folder); /* not made yet */
    snprintf(c.settings, sizeof c.settings, "%s/settings", folder);
    snprintf(c.database_serial, sizeof c.database_serial, "%s/serial", folder);
    assert_int_equal(check_devices(&c), 0);
    assert_int_equal(rmdir(folder), 0); /* nothing was left */
}
