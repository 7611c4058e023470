/* The web server of landmass-ios, on libwebsockets: who may ask, files and tiles, and the sockets
 * of pages. One thread: a callback serves one browser a little, and never waits for it.
 *
 * Nobody is trusted. A request has to name us as its Host, a page of ours as its Origin, and bear
 * the token if there is one; paths are plain names; a page sends at most PAGE_FRAMES_A_S frames, of
 * the instructors' identifiers alone; one that does not read is closed. Each refusal is counted. */
#ifndef IOS_SERVER_H
#define IOS_SERVER_H

#include "bus.h"
#include "ios/map.h"
#include "ios/recordings.h"

#include <libwebsockets.h>

enum {
    PAGES_MAX = 64,          /* sockets at a time, of each kind */
    PAGE_FRAMES_A_S = 2000,  /* a quarter of a bus of 1 Mbit/s */
    PAGE_MESSAGE_MAX = 65536 /* bytes */
};

enum refusal {
    REFUSED_HOST,     /* the Host header names another */
    REFUSED_ORIGIN,   /* the page is not ours */
    REFUSED_TOKEN,    /* none, or another */
    REFUSED_METHOD,   /* neither GET nor HEAD */
    REFUSED_PATH,     /* no plain path */
    REFUSED_NOTHING,  /* there is no such thing */
    REFUSED_CROWD,    /* too many pages */
    REFUSED_LINE,     /* a line that is no frame */
    REFUSED_ID,       /* a frame that is not an instructor's */
    REFUSED_LISTENER, /* a frame where pages may only listen */
    REFUSED_FLOOD,    /* too many frames, or too long a message */
    REFUSED_SLOW,     /* a page that does not read */
    REFUSED_FULL,     /* a frame that the bus has no room for */
    REFUSALS
};
extern const char *const refusal_keys[REFUSALS]; /* in JSON */

struct server {
    const struct command *command; /* borrowed, as bus and image */
    struct bus *bus;
    const struct image *image;
    struct ios_map map;
    struct ios_hosts hosts;
    char token[TOKEN_MAX + 1]; /* empty: none is asked for */
    struct lws_context *context;
    lws_sorted_usec_list_t tick, follow_tick;
    uint64_t fed; /* bytes of the feed when pages were last told */
    struct lws *page[PAGES_MAX];
    int pages, repeaters;
    struct {
        uint64_t requests, pages, refused[REFUSALS];
    } count;
};

/* Begin to listen. Returns 0, or -1 with the error reported. Close it whatever is returned. */
int server_open(struct server *s, const struct command *c, struct bus *bus,
                const struct image *image);
int server_port(const struct server *s);

/* Serve what is there, for some milliseconds. False: it cannot go on. */
bool server_step(struct server *s);
void server_close(struct server *s);

/* Count a refusal, and return the status of HTTP that tells it. */
unsigned server_refuse(struct server *s, enum refusal why);

/* Is this request ours to answer? 0, or the status that refuses it (server_refuse). */
unsigned server_admits(struct server *s, struct lws *wsi);

/* ---- sessions, one for each request or socket; zero when it begins ---- */

/* A body that is being sent. */
struct answer {
    int fd;           /* of a file; -1: none */
    char *owned;      /* freed with the answer; NULL: none */
    const char *text; /* in memory; NULL: it is the file's */
    uint64_t at, left;
    bool is_begun;
};

/* An instructor's page on the bus. */
struct page {
    uint64_t at;                    /* in the feed */
    char *past;                     /* owned: what was, for a page that comes late */
    size_t past_at, past_bytes;     /* sent, and all of it */
    char message[PAGE_MESSAGE_MAX]; /* that is being received */
    size_t length;
    bool is_long;     /* longer than that */
    char reply[160];  /* "! why a line was refused"; empty: none waits */
    double allowance; /* frames that it may send now */
    int64_t allowed_us;
    bool is_open, is_past_told;
};

/* A repeater that follows a recording. */
struct repeater {
    struct ios_follow follow;
    bool is_open;
};

enum { PROTOCOL_HTTP, PROTOCOL_BUS, PROTOCOL_RECORDING };
extern const struct lws_protocols server_protocols[];
lws_callback_function answers_callback, page_callback, repeater_callback;

/* Close the pages that do not read. */
void pages_check(struct server *s);

/* The display of a name, or NULL. */
const struct display *server_display(const struct server *s, const char *name);

#endif
