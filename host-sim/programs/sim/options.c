#include "options.h"

#include "hs/error.h"
#include "hs/options.h"
#include "sim/window.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    "", "run the display unit's firmware on this PC",
    "Fly a database image: the bus comes from a log or from a CAN interface, controls from a "
    "script or a window, and pictures go to the window or to files. Without a bus the unit shows "
    "what it shows in the cockpit when the bus is dead."};

static const char script_help[] =
    "A script has one command a line, each with its time; '#' begins a remark:\n"
    "  SECONDS gm|gmt|sea|bcn [norm|exp|dbs1|dbs2]    mode and field of view (dbs: gm only)\n"
    "  SECONDS range 10|20|40|80                  nautical miles: a scale of the radar in use\n"
    "  SECONDS azimuth 60|30|10                   degrees to each side\n"
    "  SECONDS gain DB | freeze on|off            -30..30 dB\n"
    "  SECONDS sar LAT LON CELL_M [EFFECT..]      patch of 256 x 256 cells seen from the ownship\n"
    "  SECONDS sarfrom LAT LON CELL_M LOOK_DEG RANGE_M HEIGHT_M [EFFECT..]\n"
    "                                             the same from a commanded place in the air;\n"
    "                                             EFFECT: plan: no layover; steady: no blur in\n"
    "                                             turns\n"
    "  SECONDS steer LAT LON | steer off          steerpoint; off: the bus's steerpoint\n"
    "  SECONDS rain LAT LON RADIUS_KM MM_PER_H    one more circle of rain (4 at most):\n"
    "                                             0.1..100 km, 1..150 mm/h\n"
    "  SECONDS jam LAT LON DB                     one more jammer (4 at most), -20..80 dB over\n"
    "                                             the noise at ten nautical miles\n"
    "  SECONDS weather fair                       no rain, nobody jams\n"
    "  SECONDS seastate 0..8 [WIND_DEG]           (3, the default, is that of the image);\n"
    "                                             degrees from north that the wind comes from\n"
    "  SECONDS clock SHOWN_S [SEED]               the exercise's clock begins, on the unit's bus\n"
    "  SECONDS clock rate RATE                    its pace from then on, 0..16; 0: it stands\n"
    "  SECONDS break NAME[=VALUE[,VALUE]] [FOR_S] a malfunction, for FOR_S or to the end: names\n"
    "                                             and values are those of landmass-nav --help\n"
    "  SECONDS osb N [HELD_S]                     press option select button 1..20\n"
    "  SECONDS rocker gain|sym|brt|con +1|-1      one step\n"
    "  SECONDS knob X                             range knob, -1..1\n"
    "  SECONDS slew X Y FOR_S                     cursor to the right and up, -1..1\n"
    "  SECONDS cursor LAT LON                     put the cursor at a place\n"
    "  SECONDS designate | drop                   target management switch up, down\n"
    "  SECONDS track                              the switch right: track what is at the cursor\n"
    "  SECONDS ranging                            range the ground straight ahead, or end that\n"
    "  SECONDS mount 1|2|3|4 FILE                 an image comes to this place: of --db, --db2 ..\n"
    "  SECONDS unmount 1|2|3|4                    the image at this place goes\n"
    "  SECONDS picture NAME                       write DIR/NAME.png then\n";

static const char *take_size(void *context, const char *text)
{
    struct options *o = context;
    unsigned width, height;
    char rest;
    if (sscanf(text, "%ux%u%c", &width, &height, &rest) != 2 || width < 256 || width > 1024 ||
        height < 256 || height > 1024) {
        return "needs WxH, 256..1024 each";
    }
    o->width_px = (uint16_t)width;
    o->height_px = (uint16_t)height;
    return NULL;
}

static const char *take_glass(void *context, const char *word)
{
    struct lm_glass_options *glass = context;
    const struct {
        const char *word;
        bool *is_chosen;
    } choices[] = {{"whole", &glass->is_sector_whole},
                   {"heading", &glass->has_heading},
                   {"strobe", &glass->has_strobe},
                   {"borders", &glass->has_borders}};
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++) {
        if (strcmp(word, choices[i].word) == 0) {
            *choices[i].is_chosen = true;
            return NULL;
        }
    }
    return hs_options_words("whole|heading|strobe|borders");
}

/* "1,2,17". */
static const char *take_nodes(void *context, const char *text)
{
    struct options *o = context;
    o->has_nodes = true;
    for (char *end; *text != '\0'; text = *end == ',' ? end + 1 : end) {
        const long node = strtol(text, &end, 10);
        if (end == text || node < 1 || node > 255 || (*end != '\0' && *end != ',')) {
            return "needs numbers of nodes, 1..255, between commas";
        }
        o->nodes[node / 8] |= (uint8_t)(1u << node % 8);
    }
    return NULL;
}

