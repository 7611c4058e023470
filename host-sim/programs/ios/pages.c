/* Sockets of pages: the bus both ways, and recordings as they grow. */
#include "server.h"

#include "hs/real_time.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 32768 };

static struct server *server_of(struct lws *wsi)
{
    return lws_context_user(lws_get_context(wsi));
}

/* A socket may be opened by those who may ask, unless there are too many. */
static int filter(struct server *s, struct lws *wsi, int open)
{
    const unsigned status = server_admits(s, wsi);
    if (status == 0 && open < PAGES_MAX) {
        return 0;
    }
    (void)lws_return_http_status(wsi, status != 0 ? status : server_refuse(s, REFUSED_CROWD), NULL);
    return -1;
}

/* Does the address of the socket mean this? Its name goes to *route. */
static bool is_for(struct lws *wsi, enum ios_route_kind kind, struct ios_route *route)
{
    char path[IOS_PATH_MAX + 2];
    return lws_hdr_copy(wsi, path, sizeof path, WSI_TOKEN_GET_URI) > 0 &&
           ios_route_read(route, path) && route->kind == kind;
}

static int write_text(struct lws *wsi, char *buffer, size_t length)
{
    return lws_write(wsi, (unsigned char *)buffer + LWS_PRE, length, LWS_WRITE_TEXT) < (int)length
               ? -1
               : 0;
}

/* ---- the bus ---- */

static int open_page(struct server *s, struct lws *wsi, struct page *p)
{
    struct ios_route route;
    if (!is_for(wsi, IOS_ROUTE_BUS, &route) || s->pages == PAGES_MAX) {
        (void)server_refuse(s, REFUSED_PATH);
        return -1;
    }
    memset(p, 0, sizeof *p);
    p->at = s->bus->feed.end;
    p->past = ios_feed_past(&s->bus->feed, &p->past_bytes);
    p->allowance = PAGE_FRAMES_A_S;
    p->allowed_us = hs_clock_us(CLOCK_MONOTONIC);
    p->is_open = true;
    s->page[s->pages++] = wsi;
    s->count.pages++;
    lws_callback_on_writable(wsi);
    return 0;
}

static void close_page(struct server *s, const struct lws *wsi, struct page *p)
{
    if (!p->is_open) {
        return;
    }
    free(p->past);
    p->past = NULL;
    p->is_open = false;
    int i = 0;
    while (s->page[i] != wsi) {
        i++;
    }
    s->page[i] = s->page[--s->pages];
}

/* A page may save up the frames of one second. */
static bool may_go(struct page *p)
{
    const int64_t now = hs_clock_us(CLOCK_MONOTONIC);
    p->allowance += (double)(now - p->allowed_us) * 1e-6 * PAGE_FRAMES_A_S;
    p->allowance = p->allowance < PAGE_FRAMES_A_S ? p->allowance : PAGE_FRAMES_A_S;
    p->allowed_us = now;
    if (p->allowance < 1) {
        return false;
    }
    p->allowance -= 1;
    return true;
}

static void refuse_line(struct server *s, struct page *p, enum refusal why, const char *cause)
{
    (void)server_refuse(s, why);
    snprintf(p->reply, sizeof p->reply, "! %.150s\n", cause);
}

static void take_line(struct server *s, struct page *p, const char *line, size_t length)
{
    struct lm_can_frame frame;
    const char *cause = ios_line_read(line, length, &frame);
    if (cause != NULL) {
        refuse_line(s, p, REFUSED_LINE, cause);
    } else if (ios_instructor_slot(&frame) < 0) {
        refuse_line(s, p, REFUSED_ID, "this identifier is not an instructor's: docs/bus.md");
    } else if (s->command->is_listening_only) {
        refuse_line(s, p, REFUSED_LISTENER, "pages may only listen here");
    } else if (!may_go(p)) {
        refuse_line(s, p, REFUSED_FLOOD, "too many frames in a second");
    } else if (!bus_send(s->bus, &frame)) {
        refuse_line(s, p, REFUSED_FULL, "the bus has no room; the frame is not sent");
    }
}

static void take_message(struct server *s, struct page *p)
{
    for (size_t at = 0; at < p->length;) {
        const char *line = p->message + at;
        const char *feed = memchr(line, '\n', p->length - at);
        size_t length = feed != NULL ? (size_t)(feed - line) : p->length - at;
        at += length + 1;
        length -= length > 0 && line[length - 1] == '\r';
        if (length > 0) {
            take_line(s, p, line, length);
        }
    }
}

/* A message comes in pieces. */
static void receive(struct server *s, struct lws *wsi, struct page *p, const char *piece,
                    size_t length)
{
    const bool fits = !p->is_long && length <= sizeof p->message - p->length;
    p->is_long = !fits;
    if (fits) {
        memcpy(p->message + p->length, piece, length);
        p->length += length;
    }
    if (!lws_is_final_fragment(wsi) || lws_remaining_packet_payload(wsi) > 0) {
        return;
    }
    if (p->is_long || lws_frame_is_binary(wsi)) {
        refuse_line(s, p, p->is_long ? REFUSED_FLOOD : REFUSED_LINE,
                    p->is_long ? "the message is too long" : "messages are texts");
    } else {
        take_message(s, p);
    }
    p->length = 0;
    p->is_long = false;
    if (p->reply[0] != '\0') {
        lws_callback_on_writable(wsi);
    }
}

