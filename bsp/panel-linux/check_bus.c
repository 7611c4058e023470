#include "check_bus.h"

#include "report.h"

#include <errno.h>
#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* The attribute of a kind among `size` bytes, or NULL. */
static const struct rtattr *find(const uint8_t *bytes, size_t size, unsigned short kind)
{
    struct rtattr a;
    for (size_t at = 0; at + sizeof a <= size;) {
        memcpy(&a, bytes + at, sizeof a);
        if (a.rta_len < sizeof a || a.rta_len > size - at) {
            return NULL;
        }
        if ((a.rta_type & NLA_TYPE_MASK) == kind) {
            return (const struct rtattr *)(const void *)(bytes + at);
        }
        at += RTA_ALIGN(a.rta_len);
    }
    return NULL;
}

static const struct rtattr *within(const struct rtattr *outer, unsigned short kind)
{
    return outer == NULL ? NULL : find(RTA_DATA(outer), RTA_PAYLOAD(outer), kind);
}

static uint32_t number_of(const struct rtattr *a)
{
    uint32_t number = 0;
    if (a != NULL && RTA_PAYLOAD(a) >= sizeof number) {
        memcpy(&number, RTA_DATA(a), sizeof number); /* bit timing begins with the bit rate */
    }
    return number;
}

bool bus_link_read(struct bus_link *link, const uint8_t *answer, size_t size)
{
    struct nlmsghdr head;
    struct ifinfomsg info;
    *link = (struct bus_link){0};
    if (size < NLMSG_LENGTH(sizeof info)) {
        return false;
    }
    memcpy(&head, answer, sizeof head);
    memcpy(&info, answer + NLMSG_HDRLEN, sizeof info);
    if (head.nlmsg_type != RTM_NEWLINK || head.nlmsg_len > size ||
        head.nlmsg_len < NLMSG_SPACE(sizeof info)) {
        return false;
    }
    link->is_can = info.ifi_type == ARPHRD_CAN;
    link->is_up = (info.ifi_flags & IFF_UP) != 0;
    const size_t at = NLMSG_SPACE(sizeof info);
    const struct rtattr *can =
        within(find(answer + at, head.nlmsg_len - at, IFLA_LINKINFO), IFLA_INFO_DATA);
    link->has_controller = within(can, IFLA_CAN_STATE) != NULL;
    link->bits_per_s = number_of(within(can, IFLA_CAN_BITTIMING));
    link->restart_ms = number_of(within(can, IFLA_CAN_RESTART_MS));
    link->state = number_of(within(can, IFLA_CAN_STATE));
    return true;
}

/* 0, or errno. */
static int ask(struct bus_link *link, unsigned index)
{
    _Alignas(struct nlmsghdr) uint8_t answer[8192];
    struct {
        struct nlmsghdr head;
        struct ifinfomsg info;
    } question = {.head = {.nlmsg_len = sizeof question,
                           .nlmsg_type = RTM_GETLINK,
                           .nlmsg_flags = NLM_F_REQUEST},
                  .info = {.ifi_index = (int)index}};
    const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
    if (fd < 0 || send(fd, &question, sizeof question, 0) < 0) {
        const int cause = errno;
        if (fd >= 0) {
            close(fd);
        }
        return cause;
    }
    const ssize_t size = recv(fd, answer, sizeof answer, 0);
    close(fd);
    return size > 0 && bus_link_read(link, answer, (size_t)size) ? 0 : EPROTO;
}

static const char *fault_of(const struct bus_link *link)
{
    return !link->is_can                               ? "is no CAN interface; ip -details link"
           : link->has_controller && !link->bits_per_s ? "has no bit rate; ip link set INTERFACE "
                                                         "type can bitrate 1000000"
           : !link->is_up                              ? "is down; ip link set INTERFACE up"
           : link->has_controller && link->state == CAN_STATE_BUS_OFF
               ? "has left the bus (bus-off): wiring, or another bit rate than the others'"
           : link->has_controller && link->state == CAN_STATE_ERROR_PASSIVE
               ? "finds errors on the bus: no other node, wiring, or another bit rate"
           : link->has_controller && link->restart_ms == 0
               ? "would never come back after bus-off; ip link set INTERFACE type can restart-ms "
                 "100"
               : NULL;
}

bool check_bus(const char *option, const char *interface)
{
    struct bus_link link = {0};
    if (interface[0] == '\0') {
        return true;
    }
    const unsigned index = if_nametoindex(interface);
    const int cause = index == 0 ? ENODEV : ask(&link, index);
    if (cause != 0) {
        report(REPORT_ERROR, "%s: %s: %s; ip link", option, interface,
               index == 0 ? "no such interface" : strerror(cause));
        return false;
    }
    const char *fault = fault_of(&link);
    if (fault != NULL) {
        report(REPORT_ERROR, "%s: %s: %s", option, interface, fault);
    } else if (link.has_controller) {
        report(REPORT_INFO, "%s: %s: up, %u bit/s", option, interface, link.bits_per_s);
    } else {
        report(REPORT_INFO, "%s: %s: up", option, interface);
    }
    return fault == NULL;
}