static const char *take_profile(void *context, const char *name)
{
    const struct lm_bus_profile **profile = context;
    *profile = lm_bus_profile_named(lm_bus_profiles, name);
    return *profile ? NULL : "needs a profile of docs/bus.md";
}

/* Numbers as the table of options keeps them. */
struct raw {
    long node, partner, every, seed;
    double start, seconds, from, speed;
};

static bool read_table(struct options *o, struct raw *raw, int argc, char **argv, int *exit_code)
{
    struct hs_taker nodes = {take_nodes, o}, size = {take_size, o}, glass = {take_glass, &o->glass},
                    profile = {take_profile, &o->profile},
                    profile_2 = {take_profile, &o->profile_2};
    const struct hs_option options[] = {
        {"db", HS_INPUT, &o->database, 0, 0, "FILE", "flash image made by landmass-db build", true},
        {"db2", HS_INPUT, &o->further[0], 0, 0, "FILE",
         "a second image; at each place the finest that has data there answers", false},
        {"db3", HS_INPUT, &o->further[1], 0, 0, "FILE", "a third", false},
        {"db4", HS_INPUT, &o->further[2], 0, 0, "FILE", "a fourth", false},
        {"bus", HS_INPUT, &o->bus_log, 0, 0, "FILE.log",
         "take the bus from a candump -L log, in flight time from its first frame", false},
        {"can", HS_TEXT, &o->can_interface, 0, 0, "IFACE",
         "take the bus from a SocketCAN interface, in real time", false},
        {"profile", HS_TAKER, &profile, 0, 0, "NAME",
         "what the bus's frames mean: a profile of docs/bus.md; left out: the table of the "
         "database, "
         "or canas17",
         false},
        {"table", HS_INPUT, &o->table, 0, 0, "FILE",
         "a text table of the bus (docs/bus.md); with --profile it is heard beside that", false},
        {"bus2", HS_INPUT, &o->bus_log_2, 0, 0, "FILE.log",
         "a second interface: its log, in flight time from its first frame", false},
        {"profile2", HS_TAKER, &profile_2, 0, 0, "NAME",
         "what its frames mean: a profile (canas17, if there is no --table2)", false},
        {"table2", HS_INPUT, &o->table_2, 0, 0, "FILE", "or a text table, or both", false},
        {"nodes", HS_TAKER, &nodes, 0, 0, "N,N..",
         "hear only these nodes of the bus, and refuse the others", false},
        {"heading", HS_CHOICE, &o->heading, 0, 0, "true|magnetic",
         "what the bus's heading angle (321) is from; a magnetic one needs the variation (1121)",
         false},
        {"node", HS_INTEGER, &raw->node, 0, 255, "N",
         "be this node of a CANaerospace bus and answer requests; 0: only listen", false},
        {"reports", HS_FLAG, &o->tells_reports, 0, 0, NULL,
         "as that node, tell cursor, designated place, mode, state and controls (docs/bus.md)",
         false},
        {"obey-controls", HS_FLAG, &o->obeys_controls, 0, 0, NULL,
         "obey keys, knobs and commands that come as frames of the bus (docs/bus.md)", false},
        {"partner", HS_INTEGER, &raw->partner, 0, 255, "N",
         "SWAP exchanges the page with the display that is this node (docs/bus.md); 0: with none",
         false},
        {"bus-out", HS_OUTPUT, &o->bus_out, 0, 0, "FILE.log",
         "write the frames that the unit sends, as candump -L does, in flight time", false},
        {"record", HS_OUTPUT, &o->record, 0, 0, "FILE.log",
         "record the flight, so that --replay shows it again bit for bit on any machine", false},
        {"replay", HS_INPUT, &o->replay, 0, 0, "FILE.log",
         "show a recording of --record or of a panel; NAME-001.log, ... follow NAME-000.log",
         false},
        {"from", HS_REAL, &raw->from, 0, 9999999, "S",
         "of --replay: show and write pictures from here on; --seconds counts from here", false},
        {"speed", HS_REAL, &raw->speed, 0.015625, 64, "X",
         "of --replay in the window: 0.5 is half as fast", false},
        {"replay-anyway", HS_FLAG, &o->is_any_replayed, 0, 0, NULL,
         "replay although image, bus table, radar or version are not those of the recording",
         false},
        {"script", HS_INPUT, &o->script, 0, 0, "FILE", "operate the controls by a script (below)",
         false},
        {"png", HS_FOLDER, &o->png_folder, 0, 0, "DIR",
         "write pictures into DIR (made if need be) as frame-NNNNN.png", false},
        {"every", HS_INTEGER, &raw->every, 0, 1000000, "N",
         "write every Nth picture; 0: only those the script names", false},
        {"window", HS_FLAG, &o->has_window, 0, 0, NULL,
         "show bezel and glass in a window, in real time, and operate them (below)", false},
        {"bezel", HS_FLAG, &o->has_bezel, 0, 0, NULL,
         "draw the bezel into the pictures of --png too", false},
        {"size", HS_TAKER, &size, 0, 0, "WxH", "pixels of the glass, 256..1024 each (768x768)",
         false},
        {"glass", HS_TAKER, &glass, 0, 0, "whole|heading|strobe|borders",
         "a choice about the glass; give the option again for a second one.\n"
         "whole: the whole sector fits the frame; heading: the heading above the picture; strobe: "
         "a faint line along the beam; borders: lines along the sector's edges",
         false},
        {"start", HS_REAL, &raw->start, 0, 999999, "S",
         "begin S seconds into the log of --bus; the script's and --seconds' times count from "
         "there",
         false},
        {"seconds", HS_REAL, &raw->seconds, 0.001, 999999, "S",
         "flight time to run; left out: to the end of the log", false},
        {"radar", HS_INPUT, &o->radar, 0, 0, "FILE",
         "table of the radar, a text (landmass-radar); left out: the database's, or the built-in "
         "one",
         false},
        {"seed", HS_INTEGER, &raw->seed, 0, 0x7fffffff, "N",
         "another speckle; the same inputs and seed give the same pictures", false},
        {"quiet", HS_FLAG, &o->is_quiet, 0, 0, NULL, "no summary", false},
        HS_CLASHES_ROW("can", "bus"),
        HS_NEEDS_ROW("profile", "bus|can"),
        HS_NEEDS_ROW("heading", "bus|can"),
        HS_NEEDS_ROW("reports", "node"),
        HS_NEEDS_ROW("bus-out", "node"),
        HS_NEEDS_ROW("every", "png"),
        HS_NEEDS_ROW("bezel", "png"),
        HS_NEEDS_ROW("start", "bus"),
        {"Script", HS_HEADING, NULL, 0, 0, NULL, script_help, false},
        {"Keys of the window", HS_HEADING, NULL, 0, 0, NULL, window_keys_help, false},
        {"Keys of the window with --replay", HS_HEADING, NULL, 0, 0, NULL, window_player_help,
         false},
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

/* Whether the options make sense together. */
static bool check(const struct options *o, int *exit_code)
{
    if (o->bus_log && o->can_interface) {
        *exit_code = hs_options_wrong(&usage, "--bus", "and --can exclude each other");
        return false;
    }
    if ((o->profile_2 || o->table_2) && !o->bus_log_2 && !o->replay) {
        *exit_code = hs_options_wrong(&usage, o->table_2 ? "--table2" : "--profile2",
                                      "needs the second interface, --bus2, or --replay");
        return false;
    }
    if (o->bus_log_2 && !o->bus_log) {
        *exit_code = hs_options_wrong(&usage, "--bus2", "needs the first interface, --bus");
        return false;
    }
    if (o->tells_reports && o->node == 0) {
        *exit_code =
            hs_options_wrong(&usage, "--reports", "needs the unit's number on the bus, --node");
        return false;
    }
    if (o->partner != 0 && (o->node == 0 || o->node == o->partner)) {
        *exit_code = hs_options_wrong(&usage, "--partner", "needs a number of its own, --node");
        return false;
    }
    if (o->start_s > 0 && !o->bus_log) {
        *exit_code = hs_options_wrong(&usage, "--start", "needs the log of --bus");
        return false;
    }
    if (o->replay && (o->bus_log || o->can_interface || o->script || o->record || o->bus_out)) {
        *exit_code =
            hs_options_wrong(&usage, "--replay",
                             "has bus and controls of its own: without --bus, --can, --script, "
                             "--record and --bus-out");
        return false;
    }
    if ((o->from_s > 0 || o->is_any_replayed) && !o->replay) {
        *exit_code = hs_options_wrong(&usage, "--from", "and --replay-anyway need --replay");
        return false;
    }
    if (!o->has_window && !o->bus_log && !o->replay && o->seconds <= 0) {
        *exit_code = hs_options_wrong(&usage, "--seconds",
                                      "or --bus or --window is needed, or the run would never end");
        return false;
    }
    return true;
}

bool options_read(struct options *o, int argc, char **argv, int *exit_code)
{
    *o = (struct options){.width_px = 768, .height_px = 768};
    struct raw raw = {.every = 30, .seconds = NAN, .speed = 1};
    if (!read_table(o, &raw, argc, argv, exit_code)) {
        return false;
    }
    o->node = (uint8_t)raw.node;
    o->partner = (uint8_t)raw.partner;
    o->every = (uint32_t)raw.every;
    o->seed = (uint32_t)raw.seed;
    o->start_s = raw.start;
    o->from_s = raw.from;
    o->speed = raw.speed;
    o->seconds = isnan(raw.seconds) ? 0 : raw.seconds;
    return check(o, exit_code);
}
