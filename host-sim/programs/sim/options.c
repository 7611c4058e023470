#include "options.h"

#include "hs/error.h"
#include "sim/window.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "Usage: landmass-sim --db FILE [--bus FILE.log | --can IFACE] [options]\n"
    "\n"
    "Run the display unit's firmware on this PC.\n"
    "\n"
    "  --db FILE          flash image made by landmass-db build\n"
    "  --bus FILE.log     take the bus from a candump -L log, in flight time from its first frame\n"
    "  --can IFACE        take the bus from a SocketCAN interface, in real time\n"
    "  --profile NAME     what the bus's frames mean: a profile of docs/bus.md; default canas17\n"
    "  --node N           be node N (1..255) of a CANaerospace bus and answer requests; 0: only "
    "listen (default)\n"
    "  --script FILE      operate the controls by a script (below)\n"
    "  --png DIR          write pictures into DIR (made if need be) as frame-NNNNN.png\n"
    "  --every N          write every Nth picture; 0: only those the script names (default 30)\n"
    "  --window           show bezel and glass in a window, in real time, and operate them "
    "(below)\n"
    "  --bezel            draw the bezel into the pictures of --png too\n"
    "  --size WxH         pixels of the glass, 256..1024 each (default 768x768)\n"
    "  --glass WORD       a choice about the glass; give the option again for a second one:\n"
    "                     whole: the whole sector fits the frame; heading: the heading above\n"
    "                     the picture; strobe: a faint line along the beam; borders: lines\n"
    "                     along the sector's edges\n"
    "  --seconds S        flight time to run (default: to the end of the log)\n"
    "  --seed N           another speckle (default 0); the same inputs and seed give the same "
    "pictures\n"
    "  --quiet            no summary\n"
    "  -h, --help         this text\n"
    "\n"
    "Without a bus the unit shows what it shows in the cockpit when the bus is dead.\n"
    "\n"
    "A script has one command a line, each with its time; '#' begins a remark:\n"
    "  SECONDS gm|gmt|sea [norm|exp|dbs1|dbs2]    mode and field of view (dbs: gm only)\n"
    "  SECONDS range 10|20|40|80                  nautical miles\n"
    "  SECONDS azimuth 60|30|10                   degrees to each side\n"
    "  SECONDS gain DB | freeze on|off            -30..30 dB\n"
    "  SECONDS sar LAT LON CELL_M [EFFECT..]      patch of 256 x 256 cells seen from the ownship\n"
    "  SECONDS sarfrom LAT LON CELL_M LOOK_DEG RANGE_M HEIGHT_M [EFFECT..]\n"
    "                                             the same from a commanded place in the air;\n"
    "                                             EFFECT: layover; steady: no blur in turns\n"
    "  SECONDS steer LAT LON | steer off          steerpoint; off: the bus's steerpoint\n"
    "  SECONDS rain LAT LON RADIUS_KM MM_PER_H    one more circle of rain (4 at most):\n"
    "                                             0.1..100 km, 1..150 mm/h\n"
    "  SECONDS jam LAT LON DB                     one more jammer (4 at most), -20..80 dB over\n"
    "                                             the noise at ten nautical miles\n"
    "  SECONDS weather fair                       no rain, nobody jams\n"
    "  SECONDS seastate 0..8 [WIND_DEG]           (3, the default, is that of the image);\n"
    "                                             degrees from north that the wind comes from\n"
    "  SECONDS osb N [HELD_S]                     press option select button 1..20\n"
    "  SECONDS rocker gain|sym|brt|con +1|-1      one step\n"
    "  SECONDS knob X                             range knob, -1..1\n"
    "  SECONDS slew X Y FOR_S                     cursor to the right and up, -1..1\n"
    "  SECONDS designate | drop                   target management switch up, down\n"
    "  SECONDS picture NAME                       write DIR/NAME.png then\n"
    "\n"
    "Keys of the window:\n";

static const char help_end[] =
    "\n"
    "Exit codes: 0 done, 1 failed, 2 wrong command line.\n";

enum {
    OPT_DB = 1,
    OPT_BUS,
    OPT_CAN,
    OPT_PROFILE,
    OPT_NODE,
    OPT_SCRIPT,
    OPT_PNG,
    OPT_EVERY,
    OPT_WINDOW,
    OPT_BEZEL,
    OPT_SIZE,
    OPT_GLASS,
    OPT_SECONDS,
    OPT_SEED,
    OPT_QUIET,
    OPT_HELP
};