/* What was, in pieces of whole lines. A frame that nobody sends says that it is all. */
static const struct lm_can_frame end_frame = {.id = 0x7ff};

static size_t take_past(struct page *p, char *to)
{
    char end[IOS_LINE_MAX];
    const size_t end_length =
        ios_line_write(end, "past", (uint64_t)hs_clock_us(CLOCK_REALTIME), &end_frame);
    size_t length = p->past_bytes - p->past_at;
    if (length > CHUNK - IOS_LINE_MAX) {
        length = CHUNK - IOS_LINE_MAX;
        while (p->past[p->past_at + length - 1] != '\n') {
            length--;
        }
    }
    if (length > 0) {
        memcpy(to, p->past + p->past_at, length);
    }
    p->past_at += length;
    if (p->past_at < p->past_bytes) {
        return length;
    }
    memcpy(to + length, end, end_length);
    p->is_past_told = true;
    return length + end_length;
}

static int write_page(struct server *s, struct lws *wsi, struct page *p)
{
    char buffer[LWS_PRE + CHUNK];
    long length;
    if (p->reply[0] != '\0') {
        length = snprintf(buffer + LWS_PRE, CHUNK, "%s", p->reply);
        p->reply[0] = '\0';
    } else if (!p->is_past_told) {
        length = (long)take_past(p, buffer + LWS_PRE);
    } else {
        length = ios_feed_take(&s->bus->feed, &p->at, buffer + LWS_PRE, CHUNK);
    }
    if (length <= 0) { /* less: check_page sees to it */
        return 0;
    }
    if (p->at != s->bus->feed.end || !p->is_past_told) {
        lws_callback_on_writable(wsi);
    }
    return write_text(wsi, buffer, (size_t)length);
}

/* libwebsockets asks a page to write only when its browser has taken what came before. One that
 * never does is found here, when the feed has gone round. */
void pages_check(struct server *s)
{
    for (int i = 0; i < s->pages; i++) {
        const struct page *p = lws_wsi_user(s->page[i]);
        if (s->bus->feed.end - p->at > s->bus->feed.room) {
            (void)server_refuse(s, REFUSED_SLOW);
            lws_set_timeout(s->page[i], PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_ASYNC);
        }
    }
}

int page_callback(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                  size_t length)
{
    struct server *s = server_of(wsi);
    struct page *p = user;
    switch ((int)reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return filter(s, wsi, s->pages);
    case LWS_CALLBACK_ESTABLISHED:
        return open_page(s, wsi, p);
    case LWS_CALLBACK_RECEIVE:
        receive(s, wsi, p, in, length);
        return 0;
    case LWS_CALLBACK_SERVER_WRITEABLE:
        return p->is_open ? write_page(s, wsi, p) : 0;
    case LWS_CALLBACK_CLOSED:
        close_page(s, wsi, p);
        return 0;
    default:
        return 0;
    }
}

/* ---- recordings ---- */

static int open_repeater(struct server *s, struct lws *wsi, struct repeater *r)
{
    struct ios_route route;
    const struct display *d =
        is_for(wsi, IOS_ROUTE_DISPLAY, &route) ? server_display(s, route.name) : NULL;
    *r = (struct repeater){.follow.fd = -1};
    if (d == NULL || !ios_follow_open(&r->follow, d->folder)) {
        (void)server_refuse(s, REFUSED_NOTHING);
        return -1;
    }
    r->is_open = true;
    s->repeaters++;
    lws_callback_on_writable(wsi);
    return 0;
}

static int write_repeater(struct lws *wsi, struct repeater *r)
{
    char buffer[LWS_PRE + CHUNK];
    const long length = ios_follow_take(&r->follow, buffer + LWS_PRE, CHUNK);
    if (length <= 0) {
        return length < 0 ? -1 : 0;
    }
    if (length > CHUNK / 2) { /* there is more than what has just been written */
        lws_callback_on_writable(wsi);
    }
    return write_text(wsi, buffer, (size_t)length);
}

int repeater_callback(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                      size_t length)
{
    struct server *s = server_of(wsi);
    struct repeater *r = user;
    (void)in;
    (void)length;
    switch ((int)reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return filter(s, wsi, s->repeaters);
    case LWS_CALLBACK_ESTABLISHED:
        return open_repeater(s, wsi, r);
    case LWS_CALLBACK_SERVER_WRITEABLE:
        return r->is_open ? write_repeater(wsi, r) : 0;
    case LWS_CALLBACK_CLOSED:
        if (r->is_open) {
            ios_follow_close(&r->follow);
            r->is_open = false;
            s->repeaters--;
        }
        return 0;
    default:
        return 0;
    }
}
