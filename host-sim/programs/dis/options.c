#include "options.h"

#include "hs/error.h"
#include "hs/network_options.h"
#include "hs/number.h"

#include <arpa/inet.h>
#include <math.h>
#include <string.h>

/* Whole numbers 0..65535 parted by `separator`; -1: they are not. */
static int take_numbers(const char *text, char separator, uint16_t *numbers, int most)
{
    double v[DIS_FILTER_MAX];
    const int count = hs_numbers(text, separator, v, most);
    for (int i = 0; i < count; i++) {
        if (v[i] < 0 || v[i] > 65535 || v[i] != floor(v[i])) {
            return -1;
        }
        numbers[i] = (uint16_t)v[i];
    }
    return count;
}

static const char *take_filter(void *context, const char *text)
{
    struct dis_filter *f = context;
    const int count = take_numbers(text, ',', f->number + f->count, DIS_FILTER_MAX - f->count);
    f->count += count > 0 ? count : 0;
    return count > 0 ? NULL : "needs whole numbers of 0..65535, parted by commas, up to 32";
}

static const char *take_ownship(void *context, const char *text)
{
    struct dis_settings *s = context;
    uint16_t id[3];
    if (take_numbers(text, ':', id, 3) != 3) {
        return "needs SITE:APPLICATION:ENTITY, three numbers of 0..65535";
    }
    s->ownship = (struct dis_id){id[0], id[1], id[2]};
    s->has_ownship = true;
    return NULL;
}

static const char *take_centre(void *context, const char *text)
{
    struct dis_settings *s = context;
    double v[2];
    if (hs_numbers(text, ',', v, 2) != 2 || fabs(v[0]) > 90 || fabs(v[1]) > 180) {
        return "needs LAT,LON in degrees";
    }
    s->centre = (struct dis_place){v[0], v[1], 0};
    s->has_centre = true;
    return NULL;
}

static const char *take_targets(void *context, const char *text)
{
    struct dis_settings *s = context;
    uint16_t v[2];
    if (take_numbers(text, '-', v, 2) != 2 || v[1] > 255 || v[0] > v[1]) {
        return "needs FIRST-LAST within 0..255";
    }
    s->first_number = (uint8_t)v[0];
    s->last_number = (uint8_t)v[1];
    return NULL;
}

static const char *take_group(void *context, const char *text)
{
    struct in_addr parsed;
    const char *cause = hs_take_address(context, text);
    if (cause == NULL && inet_pton(AF_INET, text, &parsed) == 1 &&
        IN_MULTICAST(ntohl(parsed.s_addr))) {
        return NULL;
    }
    return "needs a multicast address, 224.0.0.0 to 239.255.255.255";
}

static const struct hs_usage usage = {
    "", "tell the display of the entities of a DIS exercise",
    "Distributed Interactive Simulation (IEEE 1278.1), versions 6 and 7, becomes live targets on "
    "the display's CAN bus. The entities come from a UDP port, a recorded capture or files of one "
    "datagram each; the frames go to an interface or into a log, as candump -L writes it.\n"
    "\n"
    "Each target is told when it is new, when the display's dead reckoning of it is off by more "
    "than a threshold, and once a second."};

/* What options give that has no place of its own in struct command. */
struct raw {
    struct hs_taker exercises, sites, applications, ownship, centre, targets;
    struct hs_taker interface, can, bind, group;
    double load_percent, bitrate_kbit_s, geoid_m;
    long node;
};

