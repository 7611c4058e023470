#include "server.h"

#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    TICK_US = 5000,
    FOLLOW_TICK_US = 20000,
    CONNECTIONS_MAX = 256,
    HEADERS_MAX = 8192, /* bytes of a request's head */
    SLOW_S = 10,        /* a request that has not come by then is dropped */
    IDLE_S = 30,
    TOKEN_LEAST = 16,
    HEADER_MAX = 512 /* bytes of one that is looked at */
};

const char *const refusal_keys[REFUSALS] = {
    "other_host", "other_origin",   "no_token", "method",          "path",
    "not_there",  "too_many_pages", "no_frame", "not_instructors", "listening_only",
    "too_fast",   "slow_pages",     "bus_full"};

unsigned server_refuse(struct server *s, enum refusal why)
{
    static const unsigned statuses[REFUSALS] = {[REFUSED_HOST] = HTTP_STATUS_FORBIDDEN,
                                                [REFUSED_ORIGIN] = HTTP_STATUS_FORBIDDEN,
                                                [REFUSED_TOKEN] = HTTP_STATUS_UNAUTHORIZED,
                                                [REFUSED_METHOD] = HTTP_STATUS_METHOD_NOT_ALLOWED,
                                                [REFUSED_PATH] = HTTP_STATUS_BAD_REQUEST,
                                                [REFUSED_NOTHING] = HTTP_STATUS_NOT_FOUND,
                                                [REFUSED_CROWD] = HTTP_STATUS_SERVICE_UNAVAILABLE};
    s->count.refused[why]++;
    return statuses[why];
}

/* ---- who asks ---- */

/* A header of the request; empty if it is not there, or too long to be one of ours. */
static const char *header(struct lws *wsi, enum lws_token_indexes token, char text[HEADER_MAX])
{
    if (lws_hdr_copy(wsi, text, HEADER_MAX, token) < 0) {
        text[0] = '\0';
    }
    return text;
}

static bool has_token(const struct server *s, struct lws *wsi)
{
    char text[HEADER_MAX], value[TOKEN_MAX + 1];
    const char *bearer = ios_bearer_token(header(wsi, WSI_TOKEN_HTTP_AUTHORIZATION, text));
    if (bearer != NULL && ios_is_same_secret(s->token, bearer)) {
        return true;
    }
    if (ios_cookie_read(header(wsi, WSI_TOKEN_HTTP_COOKIE, text), "landmass_token", value,
                        sizeof value) &&
        ios_is_same_secret(s->token, value)) {
        return true;
    }
    const char *asked = lws_get_urlarg_by_name(wsi, "token=", text, sizeof text);
    return asked != NULL && ios_is_same_secret(s->token, asked);
}

unsigned server_admits(struct server *s, struct lws *wsi)
{
    char text[HEADER_MAX];
    if (!ios_host_is_ours(&s->hosts, header(wsi, WSI_TOKEN_HOST, text))) {
        return server_refuse(s, REFUSED_HOST);
    }
    if (lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > 0 &&
        !ios_origin_is_ours(&s->hosts, header(wsi, WSI_TOKEN_ORIGIN, text))) {
        return server_refuse(s, REFUSED_ORIGIN);
    }
    return s->token[0] != '\0' && !has_token(s, wsi) ? server_refuse(s, REFUSED_TOKEN) : 0;
}

const struct display *server_display(const struct server *s, const char *name)
{
    for (int i = 0; i < s->command->display_count; i++) {
        if (strcmp(s->command->display[i].name, name) == 0) {
            return &s->command->display[i];
        }
    }
    return NULL;
}

/* ---- time ---- */

static void on_tick(lws_sorted_usec_list_t *sul)
{
    struct server *s = lws_container_of(sul, struct server, tick);
    bus_step(s->bus);
    if (s->fed != s->bus->feed.end) {
        s->fed = s->bus->feed.end;
        lws_callback_on_writable_all_protocol(s->context, &server_protocols[PROTOCOL_BUS]);
    }
    lws_sul_schedule(s->context, 0, sul, on_tick, TICK_US);
}

static void on_follow_tick(lws_sorted_usec_list_t *sul)
{
    struct server *s = lws_container_of(sul, struct server, follow_tick);
    pages_check(s);
    if (s->repeaters > 0) {
        lws_callback_on_writable_all_protocol(s->context, &server_protocols[PROTOCOL_RECORDING]);
    }
    lws_sul_schedule(s->context, 0, sul, on_follow_tick, FOLLOW_TICK_US);
}

