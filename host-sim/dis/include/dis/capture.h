/* Capture: the UDP datagrams of a recorded network, a pcap or pcapng file, which libpcap reads.
 *
 * Links: Ethernet with or without VLAN tags, raw IP, Linux cooked (both versions), loopback. IPv4
 * and IPv6. A datagram in fragments is not put together: it is counted and passed over. */
#ifndef DIS_CAPTURE_H
#define DIS_CAPTURE_H

#include <stddef.h>
#include <stdint.h>

struct dis_packet {
    int64_t time_us;      /* since 1970, as recorded */
    uint16_t port;        /* it was sent to */
    const uint8_t *bytes; /* of the datagram; borrowed until the next one */
    size_t length;
};

struct dis_capture {
    void *pcap;       /* libpcap's */
    const char *path; /* borrowed */
    int link;
    uint64_t packets, other_traffic, fragments, cut_short;
};

/* Open a capture. Returns 0, or -1 with the error reported: it cannot be read, is no capture, or
 * is one of a link that is not read. */
int dis_capture_open(struct dis_capture *c, const char *path);

/* The next datagram. Returns 1, 0 at the end, or -1 with the error reported: the file is damaged
 * from here on. */
int dis_capture_next(struct dis_capture *c, struct dis_packet *packet);

/* Bytes of the file, and how many of them were read; for a progress bar. */
uint64_t dis_capture_size(const struct dis_capture *c);
uint64_t dis_capture_at(const struct dis_capture *c);

void dis_capture_close(struct dis_capture *c);

/* What a packet of `length` bytes is. */
enum dis_traffic {
    DIS_TRAFFIC_UDP,
    DIS_TRAFFIC_OTHER,
    DIS_TRAFFIC_FRAGMENT,
    DIS_TRAFFIC_CUT /* the recorder kept less of it than was sent */
};

/* Find the UDP datagram in a packet of libpcap's link type `link`: port, bytes and length are
 * written for DIS_TRAFFIC_UDP. Every byte is hostile. */
enum dis_traffic dis_find_udp(int link, const uint8_t *bytes, size_t length,
                              struct dis_packet *packet);

#endif