static bool read_table(struct command *c, struct raw *raw, int argc, char **argv, int *exit_code)
{
    struct dis_settings *s = &c->settings;
    const struct hs_option options[] = {
        {"Where the entities come from", HS_HEADING, NULL, 0, 0, NULL, "One of these.", false},
        {"listen", HS_INTEGER, &c->listen_port, 1, 65535, "PORT",
         "a UDP port, 3000 by custom; the run ends by --seconds or an interrupt", false},
        {"capture", HS_INPUT, &c->capture_path, 0, 0, "FILE",
         "a capture in pcap or pcapng, as tcpdump -w writes it; its own times are used", false},
        {"pdu", HS_INPUTS, &c->pdu_paths, 0, 0, "FILE[,FILE...]",
         "the bytes of a datagram each, taken one second after the other from time 0", false},
        {"cigi", HS_FLAG, &c->is_cigi, 0, 0, NULL,
         "the datagrams are those of a host of CIGI 3 to its image generator, not of DIS: entity 0 "
         "is the ownship, others are 0.DOMAIN.TYPE of the table of kinds, DOMAIN 1 for those "
         "clamped to the ground and 2 else",
         false},
        {"bind", HS_TAKER, &raw->bind, 0, 0, "ADDRESS",
         "listen at this address of the machine; 0.0.0.0: at all, broadcasts too. Left out: "
         "127.0.0.1, the machine itself, or 0.0.0.0 with --group",
         false},
        {"group", HS_TAKER, &raw->group, 0, 0, "ADDRESS", "join this multicast group", false},
        {"port", HS_INTEGER, &c->port, 1, 65535, "PORT",
         "of a capture, take what was sent to this port alone; left out: all of UDP", false},
        {"seconds", HS_REAL, &c->seconds, 0.01, 1e9, "S",
         "stop S seconds after the beginning; left out: at the end of the record", false},
        {"Where the frames go", HS_HEADING, NULL, 0, 0, NULL, "", false},
        {"out", HS_OUTPUT, &c->out_path, 0, 0, "FILE",
         "a log; left out, and without --can: standard output", false},
        {"can", HS_TAKER, &raw->can, 0, 0, "NAME",
         "an interface of SocketCAN, at the speed of the record", false},
        {"iface", HS_TAKER, &raw->interface, 0, 0, "NAME", "interface named in the log (can0)",
         false},
        {"node", HS_INTEGER, &raw->node, 1, 255, "N", "number of this sender on the bus", false},
        {"bitrate", HS_REAL, &raw->bitrate_kbit_s, 10, 1000, "KBIT", "of the bus, kbit/s", false},
        {"load", HS_REAL, &raw->load_percent, 1, 100, "PERCENT",
         "share of the bus that is never exceeded", false},
        {"heartbeat", HS_REAL, &s->heartbeat_s, 0.1, 2.5, "S", "tell each target so often", false},
        {"threshold", HS_REAL, &s->threshold_m, 0.1, 1000, "M",
         "tell it at once when the display has it this far off", false},
        {"threshold-heading", HS_REAL, &s->threshold_deg, 0.1, 180, "DEG", "or turned by this much",
         false},
        {"clock", HS_FLAG, &s->tells_clock, 0, 0, NULL,
         "tell the displays an exercise clock too: 0 when the run begins, and standing while the "
         "exercise is frozen",
         false},
        {"Which entities become targets", HS_HEADING, NULL, 0, 0, NULL, "", false},
        {"exercise", HS_TAKER, &raw->exercises, 0, 0, "N[,N...]",
         "take these exercises; left out: all", false},
        {"site", HS_TAKER, &raw->sites, 0, 0, "N[,N...]", "take these sites; left out: all", false},
        {"application", HS_TAKER, &raw->applications, 0, 0, "N[,N...]",
         "take these applications; left out: all", false},
        {"ownship", HS_TAKER, &raw->ownship, 0, 0, "SITE:APPLICATION:ENTITY",
         "the entity that carries the display: no target, and the nearest to it come first", false},
        {"near", HS_TAKER, &raw->centre, 0, 0, "LAT,LON",
         "the nearest to this place come first. Without this and --ownship: the first that came",
         false},
        {"targets", HS_TAKER, &raw->targets, 0, 0, "FIRST-LAST",
         "numbers of the bus to use; left out: 0-255", false},
        {"timeout", HS_REAL, &s->timeout_s, 1, 3600, "S",
         "remove an entity that was silent so long", false},
        {"kinds", HS_INPUT, &c->kinds_path, 0, 0, "FILE",
         "which target an entity's type becomes; docs/dis.md explains it. Left out: a table that "
         "is built in",
         false},
        {"print-kinds", HS_FLAG, &c->prints_kinds, 0, 0, NULL,
         "print that table, to begin one of your own with, and do nothing else", false},
        {"image", HS_INPUT, &c->image_path, 0, 0, "IMAGE",
         "the display's database, for the height of mean sea level above the ellipsoid", false},
        {"geoid", HS_REAL, &raw->geoid_m, -120, 120, "M",
         "that height, where there is no image; left out: 0", false},
        {"quiet", HS_FLAG, &c->is_quiet, 0, 0, NULL, "no summary on standard error", false},
        HS_NEEDS_ROW("cigi", "kinds"),
        HS_CLASHES_ROW("cigi", "exercise|site|application|ownship"),
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

/* Options that make sense alone and not together. */
static bool fits(const struct command *c, const struct raw *raw, int *exit_code)
{
    const int sources =
        (c->listen_port != 0) + (c->capture_path != NULL) + (c->pdu_paths.count > 0);
    const char *option = NULL, *cause = NULL;
    if (c->prints_kinds) {
        return true;
    }
    if (sources != 1) {
        option = "--listen";
        cause = "or --capture or --pdu must be given, and only one of them";
    } else if (c->out_path != NULL && c->can != NULL) {
        option = "--can";
        cause = "does not go with --out";
    } else if ((c->bind != NULL || c->group != NULL) && c->listen_port == 0) {
        option = c->bind != NULL ? "--bind" : "--group";
        cause = "goes with --listen alone";
    } else if (c->port != 0 && c->capture_path == NULL) {
        option = "--port";
        cause = "goes with --capture alone";
    } else if (c->image_path != NULL && !isnan(raw->geoid_m)) {
        option = "--geoid";
        cause = "does not go with --image, which has it";
    }
    if (option != NULL) {
        *exit_code = hs_options_wrong(&usage, option, cause);
    }
    return option == NULL;
}

bool dis_options_read(struct command *c, int argc, char **argv, int *exit_code)
{
    *c = (struct command){.interface = "can0", .settings = dis_settings_usual()};
    struct dis_settings *s = &c->settings;
    struct raw raw = {.exercises = {take_filter, &s->exercises},
                      .sites = {take_filter, &s->sites},
                      .applications = {take_filter, &s->applications},
                      .ownship = {take_ownship, s},
                      .centre = {take_centre, s},
                      .targets = {take_targets, s},
                      .interface = {hs_take_interface, &c->interface},
                      .can = {hs_take_interface, &c->can},
                      .bind = {hs_take_address, &c->bind},
                      .group = {take_group, &c->group},
                      .load_percent = s->load * 100,
                      .bitrate_kbit_s = s->bits_per_s / 1000,
                      .geoid_m = (double)NAN,
                      .node = s->node};
    if (!read_table(c, &raw, argc, argv, exit_code) || !fits(c, &raw, exit_code)) {
        return false;
    }
    s->bits_per_s = raw.bitrate_kbit_s * 1000;
    s->load = raw.load_percent / 100;
    s->node = (uint8_t)raw.node;
    s->has_ownship |= c->is_cigi;
    s->sea.height_m = isnan(raw.geoid_m) ? 0 : raw.geoid_m;
    return true;
}

void dis_options_free(struct command *c)
{
    hs_list_free(&c->pdu_paths);
}