static const struct option table[] = {
    {"db", required_argument, NULL, OPT_DB},
    {"bus", required_argument, NULL, OPT_BUS},
    {"can", required_argument, NULL, OPT_CAN},
    {"profile", required_argument, NULL, OPT_PROFILE},
    {"node", required_argument, NULL, OPT_NODE},
    {"script", required_argument, NULL, OPT_SCRIPT},
    {"png", required_argument, NULL, OPT_PNG},
    {"every", required_argument, NULL, OPT_EVERY},
    {"window", no_argument, NULL, OPT_WINDOW},
    {"bezel", no_argument, NULL, OPT_BEZEL},
    {"size", required_argument, NULL, OPT_SIZE},
    {"glass", required_argument, NULL, OPT_GLASS},
    {"seconds", required_argument, NULL, OPT_SECONDS},
    {"seed", required_argument, NULL, OPT_SEED},
    {"quiet", no_argument, NULL, OPT_QUIET},
    {"help", no_argument, NULL, OPT_HELP},
    {0},
};

static bool whole(const char *text, long low, long high, long *value)
{
    char *end;
    *value = strtol(text, &end, 10);
    return end != text && *end == 0 && *value >= low && *value <= high;
}

static bool take_size(struct options *o, const char *text)
{
    unsigned width, height;
    char rest;
    if (sscanf(text, "%ux%u%c", &width, &height, &rest) != 2 || width < 256 || width > 1024 ||
        height < 256 || height > 1024) {
        return false;
    }
    o->width_px = (uint16_t)width;
    o->height_px = (uint16_t)height;
    return true;
}

static bool take_glass(struct lm_glass_options *glass, const char *word)
{
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
            return true;
        }
    }
    return false;
}

static bool take_value(struct options *o, int option)
{
    long n;
    char *end;
    switch (option) {
    case OPT_DB:
        o->database = optarg;
        return true;
    case OPT_BUS:
        o->bus_log = optarg;
        return true;
    case OPT_CAN:
        o->can_interface = optarg;
        return true;
    case OPT_PROFILE:
        o->profile = lm_bus_profile_named(lm_bus_profiles, optarg);
        return o->profile != NULL;
    case OPT_NODE:
        if (!whole(optarg, 0, 255, &n)) {
            return false;
        }
        o->node = (uint8_t)n;
        return true;
    case OPT_SCRIPT:
        o->script = optarg;
        return true;
    case OPT_PNG:
        o->png_folder = optarg;
        return true;
    case OPT_EVERY:
        o->every = whole(optarg, 0, 1000000, &n) ? (uint32_t)n : UINT32_MAX;
        return o->every != UINT32_MAX;
    case OPT_SIZE:
        return take_size(o, optarg);
    case OPT_GLASS:
        return take_glass(&o->glass, optarg);
    case OPT_SECONDS:
        o->seconds = strtod(optarg, &end);
        return end != optarg && *end == 0 && o->seconds > 0 && o->seconds < 1e6;
    case OPT_SEED:
        o->seed = whole(optarg, 0, 0x7fffffff, &n) ? (uint32_t)n : UINT32_MAX;
        return o->seed != UINT32_MAX;
    default:
        return false;
    }
}

static enum options_result check(const struct options *o)
{
    if (!o->database) {
        hs_error("command line", "landmass-sim --help", "--db FILE is missing");
        return OPTIONS_WRONG;
    }
    if (o->bus_log && o->can_interface) {
        hs_error("command line", "give one of them", "--bus and --can exclude each other");
        return OPTIONS_WRONG;
    }
    if (!o->has_window && !o->bus_log && o->seconds <= 0) {
        hs_error("command line", "add --seconds S, --bus or --window", "the run would never end");
        return OPTIONS_WRONG;
    }
    return OPTIONS_RUN;
}

enum options_result options_read(struct options *o, int argc, char **argv)
{
    memset(o, 0, sizeof *o);
    o->every = 30;
    o->profile = &lm_bus_canas17;
    o->width_px = o->height_px = 768;
    int option;
    opterr = 0; /* the words are ours */
    while ((option = getopt_long(argc, argv, ":h", table, NULL)) != -1) {
        if (option == OPT_HELP || option == 'h') {
            printf("%s%s%s", help, window_keys_help, help_end);
            return OPTIONS_DONE;
        }
        if (option == OPT_WINDOW) {
            o->has_window = true;
        } else if (option == OPT_BEZEL) {
            o->has_bezel = true;
        } else if (option == OPT_QUIET) {
            o->is_quiet = true;
        } else if (option == '?' || option == ':') {
            hs_error("command line", "landmass-sim --help",
                     option == '?' ? "there is no option \"%s\"" : "\"%s\" lacks its value",
                     argv[optind - 1]);
            return OPTIONS_WRONG;
        } else if (!take_value(o, option)) {
            hs_error("command line", "landmass-sim --help", "\"%s\" is no value for that option",
                     optarg);
            return OPTIONS_WRONG;
        }
    }
    if (optind < argc) {
        hs_error("command line", "landmass-sim --help", "\"%s\" is not an option", argv[optind]);
        return OPTIONS_WRONG;
    }
    return check(o);
}