/* ---- beginning ---- */

static int read_token(struct server *s)
{
    const char *path = s->command->token_path;
    FILE *in = hs_input_open(path, "r");
    char line[TOKEN_MAX + 2];
    if (in == NULL) {
        return hs_error(path, NULL, "cannot be opened: %s", strerror(errno));
    }
    const bool is_read = fgets(line, sizeof line, in) != NULL;
    fclose(in);
    const size_t length = is_read ? strcspn(line, "\r\n") : 0;
    line[length] = '\0';
    if (length < TOKEN_LEAST || length > TOKEN_MAX ||
        !strpbrk(line, "0123456789abcdefghijklmnopqrstuvwxyz") ||
        strspn(line, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-") !=
            length) {
        return hs_error(path, "openssl rand -hex 24 makes one",
                        "its first line is no token: 16 to 128 letters, digits and . _ -");
    }
    memcpy(s->token, line, length + 1);
    return 0;
}

static int check_site(const char *folder)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/index.html", folder);
    return access(path, R_OK) == 0
               ? 0
               : hs_error(folder, "--site names the folder that `make ios-site` leaves",
                          "has no index.html: %s", strerror(errno));
}

static int name_hosts(struct server *s, int port)
{
    const char *const own[] = {"127.0.0.1", "localhost", s->command->bind};
    char name[IOS_NAME_MAX + 1];
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        snprintf(name, sizeof name, "%s:%d", own[i], port);
        (void)ios_hosts_add(&s->hosts, name);
    }
    for (int i = 0; i < s->command->hosts.count; i++) {
        if (!ios_hosts_add(&s->hosts, s->command->hosts.items[i])) {
            return hs_error("--host", NULL, "%s is no name of a host, or one too many",
                            s->command->hosts.items[i]);
        }
    }
    return 0;
}

static void emit(int level, const char *line)
{
    (void)level;
    fprintf(stderr, "landmass-ios: libwebsockets: %s", line);
}

const struct lws_protocols server_protocols[] = {
    {"http", answers_callback, sizeof(struct answer), 0, 0, NULL, 0},
    {"landmass-bus", page_callback, sizeof(struct page), 4096, 0, NULL, 0},
    {"landmass-recording", repeater_callback, sizeof(struct repeater), 4096, 0, NULL, 0},
    {0},
};

int server_open(struct server *s, const struct command *c, struct bus *bus,
                const struct image *image)
{
    *s = (struct server){.command = c, .bus = bus, .image = image};
    if (ios_map_open(&s->map, image) != 0 || (c->token_path != NULL && read_token(s) != 0)) {
        return -1;
    }
    if (check_site(c->site) != 0) {
        return -1;
    }
    lws_set_log_level(LLL_ERR, emit);
    const struct lws_context_creation_info info = {
        .port = (int)c->port,
        .iface = c->bind,
        .protocols = server_protocols,
        .user = s,
        .options = LWS_SERVER_OPTION_DISABLE_IPV6 | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND,
        .max_http_header_data = HEADERS_MAX,
        .max_http_header_pool = 64,
        .timeout_secs = SLOW_S,
        .keepalive_timeout = IDLE_S,
        .fd_limit_per_thread = CONNECTIONS_MAX,
    };
    s->context = lws_create_context(&info);
    if (s->context == NULL) {
        return hs_error("--port", "choose another, or 0 for any that is free",
                        "%s:%ld cannot be listened at", c->bind, c->port);
    }
    lws_sul_schedule(s->context, 0, &s->tick, on_tick, 1);
    lws_sul_schedule(s->context, 0, &s->follow_tick, on_follow_tick, 1);
    return name_hosts(s, server_port(s));
}

int server_port(const struct server *s)
{
    return lws_get_vhost_listen_port(lws_get_vhost_by_name(s->context, "default"));
}

bool server_step(struct server *s)
{
    return lws_service(s->context, 0) >= 0;
}

void server_close(struct server *s)
{
    if (s->context != NULL) {
        lws_context_destroy(s->context);
    }
    ios_map_close(&s->map);
    s->context = NULL;
}
