#include "options.h"

#include "hs/error.h"
#include "hs/network_options.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct hs_usage usage = {
    "", "the instructor's station: pages of the exercise, for browsers on this machine",
    "A web server between the avionics bus and pages: a moving map made from the database, live "
    "targets, weather, malfunctions and the exercise clock, repeaters of the displays, and their "
    "recordings. Whatever a page does goes out as a frame of the bus (docs/bus.md), and comes back "
    "to "
    "all pages.\n"
    "\n"
    "It listens at 127.0.0.1, so that nobody beyond this machine reaches it. Elsewhere it needs a "
    "token, and should have a proxy with TLS before it: docs/ios.md."};

/* NAME[:NODE]=FOLDER */
static const char *take_display(void *context, const char *text)
{
    struct command *c = context;
    const size_t length = strcspn(text, ":=");
    struct display d = {.node = 0};
    if (c->display_count == DISPLAYS_MAX) {
        return "at most 16 displays";
    }
    if (!ios_name_is_plain(text, length)) {
        return "needs NAME[:NODE]=FOLDER, the name of letters, digits, and . _ -";
    }
    memcpy(d.name, text, length);
    const char *at = text + length;
    if (*at == ':') {
        char *end;
        d.node = strtol(at + 1, &end, 10);
        at = end;
        if (d.node < 1 || d.node > 255) {
            return "needs a node of 1..255 behind the colon";
        }
    }
    if (*at != '=' || at[1] == '\0') {
        return "needs NAME[:NODE]=FOLDER";
    }
    d.folder = at + 1;
    for (int i = 0; i < c->display_count; i++) {
        if (strcmp(c->display[i].name, d.name) == 0) {
            return "needs names that are different";
        }
    }
    c->display[c->display_count++] = d;
    return NULL;
}

static bool read_table(struct command *c, int argc, char **argv, int *exit_code)
{
    const struct hs_taker can = {hs_take_interface, &c->can}, bind = {hs_take_address, &c->bind},
                          display = {take_display, c};
    const struct hs_option options[] = {
        {"The bus", HS_HEADING, NULL, 0, 0, NULL,
         "One of these; left out: no bus, and pages tell each other.", false},
        {"can", HS_TAKER, (void *)&can, 0, 0, "NAME", "a SocketCAN interface, such as can0", false},
        {"log", HS_INPUT, &c->log_path, 0, 0, "FILE",
         "a recorded bus as candump -L writes it, in real time, to its end; what pages send is "
         "told to "
         "pages alone",
         false},
        {"listen-only", HS_FLAG, &c->is_listening_only, 0, 0, NULL,
         "pages look on and send nothing", false},
        {"out", HS_OUTPUT, &c->out_path, 0, 0, "FILE",
         "write all that goes over the bus, as candump -L does", false},
        {"What the pages show", HS_HEADING, NULL, 0, 0, NULL, "", false},
        {"image", HS_INPUT, &c->image_path, 0, 0, "IMAGE",
         "the displays' database: the map is made from it, and repeaters fly over it", true},
        {"site", HS_TEXT, &c->site, 0, 0, "FOLDER",
         "the pages; left out: ../share/landmass/ios beside this program, or ../ios of a build",
         false},
        {"display", HS_TAKER, (void *)&display, 0, 0, "NAME[:NODE]=FOLDER",
         "a display, its node on the bus, and the folder in which its panel records; up to 16 "
         "times",
         false},
        {"recordings", HS_TEXT, &c->recordings, 0, 0, "FOLDER", "more recordings", false},
        {"Who may reach it", HS_HEADING, NULL, 0, 0, NULL, "", false},
        {"port", HS_INTEGER, &c->port, 0, 65535, "PORT",
         "of the server; 0: any that is free, which is printed", false},
        {"bind", HS_TAKER, (void *)&bind, 0, 0, "ADDRESS",
         "listen at this address of the machine, 0.0.0.0 for all; needs --token-file unless it is "
         "127.0.0.1, which is used when this is left out",
         false},
        {"host", HS_LIST, &c->hosts, 0, 0, "NAME[,NAME...]",
         "a name, with its port where that is not 80 or 443, by which browsers call the server; "
         "requests that name another are refused",
         false},
        {"token-file", HS_INPUT, &c->token_path, 0, 0, "FILE",
         "its first line, 16 to 128 characters, is asked of every browser: once as "
         "http://HOST/?token=TOKEN",
         false},
        {"seconds", HS_REAL, &c->seconds, 0.01, 1e9, "S",
         "stop after S seconds; left out: when it is interrupted", false},
        {"quiet", HS_FLAG, &c->is_quiet, 0, 0, NULL, "no address and no summary", false},
        HS_CLASHES_ROW("log", "can"),
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

/* The pages of an installed program, or of a build. */
static const char *usual_site(void)
{
    static char path[PATH_MAX];
    static const char *const places[] = {"/../share/landmass/ios", "/../ios"};
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 64);
    char *slash = length > 0 ? (path[length] = '\0', strrchr(path, '/')) : NULL;
    for (size_t i = 0; slash != NULL && i < 2; i++) {
        strcpy(slash, places[i]);
        if (access(path, X_OK) == 0) {
            return path;
        }
    }
    return NULL;
}

bool ios_options_read(struct command *c, int argc, char **argv, int *exit_code)
{
    *c = (struct command){.bind = "127.0.0.1", .port = 8470};
    if (!read_table(c, argc, argv, exit_code)) {
        return false;
    }
    c->site = c->site != NULL ? c->site : usual_site();
    if (c->site == NULL) {
        *exit_code = hs_options_wrong(&usage, "--site", "must be given: the pages are not found");
        return false;
    }
    if (strncmp(c->bind, "127.", 4) != 0 && c->token_path == NULL) {
        *exit_code = hs_options_wrong(
            &usage, "--bind",
            "needs --token-file: whoever reaches the address commands the exercise");
        return false;
    }
    return true;
}

void ios_options_free(struct command *c)
{
    hs_list_free(&c->hosts);
}
