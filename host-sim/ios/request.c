#include "ios/request.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* ---- paths ---- */

static bool is_plain(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
}

bool ios_name_is_plain(const char *name, size_t length)
{
    if (length < 1 || length > IOS_NAME_MAX || name[0] == '.') {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        if (!is_plain(name[i])) {
            return false;
        }
    }
    return true;
}

/* Names between slashes; returns how many, 0: it is no such path. */
static int count_names(const char *path)
{
    int count = 0;
    for (;;) {
        const size_t length = strcspn(path, "/");
        if (!ios_name_is_plain(path, length)) {
            return 0;
        }
        count++;
        if (path[length] == '\0') {
            return count;
        }
        path += length + 1;
    }
}

/* A whole number of at most 7 digits. Returns what is behind it, or NULL. */
static const char *read_number(const char *text, uint32_t *number)
{
    const char *at = text;
    for (*number = 0; *at >= '0' && *at <= '9' && at - text < 8; at++) {
        *number = *number * 10 + (uint32_t)(*at - '0');
    }
    return at > text && at - text < 8 ? at : NULL;
}

static bool read_tile(struct ios_route *r, const char *text)
{
    const char *at = read_number(text, &r->zoom);
    at = at != NULL && *at == '/' ? read_number(at + 1, &r->x) : NULL;
    at = at != NULL && *at == '/' ? read_number(at + 1, &r->y) : NULL;
    return at != NULL && strcmp(at, ".png") == 0 && r->zoom <= IOS_ZOOM_MAX &&
           r->x >> r->zoom == 0 && r->y >> r->zoom == 0;
}

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* What lies below a folder of its own; `names` are those of the whole path. */
static bool read_below(struct ios_route *r, int names)
{
    char rest[sizeof r->name];
    if (begins(r->name, "map/")) {
        snprintf(rest, sizeof rest, "%s", r->name + strlen("map/"));
        r->kind = IOS_ROUTE_TILE;
        return read_tile(r, rest);
    }
    const bool is_recording = begins(r->name, "recordings/");
    if (!is_recording && !begins(r->name, "display/")) {
        return true; /* a file */
    }
    snprintf(rest, sizeof rest, "%s", strchr(r->name, '/') + 1);
    memcpy(r->name, rest, sizeof rest);
    r->kind = is_recording ? IOS_ROUTE_RECORDING : IOS_ROUTE_DISPLAY;
    return names == 2 || (is_recording && names == 3);
}

bool ios_route_read(struct ios_route *r, const char *path)
{
    static const struct {
        const char *path;
        enum ios_route_kind kind;
    } fixed[] = {{"image", IOS_ROUTE_IMAGE},
                 {"map.json", IOS_ROUTE_MAP},
                 {"station.json", IOS_ROUTE_STATION},
                 {"recordings.json", IOS_ROUTE_LIST},
                 {"counters.json", IOS_ROUTE_COUNTERS},
                 {"bus", IOS_ROUTE_BUS}};
    *r = (struct ios_route){.kind = IOS_ROUTE_FILE};
    const size_t length = strlen(path);
    static const char index[] = "index.html";
    if (path[0] != '/' || length + sizeof index > sizeof r->name) {
        return false;
    }
    snprintf(r->name, sizeof r->name, "%s%s", path + 1, path[length - 1] == '/' ? index : "");
    const int names = count_names(r->name);
    for (size_t i = 0; i < sizeof fixed / sizeof fixed[0]; i++) {
        if (strcmp(r->name, fixed[i].path) == 0) {
            r->kind = fixed[i].kind;
        }
    }
    return names > 0 && (r->kind != IOS_ROUTE_FILE || read_below(r, names));
}

/* ---- ranges ---- */

static const char *read_offset(const char *text, uint64_t *number)
{
    const char *at = text;
    for (*number = 0; *at >= '0' && *at <= '9' && at - text < 16; at++) {
        *number = *number * 10 + (uint64_t)(*at - '0');
    }
    return at > text && at - text < 16 ? at : NULL;
}

