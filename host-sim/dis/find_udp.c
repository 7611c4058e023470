/* The way from a link's packet to the datagram in it: IEEE 802.3 and 802.1Q, RFC 791 (IPv4),
 * RFC 8200 (IPv6), RFC 768 (UDP), and the link types of libpcap. */
#include "dis/capture.h"

#include "bytes.h"

#include <pcap/dlt.h>
#include <stdbool.h>

enum { ETHER_IPV4 = 0x0800, ETHER_IPV6 = 0x86dd, ETHER_VLAN = 0x8100, ETHER_QINQ = 0x88a8 };
enum { PROTOCOL_UDP = 17, PROTOCOL_FRAGMENT = 44, IPV4_BYTES = 20, IPV6_BYTES = 40, UDP_BYTES = 8 };

/* What is left of a packet. */
struct rest {
    const uint8_t *at;
    size_t length;
};

static bool skip(struct rest *r, size_t bytes)
{
    if (r->length < bytes) {
        return false;
    }
    r->at += bytes;
    r->length -= bytes;
    return true;
}

/* Ethernet's type behind up to two VLAN tags; 0: there is none. */
static uint16_t ether_type(struct rest *r)
{
    if (!skip(r, 12)) {
        return 0;
    }
    for (int tags = 0; tags < 3 && r->length >= 2; tags++) {
        const uint16_t type = dis_u16(r->at);
        if (type != ETHER_VLAN && type != ETHER_QINQ) {
            return skip(r, 2) ? type : 0;
        }
        if (!skip(r, 4)) {
            return 0;
        }
    }
    return 0;
}

/* A link whose header has `bytes`, with a type at `type_at` or, below 0, none. */
static uint16_t type_of_header(struct rest *r, size_t bytes, int type_at)
{
    if (r->length <= bytes) {
        return 0;
    }
    const uint8_t *head = r->at;
    (void)skip(r, bytes);
    if (type_at >= 0) {
        return dis_u16(head + type_at);
    }
    return r->at[0] >> 4 == 4 ? ETHER_IPV4 : r->at[0] >> 4 == 6 ? ETHER_IPV6 : 0;
}

static uint16_t network_type(int link, struct rest *r)
{
    switch (link) {
    case DLT_EN10MB:
        return ether_type(r);
    case DLT_LINUX_SLL:
        return type_of_header(r, 16, 14);
#ifdef DLT_LINUX_SLL2
    case DLT_LINUX_SLL2:
        return type_of_header(r, 20, 0);
#endif
    case DLT_NULL:
    case DLT_LOOP:
        return type_of_header(r, 4, -1);
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
        return type_of_header(r, 0, -1);
    default:
        return 0;
    }
}

/* Step over the header of IPv4; what is left is cut to the length that it names. */
static enum dis_traffic enter_ipv4(struct rest *r)
{
    if (r->length < IPV4_BYTES || r->at[0] >> 4 != 4) {
        return DIS_TRAFFIC_OTHER;
    }
    const size_t header = (size_t)(r->at[0] & 15) * 4, total = dis_u16(r->at + 2);
    const uint16_t fragment = dis_u16(r->at + 6);
    if (r->at[9] != PROTOCOL_UDP || header < IPV4_BYTES || total < header) {
        return DIS_TRAFFIC_OTHER;
    }
    if ((fragment & 0x3fff) != 0) { /* more follow, or this is not the first */
        return DIS_TRAFFIC_FRAGMENT;
    }
    if (r->length < total) {
        return DIS_TRAFFIC_CUT;
    }
    r->length = total;
    (void)skip(r, header);
    return DIS_TRAFFIC_UDP;
}

static enum dis_traffic enter_ipv6(struct rest *r)
{
    if (r->length < IPV6_BYTES || r->at[0] >> 4 != 6) {
        return DIS_TRAFFIC_OTHER;
    }
    if (r->at[6] != PROTOCOL_UDP) { /* other headers between are not looked through */
        return r->at[6] == PROTOCOL_FRAGMENT ? DIS_TRAFFIC_FRAGMENT : DIS_TRAFFIC_OTHER;
    }
    const size_t length = dis_u16(r->at + 4);
    (void)skip(r, IPV6_BYTES);
    if (r->length < length) {
        return DIS_TRAFFIC_CUT;
    }
    r->length = length;
    return DIS_TRAFFIC_UDP;
}

enum dis_traffic dis_find_udp(int link, const uint8_t *bytes, size_t length,
                              struct dis_packet *packet)
{
    struct rest r = {bytes, length};
    const uint16_t type = network_type(link, &r);
    const enum dis_traffic traffic = type == ETHER_IPV4   ? enter_ipv4(&r)
                                     : type == ETHER_IPV6 ? enter_ipv6(&r)
                                                          : DIS_TRAFFIC_OTHER;
    if (traffic != DIS_TRAFFIC_UDP) {
        return traffic;
    }
    if (r.length < UDP_BYTES || dis_u16(r.at + 4) < UDP_BYTES) {
        return DIS_TRAFFIC_OTHER;
    }
    if (dis_u16(r.at + 4) > r.length) {
        return DIS_TRAFFIC_CUT;
    }
    packet->port = dis_u16(r.at + 2);
    packet->bytes = r.at + UDP_BYTES;
    packet->length = dis_u16(r.at + 4) - (size_t)UDP_BYTES;
    return DIS_TRAFFIC_UDP;
}
