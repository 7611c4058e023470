/* Answers to GET and HEAD: files of the site, the image and recordings in ranges, tiles of the map,
 * and what pages ask about the station. */
#include "server.h"

#include "hs/json.h"
#include "lm/version.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { CHUNK = 32768, HEAD_MAX = 4096 };

static const char POLICY[] =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src "
    "'self'; "
    "connect-src 'self'; img-src 'self' data: blob:; media-src blob:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";

/* ---- heads ---- */

struct head {
    unsigned status;
    const char *type;
    uint64_t length, whole; /* of the body that is sent, and of all of it */
    uint64_t first;         /* of a part */
    const char *tag;        /* NULL: none */
};

struct writer {
    struct lws *wsi;
    uint8_t *at, *end;
    bool has_failed;
};

static void put(struct writer *w, const char *name, const char *value)
{
    w->has_failed |=
        lws_add_http_header_by_name(w->wsi, (const uint8_t *)name, (const uint8_t *)value,
                                    (int)strlen(value), &w->at, w->end) != 0;
}

static void put_range(struct writer *w, const struct head *h)
{
    char text[80];
    if (h->status == HTTP_STATUS_PARTIAL_CONTENT) {
        snprintf(text, sizeof text, "bytes %llu-%llu/%llu", (unsigned long long)h->first,
                 (unsigned long long)(h->first + h->length - 1), (unsigned long long)h->whole);
        put(w, "content-range:", text);
    } else if (h->status == HTTP_STATUS_REQ_RANGE_NOT_SATISFIABLE) {
        snprintf(text, sizeof text, "bytes */%llu", (unsigned long long)h->whole);
        put(w, "content-range:", text);
    }
}

/* Whoever came with the token in the address keeps it as a cookie. */
static void put_cookie(struct writer *w, const struct server *s)
{
    char text[TOKEN_MAX + 100];
    if (s->token[0] != '\0' && lws_get_urlarg_by_name(w->wsi, "token=", text, sizeof text)) {
        snprintf(text, sizeof text, "landmass_token=%s; HttpOnly; SameSite=Strict; Path=/",
                 s->token);
        put(w, "set-cookie:", text);
    }
}

static int write_head(struct server *s, struct lws *wsi, const struct head *h)
{
    uint8_t buffer[LWS_PRE + HEAD_MAX], *start = buffer + LWS_PRE;
    struct writer w = {wsi, start, buffer + sizeof buffer - 1, false};
    if (lws_add_http_common_headers(wsi, h->status, h->type, h->length, &w.at, w.end) != 0) {
        return -1;
    }
    put(&w, "content-security-policy:", POLICY);
    put(&w, "x-content-type-options:", "nosniff");
    put(&w, "referrer-policy:", "no-referrer");
    put(&w, "cross-origin-resource-policy:", "same-origin");
    put(&w, "cache-control:", "no-cache");
    put(&w, "accept-ranges:", "bytes");
    if (h->tag != NULL) {
        put(&w, "etag:", h->tag);
    }
    put_range(&w, h);
    put_cookie(&w, s);
    return w.has_failed ? -1 : lws_finalize_write_http_header(wsi, start, &w.at, w.end);
}

/* ---- bodies ---- */

static void close_answer(struct answer *a)
{
    if (a->is_begun && a->fd >= 0) {
        close(a->fd);
    }
    free(a->owned);
    *a = (struct answer){.fd = -1};
}