/* "-N": the last N bytes. */
static enum ios_range_kind read_suffix(struct ios_range *range, const char *text, uint64_t size)
{
    uint64_t count;
    const char *end = read_offset(text, &count);
    if (end == NULL || *end != '\0') {
        return IOS_RANGE_ALL;
    }
    if (count == 0 || size == 0) {
        return IOS_RANGE_NONE;
    }
    count = count < size ? count : size;
    *range = (struct ios_range){size - count, count};
    return IOS_RANGE_PART;
}

enum ios_range_kind ios_range_read(struct ios_range *range, const char *header, uint64_t size)
{
    *range = (struct ios_range){0, size};
    if (header == NULL || strncmp(header, "bytes=", 6) != 0) {
        return IOS_RANGE_ALL;
    }
    if (header[6] == '-') {
        return read_suffix(range, header + 7, size);
    }
    uint64_t first, last = UINT64_MAX;
    const char *at = read_offset(header + 6, &first);
    if (at == NULL || *at != '-') {
        return IOS_RANGE_ALL;
    }
    if (at[1] != '\0') {
        at = read_offset(at + 1, &last);
        if (at == NULL || *at != '\0' || last < first) {
            return IOS_RANGE_ALL;
        }
    }
    if (first >= size) {
        return IOS_RANGE_NONE;
    }
    last = last < size ? last : size - 1;
    *range = (struct ios_range){first, last - first + 1};
    return IOS_RANGE_PART;
}

/* ---- who asks ---- */

bool ios_hosts_add(struct ios_hosts *hosts, const char *name)
{
    const size_t length = strlen(name);
    if (hosts->count == IOS_HOSTS_MAX || length < 1 || length > IOS_NAME_MAX ||
        strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-:[]") !=
            length) {
        return false;
    }
    char *to = hosts->name[hosts->count++];
    for (size_t i = 0; i <= length; i++) {
        to[i] = (char)tolower((unsigned char)name[i]);
    }
    return true;
}

bool ios_host_is_ours(const struct ios_hosts *hosts, const char *host)
{
    for (int i = 0; i < hosts->count; i++) {
        if (strcasecmp(host, hosts->name[i]) == 0) {
            return true;
        }
    }
    return false;
}

bool ios_origin_is_ours(const struct ios_hosts *hosts, const char *origin)
{
    static const char *const schemes[] = {"http://", "https://"};
    for (size_t i = 0; i < 2; i++) {
        if (begins(origin, schemes[i])) {
            return ios_host_is_ours(hosts, origin + strlen(schemes[i]));
        }
    }
    return false;
}

bool ios_is_same_secret(const char *a, const char *b)
{
    const size_t length = strlen(a);
    unsigned char difference = 0;
    if (strlen(b) != length) {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        difference |= (unsigned char)(a[i] ^ b[i]);
    }
    return difference == 0;
}

bool ios_cookie_read(const char *header, const char *name, char *value, size_t room)
{
    const size_t name_length = strlen(name);
    for (const char *at = header; *at != '\0';) {
        at += strspn(at, "; ");
        const size_t length = strcspn(at, ";");
        if (length > name_length && strncmp(at, name, name_length) == 0 && at[name_length] == '=') {
            const size_t bytes = length - name_length - 1;
            if (bytes >= room) {
                return false;
            }
            memcpy(value, at + name_length + 1, bytes);
            value[bytes] = '\0';
            return true;
        }
        at += length;
    }
    return false;
}

const char *ios_bearer_token(const char *header)
{
    return strncasecmp(header, "Bearer ", 7) == 0 ? header + 7 : NULL;
}

const char *ios_media_type(const char *name)
{
    static const char *const types[][2] = {{".html", "text/html; charset=utf-8"},
                                           {".css", "text/css; charset=utf-8"},
                                           {".mjs", "text/javascript; charset=utf-8"},
                                           {".js", "text/javascript; charset=utf-8"},
                                           {".json", "application/json"},
                                           {".wasm", "application/wasm"},
                                           {".png", "image/png"},
                                           {".svg", "image/svg+xml"},
                                           {".webm", "video/webm"},
                                           {".log", "text/plain; charset=utf-8"},
                                           {".txt", "text/plain; charset=utf-8"}};
    const char *end = strrchr(name, '.');
    for (size_t i = 0; end != NULL && i < sizeof types / sizeof types[0]; i++) {
        if (strcmp(end, types[i][0]) == 0) {
            return types[i][1];
        }
    }
    return "application/octet-stream";
}
