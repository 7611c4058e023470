#include "dis/capture.h"

#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <pcap/pcap.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>

static bool is_read(int link)
{
    static const int links[] = {DLT_EN10MB,    DLT_LINUX_SLL, DLT_NULL, DLT_LOOP,
                                DLT_RAW,       DLT_IPV4,      DLT_IPV6,
#ifdef DLT_LINUX_SLL2
                                DLT_LINUX_SLL2
#endif
    };
    for (size_t i = 0; i < sizeof links / sizeof *links; i++) {
        if (links[i] == link) {
            return true;
        }
    }
    return false;
}

int dis_capture_open(struct dis_capture *c, const char *path)
{
    char cause[PCAP_ERRBUF_SIZE] = "";
    *c = (struct dis_capture){.path = path};
    FILE *in = hs_input_open(path, "rb");
    if (in == NULL) {
        return hs_error(path, "tcpdump -w makes one", "cannot be opened: %s", strerror(errno));
    }
    pcap_t *pcap = pcap_fopen_offline(in, cause);
    if (pcap == NULL) {
        fclose(in);
        return hs_error(path, "tcpdump -w makes one", "is no capture: %s", cause);
    }
    c->pcap = pcap; /* the stream is its own now */
    c->link = pcap_datalink(pcap);
    if (!is_read(c->link)) {
        const char *name = pcap_datalink_val_to_name(c->link);
        dis_capture_close(c);
        return hs_error(path, "record on Ethernet, or on Linux's \"any\"",
                        "was recorded on a link that is not read: %s", name ? name : "unknown");
    }
    return 0;
}

static void count(struct dis_capture *c, enum dis_traffic traffic)
{
    c->other_traffic += traffic == DIS_TRAFFIC_OTHER;
    c->fragments += traffic == DIS_TRAFFIC_FRAGMENT;
    c->cut_short += traffic == DIS_TRAFFIC_CUT;
}

int dis_capture_next(struct dis_capture *c, struct dis_packet *packet)
{
    struct pcap_pkthdr *head;
    const uint8_t *bytes;
    int status;
    while ((status = pcap_next_ex(c->pcap, &head, &bytes)) == 1) {
        c->packets++;
        const enum dis_traffic traffic = dis_find_udp(c->link, bytes, head->caplen, packet);
        if (traffic == DIS_TRAFFIC_UDP) {
            packet->time_us = (int64_t)head->ts.tv_sec * 1000000 + head->ts.tv_usec;
            return 1;
        }
        count(c, traffic);
    }
    if (status == PCAP_ERROR_BREAK) { /* libpcap's word for the end of a file */
        return 0;
    }
    return hs_error(c->path, "what stands before it was read", "packet %llu: %s",
                    (unsigned long long)c->packets + 1, pcap_geterr(c->pcap));
}

uint64_t dis_capture_size(const struct dis_capture *c)
{
    struct stat status;
    return fstat(fileno(pcap_file(c->pcap)), &status) == 0 ? (uint64_t)status.st_size : 0;
}

uint64_t dis_capture_at(const struct dis_capture *c)
{
    const long at = ftell(pcap_file(c->pcap));
    return at > 0 ? (uint64_t)at : 0;
}

void dis_capture_close(struct dis_capture *c)
{
    if (c->pcap != NULL) {
        pcap_close(c->pcap);
        c->pcap = NULL;
    }
}