static int finish(struct lws *wsi, struct answer *a)
{
    close_answer(a);
    return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

/* The head goes out now, the body of *a as the browser takes it. */
static int begin(struct server *s, struct lws *wsi, struct answer *a, const struct head *h)
{
    const bool is_head = lws_hdr_total_length(wsi, WSI_TOKEN_HEAD_URI) > 0;
    a->is_begun = true;
    if (write_head(s, wsi, h) != 0) {
        close_answer(a);
        return -1;
    }
    if (is_head || a->left == 0) {
        return finish(wsi, a);
    }
    lws_callback_on_writable(wsi);
    return 0;
}

static int go_on(struct lws *wsi, struct answer *a)
{
    uint8_t buffer[LWS_PRE + CHUNK];
    if (!a->is_begun) {
        return 0;
    }
    size_t length = a->left < CHUNK ? (size_t)a->left : CHUNK;
    if (a->text != NULL) {
        memcpy(buffer + LWS_PRE, a->text + a->at, length);
    } else if (pread(a->fd, buffer + LWS_PRE, length, (off_t)a->at) != (ssize_t)length) {
        return -1; /* the file has become shorter: the browser sees that the body was cut */
    }
    a->at += length;
    a->left -= length;
    const enum lws_write_protocol how = a->left == 0 ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP;
    if (lws_write(wsi, buffer + LWS_PRE, length, how) < (int)length) {
        return -1;
    }
    if (a->left == 0) {
        return finish(wsi, a);
    }
    lws_callback_on_writable(wsi);
    return 0;
}

/* A body in memory, which the answer frees where `owned` is it. */
static int answer_text(struct server *s, struct lws *wsi, struct answer *a, unsigned status,
                       const char *type, const char *text, size_t length, char *owned)
{
    *a = (struct answer){.fd = -1, .owned = owned, .text = text, .left = length};
    const struct head h = {.status = status, .type = type, .length = length, .whole = length};
    return begin(s, wsi, a, &h);
}

static int answer_status(struct server *s, struct lws *wsi, struct answer *a, unsigned status)
{
    static const char *const texts[][2] = {{"400", "bad request\n"},
                                           {"401", "a token is needed\n"},
                                           {"403", "forbidden\n"},
                                           {"404", "there is no such thing\n"},
                                           {"503", "too many\n"}};
    const char *text = "";
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        text = (unsigned)atoi(texts[i][0]) == status ? texts[i][1] : text;
    }
    return answer_text(s, wsi, a, status, "text/plain", text, strlen(text), NULL);
}

