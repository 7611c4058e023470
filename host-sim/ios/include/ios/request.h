/* What a browser asks for: paths, ranges, hosts, tokens. Every text here comes from the network; a
 * function reads up to its terminating zero, and accepts nothing that its comment does not name. */
#ifndef IOS_REQUEST_H
#define IOS_REQUEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    IOS_PATH_MAX = 200, /* characters of a file's path below its folder */
    IOS_NAME_MAX = 64,  /* characters of one name in a path */
    IOS_HOSTS_MAX = 16,
    IOS_ZOOM_MAX = 22
};

enum ios_route_kind {
    IOS_ROUTE_FILE,      /* of the site; name */
    IOS_ROUTE_IMAGE,     /* /image */
    IOS_ROUTE_MAP,       /* /map.json */
    IOS_ROUTE_TILE,      /* /map/Z/X/Y.png; zoom, x, y */
    IOS_ROUTE_STATION,   /* /station.json */
    IOS_ROUTE_LIST,      /* /recordings.json */
    IOS_ROUTE_RECORDING, /* /recordings/NAME or /recordings/FOLDER/NAME; name */
    IOS_ROUTE_COUNTERS,  /* /counters.json */
    IOS_ROUTE_BUS,       /* /bus */
    IOS_ROUTE_DISPLAY    /* /display/NAME; name */
};

struct ios_route {
    enum ios_route_kind kind;
    char name[IOS_PATH_MAX + 1];
    uint32_t zoom, x, y; /* x and y below 2^zoom, zoom at most IOS_ZOOM_MAX */
};

/* Read a path, already without percent signs. "/" and a path that ends in "/" mean index.html
 * there. False if it is none: it does not begin with "/", is too long, or a name in it is empty,
 * too long, begins with a point, or has another character than letters, digits, and . _ - */
bool ios_route_read(struct ios_route *route, const char *path);

/* A name as ios_route_read takes it in a path. */
bool ios_name_is_plain(const char *name, size_t length);

/* Bytes of a body. */
struct ios_range {
    uint64_t first, bytes;
};
enum ios_range_kind { IOS_RANGE_ALL, IOS_RANGE_PART, IOS_RANGE_NONE };

/* Read a Range header (RFC 9110, 14.2) for a body of `size` bytes. *range is what to send:
 * - ALL: there is no header (NULL), or one that a server may pass over: another unit, several
 * ranges, no number;
 * - PART: one range, cut to the body;
 * - NONE: it lies behind the body's end (416). */
enum ios_range_kind ios_range_read(struct ios_range *range, const char *header, uint64_t size);

/* Names by which the server may be called, "127.0.0.1:8470", in small letters. */
struct ios_hosts {
    char name[IOS_HOSTS_MAX][IOS_NAME_MAX + 1];
    int count;
};

/* Add a name. False if it does not fit, or has a character that no host has. */
bool ios_hosts_add(struct ios_hosts *hosts, const char *name);

/* Is this the Host header of a request for us? Is this the Origin header, if there is one, of one
 * of our own pages: "http://" or "https://" and such a host, and nothing else? */
bool ios_host_is_ours(const struct ios_hosts *hosts, const char *host);
bool ios_origin_is_ours(const struct ios_hosts *hosts, const char *origin);

/* Are two texts the same? Takes as long whatever they are, but for their lengths. */
bool ios_is_same_secret(const char *a, const char *b);

/* Find the value of `name` in a Cookie header. False if it is not there or does not fit. */
bool ios_cookie_read(const char *header, const char *name, char *value, size_t room);

/* The token of an Authorization header ("Bearer TOKEN"); NULL: it is none. */
const char *ios_bearer_token(const char *header);

/* Media type of a file, by the end of its name. */
const char *ios_media_type(const char *name);

#endif