/* A file, whole or the range that is asked for. */
static int answer_file(struct server *s, struct lws *wsi, struct answer *a, const char *path,
                       const char *type, const char *tag)
{
    struct stat status;
    char text[100];
    *a = (struct answer){.fd = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
    if (a->fd < 0 || fstat(a->fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        if (a->fd >= 0) {
            close(a->fd);
        }
        return answer_status(s, wsi, a, server_refuse(s, REFUSED_NOTHING));
    }
    struct ios_range range;
    const bool is_asked = lws_hdr_copy(wsi, text, sizeof text, WSI_TOKEN_HTTP_RANGE) > 0;
    const enum ios_range_kind kind =
        ios_range_read(&range, is_asked ? text : NULL, (uint64_t)status.st_size);
    struct head h = {
        .status = HTTP_STATUS_OK, .type = type, .whole = (uint64_t)status.st_size, .tag = tag};
    if (kind == IOS_RANGE_NONE) {
        h.status = HTTP_STATUS_REQ_RANGE_NOT_SATISFIABLE;
        range = (struct ios_range){0, 0};
    } else if (kind == IOS_RANGE_PART) {
        h.status = HTTP_STATUS_PARTIAL_CONTENT;
    }
    h.first = a->at = range.first;
    h.length = a->left = range.bytes;
    return begin(s, wsi, a, &h);
}

/* ---- what pages ask ---- */

static void tell_station(const struct server *s, struct hs_json *j)
{
    hs_json_text(j, "bus", s->bus->name);
    hs_json_flag(j, "may_send", !s->command->is_listening_only);
    hs_json_text(j, "version", LM_VERSION);
    hs_json_array(j, "displays");
    for (int i = 0; i < s->command->display_count; i++) {
        const struct display *d = &s->command->display[i];
        char now[IOS_NAME_MAX + 1];
        hs_json_object(j, NULL);
        hs_json_text(j, "name", d->name);
        hs_json_integer(j, "node", d->node);
        hs_json_text(j, "recording", ios_recording_now(d->folder, now) ? now : NULL);
        hs_json_close(j);
    }
    hs_json_close(j);
}

static void tell_map(const struct server *s, struct hs_json *j)
{
    const struct ios_bounds b = ios_map_bounds(&s->map);
    hs_json_text(j, "title", s->image->db.title);
    hs_json_real(j, "west", b.west);
    hs_json_real(j, "south", b.south);
    hs_json_real(j, "east", b.east);
    hs_json_real(j, "north", b.north);
    hs_json_count(j, "zoom_max", b.zoom_max);
}

static void tell_counters(const struct server *s, struct hs_json *j)
{
    hs_json_integer(j, "pages", s->pages);
    hs_json_integer(j, "repeaters", s->repeaters);
    hs_json_count(j, "requests", s->count.requests);
    hs_json_count(j, "frames_heard", s->bus->count.heard);
    hs_json_count(j, "frames_sent", s->bus->count.sent);
    hs_json_count(j, "frames_not_sent", s->bus->count.failed);
    hs_json_object(j, "refused");
    for (int i = 0; i < REFUSALS; i++) {
        hs_json_count(j, refusal_keys[i], s->count.refused[i]);
    }
    hs_json_close(j);
}

/* A recording began before clocks were set: its time says nothing. */
static const double TIME_LEAST_S = 1577836800; /* 2020 */

static void tell_recording(FILE *out, const struct ios_recording *r)
{
    char utc[32];
    const time_t start = (time_t)r->start_s;
    struct tm parts;
    struct hs_json j;
    hs_json_begin(&j, out);
    hs_json_text(&j, "name", r->name);
    hs_json_count(&j, "bytes", r->bytes);
    const bool is_dated = r->start_s >= TIME_LEAST_S && gmtime_r(&start, &parts) != NULL &&
                          strftime(utc, sizeof utc, "%Y-%m-%dT%H:%M:%SZ", &parts) > 0;
    hs_json_text(&j, "start_utc", is_dated ? utc : NULL);
    hs_json_real(&j, "seconds", r->seconds);
    hs_json_end(&j);
}

static int list_recordings(const struct server *s, struct ios_recording *list)
{
    int count = 0;
    if (s->command->recordings != NULL) {
        count = ios_recordings(s->command->recordings, "", list, IOS_RECORDINGS_MAX);
    }
    for (int i = 0; i < s->command->display_count; i++) {
        const struct display *d = &s->command->display[i];
        char prefix[IOS_NAME_MAX + 2];
        snprintf(prefix, sizeof prefix, "%s/", d->name);
        count += ios_recordings(d->folder, prefix, list + count, IOS_RECORDINGS_MAX - count);
    }
    return count;
}

/* An array: hs_json writes an object at the outermost. */
static void tell_recordings(const struct server *s, FILE *out)
{
    struct ios_recording *list = calloc(IOS_RECORDINGS_MAX, sizeof *list);
    const int count = list != NULL ? list_recordings(s, list) : 0;
    fputc('[', out);
    for (int i = 0; i < count; i++) {
        fputs(i > 0 ? ",\n" : "", out);
        tell_recording(out, &list[i]);
    }
    fputs("]\n", out);
    free(list);
}

static int answer_json(struct server *s, struct lws *wsi, struct answer *a,
                       enum ios_route_kind kind)
{
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    struct hs_json j;
    if (out == NULL) {
        return -1;
    }
    if (kind == IOS_ROUTE_LIST) {
        tell_recordings(s, out);
    } else {
        hs_json_begin(&j, out);
        if (kind == IOS_ROUTE_STATION) {
            tell_station(s, &j);
        } else if (kind == IOS_ROUTE_MAP) {
            tell_map(s, &j);
        } else {
            tell_counters(s, &j);
        }
        hs_json_end(&j);
    }
    if (fclose(out) != 0) {
        free(text);
        return -1;
    }
    return answer_text(s, wsi, a, HTTP_STATUS_OK, "application/json", text, length, text);
}

/* The tile is copied: another may take its place before the browser has it. */
static int answer_tile(struct server *s, struct lws *wsi, struct answer *a,
                       const struct ios_route *r)
{
    const struct ios_tile *t = ios_map_tile(&s->map, r->zoom, r->x, r->y);
    char *copy = t != NULL && t->bytes != NULL ? malloc(t->size) : NULL;
    if (t == NULL || (t->bytes != NULL && copy == NULL)) {
        return -1;
    }
    if (copy == NULL) {
        return answer_text(s, wsi, a, HTTP_STATUS_NO_CONTENT, "image/png", "", 0, NULL);
    }
    memcpy(copy, t->bytes, t->size);
    return answer_text(s, wsi, a, HTTP_STATUS_OK, "image/png", copy, t->size, copy);
}

static int answer_in(struct server *s, struct lws *wsi, struct answer *a, const char *folder,
                     const char *name)
{
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= sizeof path) {
        return answer_status(s, wsi, a, server_refuse(s, REFUSED_NOTHING));
    }
    return answer_file(s, wsi, a, path, ios_media_type(name), NULL);
}

/* NAME, or DISPLAY/NAME of a display's own. */
static int answer_recording(struct server *s, struct lws *wsi, struct answer *a, char *name)
{
    char *slash = strchr(name, '/');
    const struct display *d = NULL;
    if (slash != NULL) {
        *slash = '\0';
        d = server_display(s, name);
    }
    const char *folder = slash == NULL ? s->command->recordings : d != NULL ? d->folder : NULL;
    return folder == NULL ? answer_status(s, wsi, a, server_refuse(s, REFUSED_NOTHING))
                          : answer_in(s, wsi, a, folder, slash != NULL ? slash + 1 : name);
}

static int answer_image(struct server *s, struct lws *wsi, struct answer *a)
{
    char tag[32];
    snprintf(tag, sizeof tag, "\"%08x\"", s->image->header.crc);
    return answer_file(s, wsi, a, s->command->image_path, "application/octet-stream", tag);
}

static int answer(struct server *s, struct lws *wsi, struct answer *a, const char *path)
{
    struct ios_route route;
    const unsigned status = server_admits(s, wsi);
    s->count.requests++;
    if (status != 0) {
        return answer_status(s, wsi, a, status);
    }
    if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) <= 0 &&
        lws_hdr_total_length(wsi, WSI_TOKEN_HEAD_URI) <= 0) {
        const struct head h = {.status = server_refuse(s, REFUSED_METHOD), .type = "text/plain"};
        (void)write_head(s, wsi, &h);
        return -1; /* its body is not read */
    }
    if (!ios_route_read(&route, path)) {
        return answer_status(s, wsi, a, server_refuse(s, REFUSED_PATH));
    }
    switch (route.kind) {
    case IOS_ROUTE_FILE:
        return answer_in(s, wsi, a, s->command->site, route.name);
    case IOS_ROUTE_IMAGE:
        return answer_image(s, wsi, a);
    case IOS_ROUTE_TILE:
        return answer_tile(s, wsi, a, &route);
    case IOS_ROUTE_RECORDING:
        return answer_recording(s, wsi, a, route.name);
    case IOS_ROUTE_MAP:
    case IOS_ROUTE_STATION:
    case IOS_ROUTE_LIST:
    case IOS_ROUTE_COUNTERS:
        return answer_json(s, wsi, a, route.kind);
    case IOS_ROUTE_BUS:
    case IOS_ROUTE_DISPLAY:
        break; /* sockets */
    }
    return answer_status(s, wsi, a, server_refuse(s, REFUSED_NOTHING));
}

int answers_callback(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                     size_t length)
{
    struct answer *a = user;
    switch ((int)reason) {
    case LWS_CALLBACK_HTTP:
        close_answer(a);
        return answer(lws_context_user(lws_get_context(wsi)), wsi, a, in);
    case LWS_CALLBACK_HTTP_WRITEABLE:
        return go_on(wsi, a);
    case LWS_CALLBACK_HTTP_DROP_PROTOCOL:
    case LWS_CALLBACK_CLOSED_HTTP:
        if (a != NULL) {
            close_answer(a);
        }
        return 0;
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return -1; /* a socket that names no protocol of ours */
    default:
        return lws_callback_http_dummy(wsi, reason, user, in, length);
    }
}
